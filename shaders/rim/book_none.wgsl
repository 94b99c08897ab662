fn book_rim(node: Node, f_int: vec3f, x: vec3f, v: vec3f, moved: Moved, way: vec3f) {}
