fn rub(x: vec3f, n: vec3f, push: f32, per_step: f32, pressed: vec3f) -> Rubbed {
    return Rubbed(pressed, 1u);
}
