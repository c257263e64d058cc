//! Where classes are registered, and the entries that stand for them.

use super::contact_model::ContactModel;
use super::convert::rows;
use super::graph_strategy::GraphStrategy;
use super::local_planner::LocalPlanner;
use super::plugin::Plugin;
use super::sampler::Sampler;
use super::stability_test::StabilityTest;
use super::stash::Stash;
use super::surface::Surface;
use pyo3::exceptions::{PyOverflowError, PyValueError};
use pyo3::prelude::*;
use regrasp::api::{self, Build, BuildError, Built, Entry, Parts, SettingsError, Slot};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// How many ids can be registered: each has functions of its own.
const PLACES: usize = 32;

struct Registered {
    entry: &'static Entry,
    class: Py<PyAny>,
    schema: String,
}

static POOL: Mutex<Vec<Registered>> = Mutex::new(Vec::new());

fn pool() -> MutexGuard<'static, Vec<Registered>> {
    POOL.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The entries of all registered classes.
pub fn entries() -> Vec<&'static Entry> {
    pool().iter().map(|registered| registered.entry).collect()
}

/// Ids of all registered classes.
#[pyfunction]
pub fn registered() -> Vec<&'static str> {
    entries().iter().map(|entry| entry.id).collect()
}

/// The JSON schema of a registered class's settings.
#[pyfunction]
pub fn role_schema(id: &str) -> Option<String> {
    pool().iter().find(|registered| registered.entry.id == id).map(|registered| registered.schema.clone())
}

/// Registers a class under an id; a class that had the id before gives way.
#[pyfunction]
pub fn register(
    id: &str,
    slots: Vec<String>,
    summary: &str,
    references: Vec<String>,
    schema: String,
    class: Py<PyAny>,
) -> PyResult<()> {
    let slot = |name: &String| Slot::ALL.into_iter().find(|slot| slot.name() == name);
    let slots: Vec<Slot> = slots.iter().filter_map(slot).collect();
    let first = slots.first().ok_or_else(|| PyValueError::new_err("a plugin fills at least one slot"))?;
    let mut pool = pool();
    let known = pool.iter().position(|registered| registered.entry.id == id);
    let place = known.unwrap_or(pool.len());
    let full = || PyOverflowError::new_err(format!("{PLACES} plugins are registered; that is the most"));
    let (check, schema_of) = (CHECKS.get(place), SCHEMAS.get(place));
    let (check, schema_of) = (check.ok_or_else(full)?, schema_of.ok_or_else(full)?);
    let build = match first.role() {
        api::Role::ContactModel => Build::ContactModel(CONTACT_MODELS[place]),
        api::Role::StabilityTest => Build::StabilityTest(STABILITY_TESTS[place]),
        api::Role::Surface => Build::Surface(SURFACES[place]),
        api::Role::Sampler => Build::Sampler(SAMPLERS[place]),
        api::Role::LocalPlanner => Build::LocalPlanner(LOCAL_PLANNERS[place]),
        api::Role::GraphStrategy => Build::GraphStrategy(GRAPH_STRATEGIES[place]),
    };
    // An entry lives as long as the program; few are ever made.
    let leak = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
    let references: Vec<&'static str> = references.iter().map(|reference| leak(reference)).collect();
    let entry: &'static Entry = Box::leak(Box::new(Entry {
        id: leak(id),
        slots: slots.leak(),
        summary: leak(summary),
        references: references.leak(),
        schema: *schema_of,
        check: *check,
        build,
    }));
    let registered = Registered { entry, class, schema };
    match known {
        Some(place) => pool[place] = registered,
        None => pool.push(registered),
    }
    Ok(())
}

fn schema<const N: usize>() -> String {
    schema_at(N)
}

fn schema_at(place: usize) -> String {
    pool().get(place).map(|registered| registered.schema.clone()).unwrap_or_default()
}

fn class(py: Python<'_>, place: usize) -> Option<(&'static str, Py<PyAny>)> {
    pool().get(place).map(|registered| (registered.entry.id, registered.class.clone_ref(py)))
}

fn check<const N: usize>(json: &str) -> Result<(), SettingsError> {
    check_at(N, json)
}

fn check_at(place: usize, json: &str) -> Result<(), SettingsError> {
    let form = |error: serde_json::Error| SettingsError::Form(error.to_string());
    let value = serde_json::from_str(if json.trim().is_empty() { "{}" } else { json }).map_err(form)?;
    let known = serde_json::from_str(&schema_at(place)).unwrap_or_default();
    api::check_schema(&value, &known)?;
    Python::attach(|py| {
        let Some((_, class)) = class(py, place) else { return Ok(()) };
        let module = py.import("regrasp._roles").map_err(|error| SettingsError::Form(error.to_string()))?;
        let checked = module.call_method1("check_settings", (class, json));
        checked.map(drop).map_err(|error| SettingsError::Form(error.value(py).to_string()))
    })
}

fn build(place: usize, json: &str, parts: &Parts<'_>) -> Result<Plugin, BuildError> {
    let stash = Stash::current();
    check_at(place, json)?;
    Python::attach(|py| {
        let (id, class) =
            class(py, place).ok_or_else(|| BuildError::Unsupported("it is no longer registered".into()))?;
        let object = instance(py, &class, json, parts);
        let object = object.map_err(|error| BuildError::Unsupported(stash.keep(py, error)))?;
        Ok(Plugin { id, object: object.unbind(), stash })
    })
}

fn instance<'py>(
    py: Python<'py>,
    class: &Py<PyAny>,
    json: &str,
    parts: &Parts<'_>,
) -> PyResult<Bound<'py, PyAny>> {
    let (object, hand) = (parts.object, parts.hand);
    let facets: Vec<[u32; 3]> = object.mesh.facets().to_vec();
    let arguments = (
        class,
        json,
        rows(py, object.mesh.vertices())?,
        facets,
        (object.mass, object.friction, rows(py, &[object.p_OCm])?),
        (hand.finger_count(), hand.fingertip_radius()),
    );
    py.import("regrasp._roles")?.call_method1("build", arguments)
}

macro_rules! builders {
    ($($name:ident, $table:ident: $role:ident($wrap:ident));+ $(;)?) => {$(
        fn $name<const N: usize>(json: &str, parts: &Parts<'_>) -> Built<dyn api::$role> {
            Ok(Box::new($wrap(build(N, json, parts)?)))
        }
        static $table: [fn(&str, &Parts<'_>) -> Built<dyn api::$role>; PLACES] = each!($name);
    )+};
}

/// An array of the function for each place.
macro_rules! each {
    ($f:ident) => {
        each!($f; 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31)
    };
    ($f:ident; $($n:literal)+) => { [$($f::<$n>),+] };
}

static CHECKS: [fn(&str) -> Result<(), SettingsError>; PLACES] = each!(check);
static SCHEMAS: [fn() -> String; PLACES] = each!(schema);

builders! {
    contact_model, CONTACT_MODELS: ContactModel(ContactModel);
    stability_test, STABILITY_TESTS: StabilityTest(StabilityTest);
    surface, SURFACES: SurfaceParam(Surface);
    sampler, SAMPLERS: ClosedChainSampler(Sampler);
    local_planner, LOCAL_PLANNERS: LocalPlanner(LocalPlanner);
    graph_strategy, GRAPH_STRATEGIES: GraphStrategy(GraphStrategy);
}
