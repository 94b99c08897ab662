// Every chain stores all corners of its faces.

fn may_leave(there: bool) -> bool {
    return !there;
}

fn store(at: u32, chain: Chain, lane: u32, chains: u32, level: u32, f: Shared) {
    slots[at] = vec4r(f.a, 0.0);
    slots[at + CHAINS] = vec4r(f.b, 0.0);
    slots[at + 2u * CHAINS] = vec4r(f.c, 0.0);
    slots[at + 3u * CHAINS] = vec4r(f.d, 0.0);
}
