//! Laws of what a strategy asks for.

use super::{Kept, ensure};
use regrasp_api::Vicinity;

/// No hand moves an object by more (m).
const FAR: f64 = 1.0;

/// Law `strategy-sensible`: a radius above 0 and at most a metre, an angle above 0 and at most half a turn.
pub fn vicinity_kept(within: &Vicinity) -> Kept {
    let Vicinity { radius, angle } = *within;
    let sound = radius > 0.0 && radius <= FAR && angle > 0.0 && angle <= std::f64::consts::PI;
    ensure("strategy-sensible", sound, || {
        format!("extends within {radius} m and {angle} rad; 0..={FAR} m and 0..=π rad make sense, 0 left out")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_units_are_told() {
        assert!(vicinity_kept(&Vicinity::default()).is_ok());
        for (radius, angle) in [(10.0, 0.5), (0.01, 30.0), (0.0, 0.5), (0.01, f64::NAN), (f64::INFINITY, 1.0)]
        {
            assert!(vicinity_kept(&Vicinity { radius, angle }).is_err(), "{radius} {angle}");
        }
    }
}
