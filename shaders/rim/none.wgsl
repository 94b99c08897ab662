// No rim.

fn is_rim(role: u32) -> bool {
    return false;
}

fn carried(k: u32) -> Moved {
    return Moved();
}

fn book_rim(node: Node, f_int: vec3r, x: vec3r, v: vec3r, moved: Moved, way: vec3r) {}
