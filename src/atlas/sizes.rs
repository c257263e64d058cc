//! Sizes on the command line.

/// The sizes (m) that a text names: `20..80mm`, `30,50mm`, `0.05m`; a range is taken in `steps` equal
/// steps, to a hundredth of a millimetre.
pub fn sizes(text: &str, steps: usize) -> Result<Vec<f64>, String> {
    let refuse = |why: &str| format!("`--size {text}`: {why}; give `20..80mm`, `30,50mm` or `0.05m`");
    let trimmed = text.trim();
    let (numbers, unit) = match trimmed.strip_suffix("mm") {
        Some(numbers) => (numbers, 1e-3),
        None => (trimmed.strip_suffix('m').ok_or_else(|| refuse("it has no unit"))?, 1.0),
    };
    let number = |text: &str| {
        let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite() && *number > 0.0);
        number.ok_or_else(|| refuse(&format!("`{}` is no length above 0", text.trim())))
    };
    let Some((low, high)) = numbers.split_once("..") else {
        let mut all = numbers.split(',').map(number).collect::<Result<Vec<_>, _>>()?;
        all.sort_by(f64::total_cmp);
        all.dedup();
        return Ok(all.into_iter().map(|size| size * unit).collect());
    };
    let (low, high) = (number(low)?, number(high.trim_start_matches('='))?);
    if low > high {
        return Err(refuse("the range is empty: its first end is above its second"));
    }
    if low == high {
        return Ok(vec![low * unit]);
    }
    let step = |k: usize| (low + (high - low) * k as f64 / (steps - 1) as f64) * unit;
    // To a hundredth of a millimetre, as tables show it.
    let mut all: Vec<f64> = (0..steps).map(|k| (step(k) * 1e5).round() / 1e5).collect();
    all.dedup();
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_and_lists_are_lengths() {
        let found = sizes("20..80mm", 7).unwrap();
        let wanted = [0.02, 0.03, 0.04, 0.05, 0.06, 0.07, 0.08];
        assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-12) && found.len() == 7);
        assert_eq!(sizes("50,30,50mm", 7).unwrap(), [0.03, 0.05]);
        assert_eq!(sizes("0.05m", 7).unwrap(), [0.05]);
        assert_eq!(sizes("40..40mm", 7).unwrap(), [0.04]);
    }

    #[test]
    fn what_is_no_size_is_refused_with_its_reason() {
        for (bad, why) in [
            ("80..20mm", "empty"),
            ("50", "no unit"),
            ("..mm", "no length"),
            ("-5mm", "no length"),
            ("mm", "`"),
        ] {
            let text = sizes(bad, 7).unwrap_err();
            assert!(text.contains(why) && text.contains("20..80mm"), "{text}");
        }
    }
}
