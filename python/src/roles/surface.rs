//! Role 3 in Python.

use super::convert::vector;
use super::data::{Contact, Context};
use super::plugin::Plugin;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use regrasp::api::{self, CallError, Projection, Random, Slot, SurfaceParam, SurfacePath, Vec3, Waypoint};
use std::sync::Arc;

/// A surface.
pub struct Surface(pub Plugin);

/// A contact that exists on every surface, for want of a true one.
fn nowhere() -> api::Contact {
    api::Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() }
}

impl SurfaceParam for Surface {
    fn sample(&self, random: &mut Random) -> api::Contact {
        self.0.value(
            |py, object| {
                let stash = Arc::clone(&self.0.stash);
                let context = Bound::new(py, Context::new(Slot::Surface, random.clone(), stash))?;
                let contact: Contact = object.call_method1("sample", (&context,))?.extract()?;
                *random = context.borrow().take().0;
                Ok(contact.0)
            },
            nowhere,
        )
    }

    fn geodesic(
        &self,
        from: &api::Contact,
        to: &api::Contact,
        path: &mut SurfacePath,
        context: &mut api::Context<'_>,
    ) -> Result<bool, CallError> {
        let ends = (Contact(*from), Contact(*to));
        let found = self.0.with_context(Slot::Surface, context, |_, object, context| {
            let answer = object.call_method1("geodesic", (ends.0, ends.1, context))?;
            answer.extract::<Option<(Vec<(Contact, f64)>, f64)>>()
        })?;
        let Some((waypoints, length)) = found else { return Ok(false) };
        let numbers = waypoints.iter().map(|(_, travelled)| *travelled).chain([length]);
        if !numbers.into_iter().all(|number| number.is_finite() && number >= 0.0) {
            let reason = "`geodesic` answered with a length that is no length".into();
            return Err(CallError::Contract { plugin: self.0.id.into(), reason });
        }
        path.length = length;
        path.waypoints.clear();
        let waypoint = |(contact, lift_length): (Contact, f64)| Waypoint { contact: contact.0, lift_length };
        path.waypoints.extend(waypoints.into_iter().map(waypoint));
        if path.waypoints.is_empty() {
            let reason = "`geodesic` answered with a path of no waypoints".into();
            return Err(CallError::Contract { plugin: self.0.id.into(), reason });
        }
        Ok(true)
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        self.0.value(
            |py, object| {
                let answer = object.call_method1("project", (vector(py, p_OF), hint))?;
                let (contact, distance): (Contact, f64) = answer.extract()?;
                if !distance.is_finite() {
                    let words = "is outside the finite numbers";
                    return Err(PyValueError::new_err(format!("`project`: the distance {distance} {words}")));
                }
                Ok(Projection { contact: contact.0, distance })
            },
            // So far away that nothing counts as touching.
            || Projection { contact: nowhere(), distance: f64::MAX },
        )
    }

    fn walk(&self, from: &api::Contact, direction_O: &Vec3, distance: f64) -> api::Contact {
        self.0.value(
            |py, object| {
                let arguments = (Contact(*from), vector(py, direction_O), distance);
                Ok(object.call_method1("walk", arguments)?.extract::<Contact>()?.0)
            },
            || *from,
        )
    }

    fn edge_distance(&self, contact: &api::Contact) -> f64 {
        self.0
            .value(|_, object| object.call_method1("edge_distance", (Contact(*contact),))?.extract(), || 0.0)
    }
}
