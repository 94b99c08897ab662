// The nearest point of a smooth height over a plane, which a road gives as `ground(place)`: height, and slopes along u and v. Twin of
// src/physics/road/nearest.rs, for nodes near the surface.

struct Foot { place: vec2r, ground: vec3r }

// By steps to the shadow of x on the tangent plane; never farther than what is below x.
fn foot_of(x: vec3r) -> Foot {
    let below = Foot(x.xy, ground(x.xy));
    var foot = below;
    let least = 0.0625 * rounding_squared() * dot(x, x);
    for (var round = 0u; round < 12u; round++) {
        let p = foot.ground.y;
        let q = foot.ground.z;
        let above = x.z - foot.ground.x;
        let s = x.x - foot.place.x + p * above;
        let t = x.y - foot.place.y + q * above;
        let det = 1.0 + p * p + q * q;
        let way = vec2r((1.0 + q * q) * s - p * q * t, (1.0 + p * p) * t - p * q * s) / det;
        if !(dot(way, way) > least) {
            break;
        }
        let place = foot.place + way;
        foot = Foot(place, ground(place));
    }
    let above = x.z - below.ground.x;
    let offset = vec3r(x.xy - foot.place, x.z - foot.ground.x);
    if dot(offset, offset) <= above * above {
        return foot;
    }
    return below;
}

fn foot_normal(foot: Foot) -> vec3r {
    let p = foot.ground.y;
    let q = foot.ground.z;
    return vec3r(-p, -q, 1.0) / sqrt(1.0 + p * p + q * q);
}

fn foot_gap(foot: Foot, x: vec3r) -> real {
    return dot(foot_normal(foot), vec3r(x.xy - foot.place, x.z - foot.ground.x));
}
