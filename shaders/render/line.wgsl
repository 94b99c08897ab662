// Lines of a given width in pixels: each instance is a segment, drawn as a screen-aligned quadrilateral.

struct Line {
    @builtin(position) clip: vec4f,
    @location(0) colour: vec4f,
}

/// A point of a line, lifted off the surface it lies on.
fn lifted(position: vec3f) -> vec4f {
    let towards_eye = normalize(view.eye.xyz - view.eye.w * position);
    return view.clip * vec4f(position + view.lift * towards_eye, 1.0);
}

@vertex
fn stretch(
    @builtin(vertex_index) corner: u32,
    @location(0) from_: vec3f,
    @location(1) to_: vec3f,
    @location(2) colour: vec4f,
    @location(3) width: f32,
) -> Line {
    let a = lifted(from_);
    let b = lifted(to_);
    let across = b.xy / b.w * view.size - a.xy / a.w * view.size;
    let along = across / max(length(across), 1e-6);
    let side = select(-1.0, 1.0, (corner & 1u) == 1u);
    let is_end = (corner & 2u) == 2u;
    // Half a width beyond both ends closes the corners where segments meet.
    let cap = select(-1.0, 1.0, is_end);
    let shift = (vec2f(-along.y, along.x) * side + along * cap) * width / view.size;
    let end = select(a, b, is_end);
    return Line(vec4f(end.xy + shift * end.w, end.zw), colour);
}

@fragment
fn ink(line: Line) -> @location(0) vec4f {
    return line.colour;
}
