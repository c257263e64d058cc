//! Role 2 in Python.

use super::convert::vector;
use super::data::Grasp;
use super::plugin::Plugin;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use regrasp::api::{self, Assessment, CallError, Certificate, Context, Hint, Slot, Stability, Vec3};

/// A stability test.
pub struct StabilityTest(pub Plugin);

impl StabilityTest {
    fn copy(&self, grasp: &api::Grasp<'_>) -> Result<Grasp, CallError> {
        Grasp::copy(grasp).ok_or_else(|| CallError::Unsupported {
            plugin: self.0.id.into(),
            reason: "plugins in Python know elliptic cones only; use another contact model".into(),
        })
    }
}

/// True, False, or None for "too close to say".
fn verdict(answer: &Bound<'_, PyAny>) -> PyResult<Stability> {
    match answer.extract::<Option<bool>>() {
        Ok(Some(true)) => Ok(Stability::Stable),
        Ok(Some(false)) => Ok(Stability::Unstable),
        Ok(None) => Ok(Stability::Undecided),
        Err(_) => Err(PyTypeError::new_err(format!("`test` answers True, False or None, not {answer}"))),
    }
}

impl api::StabilityTest for StabilityTest {
    fn test(
        &self,
        grasp: &api::Grasp<'_>,
        _: &mut Hint,
        context: &mut Context<'_>,
    ) -> Result<Stability, CallError> {
        context.count_call(Slot::StabilityTest);
        let grasp = self.copy(grasp)?;
        self.0.call(|_, object| verdict(&object.call_method1("test", (grasp,))?))
    }

    fn assess(
        &self,
        grasp: &api::Grasp<'_>,
        length: Option<f64>,
        center_O: Option<Vec3>,
        context: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        context.count_call(Slot::StabilityTest);
        let grasp = self.copy(grasp)?;
        self.0.call(|py, object| {
            let stability = verdict(&object.call_method1("test", (grasp.clone(),))?)?;
            let center = center_O.map(|center| vector(py, &center));
            let (margin_lower, margin_upper) =
                object.call_method1("margin", (grasp, length, center))?.extract::<(f64, f64)>()?;
            if margin_lower.is_nan() || margin_upper.is_nan() {
                return Err(PyValueError::new_err(
                    "`margin` answered with NaN; give two bounds, a lower one first",
                ));
            }
            Ok(Assessment { stability, margin_lower, margin_upper, certificate: Certificate::None })
        })
    }
}
