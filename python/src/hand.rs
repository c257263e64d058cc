//! Hands: forward and inverse kinematics of many postures at once.

use crate::watch::in_parts;
use crate::{errors, urdf};
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use regrasp::api::{FingerIndex, FingerJoints, Hand as _, Vec3};
use regrasp::run::scenario::load_hand;
use regrasp::world::{ChainHand, Columns};
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;

/// Postures between two looks for signals: some milliseconds.
const POSTURES: usize = 1 << 15;
/// The same for inverse kinematics, which can be iterative.
const INVERSES: usize = 1 << 9;

/// A hand as it was understood.
#[pyclass(frozen, module = "regrasp._regrasp")]
pub struct Hand {
    hand: Arc<ChainHand>,
    notes: Vec<String>,
}

impl Hand {
    fn finger(&self, py: Python<'_>, finger: usize) -> PyResult<FingerIndex> {
        let count = self.hand.finger_count();
        if finger < count {
            return Ok(FingerIndex(finger as u8));
        }
        let range = format!("0..={}", count.saturating_sub(1));
        Err(errors::argument(py, "finger", &finger.to_string(), &range))
    }

    /// Refuses columns of another number of joints.
    fn check(&self, py: Python<'_>, finger: FingerIndex, columns: usize) -> PyResult<()> {
        let count = self.hand.finger(finger).joints.len();
        if columns == count {
            return Ok(());
        }
        Err(errors::argument(
            py,
            "joints",
            &format!("{columns} columns"),
            &format!("{count} joints of this finger"),
        ))
    }
}

#[pymethods]
impl Hand {
    /// The hand that a scenario's `hand`, as JSON, names; files are looked for in `folder`.
    #[staticmethod]
    fn load(py: Python<'_>, tree: &str, folder: PathBuf) -> PyResult<Self> {
        let loaded = py.detach(|| load_hand(tree, &folder)).map_err(|error| errors::scenario(py, &error))?;
        Ok(Self { hand: Arc::new(loaded.hand), notes: loaded.remarks })
    }

    /// The description with everything resolved, and what a user should know of how it was understood, as
    /// JSON.
    fn describe(&self) -> String {
        let fingers: Vec<_> = (0..self.hand.finger_count())
            .map(|index| {
                let finger = FingerIndex(index as u8);
                let model = self.hand.finger(finger);
                json!({
                    "name": model.name,
                    "joints": model.joints.iter().map(|joint| &joint.name).collect::<Vec<_>>(),
                    "lower": model.joints.iter().map(|joint| joint.lower).collect::<Vec<_>>(),
                    "upper": model.joints.iter().map(|joint| joint.upper).collect::<Vec<_>>(),
                    "velocity": model.joints.iter().map(|joint| joint.velocity).collect::<Vec<_>>(),
                    "effort": model.joints.iter().map(|joint| joint.effort).collect::<Vec<_>>(),
                    "rest": model.rest.to_vec(),
                    "spare": model.spare,
                    "closed_form": self.hand.is_closed_form(finger),
                })
            })
            .collect();
        let description = self.hand.description();
        let radius = self.hand.fingertip_radius();
        json!({
            "fingers": fingers, "notes": self.notes, "description": description,
            "fingertip_radius": radius, "joint_names": regrasp::export::joint_names(description),
        })
        .to_string()
    }

    /// Names and contents of the hand's URDF, first, and of the meshes that it names.
    fn urdf(&self, py: Python<'_>, stem: &str) -> PyResult<Vec<(String, Py<PyBytes>)>> {
        let files = py.detach(|| urdf::files(&self.hand, stem));
        let files = files.map_err(|reason| errors::plan_file(py, &reason))?;
        let file = |file: regrasp::export::File| (file.name, PyBytes::new(py, &file.bytes).unbind());
        Ok(files.into_iter().map(file).collect())
    }

    /// Fingertip centres in H (n, 3) for postures (n, joints) of one finger.
    fn fk<'py>(
        &self,
        py: Python<'py>,
        finger: usize,
        joints: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let finger = self.finger(py, finger)?;
        let (count, columns) = joints.as_array().dim();
        self.check(py, finger, columns)?;
        let joints = joints.as_slice()?;
        let mut centers = vec![0.0; 3 * count];
        in_parts(py, count, POSTURES, |rows| {
            let joints = Columns {
                numbers: &joints[columns * rows.start..][..columns * rows.len()],
                width: columns,
                first: 0,
            };
            let numbers = &mut centers[3 * rows.start..][..3 * rows.len()];
            self.hand.tip_centers(finger, &joints, &mut Columns { numbers, width: 3, first: 0 });
        })?;
        PyArray1::from_vec(py, centers).reshape([count, 3])
    }

    /// Centres of all fingertips in H (n, fingers, 3) for postures (n, joints) of the whole hand.
    fn fingertips<'py>(
        &self,
        py: Python<'py>,
        joints: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let fingers = self.hand.finger_count();
        let sizes: Vec<usize> =
            (0..fingers).map(|finger| self.hand.finger(FingerIndex(finger as u8)).joints.len()).collect();
        let (count, columns) = joints.as_array().dim();
        if columns != sizes.iter().sum::<usize>() {
            let range = format!("{} joints of the hand", sizes.iter().sum::<usize>());
            return Err(errors::argument(py, "joints", &format!("{columns} columns"), &range));
        }
        let joints = joints.as_slice()?;
        let mut centers = vec![0.0; 3 * fingers * count];
        in_parts(py, count, POSTURES, |rows| {
            let numbers = &joints[columns * rows.start..][..columns * rows.len()];
            let tips = &mut centers[3 * fingers * rows.start..][..3 * fingers * rows.len()];
            let mut first = 0;
            for (finger, size) in sizes.iter().enumerate() {
                let joints = Columns { numbers, width: columns, first };
                let mut own = Columns { numbers: &mut *tips, width: 3 * fingers, first: 3 * finger };
                self.hand.tip_centers(FingerIndex(finger as u8), &joints, &mut own);
                first += size;
            }
        })?;
        PyArray1::from_vec(py, centers).reshape([count, fingers, 3])
    }

    /// Jacobians of the fingertip centre in H (n, 3, joints) for postures (n, joints).
    fn jacobian<'py>(
        &self,
        py: Python<'py>,
        finger: usize,
        joints: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let finger = self.finger(py, finger)?;
        let (count, columns) = joints.as_array().dim();
        self.check(py, finger, columns)?;
        let joints = joints.as_slice()?;
        let mut flat = vec![0.0; count * 3 * columns];
        in_parts(py, count, POSTURES, |rows| {
            let numbers = &joints[columns * rows.start..][..columns * rows.len()];
            let width = 3 * columns;
            let jacobians = &mut flat[width * rows.start..][..width * rows.len()];
            let joints = Columns { numbers, width: columns, first: 0 };
            self.hand.tip_jacobians(finger, &joints, &mut Columns { numbers: jacobians, width, first: 0 });
        })?;
        PyArray1::from_vec(py, flat).reshape([count, 3, columns])
    }

    /// Postures (n, joints) that bring the fingertip to centres (n, 3) in H, close to `near` (n, joints);
    /// NaN where out of reach.
    fn ik<'py>(
        &self,
        py: Python<'py>,
        finger: usize,
        centers: PyReadonlyArray2<'py, f64>,
        near: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let finger = self.finger(py, finger)?;
        let (count, columns) = near.as_array().dim();
        self.check(py, finger, columns)?;
        if centers.as_array().dim() != (count, 3) {
            let shape = format!("shape {:?}", centers.as_array().dim());
            return Err(errors::argument(py, "centers", &shape, &format!("({count}, 3)")));
        }
        let (centers, near) = (centers.as_slice()?, near.as_slice()?);
        let mut found = Vec::with_capacity(count * columns);
        in_parts(py, count, INVERSES, |rows| {
            for row in rows {
                let p_HF = Vec3::from_column_slice(&centers[3 * row..][..3]);
                let near = FingerJoints::from_slice(&near[row * columns..][..columns]);
                match self.hand.inverse(finger, &p_HF, &near) {
                    Some(joints) => found.extend_from_slice(&joints),
                    None => found.extend(std::iter::repeat_n(f64::NAN, columns)),
                }
            }
        })?;
        PyArray1::from_vec(py, found).reshape([count, columns])
    }
}
