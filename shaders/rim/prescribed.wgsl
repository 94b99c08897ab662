// The rim's motion comes with the plan of the step.

struct Pose { axle: vec3f, velocity: vec3f, before: vec3f, rotation: mat3x3f, rate: mat3x3f }

fn rim_pose() -> Pose {
    return Pose(step.axle.xyz, step.axle_velocity.xyz, step.axle_before.xyz,
        mat3x3f(step.rotation0.xyz, step.rotation1.xyz, step.rotation2.xyz),
        mat3x3f(step.rate0.xyz, step.rate1.xyz, step.rate2.xyz));
}
