//! How sure a median is.

use super::{Estimate, quantile, sorted};
use regrasp_api::Random;

/// How many resamples the interval is read from.
const RESAMPLES: usize = 2000;

/// Names the bootstrap's random streams; the value means nothing.
const STREAM: u64 = 0xb007;

/// The median with its 95 % percentile interval; `None` for no finite values.
///
/// B. Efron, "Bootstrap methods: another look at the jackknife", Annals of Statistics 1979. 2000 resamples
/// from a stream that the number of values alone determines: equal values give the equal interval, in
/// whichever order they come.
pub fn median_interval(values: impl IntoIterator<Item = f64>) -> Option<Estimate> {
    let values = sorted(values);
    let value = quantile(&values, 0.5)?;
    let mut random = Random::from_key(STREAM, values.len() as u64, 0, 0);
    let mut hits = vec![0_usize; values.len()];
    let mut medians: Vec<f64> = (0..RESAMPLES).map(|_| resampled(&values, &mut hits, &mut random)).collect();
    medians.sort_by(f64::total_cmp);
    let end = |share| quantile(&medians, share);
    Some(Estimate { value, low: end(0.025)?, high: end(0.975)? })
}

/// The median of one resample: the values are sorted, so that counting how often each was drawn replaces
/// sorting the resample.
fn resampled(values: &[f64], hits: &mut [usize], random: &mut Random) -> f64 {
    hits.fill(0);
    (0..values.len()).for_each(|_| hits[random.index(values.len())] += 1);
    let ranked = |rank: usize| {
        let mut before = 0;
        let place = hits.iter().position(|count| {
            before += count;
            before > rank
        });
        values[place.expect("the counts sum to more than any rank")]
    };
    let last = values.len() - 1;
    0.5 * (ranked(last / 2) + ranked(last.div_ceil(2)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn the_interval_covers_as_often_as_it_says() {
        // The median of ln-normal samples is 1; of 400 intervals about 95 % hold it (3 standard deviations
        // are 3.3 %).
        let mut random = Random::from_key(5, 0, 0, 0);
        let mut holds = || {
            let found = median_interval((0..60).map(|_| random.normal().exp())).unwrap();
            (found.low..=found.high).contains(&1.0)
        };
        let covered = (0..400).filter(|_| holds()).count();
        assert!((367..=393).contains(&covered), "{covered} of 400");
    }

    #[test]
    fn agrees_with_scipy() {
        // scipy 1.17.1: scipy.stats.bootstrap((range(1, 52),), numpy.median, method="percentile") gives 19
        // and 33.
        let found = median_interval((1..52).map(f64::from)).unwrap();
        assert_eq!(found.value, 26.0);
        assert!((found.low - 19.0).abs() <= 1.0 && (found.high - 33.0).abs() <= 1.0, "{found:?}");
    }

    #[test]
    fn one_value_is_its_own_interval() {
        assert_eq!(median_interval([3.0]), Some(Estimate { value: 3.0, low: 3.0, high: 3.0 }));
        assert_eq!(median_interval([]), None);
    }

    proptest! {
        #[test]
        fn order_does_not_matter_and_scale_carries_over(values in prop::collection::vec(0.1..10.0_f64, 1..30)) {
            let found = median_interval(values.iter().copied()).unwrap();
            prop_assert_eq!(found, median_interval(values.iter().rev().copied()).unwrap());
            let doubled = median_interval(values.iter().map(|value| 2.0 * value)).unwrap();
            prop_assert_eq!(found.map(|value| 2.0 * value), doubled);
            prop_assert!(found.low <= found.value && found.value <= found.high);
        }
    }
}
