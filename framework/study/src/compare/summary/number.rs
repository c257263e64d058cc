//! Numbers as a person reads them.

use crate::compare::statistics::Estimate;

/// Three significant digits, or all digits before the point.
pub fn three_digits(value: f64) -> String {
    let digits_before = if value == 0.0 { 1.0 } else { value.abs().log10().floor() + 1.0 };
    let digits_after = (3.0 - digits_before).clamp(0.0, 12.0) as usize;
    format!("{value:.digits_after$}")
}

/// An estimate with its interval, such as `9.13 (8.95 to 9.40)`; an end that is not known is left open.
fn with_interval(estimate: Estimate, text: fn(f64) -> String) -> String {
    let Estimate { value, low, high } = estimate;
    if high.is_infinite() {
        return format!("{} (interval unknown: too few)", text(value));
    }
    format!("{} ({} to {})", text(value), text(low), text(high))
}

/// Seconds as milliseconds with the interval, without the unit.
pub fn milliseconds(estimate: Estimate) -> String {
    with_interval(estimate.map(|s| 1e3 * s), three_digits)
}

/// A share in percent with its interval.
pub fn percent(estimate: Estimate) -> String {
    with_interval(estimate.map(|share| 1e2 * share), |value| format!("{value:.0}"))
}

/// A median of counts: whole or half.
pub fn count_text(value: f64) -> String {
    format!("{value}")
}

/// A p-value: `p = 0.031`, or `p < 0.001`.
pub fn p_text(p: f64) -> String {
    match p {
        p if p < 0.001 => "p < 0.001".into(),
        p if p < 0.0995 => format!("p = {p:.3}"),
        p => format!("p = {p:.2}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_whatever_the_size() {
        let texts = [0.0, 0.012_345, 0.9999, 1.0, 12.345, 999.6, 123_456.7].map(three_digits);
        assert_eq!(texts, ["0.00", "0.0123", "1.000", "1.00", "12.3", "1000", "123457"]);
    }

    #[test]
    fn p_values_never_claim_zero() {
        assert_eq!(
            [1e-9, 0.0009, 0.031, 0.0994, 0.2, 1.0].map(p_text).join(", "),
            "p < 0.001, p < 0.001, p = 0.031, p = 0.099, p = 0.20, p = 1.00"
        );
    }

    #[test]
    fn intervals_that_are_not_known_say_so() {
        let open = Estimate { value: 2.0, low: 0.0, high: f64::INFINITY };
        assert_eq!(milliseconds(open.map(|s| 1e-3 * s)), "2.00 (interval unknown: too few)");
        assert_eq!(milliseconds(Estimate { value: 0.009, low: 0.008, high: 0.01 }), "9.00 (8.00 to 10.0)");
    }
}
