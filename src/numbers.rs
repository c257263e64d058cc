//! Numbers on the command line: each refusal says what is allowed.

/// A whole number in `LOW..=HIGH`.
pub fn whole<T: TryFrom<u64>, const LOW: u64, const HIGH: u64>(text: &str) -> Result<T, String> {
    let refuse = || format!("it must be a whole number in {LOW}..={HIGH}");
    let number = text.trim().parse::<u64>().ok().filter(|number| (LOW..=HIGH).contains(number));
    T::try_from(number.ok_or_else(refuse)?).map_err(|_| refuse())
}

/// A number of seconds.
pub fn seconds(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(seconds) if (0.001..=1e7).contains(&seconds) => Ok(seconds),
        _ => Err("it must be a number of seconds in 0.001..=10000000".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_kept_to_their_range() {
        assert_eq!(whole::<u16, 1, 256>("256"), Ok(256));
        for bad in ["0", "257", "-1", "1.5", "1e2", "many", ""] {
            assert_eq!(
                whole::<u16, 1, 256>(bad),
                Err("it must be a whole number in 1..=256".into()),
                "{bad}"
            );
        }
        assert_eq!(whole::<u64, 0, { u64::MAX }>("18446744073709551615"), Ok(u64::MAX));
        assert!(whole::<u64, 0, { u64::MAX }>("18446744073709551616").is_err());
    }

    #[test]
    fn seconds_are_positive_and_finite() {
        assert_eq!(seconds("1.5"), Ok(1.5));
        for bad in ["0", "-1", "nan", "inf", "soon"] {
            assert!(seconds(bad).is_err(), "{bad}");
        }
    }
}
