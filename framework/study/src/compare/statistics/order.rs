//! Order statistics: quantiles, box plots, and the share of runs that are done by a time.

use serde::Serialize;

/// The values in rising order, without those that are not finite.
pub fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// The quantile `share` (0..=1) of values in rising order, by linear interpolation between neighbours; `None`
/// for no values.
///
/// R. J. Hyndman, Y. Fan, "Sample quantiles in statistical packages", The American Statistician 1996,
/// definition 7: that of numpy and R.
pub fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let place = share * sorted.len().checked_sub(1)? as f64;
    let below = place.floor() as usize;
    let above = sorted[(below + 1).min(sorted.len() - 1)];
    Some(sorted[below] + (place - below as f64) * (above - sorted[below]))
}

/// The median of values in any order.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    quantile(&sorted(values), 0.5)
}

/// What a box plot shows (J. W. Tukey, "Exploratory Data Analysis", 1977).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoxPlot {
    /// The first quartile, the median and the third quartile.
    pub quartiles: [f64; 3],
    /// The outermost values within one and a half times the box's height of it.
    pub whiskers: [f64; 2],
    /// The values beyond the whiskers, in rising order.
    pub outliers: Vec<f64>,
}

/// The box plot of values, the fences measured on the scale of the logarithm, on which it is drawn; `None`
/// for no positive values.
pub fn log_box_plot(values: impl IntoIterator<Item = f64>) -> Option<BoxPlot> {
    let values = sorted(values.into_iter().filter(|&value| value > 0.0));
    of_sorted(&values, |first, third| {
        let reach = (third / first).powf(1.5);
        [first / reach, third * reach]
    })
}

/// The box plot of values on a linear scale; `None` for no values.
pub fn box_plot(values: impl IntoIterator<Item = f64>) -> Option<BoxPlot> {
    of_sorted(&sorted(values), |first, third| {
        let reach = 1.5 * (third - first);
        [first - reach, third + reach]
    })
}

/// The box plot of values in rising order; the fences come from the outer quartiles.
fn of_sorted(values: &[f64], fences: impl Fn(f64, f64) -> [f64; 2]) -> Option<BoxPlot> {
    let quartiles = [0.25, 0.5, 0.75].map(|share| quantile(values, share));
    let [Some(first), Some(middle), Some(third)] = quartiles else { return None };
    let [low, high] = fences(first, third);
    let is_inside = |value: &&f64| (low..=high).contains(*value);
    let inside: Vec<f64> = values.iter().filter(is_inside).copied().collect();
    Some(BoxPlot {
        quartiles: [first, middle, third],
        // A quartile lies between two values, so that the nearest value inside may be beyond it: a whisker
        // never points inwards.
        whiskers: [
            inside.first().copied().unwrap_or(first).min(first),
            inside.last().copied().unwrap_or(third).max(third),
        ],
        outliers: values.iter().filter(|value| !is_inside(value)).copied().collect(),
    })
}

/// The empirical distribution over `runs` runs, of which these ended at all: each time with the share of all
/// runs that had ended by then.
///
/// Runs that never ended keep the curve below 1. Equal times make one step.
pub fn ecdf(times: impl IntoIterator<Item = f64>, runs: usize) -> Vec<(f64, f64)> {
    let times = sorted(times);
    let step = |(k, time): (usize, &f64)| {
        let is_last_of_equals = times.get(k + 1) != Some(time);
        is_last_of_equals.then(|| (*time, (k + 1) as f64 / runs.max(1) as f64))
    };
    times.iter().enumerate().filter_map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quantiles_are_those_of_numpy() {
        // numpy 2.4.6: numpy.quantile([1, 2, 4, 8, 16], [0.1, 0.25, 0.5, 0.9]).
        let values = [1.0, 2.0, 4.0, 8.0, 16.0];
        for (share, expected) in [(0.0, 1.0), (0.1, 1.4), (0.25, 2.0), (0.5, 4.0), (0.9, 12.8), (1.0, 16.0)] {
            assert!((quantile(&values, share).unwrap() - expected).abs() < 1e-12);
        }
        assert_eq!(median([3.0, 1.0, f64::NAN, 2.0, 10.0]), Some(2.5));
        assert_eq!(median([f64::INFINITY]), None);
    }

    #[test]
    fn a_box_leaves_outliers_outside() {
        let found = log_box_plot([1.0, 1.1, 1.2, 1.3, 1.4, 50.0, 0.0, -3.0]).unwrap();
        assert_eq!(found.outliers, [50.0]);
        assert_eq!(found.whiskers, [1.0, 1.4]);
        assert_eq!(log_box_plot([0.0]), None);
        let found = box_plot([-1.0, 0.0, 0.0, 1.0, 40.0]).unwrap();
        assert_eq!((found.whiskers, found.outliers), ([-1.0, 1.0], vec![40.0]));
        assert_eq!(log_box_plot([2.0]).unwrap().whiskers, [2.0, 2.0]);
    }

    #[test]
    fn runs_that_never_end_hold_the_curve_down() {
        assert_eq!(ecdf([2.0, 1.0, 2.0], 4), [(1.0, 0.25), (2.0, 0.75)]);
        assert_eq!(ecdf([], 4), []);
    }

    proptest! {
        #[test]
        fn boxes_are_in_order_and_lose_no_value(values in prop::collection::vec(1e-3..1e3_f64, 1..60)) {
            let found = log_box_plot(values.iter().copied()).unwrap();
            let [q1, q2, q3] = found.quartiles;
            let heights = [found.whiskers[0], q1, q2, q3, found.whiskers[1]];
            prop_assert!(heights.windows(2).all(|pair| pair[0] <= pair[1]), "{heights:?}");
            let shown = values.iter().filter(|v| (found.whiskers[0]..=found.whiskers[1]).contains(*v)).count();
            prop_assert_eq!(shown + found.outliers.len(), values.len());
        }

        #[test]
        fn the_curve_rises_to_the_share_of_ended_runs(times in prop::collection::vec(0.0..9.0_f64, 0..40), lost in 0_usize..9) {
            let runs = times.len() + lost;
            let curve = ecdf(times.iter().copied(), runs);
            prop_assert!(curve.windows(2).all(|pair| pair[0].0 < pair[1].0 && pair[0].1 < pair[1].1));
            let end = curve.last().map_or(0.0, |step| step.1);
            prop_assert!((end - times.len() as f64 / runs.max(1) as f64).abs() < 1e-12);
        }
    }
}
