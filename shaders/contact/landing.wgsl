// What puts a touching node on the surface to the last digit of the pair.
fn landing(x: Pair, touches: u32) -> vec3r {
    let n = road_normal(x.hi);
    return select(vec3r(0.0), -(road_gap(x.hi) + dot(n, x.lo)) * n, touches != 0u);
}
