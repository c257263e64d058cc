//! Numbers on the command line: each refusal says what is allowed.

use regrasp::run::{Extent, Objective};

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

/// How long `--improve` goes on: seconds, or with an `x` a number of searches.
pub fn extent(text: &str) -> Result<Extent, String> {
    let refuse = |_| {
        "it must be a number of seconds in 0.001..=10000000, such as `5`, or of further searches in \
         1..=1000000 with an `x`, such as `20x`"
            .to_owned()
    };
    match text.trim().strip_suffix('x') {
        Some(count) => whole::<u64, 1, 1_000_000>(count).map(Extent::Searches).map_err(refuse),
        None => seconds(text).map(Extent::Seconds).map_err(refuse),
    }
}

/// What `--optimise` makes less.
pub fn objective(text: &str) -> Result<Objective, String> {
    let all = [Objective::Regrasps, Objective::Duration, Objective::Holds, Objective::Travel];
    let found = all.into_iter().find(|objective| objective.name() == text);
    found.ok_or_else(|| "it must be `regrasps`, `duration`, `holds` or `travel`".into())
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
    fn improvements_last_seconds_or_searches() {
        assert_eq!(extent("2.5"), Ok(Extent::Seconds(2.5)));
        assert_eq!(extent("20x"), Ok(Extent::Searches(20)));
        for bad in ["0", "0x", "-3", "x", "2.5x", "1000001x", "for ever"] {
            assert!(extent(bad).is_err_and(|why| why.contains("`20x`")), "{bad}");
        }
        assert_eq!(objective("travel"), Ok(Objective::Travel));
        assert!(objective("time").is_err_and(|why| why.contains("`duration`")));
    }

    #[test]
    fn seconds_are_positive_and_finite() {
        assert_eq!(seconds("1.5"), Ok(1.5));
        for bad in ["0", "-1", "nan", "inf", "soon"] {
            assert!(seconds(bad).is_err(), "{bad}");
        }
    }
}
