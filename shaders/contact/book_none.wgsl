fn book_contact(role: u32, moved: Moved, way: vec3f) {}
