//! A package for a plugin of one's own.

use crate::errors;
use pyo3::prelude::*;
use regrasp::api::Role;
use regrasp::host::Choices;
use regrasp_template::python;

/// The files of a package with a small plugin of a role, by their paths in it.
#[pyfunction]
pub fn plugin_package(py: Python<'_>, role: &str, name: &str) -> PyResult<Vec<(String, String)>> {
    let found = Role::ALL.into_iter().find(|known| known.name() == role);
    let known = || Role::ALL.map(Role::name).join(", ");
    let role = found.ok_or_else(|| errors::argument(py, "role", role, &known()))?;
    let (_, _, slot) = python::module(role);
    let choices = Choices::default();
    let default = choices.choice(slot).id.rsplit('/').next().unwrap_or_default();
    Ok(python::files(role, name, default))
}
