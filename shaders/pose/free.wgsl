// The rim's motion comes from its own equation (kernels/rim.wgsl).

struct Pose { axle: vec3r, velocity: vec3r, before: vec3r, rotation: mat3x3r, rate: mat3x3r }

fn rim_pose() -> Pose {
    return Pose(rim_state.axle.xyz, rim_state.axle_velocity.xyz, rim_state.axle_before.xyz,
        mat3x3r(rim_state.rotation0.xyz, rim_state.rotation1.xyz, rim_state.rotation2.xyz),
        mat3x3r(rim_state.rate0.xyz, rim_state.rate1.xyz, rim_state.rate2.xyz));
}
