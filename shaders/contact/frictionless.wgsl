fn rub(role: u32, x: vec3f, v: vec3f, n: vec3f, push: f32, per_step: f32, pressed: vec3f) -> Rubbed {
    return Rubbed(pressed, 1u);
}
