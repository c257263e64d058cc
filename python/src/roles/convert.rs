//! Vectors, poses and sets of fingers between the contract and Python.

use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use regrasp::api::{
    Configuration, FingerIndex, FingerJoints, FingerSet, Hand, MAX_FINGER_JOINTS, Pose, Reason, Rotation,
    Vec3,
};

/// A vector as an array (3,).
pub fn vector<'py>(py: Python<'py>, v: &Vec3) -> Bound<'py, PyArray1<f64>> {
    PyArray1::from_slice(py, v.as_slice())
}

/// Rows of three as an array (n, 3).
pub fn rows<'py>(py: Python<'py>, vectors: &[Vec3]) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: Vec<f64> = vectors.iter().flat_map(|v| v.iter().copied()).collect();
    PyArray1::from_vec(py, flat).reshape([vectors.len(), 3])
}

/// A pose as an array (4, 4).
pub fn matrix<'py>(py: Python<'py>, X: &Pose) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let m = X.to_homogeneous();
    let flat: Vec<f64> = (0..4).flat_map(|row| (0..4).map(move |column| m[(row, column)])).collect();
    PyArray1::from_vec(py, flat).reshape([4, 4])
}

/// A finite vector from Python.
pub fn to_vector(name: &str, v: [f64; 3]) -> PyResult<Vec3> {
    let finite = v.iter().all(|x| x.is_finite());
    let refused = || PyValueError::new_err(format!("`{name}` = {v:?} is outside the finite numbers"));
    if finite { Ok(Vec3::from(v)) } else { Err(refused()) }
}

/// A pose from a 4×4 matrix.
pub fn to_pose(m: [[f64; 4]; 4]) -> PyResult<Pose> {
    let R = nalgebra::Matrix3::from_fn(|row, column| m[row][column]);
    let p = to_vector("pose", [m[0][3], m[1][3], m[2][3]])?;
    let error = (R * R.transpose() - nalgebra::Matrix3::identity()).norm();
    if !(error < 1e-6 && R.determinant() > 0.0) {
        return Err(PyValueError::new_err("the pose's upper left 3×3 block is not a rotation"));
    }
    let R = Rotation::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(R));
    Ok(Pose::from_parts(p.into(), R))
}

/// Joint positions of one finger from Python.
pub fn to_joints(values: &[f64]) -> PyResult<FingerJoints> {
    if values.len() > MAX_FINGER_JOINTS || values.iter().any(|x| !x.is_finite()) {
        let most =
            format!("joints are at most {MAX_FINGER_JOINTS} finite numbers for a finger, not {values:?}");
        return Err(PyValueError::new_err(most));
    }
    Ok(FingerJoints::from_slice(values))
}

/// The numbers of the fingers in a set.
pub fn fingers(set: FingerSet) -> Vec<u8> {
    set.iter().map(|finger| finger.0).collect()
}

/// A finger of a hand with `count` fingers.
pub fn to_finger(finger: u8, count: usize) -> PyResult<FingerIndex> {
    if usize::from(finger) < count {
        return Ok(FingerIndex(finger));
    }
    Err(PyValueError::new_err(format!("`finger` = {finger} is outside 0..={}", count.saturating_sub(1))))
}

/// A set of fingers of a hand with `count` fingers.
pub fn to_fingers(fingers: &[u8], count: usize) -> PyResult<FingerSet> {
    fingers.iter().map(|&finger| to_finger(finger, count)).collect()
}

/// Whether a configuration has the fingers and joints of a hand.
pub fn fits(hand: &dyn Hand, q: &Configuration) -> bool {
    q.joints.len() == hand.finger_count()
        && q.joints.iter().all(|(finger, joints)| joints.len() == hand.finger(finger).joints.len())
}

/// What a plugin answers, where it is one of this hand.
pub fn of_this_hand(hand: &dyn Hand, method: &str, q: &Configuration) -> PyResult<()> {
    if fits(hand, q) {
        return Ok(());
    }
    let words = "answered with a configuration that has other fingers or joints than this hand";
    Err(PyValueError::new_err(format!("`{method}` {words}")))
}

/// The reason of this name.
pub fn to_reason(name: &str) -> PyResult<Reason> {
    Reason::ALL.into_iter().find(|reason| reason.name() == name).ok_or_else(|| {
        let known = Reason::ALL.map(Reason::name).join("`, `");
        PyValueError::new_err(format!("there is no reason `{name}`; there are `{known}`"))
    })
}
