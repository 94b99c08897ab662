//! Numbers as people read them.

/// Three digits and an SI prefix: `2.64 MPa`, `1.39 us`; zero and what has no prefix stay as they are.
pub fn si(value: f64, unit: &str) -> String {
    const PREFIXES: [(&str, f64); 8] =
        [("p", 1e-12), ("n", 1e-9), ("u", 1e-6), ("m", 1e-3), ("", 1.0), ("k", 1e3), ("M", 1e6), ("G", 1e9)];
    let size = value.abs();
    if !(size > 1e-12 && size < 1e12) {
        return if value == 0.0 { format!("0 {unit}") } else { format!("{value:.2e} {unit}") };
    }
    // The last prefix that leaves a digit before the point, after rounding to three.
    let fits = |&(_, scale): &(&str, f64)| size >= 0.9995 * scale;
    let (prefix, scale) = PREFIXES.into_iter().rev().find(fits).unwrap_or(PREFIXES[0]);
    let scaled = value / scale;
    let digits = [9.995, 99.95].iter().filter(|limit| scaled.abs() >= **limit).count();
    format!("{scaled:.*} {prefix}{unit}", 2 - digits)
}

/// A rate of element updates per second.
pub fn updates(rate: f64) -> String {
    format!("{rate:.2e} updates/s")
}

/// Bytes in binary units.
pub fn bytes(count: u64) -> String {
    const UNITS: [&str; 4] = ["B", "KiB", "MiB", "GiB"];
    let mut value = count as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{count} B") } else { format!("{value:.1} {}", UNITS[unit]) }
}

/// A duration: `850 ms`, `12.3 s`, `4 min 05 s`, `2 h 10 min`.
pub fn duration(seconds: f64) -> String {
    if !seconds.is_finite() {
        return "?".into();
    }
    let whole = seconds.round() as u64;
    match seconds {
        s if s < 1.0 => format!("{:.0} ms", 1e3 * s),
        s if s < 60.0 => format!("{s:.1} s"),
        s if s < 3600.0 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole % 3600 / 60),
    }
}

/// A number of things: `1 picture`, `3 pictures`.
pub fn plural(number: usize, thing: &str) -> String {
    format!("{} {thing}{}", count(number as u64), if number == 1 { "" } else { "s" })
}

/// A whole number with thousands apart.
pub fn count(number: u64) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> = digits
        .as_bytes()
        .rchunks(3)
        .rev()
        .map(|group| std::str::from_utf8(group).unwrap_or_default())
        .collect();
    groups.join(",")
}
