//! Round numbers along an axis.

/// Ticks that cover `low..high` with about `wanted` intervals of 1, 2 or 5 times a power of ten, and the decimals
/// they need.
pub fn ticks(low: f64, high: f64, wanted: f64) -> (Vec<f64>, usize) {
    let raw = (high - low) / wanted;
    let power = 10f64.powf(raw.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| *s >= raw * 0.999);
    let step = step.unwrap_or(10.0 * power);
    let decimals = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    let first = (low / step - 1e-6).ceil() as i64;
    let last = (high / step + 1e-6).floor() as i64;
    // + 0.0: no tick at -0.
    ((first..=last).map(|i| i as f64 * step + 0.0).collect(), decimals)
}

/// Ticks at 1, 2 and 5 times every power of ten between two logarithms, with their texts.
pub fn decades(low: f64, high: f64) -> Vec<(f64, String)> {
    let powers = low.floor() as i32..=high.ceil() as i32;
    let all = powers.flat_map(|power| [1.0, 2.0, 5.0].map(|m| (m * 10f64.powi(power), power)));
    let inside = all.filter(|(v, _)| (low..=high).contains(&v.log10()));
    inside
        .map(|(v, power)| {
            let text = match power {
                6.. => format!("{v:e}"),
                3..6 => format!("{}k", v / 1e3),
                _ => format!("{v:.*}", (-power).max(0) as usize),
            };
            (v, text)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(ticks(0.0, 10.0, 5.0), (vec![0.0, 2.0, 4.0, 6.0, 8.0, 10.0], 0));
        let (at, decimals) = ticks(-0.013, 0.022, 4.0);
        assert_eq!((at, decimals), (vec![-0.01, 0.0, 0.01, 0.02], 2));
        assert_eq!(ticks(199.1, 200.9, 4.0).0, [199.5, 200.0, 200.5]);
        assert_eq!(ticks(1e6, 3e6, 4.0).1, 0);
    }

    #[test]
    fn a_logarithmic_axis_has_ones_twos_and_fives() {
        let texts: Vec<String> = decades(2.0, 3.75).into_iter().map(|(_, text)| text).collect();
        assert_eq!(texts, ["100", "200", "500", "1k", "2k", "5k"]);
        assert_eq!(decades(-1.0, 0.0)[1].1, "0.2");
    }
}
