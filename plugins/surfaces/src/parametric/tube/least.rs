//! The least value of a function of one angle.

/// Places at which the function is looked at first.
const PLACES: usize = 64;
/// Steps of golden section; each leaves 0.618 of the interval.
const STEPS: usize = 48;

/// Where a function of an angle (rad) in a range is least, and its value there: places in equal distances and
/// at `kinks`, each that is lower than its neighbours improved by golden section.
pub(super) fn least((low, high): (f64, f64), kinks: &[f64], f: impl Fn(f64) -> f64) -> (f64, f64) {
    let mut places: Vec<f64> = (0..=PLACES)
        .map(|i| low + (high - low) * i as f64 / PLACES as f64)
        .chain(kinks.iter().copied())
        .collect();
    places.sort_by(f64::total_cmp);
    let values: Vec<f64> = places.iter().map(|&x| f(x)).collect();
    let mut best = (low, f64::INFINITY);
    for i in 0..places.len() {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(places.len() - 1));
        if values[i] <= values[before] && values[i] <= values[after] {
            for found in [(places[i], values[i]), golden(places[before], places[after], &f)] {
                best = if found.1 < best.1 { found } else { best };
            }
        }
    }
    best
}

fn golden(mut low: f64, mut high: f64, f: &impl Fn(f64) -> f64) -> (f64, f64) {
    let share = (5.0_f64.sqrt() - 1.0) / 2.0;
    let mut inner = [high - share * (high - low), low + share * (high - low)];
    let mut values = inner.map(f);
    for _ in 0..STEPS {
        if values[0] <= values[1] {
            high = inner[1];
            inner = [high - share * (high - low), inner[0]];
            values = [f(inner[0]), values[0]];
        } else {
            low = inner[0];
            inner = [inner[1], low + share * (high - low)];
            values = [values[1], f(inner[1])];
        }
    }
    if values[0] <= values[1] { (inner[0], values[0]) } else { (inner[1], values[1]) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lowest_of_several_valleys_is_found_also_with_a_kink() {
        let (x, value) = least((-2.0, 2.0), &[], |x: f64| (3.0 * x).cos() + 0.1 * x);
        // There 3 sin 3x = 0.1; the other valley, on the right, is higher.
        assert!((x + (std::f64::consts::PI + (1.0_f64 / 30.0).asin()) / 3.0).abs() < 1e-7, "{x}");
        assert!(value < -1.1);
        let (x, value) = least((-3.0, 3.0), &[0.3], |x: f64| (x - 0.3).abs() + 0.5 * (x - 1.0).powi(2));
        assert!((x - 0.3).abs() < 1e-9 && (value - 0.245).abs() < 1e-12);
    }
}
