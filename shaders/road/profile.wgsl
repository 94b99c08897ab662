// Lines, arcs and corners over a plane, extruded across; twin of src/physics/road/profile.rs and pieces.rs.

override road_top: real;
// How far the lowest point is below it.
override road_relief: real;
override road_start: real;
// Zero: it does not come again.
override road_period: real;
override road_pieces: u32;
override road_shares: u32;
override road_per_length: real;

// How a point sees a piece: distance along the normal, negative inside, and the normal; none: it has no nearest point.
struct Seen { distance: real, normal: vec2r, none: bool }

fn cross_of(a: vec2r, b: vec2r) -> real {
    return a.x * b.y - a.y * b.x;
}

fn seen_piece(piece: u32, x: vec2r) -> Seen {
    let first = road_shape[2u * piece];
    let second = road_shape[2u * piece + 1u];
    let d = x - first.xy;
    if second.w == 0.0 {
        let s = dot(d, vec2r(first.w, -first.z));
        let rounding = 0.25 * sqrt(rounding_squared()) * (abs(x.x) + abs(x.y));
        return Seen(dot(d, first.zw), first.zw, s < second.x - rounding || s > second.y + rounding);
    }
    let distance = sqrt(dot(d, d));
    if second.w == 1.0 {
        // Nearer than rounding it lies on the corner, and has no direction from it.
        if distance * distance <= 1e-4 * rounding_squared() * dot(x, x) {
            return Seen(second.x * distance, first.zw, false);
        }
        return Seen(second.x * distance, (second.x / distance) * d, false);
    }
    let outside = cross_of(first.zw, d) > 0.0 || cross_of(d, second.xy) > 0.0;
    return Seen(distance - second.z, d / distance, outside);
}

fn nearest_piece(local: vec3r) -> Seen {
    var u = local.x;
    if road_period > 0.0 {
        u -= road_period * floor((u - road_start) / road_period);
    }
    let share = u32(clamp((u - road_start) * road_per_length, 0.0, real(road_shares - 1u)));
    let range = vec2u(road_shape[2u * road_pieces + share].xy);
    var best = Seen(local.z - road_top, vec2r(0.0, 1.0), true);
    for (var piece = range.x; piece < range.y; piece++) {
        let seen = seen_piece(piece, vec2r(u, local.z));
        if !seen.none && (best.none || abs(seen.distance) < abs(best.distance)) {
            best = seen;
        }
    }
    return best;
}

fn road_gap(x: vec3r) -> real {
    let local = base_local(x);
    if local.z > road_top + road_relief {
        return local.z - road_top;
    }
    return nearest_piece(local).distance;
}

fn road_normal(x: vec3r) -> vec3r {
    let local = base_local(x);
    if local.z > road_top + road_relief {
        return base_normal();
    }
    let normal = nearest_piece(local).normal;
    return base_vector(vec3r(normal.x, 0.0, normal.y));
}

// It rests.
fn road_velocity(x: vec3r) -> vec3r {
    return vec3r(0.0);
}

// Rounding alone hides slip.
fn road_told_squared() -> real {
    return rounding_squared();
}
