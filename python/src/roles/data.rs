//! Plain data of the contract as Python sees it: contacts, grasps, configurations, the context of a call.

use super::convert::{matrix, rows, to_joints, to_pose, to_reason, to_vector, vector};
use super::stash::Stash;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use regrasp::api::{
    self, Cone, FingerIndex, GraspContact, MAX_FINGERS, PerFinger, Random, Slot, Tally, Uninterrupted, Vec3,
};
use std::cell::RefCell;
use std::sync::Arc;

/// Where a fingertip touches, or could touch, the object.
#[pyclass(frozen, module = "regrasp", from_py_object)]
#[derive(Clone, Copy)]
pub struct Contact(pub api::Contact);

#[pymethods]
impl Contact {
    #[new]
    #[pyo3(signature = (point, normal, facet = 0))]
    fn new(point: [f64; 3], normal: [f64; 3], facet: u32) -> PyResult<Self> {
        let n = to_vector("normal", normal)?;
        if n.norm() < 1e-9 {
            return Err(PyValueError::new_err("`normal` has the length 0"));
        }
        Ok(Self(api::Contact { facet, p_OC: to_vector("point", point)?, n_O: n.normalize() }))
    }

    #[getter]
    fn facet(&self) -> u32 {
        self.0.facet
    }

    #[getter]
    fn point<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.p_OC)
    }

    #[getter]
    fn normal<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.n_O)
    }

    fn tip_center<'py>(&self, py: Python<'py>, radius: f64) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.0.tip_center(radius))
    }
}

/// One contact of a grasp: finger, point and outward normal in O, friction, torsional radius.
#[derive(Clone, Copy)]
struct Touch {
    finger: u8,
    p_OC: Vec3,
    n_O: Vec3,
    mu: f64,
    gamma: f64,
}

/// Contacts that hold the object, each with its friction cone.
#[pyclass(frozen, module = "regrasp", from_py_object)]
#[derive(Clone)]
pub struct Grasp {
    touches: Vec<Touch>,
    g_O: Vec3,
}

impl Grasp {
    /// A copy of a grasp; `None` where a cone is not elliptic.
    pub fn copy(grasp: &api::Grasp<'_>) -> Option<Self> {
        let touch = |contact: &GraspContact<'_>| {
            let Cone::Elliptic { mu, gamma } = contact.cone else { return None };
            Some(Touch { finger: contact.finger.0, p_OC: contact.p_OC, n_O: contact.n_O, mu, gamma })
        };
        let touches = grasp.contacts().iter().map(touch).collect::<Option<_>>()?;
        Some(Self { touches, g_O: grasp.g_O })
    }

    /// The grasp of the contract.
    pub fn grasp(&self) -> api::Grasp<'static> {
        let mut grasp = api::Grasp::new(self.g_O);
        for &Touch { finger, p_OC, n_O, mu, gamma } in &self.touches {
            let cone = Cone::Elliptic { mu, gamma };
            grasp.push(GraspContact { finger: FingerIndex(finger), p_OC, n_O, cone });
        }
        grasp
    }

    fn numbers<'py>(&self, py: Python<'py>, of: impl Fn(&Touch) -> f64) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_vec(py, self.touches.iter().map(of).collect())
    }

    fn vectors<'py>(
        &self,
        py: Python<'py>,
        of: impl Fn(&Touch) -> Vec3,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        rows(py, &self.touches.iter().map(of).collect::<Vec<_>>())
    }
}

#[pymethods]
impl Grasp {
    #[new]
    #[pyo3(signature = (points, normals, friction = 0.8, torsion = 0.0, gravity = [0.0; 3]))]
    fn new(
        points: Vec<[f64; 3]>,
        normals: Vec<[f64; 3]>,
        friction: f64,
        torsion: f64,
        gravity: [f64; 3],
    ) -> PyResult<Self> {
        let count = points.len();
        if normals.len() != count || !(1..=MAX_FINGERS).contains(&count) {
            let range = format!("a grasp has 1..={MAX_FINGERS} contacts, each a point and a normal");
            return Err(PyValueError::new_err(format!("{range}, not {count} and {}", normals.len())));
        }
        if !(friction.is_finite() && friction >= 0.0 && torsion.is_finite() && torsion >= 0.0) {
            return Err(PyValueError::new_err("`friction` and `torsion` are finite and not negative"));
        }
        let touch = |(finger, (p, n))| {
            let Contact(contact) = Contact::new(p, n, 0)?;
            let (p_OC, n_O) = (contact.p_OC, contact.n_O);
            Ok(Touch { finger, p_OC, n_O, mu: friction, gamma: torsion })
        };
        let touches = (0..).zip(points.into_iter().zip(normals)).map(touch).collect::<PyResult<_>>()?;
        Ok(Self { touches, g_O: to_vector("gravity", gravity)? })
    }

    #[getter]
    fn fingers(&self) -> Vec<u8> {
        self.touches.iter().map(|touch| touch.finger).collect()
    }

    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |touch| touch.p_OC)
    }

    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        self.vectors(py, |touch| touch.n_O)
    }

    #[getter]
    fn friction<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.numbers(py, |touch| touch.mu)
    }

    #[getter]
    fn torsion<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.numbers(py, |touch| touch.gamma)
    }

    #[getter]
    fn gravity<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.g_O)
    }

    fn __len__(&self) -> usize {
        self.touches.len()
    }
}

/// A configuration of hand and object.
#[pyclass(frozen, module = "regrasp", from_py_object)]
#[derive(Clone)]
pub struct Configuration(pub api::Configuration);

#[pymethods]
impl Configuration {
    #[new]
    fn new(pose: [[f64; 4]; 4], joints: Vec<Vec<f64>>, contacts: Vec<Option<Contact>>) -> PyResult<Self> {
        let count = joints.len();
        if contacts.len() != count || !(1..=MAX_FINGERS).contains(&count) {
            let range = format!("joints and contacts have an entry for each of 1..={MAX_FINGERS} fingers");
            return Err(PyValueError::new_err(format!("{range}, not {count} and {}", contacts.len())));
        }
        let joints: Vec<_> = joints.iter().map(|joints| to_joints(joints)).collect::<PyResult<_>>()?;
        Ok(Self(api::Configuration {
            X_HO: to_pose(pose)?,
            joints: PerFinger::from_fn(count, |finger| joints[finger.index()]),
            contacts: PerFinger::from_fn(count, |finger| contacts[finger.index()].map(|contact| contact.0)),
        }))
    }

    #[getter]
    fn pose<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        matrix(py, &self.0.X_HO)
    }

    #[getter]
    fn joints<'py>(&self, py: Python<'py>) -> Vec<Bound<'py, PyArray1<f64>>> {
        self.0.joints.iter().map(|(_, joints)| PyArray1::from_slice(py, joints)).collect()
    }

    #[getter]
    fn contacts(&self) -> Vec<Option<Contact>> {
        self.0.contacts.iter().map(|(_, contact)| contact.map(Contact)).collect()
    }
}

/// The mutable side of one call: random stream and counts. Lasts as long as the call.
#[pyclass(unsendable, module = "regrasp")]
pub struct Context {
    slot: Slot,
    pub inner: RefCell<api::Context<'static>>,
    stash: Arc<Stash>,
}

impl Context {
    /// The context of a call of the plugin in `slot`.
    pub fn new(slot: Slot, random: Random, stash: Arc<Stash>) -> Self {
        Self { slot, inner: RefCell::new(api::Context::new(random, &Uninterrupted)), stash }
    }

    /// What the call has left: its random stream and its counts.
    pub fn take(&self) -> (Random, Tally) {
        let inner = self.inner.borrow();
        (inner.random.clone(), inner.tally.clone())
    }
}

#[pymethods]
impl Context {
    #[new]
    #[pyo3(signature = (seed = 0))]
    fn seeded(seed: u64) -> Self {
        Self::new(Slot::Sampler, Random::from_key(seed, 0, 0, 0), Arc::default())
    }

    #[pyo3(signature = (low = 0.0, high = 1.0))]
    fn uniform(&self, low: f64, high: f64) -> f64 {
        self.inner.borrow_mut().random.range(low, high)
    }

    fn normal(&self) -> f64 {
        self.inner.borrow_mut().random.normal()
    }

    fn index(&self, count: usize) -> PyResult<usize> {
        if count == 0 {
            return Err(PyValueError::new_err("`count` = 0: there is nothing to choose from"));
        }
        Ok(self.inner.borrow_mut().random.index(count))
    }

    fn direction<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        vector(py, &self.inner.borrow_mut().random.direction())
    }

    fn rotation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let R = self.inner.borrow_mut().random.rotation().to_rotation_matrix();
        rows(py, &[0, 1, 2].map(|row| R.matrix().row(row).transpose()))
    }

    fn word(&self) -> u64 {
        self.inner.borrow_mut().random.word()
    }

    fn reject(&self, reason: &str) -> PyResult<()> {
        self.inner.borrow_mut().reject(self.slot, to_reason(reason)?);
        Ok(())
    }

    #[getter]
    fn interrupted(&self) -> bool {
        self.stash.interrupted()
    }
}
