fn gravity() -> vec3f {
    return vec3f(0.0);
}
