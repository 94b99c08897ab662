fn book_others(n: u32, node: Node, v: vec3f, after: vec3f, way: vec3f, rim: bool) {}
