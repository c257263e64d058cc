//! Numbers as short as the page can bear: most of its size is numbers.

/// Rounded to 1e-9: nanometres, nanoradians. Far below the micrometre to which page and program must agree.
pub(crate) fn nano(x: f64) -> f64 {
    round(x, 1e9)
}

/// Rounded to 1e-3: forces in newtons, parts of limits.
pub(crate) fn milli(x: f64) -> f64 {
    round(x, 1e3)
}

/// Rounded to 1e-6: unit normals, times, margins.
pub(crate) fn micro(x: f64) -> f64 {
    round(x, 1e6)
}

fn round(x: f64, scale: f64) -> f64 {
    // Adding zero makes -0.0 the shorter 0.0.
    (x * scale).round() / scale + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_close() {
        assert_eq!(nano(0.1234567894), 0.123456789);
        assert_eq!(micro(-1e-9).to_string(), "0");
        assert_eq!(nano(3.0), 3.0);
    }
}
