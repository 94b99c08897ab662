// Elements remember nothing.

fn recall(element: u32, own: bool) {}

fn lose(power: real) {}

fn book_memory(chain: u32) {}
