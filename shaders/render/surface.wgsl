// Shaded triangles: a colour of their own (`plain`), or a value looked up in the colour map (`mapped`).

struct Surface {
    @builtin(position) clip: vec4f,
    @location(0) position: vec3f,
    @location(1) normal: vec3f,
    @location(2) paint: vec3f,
}

@vertex
fn place(@location(0) position: vec3f, @location(1) normal: vec3f, @location(2) paint: vec3f) -> Surface {
    return Surface(view.clip * vec4f(position, 1.0), position, normal, paint);
}

/// Brightness of a surface, one where it faces the light; both sides of a surface are lit alike.
fn brightness(position: vec3f, normal: vec3f) -> f32 {
    let towards_eye = view.eye.xyz - view.eye.w * position;
    let facing = normal * select(-1.0, 1.0, dot(normal, towards_eye) >= 0.0);
    let lambert = 0.5 + 0.5 * dot(normalize(facing), view.light.xyz);
    return mix(1.0, lambert, view.light.w);
}

@fragment
fn plain(surface: Surface) -> @location(0) vec4f {
    return vec4f(surface.paint * brightness(surface.position, surface.normal), 1.0);
}
