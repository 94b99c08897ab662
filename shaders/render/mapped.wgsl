// The fragment stage of surfaces coloured by a field: `paint.x` is the place on the colour bar, 0 to 1.

@group(0) @binding(1) var map: texture_2d<f32>;
@group(0) @binding(2) var map_sampler: sampler;

@fragment
fn mapped(surface: Surface) -> @location(0) vec4f {
    let count = f32(textureDimensions(map).x);
    // Texel centres carry the map's colours, so the ends of the bar are the first and last centre.
    let u = (0.5 + clamp(surface.paint.x, 0.0, 1.0) * (count - 1.0)) / count;
    let colour = textureSampleLevel(map, map_sampler, vec2f(u, 0.5), 0.0).rgb;
    return vec4f(colour * brightness(surface.position, surface.normal), 1.0);
}
