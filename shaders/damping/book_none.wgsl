fn damping_work(mass: f32, before: vec3f, after: vec3f, way: vec3f) -> f32 {
    return 0.0;
}
