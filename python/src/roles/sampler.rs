//! Role 4 in Python.

use super::convert::{fingers, matrix, of_this_hand};
use super::data::{Configuration, Contact};
use super::loan::lend_task;
use super::plugin::Plugin;
use numpy::PyArray2;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use regrasp::api::{self, CallError, ClosedChainSampler, Context, FingerSet, PerFinger, Pose, Slot};

/// Where the object's pose comes from in a sample.
#[pyclass(frozen, module = "regrasp")]
pub struct PoseRequest {
    kind: &'static str,
    pose: Option<Pose>,
    near: Option<Configuration>,
    radius: f64,
    angle: f64,
}

impl From<api::PoseRequest<'_>> for PoseRequest {
    fn from(request: api::PoseRequest<'_>) -> Self {
        let anywhere = Self { kind: "anywhere", pose: None, near: None, radius: 0.0, angle: 0.0 };
        match request {
            api::PoseRequest::Anywhere => anywhere,
            api::PoseRequest::At(pose) => Self { kind: "at", pose: Some(pose), ..anywhere },
            api::PoseRequest::Near { configuration, radius, angle } => {
                let near = Some(Configuration(configuration.clone()));
                Self { kind: "near", pose: Some(configuration.X_HO), near, radius, angle }
            }
        }
    }
}

#[pymethods]
impl PoseRequest {
    #[getter]
    fn kind(&self) -> &'static str {
        self.kind
    }

    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.pose.map(|pose| matrix(py, &pose)).transpose()
    }

    #[getter]
    fn near(&self) -> Option<Configuration> {
        self.near.clone()
    }

    #[getter]
    fn radius(&self) -> f64 {
        self.radius
    }

    #[getter]
    fn angle(&self) -> f64 {
        self.angle
    }
}

/// The configuration in an answer, if there is one.
fn answer(
    task: &api::Task<'_>,
    method: &str,
    answer: &Bound<'_, PyAny>,
) -> PyResult<Option<api::Configuration>> {
    let found = answer.extract::<Option<Configuration>>().map_err(|_| {
        PyTypeError::new_err(format!("`{method}` answers with a Configuration or None, not {answer}"))
    })?;
    found.map(|q| of_this_hand(task.hand, method, &q.0).map(|()| q.0)).transpose()
}

/// The configuration at the very pose that was asked for: as a matrix it lost the last bits.
fn exactly(mut q: api::Configuration, asked: Option<&Pose>) -> api::Configuration {
    if let Some(X_HO) = asked
        && (q.X_HO.translation.vector - X_HO.translation.vector).norm() < 1e-12
        && q.X_HO.rotation.angle_to(&X_HO.rotation) < 1e-7
    {
        q.X_HO = *X_HO;
    }
    q
}

/// A sampler.
pub struct Sampler(pub Plugin);

impl ClosedChainSampler for Sampler {
    fn sample(
        &self,
        task: &api::Task<'_>,
        pose: api::PoseRequest<'_>,
        holding: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<api::Configuration>, CallError> {
        let found = self.0.with_context(Slot::Sampler, context, |py, object, context| {
            lend_task(py, task, |lent| {
                let arguments = (lent, PoseRequest::from(pose), fingers(holding), context);
                answer(task, "sample", &object.call_method1("sample", arguments)?)
            })
        })?;
        let asked = match pose {
            api::PoseRequest::At(X_HO) => Some(X_HO),
            _ => None,
        };
        Ok(found.map(|q| exactly(q, asked.as_ref())))
    }

    fn close(
        &self,
        task: &api::Task<'_>,
        X_HO: &Pose,
        contacts: &PerFinger<Option<api::Contact>>,
        near: &api::Configuration,
        context: &mut Context<'_>,
    ) -> Result<Option<api::Configuration>, CallError> {
        let contacts: Vec<_> = contacts.iter().map(|(_, contact)| contact.map(Contact)).collect();
        let found = self.0.with_context(Slot::Sampler, context, |py, object, context| {
            lend_task(py, task, |lent| {
                let arguments = (lent, matrix(py, X_HO)?, contacts, Configuration(near.clone()), context);
                answer(task, "close", &object.call_method1("close", arguments)?)
            })
        })?;
        Ok(found.map(|q| exactly(q, Some(X_HO))))
    }
}
