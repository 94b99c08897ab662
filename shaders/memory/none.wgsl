// Elements remember nothing.

fn recall(chain: Chain, level: u32, own: bool) {}

fn lose(power: real) {}

fn book_memory(chain: u32) {}
