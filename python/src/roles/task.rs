//! The task that samplers and local planners are handed: services and the other roles, for the time of one
//! call.

use super::convert::{fingers, fits, matrix, to_finger, to_fingers, to_joints, to_pose, to_vector, vector};
use super::data::{Configuration, Contact, Context, Grasp};
use super::loan::Loan;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use regrasp::api::{
    self, CallError, FingerSet, Hint, PerFinger, SurfacePath, TipRule, pending_fault, take_fault,
};

/// Everything that the calls of one search share.
#[pyclass(unsendable, module = "regrasp")]
pub struct Task(pub Loan<api::Task<'static>>);

/// The answer of a service or another plugin; their faults are exceptions here.
fn answer<T>(result: Result<T, CallError>) -> PyResult<T> {
    result.map_err(|error| PyRuntimeError::new_err(error.to_string()))
}

/// A value of a plugin that can report a fault only aside.
fn value<T>(value: T) -> PyResult<T> {
    match pending_fault().and_then(|_| take_fault()) {
        Some(fault) => Err(PyRuntimeError::new_err(fault.to_string())),
        None => Ok(value),
    }
}

impl Task {
    /// Refuses a configuration of another hand.
    fn check(&self, q: &Configuration) -> PyResult<api::Task<'static>> {
        let task = self.0.value()?;
        if fits(task.hand, &q.0) {
            Ok(task)
        } else {
            Err(PyValueError::new_err("the configuration does not fit this hand"))
        }
    }

    fn joints(&self, finger: u8, joints: &[f64]) -> PyResult<(api::FingerIndex, api::FingerJoints)> {
        let hand = self.0.value()?.hand;
        let finger = to_finger(finger, hand.finger_count())?;
        let count = hand.finger(finger).joints.len();
        if joints.len() != count {
            return Err(PyValueError::new_err(format!(
                "finger {} has {count} joints, not {}",
                finger.0,
                joints.len()
            )));
        }
        Ok((finger, to_joints(joints)?))
    }

    fn holding(&self, fingers: Option<Vec<u8>>) -> PyResult<FingerSet> {
        let count = self.0.value()?.hand.finger_count();
        fingers.map_or(Ok(FingerSet::first(count)), |fingers| to_fingers(&fingers, count))
    }
}

#[pymethods]
impl Task {
    #[getter]
    fn finger_count(&self) -> PyResult<usize> {
        Ok(self.0.value()?.hand.finger_count())
    }

    #[getter]
    fn fingertip_radius(&self) -> PyResult<f64> {
        Ok(self.0.value()?.hand.fingertip_radius())
    }

    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(vector(py, &self.0.value()?.g_H))
    }

    #[getter]
    fn friction(&self) -> PyResult<f64> {
        Ok(self.0.value()?.planning_friction())
    }

    /// Lowest and highest coordinates of the object's origin in H for samples.
    #[getter]
    fn workspace<'py>(&self, py: Python<'py>) -> PyResult<[Bound<'py, PyArray1<f64>>; 2]> {
        let (lower, upper) = self.0.value()?.workspace;
        Ok([vector(py, &lower), vector(py, &upper)])
    }

    #[getter]
    fn landmarks<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyArray2<f64>>>> {
        self.0.value()?.landmarks.iter().map(|pose| matrix(py, pose)).collect()
    }

    /// The distance that free bodies are to keep (m), between the stored states too.
    #[getter]
    fn clearance(&self) -> PyResult<f64> {
        let task = self.0.value()?;
        Ok(task.tolerances.clearance + task.resolution.clearance)
    }

    /// The height above the surface from which a finger counts as lifted (m).
    #[getter]
    fn lift(&self) -> PyResult<f64> {
        Ok(self.0.value()?.resolution.lift)
    }

    /// The longest step of a fingertip between two states of a regrasp (m).
    #[getter]
    fn regrasp_step(&self) -> PyResult<f64> {
        Ok(self.0.value()?.resolution.regrasp_step)
    }

    /// The joints of a finger, by number, that a fingertip's position leaves free.
    fn spare(&self, finger: u8) -> PyResult<Vec<usize>> {
        let hand = self.0.value()?.hand;
        Ok(hand.finger(to_finger(finger, hand.finger_count())?).spare.to_vec())
    }

    fn rest<'py>(&self, py: Python<'py>, finger: u8) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let hand = self.0.value()?.hand;
        Ok(PyArray1::from_slice(py, &hand.finger(to_finger(finger, hand.finger_count())?).rest))
    }

    /// Lowest and highest positions of a finger's joints.
    fn limits<'py>(&self, py: Python<'py>, finger: u8) -> PyResult<[Bound<'py, PyArray1<f64>>; 2]> {
        let hand = self.0.value()?.hand;
        let joints = &hand.finger(to_finger(finger, hand.finger_count())?).joints;
        let bounds = [joints.iter().map(|j| j.lower).collect(), joints.iter().map(|j| j.upper).collect()];
        Ok(bounds.map(|bound| PyArray1::from_vec(py, bound)))
    }

    fn fk<'py>(&self, py: Python<'py>, finger: u8, joints: Vec<f64>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (finger, joints) = self.joints(finger, &joints)?;
        Ok(vector(py, &self.0.value()?.hand.tip_center(finger, &joints)))
    }

    fn ik<'py>(
        &self,
        py: Python<'py>,
        finger: u8,
        point: [f64; 3],
        near: Vec<f64>,
    ) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let (finger, near) = self.joints(finger, &near)?;
        let found = self.0.value()?.hand.inverse(finger, &to_vector("point", point)?, &near);
        Ok(found.map(|joints| PyArray1::from_slice(py, &joints)))
    }

    fn sample_contact(&self, context: &Context) -> PyResult<Contact> {
        let task = self.0.value()?;
        value(Contact(task.surface.sample(&mut context.inner.borrow_mut().random)))
    }

    #[pyo3(signature = (point, hint = None))]
    fn project(&self, point: [f64; 3], hint: Option<u32>) -> PyResult<(Contact, f64)> {
        let found = self.0.value()?.surface.project(&to_vector("point", point)?, hint);
        value((Contact(found.contact), found.distance))
    }

    fn walk(&self, contact: Contact, direction: [f64; 3], distance: f64) -> PyResult<Contact> {
        let direction = to_vector("direction", direction)?;
        value(Contact(self.0.value()?.surface.walk(&contact.0, &direction, distance)))
    }

    fn edge_distance(&self, contact: Contact) -> PyResult<f64> {
        value(self.0.value()?.surface.edge_distance(&contact.0))
    }

    fn geodesic(
        &self,
        start: Contact,
        end: Contact,
        context: &Context,
    ) -> PyResult<Option<(Vec<(Contact, f64)>, f64)>> {
        let (task, mut path) = (self.0.value()?, SurfacePath::default());
        let mut inner = context.inner.borrow_mut();
        if !answer(task.surface.geodesic(&start.0, &end.0, &mut path, &mut inner))? {
            return Ok(None);
        }
        let waypoints =
            path.waypoints.iter().map(|point| (Contact(point.contact), point.lift_length)).collect();
        Ok(Some((waypoints, path.length)))
    }

    #[pyo3(signature = (q, holding = None, moving = false))]
    fn grasp(&self, q: &Configuration, holding: Option<Vec<u8>>, moving: bool) -> PyResult<Grasp> {
        let (task, holding) = (self.check(q)?, self.holding(holding)?);
        let grasp = if moving { task.transfer_grasp(&q.0, holding) } else { task.grasp(&q.0, holding) };
        value(Grasp::copy(&grasp))?
            .ok_or_else(|| PyRuntimeError::new_err("the contact model's cones are not elliptic"))
    }

    fn is_stable(&self, grasp: &Grasp, context: &Context) -> PyResult<bool> {
        let (task, grasp) = (self.0.value()?, grasp.grasp());
        let mut inner = context.inner.borrow_mut();
        Ok(answer(task.stability.test(&grasp, &mut Hint::default(), &mut inner))?.is_stable())
    }

    /// The fingers that may be lifted, the rest being stable.
    fn liftable(&self, grasp: &Grasp, context: &Context) -> PyResult<Vec<u8>> {
        let (task, grasp) = (self.0.value()?, grasp.grasp());
        Ok(fingers(answer(task.stability.liftable(&grasp, 0, &mut context.inner.borrow_mut()))?))
    }

    fn object_free(&self, pose: [[f64; 4]; 4]) -> PyResult<bool> {
        Ok(self.0.value()?.clearance.object_free(&to_pose(pose)?).is_ok())
    }

    #[pyo3(signature = (finger, joints, pose, touches = true, clear = 0.0))]
    fn finger_free(
        &self,
        finger: u8,
        joints: Vec<f64>,
        pose: [[f64; 4]; 4],
        touches: bool,
        clear: f64,
    ) -> PyResult<bool> {
        let (finger, joints) = self.joints(finger, &joints)?;
        let tip = if touches { TipRule::Touches } else { TipRule::Clear(clear) };
        Ok(self.0.value()?.clearance.finger_free(finger, &joints, &to_pose(pose)?, tip).is_ok())
    }

    fn is_free(&self, q: &Configuration) -> PyResult<bool> {
        let task = self.check(q)?;
        let all = FingerSet::first(q.0.joints.len());
        Ok(task.clearance.configuration_free(&q.0, all, true).is_ok())
    }

    /// Why the configuration may not become a node; None where it may.
    fn admit(&self, q: &Configuration, context: &Context) -> PyResult<Option<&'static str>> {
        let task = self.check(q)?;
        let reason = answer(task.admissible.admit(&task, &q.0, &mut context.inner.borrow_mut()))?;
        Ok(reason.map(api::Reason::name))
    }

    /// What `admit` asks of one finger of `q` beside the fingers in `placed`: None where it may stay.
    fn admit_finger(
        &self,
        q: &Configuration,
        finger: u8,
        placed: Vec<u8>,
        context: &Context,
    ) -> PyResult<Option<&'static str>> {
        let (task, count) = (self.check(q)?, q.0.joints.len());
        let (finger, placed) = (to_finger(finger, count)?, to_fingers(&placed, count)?);
        let mut inner = context.inner.borrow_mut();
        let reason = answer(task.admissible.admit_finger(&task, &q.0, finger, placed, &mut inner))?;
        Ok(reason.map(api::Reason::name))
    }

    /// What `admit` asks of the grasp as a whole, once every finger may stay.
    fn admit_grasp(&self, q: &Configuration, context: &Context) -> PyResult<Option<&'static str>> {
        let task = self.check(q)?;
        let reason = answer(task.admissible.admit_grasp(&task, &q.0, &mut context.inner.borrow_mut()))?;
        Ok(reason.map(api::Reason::name))
    }

    /// Whether each posture of a finger that moves alone, the rest of `q` at rest, touches nothing.
    fn way_free(&self, q: &Configuration, finger: u8, way: Vec<Vec<f64>>, clear: f64) -> PyResult<Vec<bool>> {
        let task = self.check(q)?;
        let way: Vec<_> =
            way.iter().map(|joints| Ok(self.joints(finger, joints)?.1)).collect::<PyResult<_>>()?;
        let (finger, all) = (to_finger(finger, q.0.joints.len())?, FingerSet::first(q.0.joints.len()));
        let lone = task.clearance.lone_finger(finger, &q.0, all);
        Ok(way.iter().map(|joints| lone.free(joints, TipRule::Clear(clear)).is_ok()).collect())
    }

    /// The configuration at a pose with every finger at rest and free.
    fn at_rest(&self, pose: [[f64; 4]; 4]) -> PyResult<Configuration> {
        let hand = self.0.value()?.hand;
        let count = hand.finger_count();
        Ok(Configuration(api::Configuration {
            X_HO: to_pose(pose)?,
            joints: PerFinger::from_fn(count, |finger| hand.finger(finger).rest),
            contacts: PerFinger::filled(count, None),
        }))
    }
}
