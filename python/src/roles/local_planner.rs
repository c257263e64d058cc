//! Role 5 in Python.

use super::convert::{matrix, of_this_hand, to_reason};
use super::data::{Configuration, Contact};
use super::loan::lend_task;
use super::plugin::Plugin;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use regrasp::api::{self, CallError, Context, FingerJoints, Path, Pose, Reached, Reason, Slot};

/// Where a local planner is to go.
#[pyclass(frozen, module = "regrasp")]
pub struct Target {
    slot: Slot,
    configuration: Option<Configuration>,
    pose: Option<Pose>,
    finger: Option<u8>,
    contact: Option<Contact>,
    joints: Option<FingerJoints>,
}

impl From<&api::Target<'_>> for Target {
    fn from(target: &api::Target<'_>) -> Self {
        let slot = Slot::GraspPlanner;
        let empty = Self { slot, configuration: None, pose: None, finger: None, contact: None, joints: None };
        match *target {
            api::Target::Grasp(q) => Self { configuration: Some(Configuration(q.clone())), ..empty },
            api::Target::Transfer(pose) => Self { slot: Slot::TransferPlanner, pose: Some(*pose), ..empty },
            api::Target::Regrasp { finger, contact, joints } => Self {
                slot: Slot::RegraspPlanner,
                finger: Some(finger.0),
                contact: contact.copied().map(Contact),
                joints: Some(*joints),
                ..empty
            },
        }
    }
}

#[pymethods]
impl Target {
    #[getter]
    fn kind(&self) -> &'static str {
        match self.slot {
            Slot::TransferPlanner => "transfer",
            Slot::RegraspPlanner => "regrasp",
            _ => "grasp",
        }
    }

    #[getter]
    fn configuration(&self) -> Option<Configuration> {
        self.configuration.clone()
    }

    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        self.pose.map(|pose| matrix(py, &pose)).transpose()
    }

    #[getter]
    fn finger(&self) -> Option<u8> {
        self.finger
    }

    #[getter]
    fn contact(&self) -> Option<Contact> {
        self.contact
    }

    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.joints.map(|joints| PyArray1::from_slice(py, &joints))
    }
}

/// A local planner.
pub struct LocalPlanner(pub Plugin);

impl LocalPlanner {
    /// A class is asked only for the motions that it says it makes.
    fn refuse_other_slots(&self, slot: Slot) -> Result<(), CallError> {
        let slots: Vec<String> = self.0.call(|_, object| object.getattr("slots")?.extract())?;
        if slots.iter().any(|own| own == slot.name()) {
            return Ok(());
        }
        let reason = format!("it fills `{}`, not `{}`", slots.join("`, `"), slot.name());
        Err(CallError::Unsupported { plugin: self.0.id.into(), reason })
    }
}

/// The states after the first, the fraction made, and the reason for stopping short.
type Answer = (Vec<Configuration>, f64, Option<String>);

impl api::LocalPlanner for LocalPlanner {
    fn connect(
        &self,
        task: &api::Task<'_>,
        from: &api::Configuration,
        to: &api::Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        let target = Target::from(to);
        let slot = target.slot;
        self.refuse_other_slots(slot)?;
        let (states, fraction, stop): (Vec<Configuration>, f64, Option<Reason>) =
            self.0.with_context(slot, context, |py, object, context| {
                lend_task(py, task, |lent| {
                    let arguments = (lent, Configuration(from.clone()), target, context);
                    let (states, fraction, stop): Answer =
                        object.call_method1("connect", arguments)?.extract()?;
                    states.iter().try_for_each(|q| of_this_hand(task.hand, "connect", &q.0))?;
                    if !(0.0..=1.0).contains(&fraction) || (fraction == 1.0) != stop.is_none() {
                        let rule = "a fraction of 0 to 1, and a reason exactly where it is below 1";
                        return Err(PyValueError::new_err(format!(
                            "`connect` answers with {rule}, not {fraction} and {stop:?}"
                        )));
                    }
                    Ok((states, fraction, stop.map(|name| to_reason(&name)).transpose()?))
                })
            })?;
        if let Some(reason) = stop {
            context.reject(slot, reason);
        }
        let end = states.last().map_or_else(|| from.clone(), |state| state.0.clone());
        if let Some(path) = path {
            path.restart(from);
            path.states.extend(states.into_iter().map(|state| state.0));
        }
        Ok(Reached { end, fraction, stop })
    }
}
