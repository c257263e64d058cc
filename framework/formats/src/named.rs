//! Which files a robot's file names: what must not be written over while it is in use.

use crate::decode::read_xml;
use crate::packages::Packages;
use crate::xml;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// More files than this are not looked into.
const MOST_FILES: usize = 100;

/// The files that a URDF, a xacro or an MJCF names and that are there: meshes, textures, included files and
/// what these name. A file that cannot be read names none.
pub fn named_files(robot: &Path, packages: &[PathBuf]) -> Vec<PathBuf> {
    let places = Packages::new(robot, packages);
    let (mut found, mut open) = (BTreeSet::new(), vec![robot.to_owned()]);
    let mut read = 0;
    while let Some(path) = open.pop().filter(|_| read < MOST_FILES) {
        read += 1;
        for name in names(&path).unwrap_or_default() {
            let Ok(file) = places.resolve(&name) else { continue };
            let is_text = ["xml", "urdf", "xacro", "mjcf"]
                .iter()
                .any(|ending| file.extension().is_some_and(|e| e.eq_ignore_ascii_case(ending)));
            if found.insert(file.clone()) && is_text {
                open.push(file);
            }
        }
    }
    found.into_iter().collect()
}

/// The names in one file, as they are and within the folders that an MJCF's compiler gives.
fn names(path: &Path) -> Option<Vec<String>> {
    let text = read_xml(path).ok()?;
    let document = xml::parse(&text).ok()?;
    let elements = || document.descendants().filter(|node| node.is_element());
    let folders: Vec<&str> = elements()
        .flat_map(|element| ["meshdir", "assetdir", "texturedir"].map(|name| element.attribute(name)))
        .flatten()
        .collect();
    let mut names = Vec::new();
    for name in elements().flat_map(|e| ["filename", "file"].map(|name| e.attribute(name))).flatten() {
        names.push(name.to_owned());
        names.extend(folders.iter().map(|folder| format!("{}/{name}", folder.trim_end_matches('/'))));
    }
    Some(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn meshes_and_included_files_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::create_dir(at("meshes")).unwrap();
        for name in ["meshes/a.stl", "b.stl", "c.obj"] {
            std::fs::write(at(name), "x").unwrap();
        }
        let inner = "<mujocoinclude><asset><mesh file=\"a.stl\"/></asset></mujocoinclude>";
        std::fs::write(at("inner.xml"), inner).unwrap();
        let outer = "<mujoco><compiler meshdir=\"meshes\"/><include file=\"inner.xml\"/>\
                     <asset><mesh file=\"a.stl\"/></asset></mujoco>";
        std::fs::write(at("outer.xml"), outer).unwrap();
        assert_eq!(named_files(&at("outer.xml"), &[]), [at("inner.xml"), at("meshes/a.stl")]);
        let urdf = "<robot><link><visual><geometry><mesh \
            filename=\"package://meshes/a.stl\"/></geometry></visual>\
                    </link><mesh filename=\"c.obj\"/><mesh filename=\"none.stl\"/></robot>";
        std::fs::write(at("hand.urdf"), urdf).unwrap();
        assert_eq!(named_files(&at("hand.urdf"), &[]), [at("c.obj"), at("meshes/a.stl")]);
        assert!(named_files(&at("c.obj"), &[]).is_empty());
    }
}
