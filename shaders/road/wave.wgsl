// A cosine over a plane, extruded across; twin of src/physics/road/wave.rs.

override road_amplitude: real;
override road_wavelength: real;

// Height, and slopes along u and v.
fn ground(place: vec2r) -> vec3r {
    let waves = place.x / road_wavelength;
    let k = 6.283185307179586 / road_wavelength;
    let angle = turn(6.283185307179586 * (waves - round(waves)));
    return vec3r(road_amplitude * angle.c, -road_amplitude * k * angle.s, 0.0);
}

fn road_gap(x: vec3r) -> real {
    let local = base_local(x);
    if local.z > 3.0 * road_amplitude {
        return local.z - road_amplitude;
    }
    return foot_gap(foot_of(local), local);
}

fn road_normal(x: vec3r) -> vec3r {
    let local = base_local(x);
    if local.z > 3.0 * road_amplitude {
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
