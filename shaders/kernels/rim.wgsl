// The rim's own equation of motion: reaction of the rubber in fixed order, then one step of the free components;
// twin of src/cpu/rim.rs.

override free_x: bool;
override free_y: bool;
override free_z: bool;
override free_spin: bool;
// 1/(own mass + rim nodes' mass), likewise the inertia about the axle; mass damping.
override inverse_mass_x: f32;
override inverse_mass_y: f32;
override inverse_mass_z: f32;
override inverse_inertia: f32;
override rim_alpha: f32;

@group(0) @binding(4) var<storage, read> rim_nodes: array<u32>;
@group(0) @binding(5) var<uniform> step: Step;
@group(0) @binding(8) var<storage, read_write> rim_state: RimState;

var<workgroup> forces: array<vec3f, 64>;
var<workgroup> moments: array<vec3f, 64>;

fn about_y(angle: f32) -> mat3x3f {
    let s = sin(angle);
    let c = cos(angle);
    return mat3x3f(vec3f(c, 0.0, -s), vec3f(0.0, 1.0, 0.0), vec3f(s, 0.0, c));
}

// (coordinate's move since the window began, rate) one step on.
fn advanced(at: vec2f, push: f32, inverse: f32) -> vec2f {
    let h = 0.5 * rim_alpha * step.dtm;
    let rate = ((1.0 - h) * at.y + step.dtm * push * inverse) / (1.0 + h);
    return vec2f(at.x + step.dt * rate, rate);
}

fn move_rim(force: vec3f, moment: vec3f) {
    // Prescribed components as planned; `step.axle` and `step.axle_before` hold moves since the window began.
    var to = vec4f(step.axle.xyz, step.spin);
    let before = rim_state.at;
    let old_rate = rim_state.velocity;
    var rate = (to - before) / step.dt;
    if free_x {
        let a = advanced(vec2f(before.x, old_rate.x), force.x + step.load.x, inverse_mass_x);
        to.x = a.x;
        rate.x = a.y;
    }
    if free_y {
        let a = advanced(vec2f(before.y, old_rate.y), force.y + step.load.y, inverse_mass_y);
        to.y = a.x;
        rate.y = a.y;
    }
    if free_z {
        let a = advanced(vec2f(before.z, old_rate.z), force.z + step.load.z, inverse_mass_z);
        to.z = a.x;
        rate.z = a.y;
    }
    if free_spin {
        let along = dot(moment, rim_state.direction.xyz) + step.load.w;
        let a = advanced(vec2f(before.w, old_rate.w), along, inverse_inertia);
        to.w = a.x;
        rate.w = a.y;
    }
    let frame = mat3x3f(step.rotation0.xyz, step.rotation1.xyz, step.rotation2.xyz);
    let start = mat3x3f(rim_state.start0.xyz, rim_state.start1.xyz, rim_state.start2.xyz);
    let rotation = frame * (about_y(to.w) * start);
    let old = mat3x3f(rim_state.rotation0.xyz, rim_state.rotation1.xyz, rim_state.rotation2.xyz);
    let turning = (rotation - old) * (1.0 / step.dt);
    rim_state.axle_before = rim_state.axle;
    rim_state.axle = vec4f(rim_state.origin.xyz + to.xyz, 0.0);
    rim_state.axle_velocity = vec4f((to.xyz - before.xyz) / step.dt, 0.0);
    rim_state.rotation0 = vec4f(rotation[0], 0.0);
    rim_state.rotation1 = vec4f(rotation[1], 0.0);
    rim_state.rotation2 = vec4f(rotation[2], 0.0);
    rim_state.rate0 = vec4f(turning[0], 0.0);
    rim_state.rate1 = vec4f(turning[1], 0.0);
    rim_state.rate2 = vec4f(turning[2], 0.0);
    rim_state.direction = vec4f(frame[1], 0.0);
    rim_state.at = to;
    rim_state.velocity = rate;
}

@compute @workgroup_size(64)
fn main(@builtin(local_invocation_index) lane: u32) {
    var force = vec3f(0.0);
    var moment = vec3f(0.0);
    for (var k = lane; k < arrayLength(&rim_nodes); k += 64u) {
        let n = rim_nodes[k];
        let here = load_node(n);
        let f = abs(here.w) * gravity() - gather(n);
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
