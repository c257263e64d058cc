//! `regrasp new-plugin --python`

use super::{default_name, write_all};
use crate::{Failure, say};
use regrasp::api::Role;
use regrasp_template::python;
use std::path::Path;

/// Writes a Python package with the plugin `ROLE/name`, and says what can be done with it.
pub fn write(role: Role, name: &str, folder: &Path) -> Result<(), Failure> {
    let (_, _, slot) = python::module(role);
    write_all(folder, python::files(role, name, &default_name(slot)))?;
    let module = python::module_name(role, name);
    let (folder, id, slot) = (folder.display(), format!("{}/{name}", role.name()), slot.name());
    say(&format!(
        "\
`{folder}` has the plugin `{id}` in Python; it works as it is, with Python's package `regrasp`:
    cd {folder}
    python -m pytest            # the laws of its role, and a plan
    python -m regrasp plan sphere --load {module}.py --use {slot}={name}
The plugin is in `{module}.py`: make it yours, and do the same again.
"
    ))
}
