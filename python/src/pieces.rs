//! Grasps by themselves: force closure, margins and internal forces of many grasps at once.

use crate::errors;
use crate::watch::in_parts;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use regrasp::api::{
    CallError, Cone, Context, FingerIndex, Grasp, GraspContact, Hint, MAX_FINGERS, StabilityTest, Vec3,
};
use regrasp::plugins::stability_tests::{ForceClosure, ForceClosureSettings};

/// Margins take a millisecond each: so many of them between two looks for signals.
const MARGINS: usize = 16;
/// Verdicts and their proofs take microseconds.
const PROOFS: usize = 8192;

/// Many grasps of equally many contacts, in arrays without gaps.
struct Grasps<'a> {
    points: &'a [f64],
    normals: &'a [f64],
    /// Friction and torsional radius of each contact.
    cones: &'a [f64],
    /// Contacts of one grasp.
    size: usize,
    count: usize,
}

impl Grasps<'_> {
    fn grasp(&self, index: usize) -> Grasp<'static> {
        let mut grasp = Grasp::new(Vec3::zeros());
        for finger in 0..self.size {
            let contact = index * self.size + finger;
            let [mu, gamma] = [self.cones[2 * contact], self.cones[2 * contact + 1]];
            grasp.push(GraspContact {
                finger: FingerIndex(finger as u8),
                p_OC: Vec3::from_column_slice(&self.points[3 * contact..][..3]),
                n_O: Vec3::from_column_slice(&self.normals[3 * contact..][..3]),
                cone: Cone::Elliptic { mu, gamma },
            });
        }
        grasp
    }

    /// Calls `each` with the number of every grasp in turn; with `part` of them between two looks for
    /// signals.
    fn each(
        &self,
        py: Python<'_>,
        part: usize,
        mut each: impl FnMut(usize, &ForceClosure, &Grasp<'_>, &mut Context<'_>) -> Result<(), CallError> + Send,
    ) -> PyResult<()> {
        let fault = |error: &dyn std::fmt::Display| PyRuntimeError::new_err(error.to_string());
        let test = ForceClosure::new(ForceClosureSettings::default()).map_err(|error| fault(&error))?;
        let mut done = Ok(());
        in_parts(py, self.count, part, |mut rows| {
            let mut context = Context::seeded(0);
            let answers = rows.try_for_each(|index| each(index, &test, &self.grasp(index), &mut context));
            done = std::mem::replace(&mut done, Ok(())).and(answers);
        })?;
        done.map_err(|error| fault(&error))
    }
}

fn grasps<'a>(
    py: Python<'_>,
    points: &'a PyReadonlyArray3<'_, f64>,
    normals: &'a PyReadonlyArray3<'_, f64>,
    cones: &'a PyReadonlyArray3<'_, f64>,
) -> PyResult<Grasps<'a>> {
    let (count, size, _) = points.as_array().dim();
    let shapes = [points.as_array().dim(), normals.as_array().dim(), cones.as_array().dim()];
    if shapes != [(count, size, 3), (count, size, 3), (count, size, 2)] {
        let range = format!("({count}, {size}, 3), ({count}, {size}, 3), ({count}, {size}, 2)");
        return Err(errors::argument(py, "points, normals, cones", &format!("{shapes:?}"), &range));
    }
    if !(1..=MAX_FINGERS).contains(&size) {
        return Err(errors::argument(py, "contacts", &size.to_string(), &format!("1..={MAX_FINGERS}")));
    }
    Ok(Grasps {
        points: points.as_slice()?,
        normals: normals.as_slice()?,
        cones: cones.as_slice()?,
        size,
        count,
    })
}

/// Whether each grasp is force closure (n,): points and outward unit normals (n, k, 3), cones (n, k, 2).
#[pyfunction]
pub fn force_closure<'py>(
    py: Python<'py>,
    points: PyReadonlyArray3<'py, f64>,
    normals: PyReadonlyArray3<'py, f64>,
    cones: PyReadonlyArray3<'py, f64>,
) -> PyResult<Bound<'py, PyArray1<bool>>> {
    let grasps = grasps(py, &points, &normals, &cones)?;
    let mut verdicts = Vec::with_capacity(grasps.count);
    grasps.each(py, PROOFS, |_, test, grasp, context| {
        verdicts.push(test.test(grasp, &mut Hint::default(), context)?.is_stable());
        Ok(())
    })?;
    Ok(PyArray1::from_vec(py, verdicts))
}

/// Bounds (n, 2) of the margin of each grasp; torques about `centers` (n, 3) and divided by `length`, by the
/// grasp's own where NaN.
#[pyfunction]
pub fn closure_margins<'py>(
    py: Python<'py>,
    points: PyReadonlyArray3<'py, f64>,
    normals: PyReadonlyArray3<'py, f64>,
    cones: PyReadonlyArray3<'py, f64>,
    center: Option<[f64; 3]>,
    length: Option<f64>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let grasps = grasps(py, &points, &normals, &cones)?;
    let mut margins = Vec::with_capacity(2 * grasps.count);
    grasps.each(py, MARGINS, |_, test, grasp, context| {
        let assessed = test.assess(grasp, length, center.map(Vec3::from), context)?;
        margins.extend([assessed.margin_lower, assessed.margin_upper]);
        Ok(())
    })?;
    PyArray1::from_vec(py, margins).reshape([grasps.count, 2])
}

/// A force for each contact (n, k, 3), in O on the object, balanced and strictly inside the cones; NaN where
/// there is none.
#[pyfunction]
pub fn internal_forces<'py>(
    py: Python<'py>,
    points: PyReadonlyArray3<'py, f64>,
    normals: PyReadonlyArray3<'py, f64>,
    cones: PyReadonlyArray3<'py, f64>,
) -> PyResult<Bound<'py, PyArray3<f64>>> {
    let grasps = grasps(py, &points, &normals, &cones)?;
    let mut flat = vec![f64::NAN; 3 * grasps.size * grasps.count];
    let mut forces = Vec::with_capacity(grasps.size);
    grasps.each(py, PROOFS, |index, test, grasp, _| {
        if test.internal_forces(grasp, &mut forces)? {
            let own = flat[3 * grasps.size * index..].iter_mut();
            own.zip(forces.iter().flatten()).for_each(|(number, part)| *number = *part);
        }
        Ok(())
    })?;
    PyArray1::from_vec(py, flat).reshape([grasps.count, grasps.size, 3])
}

/// Refuses arrays that are not (n, 3), and gives their numbers.
pub fn triples<'a>(py: Python<'_>, key: &str, array: &'a PyReadonlyArray2<'_, f64>) -> PyResult<&'a [f64]> {
    if array.as_array().dim().1 == 3 {
        return Ok(array.as_slice()?);
    }
    let shape = format!("shape {:?}", array.as_array().dim());
    Err(errors::argument(py, key, &shape, "(any, 3)"))
}
