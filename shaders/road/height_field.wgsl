// Heights on a grid, bicubic between the samples; twin of src/physics/road/height_field.rs and samples.rs.

override road_top: real;
// How far the lowest sample is below the top.
override road_relief: real;
override road_columns: i32;
override road_rows: i32;
override road_columns_per_length: real;
override road_rows_per_length: real;
// 1 where the samples come again beyond the last one, 0 where that is kept.
override road_again: i32;

fn sample_index(i: i32, count: i32) -> i32 {
    if road_again == 1 {
        return (i % count + count) % count;
    }
    return clamp(i, 0, count - 1);
}

fn sample_at(k: i32) -> real {
    return road_shape[k / 4][k % 4];
}

// Value and slope at t = 0..1 between the middle two of four samples.
fn cubic(p: vec4r, t: real) -> vec2r {
    let before = p.y - p.x;
    let here = p.z - p.y;
    let after = p.w - p.z;
    let start = 0.5 * (before + here);
    let end = 0.5 * (here + after);
    let b = 3.0 * here - 2.0 * start - end;
    let c = start + end - 2.0 * here;
    return vec2r(p.y + t * (start + t * (b + t * c)), start + t * (2.0 * b + 3.0 * t * c));
}

// Of four samples in row j.
fn cubic_row(i: i32, j: i32, t: real) -> vec2r {
    let row = sample_index(j, road_rows) * road_columns;
    return cubic(
        vec4r(
            sample_at(row + sample_index(i - 1, road_columns)), sample_at(row + sample_index(i, road_columns)),
            sample_at(row + sample_index(i + 1, road_columns)), sample_at(row + sample_index(i + 2, road_columns))),
        t);
}

// Height, and slopes along u and v.
fn ground(place: vec2r) -> vec3r {
    let a = place.x * road_columns_per_length;
    let b = place.y * road_rows_per_length;
    let t = a - floor(a);
    let s = b - floor(b);
    let i = i32(floor(a));
    let j = i32(floor(b));
    let r0 = cubic_row(i, j - 1, t);
    let r1 = cubic_row(i, j, t);
    let r2 = cubic_row(i, j + 1, t);
    let r3 = cubic_row(i, j + 2, t);
    let height = cubic(vec4r(r0.x, r1.x, r2.x, r3.x), s);
    let along = cubic(vec4r(r0.y, r1.y, r2.y, r3.y), s);
    return vec3r(height.x, along.x * road_columns_per_length, height.y * road_rows_per_length);
}

fn road_gap(x: vec3r) -> real {
    let local = base_local(x);
    if local.z > road_top + road_relief {
        return local.z - road_top;
    }
    return foot_gap(foot_of(local), local);
}

fn road_normal(x: vec3r) -> vec3r {
    let local = base_local(x);
    if local.z > road_top + road_relief {
        return base_normal();
    }
    return base_vector(foot_normal(foot_of(local)));
}

// It rests.
fn road_velocity(x: vec3r) -> vec3r {
    return vec3r(0.0);
}

// Rounding alone hides slip.
fn road_told_squared() -> real {
    return rounding_squared();
}
