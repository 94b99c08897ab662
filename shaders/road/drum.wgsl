// A drum that turns about its axis, as a plane bent about it; twin of src/physics/road/drum.rs.

override road_point_x: real;
override road_point_y: real;
override road_point_z: real;
override road_normal_x: real;
override road_normal_y: real;
override road_normal_z: real;
override road_axis_x: real;
override road_axis_y: real;
override road_axis_z: real;
override road_curvature: real;
override road_speed: real;

// y, the part of x - point that is square to the axis; s = n0 . (x - point) + k y . y / 2, and sqrt(1 + 2 k s).
struct Bent { y: vec3r, s: real, root: real }

fn bent(x: vec3r) -> Bent {
    let axis = vec3r(road_axis_x, road_axis_y, road_axis_z);
    let from_point = x - vec3r(road_point_x, road_point_y, road_point_z);
    let y = from_point - dot(axis, from_point) * axis;
    let s = dot(vec3r(road_normal_x, road_normal_y, road_normal_z), from_point) + 0.5 * road_curvature * dot(y, y);
    return Bent(y, s, sqrt(1.0 + 2.0 * road_curvature * s));
}

fn road_gap(x: vec3r) -> real {
    let at = bent(x);
    return 2.0 * at.s / (1.0 + at.root);
}

fn road_normal(x: vec3r) -> vec3r {
    let at = bent(x);
    return (vec3r(road_normal_x, road_normal_y, road_normal_z) + road_curvature * at.y) / at.root;
}

fn road_velocity(x: vec3r) -> vec3r {
    return road_speed * cross(vec3r(road_axis_x, road_axis_y, road_axis_z), road_normal(x));
}

// Rounding alone hides slip.
fn road_told_squared() -> real {
    return rounding_squared();
}
