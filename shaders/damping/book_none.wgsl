fn damping_work(mass: real, before: vec3r, after: vec3r, way: vec3r) -> real {
    return 0.0;
}
