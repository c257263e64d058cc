//! Figures with their units, as a person reads them: 2.59 µm, 12.7 s, 98 % of the limit.

/// A value in the unit of a check, in the multiple of it that suits its size.
pub fn quantity(value: f64, unit: &str) -> String {
    if value == 0.0 {
        let unit = if unit == "of the limit" { "" } else { unit };
        return format!("0 {unit}").trim_end().to_owned();
    }
    match unit {
        "m" => scaled(value, &[(1.0, "m"), (1e-3, "mm"), (1e-6, "µm"), (1e-9, "nm")]),
        "s" => scaled(value, &[(1.0, "s"), (1e-3, "ms"), (1e-6, "µs")]),
        "rad" => scaled(value, &[(1.0, "rad"), (1e-3, "mrad"), (1e-6, "µrad")]),
        "of the limit" => format!("{} %", digits(100.0 * value)),
        _ => format!("{} {unit}", digits(value)).trim_end().to_owned(),
    }
}

/// A time span (s): in milliseconds below a second, in minutes from two on.
pub fn span(seconds: f64) -> String {
    match seconds {
        s if s < 0.9995 => format!("{:.1} ms", s * 1e3),
        s if s < 120.0 => format!("{s:.1} s"),
        // Rounded first: 299.9 s are 5 min 0 s, not 4 min 60 s.
        s => format!("{:.0} min {:.0} s", (s.round() / 60.0).floor(), s.round() % 60.0),
    }
}

/// A number alone, short at any size.
pub fn digits(x: f64) -> String {
    let size = x.abs();
    match size {
        _ if x == 0.0 => "0".to_owned(),
        _ if !x.is_finite() => x.to_string(),
        _ if size.fract() == 0.0 && size < 1e5 => format!("{x:.0}"),
        s if !(1e-3..1e5).contains(&s) => format!("{x:.2e}"),
        s if s >= 99.95 => format!("{x:.1}"),
        s if s >= 0.9995 => format!("{x:.2}"),
        _ => format!("{x:.4}"),
    }
}

fn scaled(value: f64, units: &[(f64, &str)]) -> String {
    // 999.97 µm is 1 mm: what rounds up belongs to the larger unit.
    let fitting = units.iter().find(|(unit, _)| value.abs() >= 0.9995 * unit);
    match fitting {
        Some((unit, name)) => {
            let x = value / unit;
            let decimals = if x.abs() >= 99.95 { 0 } else { 2 };
            let text = format!("{x:.decimals$}");
            let short =
                if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
            format!("{short} {name}")
        }
        // Below what the unit is used for: rounding.
        None => format!("{value:.1e} {}", units[0].1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_suit_the_size() {
        let cases = [
            (2.59e-6, "m", "2.59 µm"),
            (-1.34e-4, "m", "-134 µm"),
            (1e-4, "m", "100 µm"),
            (9.9999e-4, "m", "1 mm"),
            (1.5e-3, "m", "1.5 mm"),
            (1e-13, "m", "1.0e-13 m"),
            (2.8e-3, "s", "2.8 ms"),
            (1.7e-3, "rad", "1.7 mrad"),
            (0.98, "of the limit", "98 %"),
            (0.0, "of the limit", "0"),
            (0.0, "faults", "0 faults"),
            (3.0, "faults", "3 faults"),
            (1e-8, "force", "1.00e-8 force"),
            (0.1209, "force", "0.1209 force"),
        ];
        for (value, unit, text) in cases {
            assert_eq!(quantity(value, unit), text);
        }
        assert!(quantity(f64::NAN, "m").contains("NaN"));
    }

    #[test]
    fn spans_suit_the_size() {
        assert_eq!([0.0123, 0.99996, 12.71, 150.2].map(span), ["12.3 ms", "1.0 s", "12.7 s", "2 min 30 s"]);
        assert_eq!(span(299.9), "5 min 0 s");
    }

    #[test]
    fn digits_are_short_at_any_size() {
        let all = [0.0, 12.5, 2e-5, 314.15926, 2.0, 1e7, 0.25];
        assert_eq!(all.map(digits), ["0", "12.50", "2.00e-5", "314.2", "2", "1.00e7", "0.2500"]);
    }
}
