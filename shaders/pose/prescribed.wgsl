// The rim's motion comes with the plan of the step.

struct Pose { axle: vec3r, velocity: vec3r, before: vec3r, rotation: mat3x3r, rate: mat3x3r }

fn rim_pose() -> Pose {
    return Pose(step.axle.xyz, step.axle_velocity.xyz, step.axle_before.xyz,
        mat3x3r(step.rotation0.xyz, step.rotation1.xyz, step.rotation2.xyz),
        mat3x3r(step.rate0.xyz, step.rate1.xyz, step.rate2.xyz));
}
