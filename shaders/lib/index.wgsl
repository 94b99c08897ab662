// Number of a work group in a dispatch folded into two dimensions, and of a thread.
fn group_index(group: vec3u, groups: vec3u) -> u32 {
    return group.y * groups.x + group.x;
}

fn thread_index(group: vec3u, groups: vec3u, lane: u32) -> u32 {
    return group_index(group, groups) * 64u + lane;
}
