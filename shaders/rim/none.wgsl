fn is_rim(role: u32) -> bool {
    return false;
}

fn carried(k: u32) -> Moved {
    return Moved();
}
