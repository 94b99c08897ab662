// What every pass of a picture knows about its camera. Lengths are those of the picture's own frame:
// origin at the middle of the body, its half size as the unit.
struct View {
    /// From the picture's frame to clip space.
    clip: mat4x4f,
    /// Where the eye is (w = 1), or the direction towards it (w = 0, orthographic).
    eye: vec4f,
    /// Unit direction towards the light; w: depth of the shading, 0 (none) to 1.
    light: vec4f,
    /// Picture size [pixels].
    size: vec2f,
    /// How far lines are pulled towards the eye so that they lie on their surface.
    lift: f32,
    unused: f32,
}

@group(0) @binding(0) var<uniform> view: View;
