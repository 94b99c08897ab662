// The rim's motion comes from its own equation (kernels/rim.wgsl).

struct Pose { axle: vec3f, velocity: vec3f, before: vec3f, rotation: mat3x3f, rate: mat3x3f }

@group(0) @binding(8) var<storage, read> rim_state: RimState;

fn rim_pose() -> Pose {
    return Pose(rim_state.axle.xyz, rim_state.axle_velocity.xyz, rim_state.axle_before.xyz,
        mat3x3f(rim_state.rotation0.xyz, rim_state.rotation1.xyz, rim_state.rotation2.xyz),
        mat3x3f(rim_state.rate0.xyz, rim_state.rate1.xyz, rim_state.rate2.xyz));
}
