//! A scenario with its plugins built, for calls by hand of many points and grasps at once.

use crate::errors;
use crate::pieces::triples;
use crate::roles::{Configuration, Stash, fits, with_stash};
use crate::run::Changes;
use crate::scenario::{Scenario, registry};
use crate::watch::{Watch, beside};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use regrasp::api::{
    CallError, Contact, Context, FingerSet, Interrupt, PoseRequest, Random, SurfacePath, Vec3, unless_fault,
};
use regrasp::run::{RunError, Workbench};
use std::sync::Arc;

/// A scenario with its plugins.
#[pyclass(frozen, module = "regrasp._regrasp")]
pub struct Bench {
    bench: Arc<Workbench>,
    stash: Arc<Stash>,
}

/// Contacts in columns: facets, points (3), normals (3).
#[derive(Default)]
struct Columns {
    facets: Vec<u32>,
    points: Vec<f64>,
    normals: Vec<f64>,
}

impl Columns {
    fn push(&mut self, contact: &Contact) {
        self.facets.push(contact.facet);
        self.points.extend(contact.p_OC.iter());
        self.normals.extend(contact.n_O.iter());
    }

    fn arrays<'py>(self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (arrays, count) = (PyDict::new(py), self.facets.len());
        arrays.set_item("facets", PyArray1::from_vec(py, self.facets))?;
        arrays.set_item("points", PyArray1::from_vec(py, self.points).reshape([count, 3])?)?;
        arrays.set_item("normals", PyArray1::from_vec(py, self.normals).reshape([count, 3])?)?;
        Ok(arrays)
    }
}

impl Bench {
    /// Runs `job` without the GIL, on a thread of its own; faults of plugins in Python are their exceptions.
    fn run<T: Send + 'static>(
        &self,
        py: Python<'_>,
        job: impl FnOnce(&Workbench, &Watch) -> Result<T, CallError> + Send + 'static,
    ) -> PyResult<T> {
        let watch = Watch::start(None);
        let (bench, theirs) = (Arc::clone(&self.bench), Arc::clone(&watch));
        let done = beside(py, &watch, None, move || unless_fault(job(&bench, &theirs)))?;
        done.map_err(|error| errors::run(py, &RunError::Call(error), &self.stash))
    }
}

#[pymethods]
impl Bench {
    /// Builds the plugins of a scenario.
    #[new]
    fn new(py: Python<'_>, scenario: &Scenario, changes: Changes) -> PyResult<Self> {
        let scenario = changes.apply(&scenario.0).map_err(|error| errors::host(py, &error))?;
        let watch = Watch::start(None);
        let stash = Stash::new(&watch);
        let plugins = Arc::clone(&stash);
        let job = move || with_stash(&plugins, || Workbench::new(scenario, &registry()?));
        let bench = beside(py, &watch, None, job)?.map_err(|error| errors::run(py, &error, &stash))?;
        Ok(Self { bench: Arc::new(bench), stash })
    }

    /// `count` random contacts, uniform over what a fingertip can touch.
    fn sample_contacts<'py>(&self, py: Python<'py>, count: usize, seed: u64) -> PyResult<Bound<'py, PyDict>> {
        let columns = self.run(py, move |bench, watch| {
            let (surface, mut random) = (bench.task().surface, Random::from_key(seed, 0, 0, 0));
            let mut columns = Columns::default();
            for _ in 0..count {
                proceed(watch)?;
                columns.push(&surface.sample(&mut random));
            }
            Ok(columns)
        })?;
        columns.arrays(py)
    }

    /// The contacts closest to fingertip centres (n, 3) in O, with signed distances (n,).
    fn closest_points<'py>(
        &self,
        py: Python<'py>,
        centers: PyReadonlyArray2<'py, f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let centers = triples(py, "centers", &centers)?.to_vec();
        let (columns, distances) = self.run(py, move |bench, watch| {
            let surface = bench.task().surface;
            let (mut columns, mut distances) = (Columns::default(), Vec::new());
            for center in centers.chunks_exact(3) {
                proceed(watch)?;
                let found = surface.project(&Vec3::from_column_slice(center), None);
                columns.push(&found.contact);
                distances.push(found.distance);
            }
            Ok((columns, distances))
        })?;
        let arrays = columns.arrays(py)?;
        arrays.set_item("distances", PyArray1::from_vec(py, distances))?;
        Ok(arrays)
    }

    /// Lengths (n,) of the shortest paths between contacts; infinite where there is none.
    fn geodesics<'py>(
        &self,
        py: Python<'py>,
        starts: [PyReadonlyArray2<'py, f64>; 2],
        ends: [PyReadonlyArray2<'py, f64>; 2],
        facets: [PyReadonlyArray1<'py, u32>; 2],
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let starts = contacts(py, &starts, &facets[0])?;
        let ends = contacts(py, &ends, &facets[1])?;
        if starts.len() != ends.len() {
            let (given, wanted) = (ends.len().to_string(), starts.len().to_string());
            return Err(errors::argument(py, "ends", &given, &format!("as many as starts, {wanted}")));
        }
        let lengths = self.run(py, move |bench, watch| {
            let (surface, mut context) =
                (bench.task().surface, Context::new(Random::from_key(0, 0, 0, 0), watch));
            let mut path = SurfacePath::default();
            let mut length = |(start, end): (&Contact, &Contact)| {
                context.proceed()?;
                let found = surface.geodesic(start, end, &mut path, &mut context)?;
                Ok(if found { path.length } else { f64::INFINITY })
            };
            starts.iter().zip(&ends).map(&mut length).collect::<Result<Vec<f64>, CallError>>()
        })?;
        Ok(PyArray1::from_vec(py, lengths))
    }

    /// `count` admissible configurations in which the fingers of `holding` hold the object, by the
    /// scenario's sampler, each with a random
    /// stream of its own; fewer where `tries` samples do not give as many.
    fn sample_grasps(
        &self,
        py: Python<'_>,
        count: usize,
        seed: u64,
        holding: Option<Vec<u8>>,
        tries: usize,
    ) -> PyResult<Vec<Configuration>> {
        let found = self.run(py, move |bench, watch| {
            let task = bench.task();
            let every = FingerSet::first(task.hand.finger_count());
            let asked =
                holding.map(|fingers| fingers.iter().map(|&f| regrasp::api::FingerIndex(f)).collect());
            let holding = asked.map_or(every, |asked: FingerSet| asked.intersection(every));
            let mut found = Vec::new();
            for attempt in 0..tries as u64 {
                if found.len() == count {
                    break;
                }
                let mut context = Context::new(Random::from_key(seed, 1, attempt, 0), watch);
                context.proceed()?;
                found.extend(bench.sampler().sample(&task, PoseRequest::Anywhere, holding, &mut context)?);
            }
            Ok(found)
        })?;
        Ok(found.into_iter().map(Configuration).collect())
    }

    /// Bounds of the margins (n, 2) that the scenario's stability test gives the grasps of configurations,
    /// about the object's centre of mass.
    fn margins<'py>(
        &self,
        py: Python<'py>,
        configurations: Vec<Configuration>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let count = configurations.len();
        let hand = self.bench.task().hand;
        if let Some(odd) = configurations.iter().position(|q| !fits(hand, &q.0)) {
            let range = "configurations of this hand that hold the object";
            return Err(errors::argument(
                py,
                &format!("configurations[{odd}]"),
                "one of another hand",
                range,
            ));
        }
        let flat = self.run(py, move |bench, watch| {
            let mut flat = Vec::with_capacity(2 * count);
            for Configuration(q) in &configurations {
                proceed(watch)?;
                let assessed = bench.assess(q)?;
                flat.extend([assessed.margin_lower, assessed.margin_upper]);
            }
            Ok(flat)
        })?;
        PyArray1::from_vec(py, flat).reshape([count, 2])
    }
}

fn proceed(watch: &Watch) -> Result<(), CallError> {
    if watch.interrupted() { Err(CallError::Interrupted) } else { Ok(()) }
}

fn contacts(
    py: Python<'_>,
    [points, normals]: &[PyReadonlyArray2<'_, f64>; 2],
    facets: &PyReadonlyArray1<'_, u32>,
) -> PyResult<Vec<Contact>> {
    let (points, normals) = (triples(py, "points", points)?, triples(py, "normals", normals)?);
    let facets = facets.as_slice()?;
    if points.len() != normals.len() || facets.len() * 3 != points.len() {
        let shape = format!("{}, {}, {}", points.len() / 3, normals.len() / 3, facets.len());
        return Err(errors::argument(py, "points, normals, facets", &shape, "equally many"));
    }
    let vector = |values: &[f64], i: usize| Vec3::from_column_slice(&values[3 * i..][..3]);
    let contact =
        |(i, &facet): (usize, &u32)| Contact { facet, p_OC: vector(points, i), n_O: vector(normals, i) };
    Ok(facets.iter().enumerate().map(contact).collect())
}
