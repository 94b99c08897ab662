// Lines of a given width in pixels: each instance is a segment, drawn as a screen-aligned quadrilateral.

struct Line {
    @builtin(position) clip: vec4f,
    @location(0) colour: vec4f,
}

@vertex
fn stretch(
    @builtin(vertex_index) corner: u32,
    @location(0) from_: vec3f,
    @location(1) to_: vec3f,
    @location(2) colour: vec4f,
    @location(3) width: f32,
) -> Line {
    let a = view.clip * vec4f(from_, 1.0);
    let b = view.clip * vec4f(to_, 1.0);
    let across = b.xy / b.w * view.size - a.xy / a.w * view.size;
    let along = across / max(length(across), 1e-6);
    let side = select(-1.0, 1.0, (corner & 1u) == 1u);
    let is_end = (corner & 2u) == 2u;
    // Half a width beyond both ends closes the corners where segments meet.
    let cap = select(-1.0, 1.0, is_end);
    let shift = (vec2f(-along.y, along.x) * side + along * cap) * width / view.size;
    var clip = select(a, b, is_end);
    clip = vec4f(clip.xy + shift * clip.w, clip.z - view.lift * clip.w, clip.w);
    return Line(clip, colour);
}

@fragment
fn ink(line: Line) -> @location(0) vec4f {
    return line.colour;
}
