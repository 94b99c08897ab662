fn book_viscous(element: u32, result: ElementForce) {}
