fn book_others(n: u32, node: Node, v: vec3r, after: vec3r, way: vec3r, rim: bool) {}
