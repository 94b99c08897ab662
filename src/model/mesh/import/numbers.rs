//! Numbers of text files, as strictly as their formats are.

/// Coordinates beyond this are no mesh [unit of the file]: products of three of them, and of their squares, must be numbers.
const LARGEST: f64 = 1e30;

/// Fields of a line between commas, blanks at both ends left out.
pub fn fields(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(|&b| b == b',').map(<[u8]>::trim_ascii)
}

/// Fields of a line between blanks.
pub fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// A field as text, for messages: what is not UTF-8 is shown as such, what is long is cut.
pub fn shown(field: &[u8]) -> String {
    const MOST: usize = 40;
    let cut = field.len() > MOST;
    let text = String::from_utf8_lossy(&field[..field.len().min(MOST)]);
    format!("{text:?}{}", if cut { " .." } else { "" })
}

/// A number that is finite and not huge; also with Fortran's exponent `1.5D-3`.
pub fn real(field: &[u8]) -> Result<f64, String> {
    let text = std::str::from_utf8(field).map_err(|_| format!("{} is not a number", shown(field)))?;
    let value = text.parse().or_else(|_| text.replace(['d', 'D'], "e").parse());
    match value {
        Ok(value) => sane(value),
        Err(_) => Err(format!("{} is not a number", shown(field))),
    }
}

/// Refuses what is not finite, or huge.
pub fn sane(value: f64) -> Result<f64, String> {
    match value.abs() <= LARGEST {
        true => Ok(value),
        false if value.is_finite() => Err(format!("{value:e} is too large for a coordinate")),
        false => Err(format!("{value} is not a finite number")),
    }
}

/// A whole number that is not negative. `12.` is one: some programs write whole numbers with a point.
pub fn whole(field: &[u8]) -> Result<u64, String> {
    let digits = field.strip_prefix(b"+").unwrap_or(field);
    let digits = digits.strip_suffix(b".").unwrap_or(digits);
    // Up to 18 digits fit.
    if digits.is_empty() || digits.len() > 18 || !digits.iter().all(u8::is_ascii_digit) {
        return Err(format!("{} is not a whole number from 0", shown(field)));
    }
    Ok(digits.iter().fold(0, |n, d| 10 * n + u64::from(d - b'0')))
}
