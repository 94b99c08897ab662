//! Richardson extrapolation and the grid convergence index.
//!
//! Values f(h) of a sequence of meshes (or steps) of relative size h are taken to follow f = f0 + C h^p. Three of them
//! give p, f0 and C:
//!
//! (f3 - f2)/(f2 - f1) = (h3^p - h2^p)/(h2^p - h1^p),   h1 < h2 < h3.
//!
//! The grid convergence index is F |f1 - f0|, an error bar for the finest value, with the factor of safety that Oberkampf
//! & Roy (Verification and Validation in Scientific Computing, 2010, sec. 8.7) recommend: F = 1.25 where the observed
//! order is within 10 % of the formal one; else F = 3, with the order kept between 0.5 and the formal one. A sequence
//! that turns back, or whose differences grow, is not extrapolated.

/// Order of accuracy of the method in the mesh size, and in the time step.
pub const FORMAL_ORDER: f64 = 2.0;

/// Roache's factor of safety where the observed order is the formal one, and Oberkampf & Roy's where it is not.
const SAFE: f64 = 1.25;
const UNSURE: f64 = 3.0;

/// A value at a relative size.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    pub h: f64,
    pub value: f64,
}

/// What a sequence comes to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Convergence {
    /// Extrapolated value, observed order, and the grid convergence index as an absolute error bar about `value`.
    Monotone { value: f64, order: f64, error: f64 },
    /// It turns back: the finest value, and how far the three finest spread.
    NotMonotone { finest: f64, spread: f64 },
    /// Its differences do not shrink as the sizes do.
    Diverging { finest: f64, spread: f64 },
    /// All three finest values are equal to `within`, relative.
    Constant { value: f64, within: f64 },
    /// Fewer than three sizes, or values that are not finite.
    TooFew,
}

/// Differences below this share of a value are round-off or settling, not a trend.
const EQUAL: f64 = 1e-6;

/// Judges a sequence of any order of sizes, all of them different.
pub fn judge(levels: &[Level]) -> Convergence {
    let mut levels = levels.to_vec();
    levels.sort_by(|a, b| a.h.total_cmp(&b.h));
    let [one, two, three, ..] = levels[..] else { return Convergence::TooFew };
    if levels.iter().any(|l| !l.value.is_finite()) {
        return Convergence::TooFew;
    }
    let finest = one.value;
    let low = one.value.min(two.value).min(three.value);
    let spread = one.value.max(two.value).max(three.value) - low;
    if spread <= EQUAL * finest.abs() {
        return Convergence::Constant { value: finest, within: EQUAL };
    }
    let differences: Vec<f64> = levels.windows(2).map(|pair| pair[1].value - pair[0].value).collect();
    if differences.iter().any(|d| d * differences[0] <= 0.0) {
        return Convergence::NotMonotone { finest, spread };
    }
    let Some(order) = observed_order([one.h, two.h, three.h], differences[1] / differences[0]) else {
        return Convergence::Diverging { finest, spread };
    };
    let near = (order / FORMAL_ORDER - 1.0).abs() <= 0.1;
    let (used, factor) = if near { (order, SAFE) } else { (order.clamp(0.5, FORMAL_ORDER), UNSURE) };
    let correction = differences[0] / ((two.h / one.h).powf(used) - 1.0);
    Convergence::Monotone { value: finest - correction, order, error: factor * correction.abs() }
}

/// The p of (h3^p - h2^p)/(h2^p - h1^p) = ratio, which grows with p; none at p <= 0.
fn observed_order([h1, h2, h3]: [f64; 3], ratio: f64) -> Option<f64> {
    /// Above this the third mesh is outside of every asymptotic range.
    const MOST: f64 = 20.0;
    let of = |p: f64| ((h3 / h1).powf(p) - (h2 / h1).powf(p)) / ((h2 / h1).powf(p) - 1.0);
    // The limit at p -> 0.
    if ratio <= (h3 / h2).ln() / (h2 / h1).ln() {
        return None;
    }
    let (mut low, mut high) = (0.0, MOST);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < ratio { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(sizes: &[f64], f: impl Fn(f64) -> f64) -> Vec<Level> {
        sizes.iter().map(|&h| Level { h, value: f(h) }).collect()
    }

    #[test]
    fn a_power_law_gives_back_its_order_and_limit() {
        for p in [0.7, 1.0, 1.5, 2.0] {
            for sizes in [&[1.0, 0.5, 0.25][..], &[1.0, 0.5, 1.0 / 3.0, 0.25], &[0.9, 0.45, 0.3]] {
                let Convergence::Monotone { value, order, error } =
                    judge(&levels(sizes, |h| 315.0 - 12.0 * h.powf(p)))
                else {
                    panic!("order {p}, {sizes:?}")
                };
                // Round-off of differences of about 1 in 300: 1e-13, over ln 2.
                assert!((order - p).abs() < 1e-10 && (value - 315.0).abs() < 1e-9, "{order}, {value}");
                let finest = sizes.iter().copied().fold(1.0, f64::min);
                let factor = if p > 1.8 { 1.25 } else { 3.0 };
                assert!((error / (factor * 12.0 * finest.powf(p)) - 1.0).abs() < 1e-8, "{error}");
            }
        }
    }

    #[test]
    fn an_order_beyond_the_formal_one_does_not_shrink_the_error_bar() {
        let Convergence::Monotone { value, order, error } =
            judge(&levels(&[1.0, 0.5, 0.25], |h| 100.0 + h.powi(4)))
        else {
            panic!()
        };
        assert!((order - 4.0).abs() < 1e-9);
        // The last difference is 1/16 - 1/256; at order 2 the rest is a third of it, times 3.
        let last = 1.0 / 16.0 - 1.0 / 256.0;
        assert!((error - last).abs() < 1e-12 && (value - (100.0 + 1.0 / 256.0 - last / 3.0)).abs() < 1e-12);
    }

    #[test]
    fn the_order_of_the_meshes_does_not_matter() {
        let sorted = levels(&[1.0, 0.5, 0.25], |h| 1.0 + h * h);
        let mut turned = sorted.clone();
        turned.reverse();
        assert_eq!(judge(&sorted), judge(&turned));
    }

    #[test]
    fn a_sequence_that_turns_back_is_not_extrapolated() {
        // As the static wheel with friction on four meshes: up, then down.
        let sizes = [1.0, 0.5, 1.0 / 3.0, 0.25];
        let forces = [300.0, 316.0, 315.8, 315.0];
        let levels: Vec<Level> = sizes.iter().zip(forces).map(|(&h, value)| Level { h, value }).collect();
        let Convergence::NotMonotone { finest, spread } = judge(&levels) else { panic!() };
        assert!(finest == 315.0 && (spread - 1.0).abs() < 1e-9);
    }

    #[test]
    fn growing_differences_diverge() {
        // As 1/sqrt(h), the pressure at a sharp edge.
        let judged = judge(&levels(&[1.0, 0.5, 1.0 / 3.0], |h| h.powf(-0.5)));
        assert!(matches!(judged, Convergence::Diverging { .. }), "{judged:?}");
        let logarithm = judge(&levels(&[1.0, 0.5, 0.25], |h| 5.0 + h.ln()));
        assert!(matches!(logarithm, Convergence::Diverging { .. }), "{logarithm:?}");
    }

    #[test]
    fn constants_and_short_sequences_are_named() {
        assert!(matches!(judge(&levels(&[1.0, 0.5, 0.25], |_| 3.0)), Convergence::Constant { .. }));
        assert_eq!(judge(&levels(&[1.0, 0.5], |h| h)), Convergence::TooFew);
        assert_eq!(judge(&levels(&[1.0, 0.5, 0.25], |h| h / 0.0 * 0.0)), Convergence::TooFew);
    }
}
