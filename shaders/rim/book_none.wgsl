fn book_rim(node: Node, f_int: vec3r, x: vec3r, v: vec3r, moved: Moved, way: vec3r) {}
