fn rub(role: u32, x: vec3r, v: vec3r, n: vec3r, push: real, per_step: real, pressed: vec3r) -> Rubbed {
    return Rubbed(pressed, 1u);
}
