// Where a road with a shape of its own lies; twin of src/physics/road/base.rs.

override base_point_x: real;
override base_point_y: real;
override base_point_z: real;
override base_normal_x: real;
override base_normal_y: real;
override base_normal_z: real;
override base_along_x: real;
override base_along_y: real;
override base_along_z: real;

fn base_normal() -> vec3r {
    return vec3r(base_normal_x, base_normal_y, base_normal_z);
}

// u, v and height of a point.
fn base_local(x: vec3r) -> vec3r {
    let from_point = x - vec3r(base_point_x, base_point_y, base_point_z);
    let normal = base_normal();
    let along = vec3r(base_along_x, base_along_y, base_along_z);
    return vec3r(dot(along, from_point), dot(cross(normal, along), from_point), dot(normal, from_point));
}

// A vector given by its parts along u, v and the normal.
fn base_vector(v: vec3r) -> vec3r {
    let normal = base_normal();
    let along = vec3r(base_along_x, base_along_y, base_along_z);
    return v.x * along + v.y * cross(normal, along) + v.z * normal;
}
