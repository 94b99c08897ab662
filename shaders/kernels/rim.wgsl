// The rim's own equation of motion: reaction of the rubber in fixed order, then one step of the free components;
// twin of src/cpu/rim.rs.

override free_x: bool;
override free_y: bool;
override free_z: bool;
override free_spin: bool;
// 1/(own mass + rim nodes' mass), likewise the inertia about the axle; mass damping.
override inverse_mass_x: real;
override inverse_mass_y: real;
override inverse_mass_z: real;
override inverse_inertia: real;
override rim_alpha: real;

var<workgroup> forces: array<vec3r, 64>;
var<workgroup> moments: array<vec3r, 64>;

fn about_y(angle: real) -> mat3x3r {
    let t = turn(angle);
    return mat3x3r(vec3r(t.c, 0.0, -t.s), vec3r(0.0, 1.0, 0.0), vec3r(t.s, 0.0, t.c));
}

// (coordinate's move since the window began, rate) one step on.
fn advanced(at: vec2r, push: real, inverse: real) -> vec2r {
    let h = 0.5 * rim_alpha * step.dtm;
    let rate = ((1.0 - h) * at.y + step.dtm * push * inverse) / (1.0 + h);
    return vec2r(at.x + step.dt * rate, rate);
}

fn move_rim(force: vec3r, moment: vec3r) {
    // Prescribed components as planned; `step.axle` and `step.axle_before` hold moves since the window began.
    var to = vec4r(step.axle.xyz, step.spin);
    let before = rim_state.at;
    let old_rate = rim_state.velocity;
    var rate = (to - before) / step.dt;
    if free_x {
        let a = advanced(vec2r(before.x, old_rate.x), force.x + step.load.x, inverse_mass_x);
        to.x = a.x;
        rate.x = a.y;
    }
    if free_y {
        let a = advanced(vec2r(before.y, old_rate.y), force.y + step.load.y, inverse_mass_y);
        to.y = a.x;
        rate.y = a.y;
    }
    if free_z {
        let a = advanced(vec2r(before.z, old_rate.z), force.z + step.load.z, inverse_mass_z);
        to.z = a.x;
        rate.z = a.y;
    }
    if free_spin {
        let along = dot(moment, rim_state.direction.xyz) + step.load.w;
        let a = advanced(vec2r(before.w, old_rate.w), along, inverse_inertia);
        to.w = a.x;
        rate.w = a.y;
    }
    let frame = mat3x3r(step.rotation0.xyz, step.rotation1.xyz, step.rotation2.xyz);
    let start = mat3x3r(rim_state.start0.xyz, rim_state.start1.xyz, rim_state.start2.xyz);
    let rotation = frame * (about_y(to.w) * start);
    let old = mat3x3r(rim_state.rotation0.xyz, rim_state.rotation1.xyz, rim_state.rotation2.xyz);
    let turning = (rotation - old) * (1.0 / step.dt);
    rim_state.axle_before = rim_state.axle;
    rim_state.axle = vec4r(rim_state.origin.xyz + to.xyz, 0.0);
    rim_state.axle_velocity = vec4r((to.xyz - before.xyz) / step.dt, 0.0);
    rim_state.rotation0 = vec4r(rotation[0], 0.0);
    rim_state.rotation1 = vec4r(rotation[1], 0.0);
    rim_state.rotation2 = vec4r(rotation[2], 0.0);
    rim_state.rate0 = vec4r(turning[0], 0.0);
    rim_state.rate1 = vec4r(turning[1], 0.0);
    rim_state.rate2 = vec4r(turning[2], 0.0);
    rim_state.direction = vec4r(frame[1], 0.0);
    rim_state.at = to;
    rim_state.velocity = rate;
}

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    var force = vec3r(0.0);
    var moment = vec3r(0.0);
    for (var k = lane; k < arrayLength(&rim_nodes); k += 64u) {
        let n = rim_nodes[k];
        let here = load_node(n);
        let f = here.w * gravity() - gather(n);
        force += f;
        moment += cross(here.xyz - rim_state.axle.xyz, f);
    }
    forces[lane] = force;
    moments[lane] = moment;
    workgroupBarrier();
    for (var half = 32u; half > 0u; half /= 2u) {
        if lane < half {
            forces[lane] += forces[lane + half];
            moments[lane] += moments[lane + half];
        }
        workgroupBarrier();
    }
    if lane == 0u {
        move_rim(forces[0], moments[0]);
    }
}
