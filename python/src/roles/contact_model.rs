//! Role 1 in Python.

use super::data::Contact;
use super::plugin::Plugin;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use regrasp::api::{self, Cone, ConeEdge, FingerIndex, MAX_FINGERS};

/// A contact model.
pub struct ContactModel(pub Plugin);

/// Friction and torsional radius, or edges: tangential forces along both tangents and torsion.
#[derive(FromPyObject)]
enum Answer {
    Elliptic(f64, f64),
    Polyhedral(Vec<[f64; 3]>),
}

fn cone(answer: Answer) -> PyResult<Cone<'static>> {
    let finite = |x: &f64| x.is_finite();
    match answer {
        Answer::Elliptic(mu, gamma) if [mu, gamma].iter().all(|x| x.is_finite() && *x >= 0.0) => {
            Ok(Cone::Elliptic { mu, gamma })
        }
        Answer::Polyhedral(edges) if !edges.is_empty() && edges.iter().flatten().all(finite) => {
            let edge = |[a, b, torsion]: [f64; 3]| ConeEdge { tangential: [a, b], torsion };
            Ok(Cone::Polyhedral(edges.into_iter().map(edge).collect::<Vec<_>>().into()))
        }
        _ => Err(PyValueError::new_err(
            "a cone is friction and torsional radius (m), finite and not negative, or edges of three numbers",
        )),
    }
}

impl api::ContactModel for ContactModel {
    fn cone(&self, finger: FingerIndex, contact: &api::Contact, mu: f64) -> Cone<'_> {
        self.0.value(
            |_, object| cone(object.call_method1("cone", (finger.0, Contact(*contact), mu))?.extract()?),
            || Cone::FRICTIONLESS,
        )
    }

    fn fewest_contacts(&self) -> usize {
        self.0.value(|_, object| Ok(object.getattr("fewest_contacts")?.extract()?), || MAX_FINGERS)
    }
}
