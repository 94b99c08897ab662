// Index of a thread in a dispatch folded into two dimensions.
fn thread_index(group: vec3u, groups: vec3u, lane: u32) -> u32 {
    return (group.y * groups.x + group.x) * 64u + lane;
}
