//! Ranges, ticks at round numbers and SI prefixes.

/// Which values a colour bar spans, in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Range {
    /// From the lowest to the highest value, widened to round numbers.
    #[default]
    Auto,
    /// As given; values outside take the end colours, and the bar's ends are pointed.
    Fixed(f64, f64),
}

impl Range {
    /// From one value to another, widened to round numbers.
    pub fn round(low: f64, high: f64) -> Range {
        let scale = Scale::new(&[low, high], "", Range::Auto, false);
        Range::Fixed(scale.low, scale.high)
    }
}

/// A scale of values: its ends, its ticks and how they are written.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    /// Ends [SI].
    pub low: f64,
    pub high: f64,
    /// Round values within the ends [SI] and their labels.
    pub ticks: Vec<(f64, String)>,
    /// Unit of the labels with its prefix, e.g. `MPa`; empty for a pure number.
    pub unit: String,
    /// Whether values lie outside the lower and the upper end.
    pub beyond: [bool; 2],
}

impl Scale {
    /// The scale of `values` in `unit` (`"Pa"`, `"m"`, .. or empty); non-finite values are left out.
    /// `from_zero`: an automatic scale starts at zero, as magnitudes should.
    pub fn new(values: &[f64], unit: &str, range: Range, from_zero: bool) -> Scale {
        let finite = || values.iter().copied().filter(|v| v.is_finite());
        let (lowest, highest) =
            (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
        let (low, high) = match range {
            Range::Fixed(a, b) => (a.min(b), a.max(b)),
            Range::Auto if lowest > highest => (0.0, 0.0),
            Range::Auto => (if from_zero { lowest.min(0.0) } else { lowest }, highest),
        };
        let (mut low, mut high) = apart(low, high);
        let step = round_step(high - low, 7);
        if range == Range::Auto {
            (low, high) = ((low / step + 1e-9).floor() * step, (high / step - 1e-9).ceil() * step);
        }
        let (factor, prefixed) = prefix(unit, low.abs().max(high.abs()));
        let slack = 1e-9 * (high - low);
        Scale {
            low,
            high,
            ticks: round_values(low, high, step)
                .into_iter()
                .map(|v| (v, number(v / factor, step / factor)))
                .collect(),
            unit: prefixed,
            beyond: [lowest < low - slack, highest > high + slack],
        }
    }

    /// Place of a value along the scale, 0 to 1 within its ends.
    pub fn place(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }
}

/// Two ends that differ enough to draw a scale between them.
fn apart(low: f64, high: f64) -> (f64, f64) {
    let size = low.abs().max(high.abs());
    if high - low > 1e-9 * size && high > low {
        (low, high)
    } else if size > 0.0 {
        (low - 0.01 * size, high + 0.01 * size)
    } else {
        (0.0, 1.0)
    }
}

/// The smallest of 1, 2, 5 times a power of ten that divides `span` into at most `count` parts.
pub fn round_step(span: f64, count: usize) -> f64 {
    let raw = span / count as f64;
    let power = 10f64.powf(raw.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|&s| s >= raw * (1.0 - 1e-9)).unwrap_or(raw)
}

/// The largest of 1, 2, 5 times a power of ten that is not above `limit`.
pub fn round_below(limit: f64) -> f64 {
    let power = 10f64.powf(limit.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|m| m * power).find(|&s| s <= limit * (1.0 + 1e-9)).unwrap_or(power)
}

/// Multiples of `step` from `low` to `high`.
pub fn round_values(low: f64, high: f64, step: f64) -> Vec<f64> {
    let (first, last) = ((low / step - 1e-6).ceil() as i64, (high / step + 1e-6).floor() as i64);
    (first..=last).map(|i| i as f64 * step).collect()
}

/// Factor and prefixed unit in which `size` reads as 1 to 1000; pure numbers stay as they are.
pub fn prefix(unit: &str, size: f64) -> (f64, String) {
    if unit.is_empty() || size <= 0.0 || !size.is_finite() {
        return (1.0, unit.to_string());
    }
    const PREFIXES: [&str; 7] = ["n", "\u{b5}", "m", "", "k", "M", "G"];
    // 1e-9: so that 1000 mm, give or take a rounding, is 1 m.
    let thousands = ((size.log10() + 1e-9) / 3.0).floor().clamp(-3.0, 3.0) as i32;
    (1000f64.powi(thousands), format!("{}{unit}", PREFIXES[(thousands + 3) as usize]))
}

/// `value` with the decimals that `step` calls for, and a true minus sign.
pub fn number(value: f64, step: f64) -> String {
    let decimals = (-(step.abs() * 1.0001).log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(digits) if digits.chars().all(|c| c == '0' || c == '.') => digits.to_string(),
        Some(digits) => format!("\u{2212}{digits}"),
        None => text,
    }
}

/// A quantity in words: about `digits` significant digits and the fitting prefix, e.g. `306.0 N`.
pub fn quantity(value: f64, unit: &str, digits: i32) -> String {
    let (factor, unit) = prefix(unit, value.abs());
    let scaled = value / factor;
    let text = if scaled == 0.0 {
        "0".to_string()
    } else {
        number(scaled, 10f64.powi(scaled.abs().log10().floor() as i32 - digits + 1).min(1.0))
    };
    if unit.is_empty() { text } else { format!("{text} {unit}") }
}
