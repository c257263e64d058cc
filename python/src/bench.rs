//! A scenario with its plugins built, for calls by hand of many points and grasps at once.

use crate::errors;
use crate::holding::{Asker, Columns as Holding};
use crate::pieces::triples;
use crate::roles::{Configuration, Stash, fits, to_pose, with_stash};
use crate::run::Changes;
use crate::scenario::{Scenario, registry};
use crate::watch::{Watch, beside};
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use regrasp::api::{
    self, CallError, Contact, Context, FingerIndex, FingerSet, Interrupt, Path, PoseRequest, Random,
    SurfacePath, Vec3, unless_fault,
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

impl Bench {
    /// Refuses configurations of another hand.
    fn check<'a>(
        &self,
        py: Python<'_>,
        key: &str,
        mut configurations: impl Iterator<Item = &'a Configuration>,
    ) -> PyResult<()> {
        let hand = self.bench.task().hand;
        match configurations.position(|q| !fits(hand, &q.0)) {
            Some(odd) => {
                let (key, range) =
                    (format!("{key}[{odd}]"), "configurations of this hand that hold the object");
                Err(errors::argument(py, &key, "one of another hand", range))
            }
            None => Ok(()),
        }
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
        self.check(py, "configurations", configurations.iter())?;
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

    /// What holds the object at rest in configurations, by forces that need at most `share` of the
    /// friction: `forces` (n, fingers, 3) in O, `efforts` (n, joints), and (n,) `friction_share`,
    /// `effort_share`, `mass`.
    fn holds<'py>(
        &self,
        py: Python<'py>,
        configurations: Vec<Configuration>,
        share: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        let count = configurations.len();
        self.check(py, "configurations", configurations.iter())?;
        let hand = self.bench.task().hand;
        let fingers = hand.finger_count();
        let joints: usize = (0..fingers as u8).map(|f| hand.finger(FingerIndex(f)).joints.len()).sum();
        let found = self.run(py, move |bench, watch| {
            let (mut asker, mut columns) = (Asker::new(bench.task()), Holding::default());
            for Configuration(q) in &configurations {
                proceed(watch)?;
                asker.add(q, share, &mut columns)?;
            }
            Ok(columns)
        })?;
        let arrays = PyDict::new(py);
        arrays.set_item("forces", PyArray1::from_vec(py, found.forces).reshape([count, fingers, 3])?)?;
        arrays.set_item("efforts", PyArray1::from_vec(py, found.efforts).reshape([count, joints])?)?;
        arrays.set_item("friction_share", PyArray1::from_vec(py, found.friction))?;
        arrays.set_item("effort_share", PyArray1::from_vec(py, found.effort))?;
        arrays.set_item("mass", PyArray1::from_vec(py, found.mass))?;
        Ok(arrays)
    }

    /// The ways of the scenario's local planners, each with a random stream of its own.
    fn connect(
        &self,
        py: Python<'_>,
        starts: Vec<Configuration>,
        ends: Vec<End>,
        seed: u64,
    ) -> PyResult<Vec<Way>> {
        self.check(py, "starts", starts.iter())?;
        self.check(py, "ends", ends.iter().filter_map(End::configuration))?;
        let fingers = self.bench.task().hand.finger_count();
        for end in &ends {
            match end {
                End::Regrasp(_, finger) if usize::from(*finger) >= fingers => {
                    let range = format!("0..={}", fingers - 1);
                    return Err(errors::argument(py, "finger", &finger.to_string(), &range));
                }
                End::Transfer(pose) => {
                    to_pose(*pose)?;
                }
                _ => {}
            }
        }
        self.run(py, move |bench, watch| {
            let mut ways = Vec::with_capacity(starts.len());
            for (number, (from, to)) in starts.iter().zip(&ends).enumerate() {
                let mut context = Context::new(Random::from_key(seed, 2, number as u64, 0), watch);
                context.proceed()?;
                ways.push(to.connect(bench, from, &mut context)?);
            }
            Ok(ways)
        })
    }
}

/// Where a local planner is to go: the object to a pose, all fingers to another grasp, or one finger to
/// where it is there.
#[derive(FromPyObject)]
pub enum End {
    /// The finger moves alone.
    Regrasp(Configuration, u8),
    /// The contacts slide.
    #[pyo3(transparent)]
    Grasp(Configuration),
    /// The object moves, X_HO.
    #[pyo3(transparent)]
    Transfer([[f64; 4]; 4]),
}

impl End {
    /// The configuration, where there is one.
    fn configuration(&self) -> Option<&Configuration> {
        match self {
            Self::Regrasp(q, _) | Self::Grasp(q) => Some(q),
            Self::Transfer(_) => None,
        }
    }

    /// The way of this slot's local planner from `from`.
    fn connect(
        &self,
        bench: &Workbench,
        from: &Configuration,
        context: &mut Context<'_>,
    ) -> Result<Way, CallError> {
        let (task, plugins, mut path) = (bench.task(), bench.plugins(), Path::default());
        let way = match self {
            Self::Regrasp(q, finger) => {
                let finger = FingerIndex(*finger);
                let contact = q.0.contacts[finger].as_ref();
                let to = api::Target::Regrasp { finger, contact, joints: &q.0.joints[finger] };
                plugins.regrasp.connect(&task, &from.0, &to, Some(&mut path), context)
            }
            Self::Grasp(q) => {
                plugins.grasp.connect(&task, &from.0, &api::Target::Grasp(&q.0), Some(&mut path), context)
            }
            Self::Transfer(pose) => {
                // It was checked.
                let X_HO = to_pose(*pose).unwrap_or(from.0.X_HO);
                let to = api::Target::Transfer(&X_HO);
                plugins.transfer.connect(&task, &from.0, &to, Some(&mut path), context)
            }
        }?;
        let states = path.states.into_iter().map(Configuration).collect();
        Ok((states, way.fraction, way.stop.map(api::Reason::name)))
    }
}

/// States, the fraction made, and why it is not all.
type Way = (Vec<Configuration>, f64, Option<&'static str>);

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
