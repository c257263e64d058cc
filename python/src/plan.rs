//! Plans.

use crate::table::{spans, table};
use crate::watch::{Watch, beside};
use crate::{errors, table::Table};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use regrasp::export::{ExportError, Format, Scene};
use regrasp::plan::{self, SegmentName};
use regrasp::verify::StateFigures;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Names and contents of files.
type Exported = Vec<(String, Py<PyBytes>)>;

/// Margins and smallest distances.
type Series<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>);

/// A plan as its file holds it.
#[pyclass(frozen, module = "regrasp._regrasp")]
pub struct Plan(Arc<plan::Plan>);

impl Plan {
    /// A plan for Python.
    pub fn new(plan: plan::Plan) -> Self {
        Self(Arc::new(plan))
    }
}

#[pymethods]
impl Plan {
    /// Reads a plan file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let plan = py.detach(|| plan::read(&path));
        plan.map(Self::new).map_err(|error| errors::plan_file(py, &error))
    }

    /// A plan from the text of its file; `name` is what messages call it.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        let plan = py.detach(|| plan::from_json(text.as_bytes(), Path::new(name)));
        plan.map(Self::new).map_err(|error| errors::plan_file(py, &error))
    }

    /// Writes the plan file.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| plan::write(&path, &self.0)).map_err(|error| errors::plan_file(py, &error))
    }

    /// The text of the plan file.
    fn text(&self, py: Python<'_>) -> PyResult<String> {
        let mut text = Vec::new();
        py.detach(|| plan::write_json(&*self.0, &mut text))?;
        String::from_utf8(text).map_err(|error| errors::plan_file(py, &error))
    }

    /// Everything but the segments, as JSON.
    fn head(&self) -> String {
        let plan = &self.0;
        json!({
            "version": plan.version,
            "seed": plan.seed,
            "versions": plan.versions,
            "claims": plan.claims,
            "scenario": plan.scenario,
            "goals_reached": plan.goals_reached,
            "stopped_by": plan.stopped_by,
            "statistics": plan.statistics,
            "certificate": plan.certificate,
        })
        .to_string()
    }

    /// For each segment its kind, the finger that moves, and the numbers of its first and last state.
    fn segments(&self) -> Vec<(&'static str, Option<u8>, usize, usize)> {
        let kind = |name| match name {
            SegmentName::Transfer => "transfer",
            SegmentName::Regrasp => "regrasp",
        };
        let segments = self.0.segments.iter().zip(spans(&self.0));
        segments.map(|(segment, (first, last))| (kind(segment.kind), segment.finger, first, last)).collect()
    }

    /// The states as arrays: `time` (S), `pose` (S, 7), `joints` (S, J), `contact` (S, F, 3, 3).
    fn arrays<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let table = py.detach(|| table(&self.0)).map_err(|error| errors::plan_file(py, &error))?;
        let Table { states, fingers, joints, time, pose, q, contact, velocity, force, effort } = table;
        let arrays = PyDict::new(py);
        arrays.set_item("time", PyArray1::from_vec(py, time))?;
        arrays.set_item("pose", PyArray1::from_vec(py, pose).reshape([states, 7])?)?;
        arrays.set_item("joints", PyArray1::from_vec(py, q).reshape([states, joints])?)?;
        arrays.set_item("contact", PyArray1::from_vec(py, contact).reshape([states, fingers, 3, 3])?)?;
        let by_joint = [("velocity", velocity), ("effort", effort)];
        for (name, column) in by_joint.into_iter().filter(|(_, column)| !column.is_empty()) {
            arrays.set_item(name, PyArray1::from_vec(py, column).reshape([states, joints])?)?;
        }
        if !force.is_empty() {
            arrays.set_item("force", PyArray1::from_vec(py, force).reshape([states, fingers, 3])?)?;
        }
        Ok(arrays)
    }

    /// Files for other programs, by name, and what a user should know of them.
    fn export(&self, py: Python<'_>, format: &str, stem: &str) -> PyResult<(Exported, Vec<String>)> {
        let found = Format::ALL.into_iter().find(|known| known.name() == format);
        let known = Format::ALL.map(Format::name).join(", ");
        let format = found.ok_or_else(|| errors::argument(py, "format", format, &known))?;
        let made = py.detach(|| {
            let scene = Scene::new(&self.0)?;
            Ok((scene.export(format, stem)?, scene.notes()))
        });
        let (files, notes) = made.map_err(|error: ExportError| errors::plan_file(py, &error))?;
        let file = |file: regrasp::export::File| (file.name, PyBytes::new(py, &file.bytes).unbind());
        Ok((files.into_iter().map(file).collect(), notes))
    }

    /// The verifier's verdict, as JSON.
    fn verify(&self, py: Python<'_>) -> PyResult<String> {
        let plan = Arc::clone(&self.0);
        let verdict = beside(py, &Watch::start(None), None, move || regrasp::verify::verify(&plan))?;
        Ok(json!(verdict).to_string())
    }

    /// For every state, segment after segment, the verifier's margin and the smallest distance (m); NaN where
    /// there is none.
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Series<'py>> {
        let plan = Arc::clone(&self.0);
        let series = beside(py, &Watch::start(None), None, move || regrasp::verify::series(&plan))?;
        let states = series.map_err(|error| errors::plan_file(py, &error))?.concat();
        let margins = states.iter().map(|state| state.margin.unwrap_or(f64::NAN)).collect();
        let distance = |state: &StateFigures| state.clearance.map_or(f64::NAN, |(distance, _)| distance);
        let distances = states.iter().map(distance).collect();
        Ok((PyArray1::from_vec(py, margins), PyArray1::from_vec(py, distances)))
    }

    /// The page that plays the plan, as HTML.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        let plan = Arc::clone(&self.0);
        let page = beside(py, &Watch::start(None), None, move || {
            regrasp::view::page(&plan, &regrasp::page::of_plan(&plan)).map_err(|error| error.to_string())
        })?;
        page.map_err(|reason| errors::plan_file(py, &reason))
    }
}
