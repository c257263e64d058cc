//! Where the mesh files are: `package://` paths against given roots and the URDF's own surroundings.

use std::path::{Component, Path, PathBuf};

/// How many folders above the URDF are looked at.
const ANCESTORS: usize = 6;

/// Where to look.
#[derive(Debug)]
pub struct Packages {
    /// The URDF's own folder.
    home: PathBuf,
    /// The given roots, then the folders above the URDF, nearest first.
    roots: Vec<PathBuf>,
}

impl Packages {
    /// The folders to look in for a robot's file: the given ones, then those above the file.
    pub fn new(urdf: &Path, given: &[PathBuf]) -> Self {
        let home = urdf.parent().unwrap_or(Path::new("")).to_owned();
        // A bare file name has no ancestors to go through: those of the whole path are meant.
        let whole = std::path::absolute(&home).unwrap_or_else(|_| home.clone());
        let above = whole.ancestors().take(ANCESTORS).map(Path::to_owned);
        Self { home, roots: given.iter().cloned().chain(above).collect() }
    }

    /// The file that a `filename` means; or the places that were looked at.
    ///
    /// `package://NAME/rest` is `NAME/rest` below a root, or `rest` in a root that is itself called NAME; where neither is there, the path's
    /// end (at least a folder and the file) below a root.
    pub fn resolve(&self, name: &str) -> Result<PathBuf, Vec<PathBuf>> {
        // Exporters on Windows write its separators.
        let name = &name.replace('\\', "/")[..];
        let package = name.strip_prefix("package://").or_else(|| name.strip_prefix("model://"));
        let Some(rest) = package else {
            let path = self.home.join(name.strip_prefix("file://").unwrap_or(name));
            return if path.is_file() { Ok(path) } else { Err(vec![path]) };
        };
        let parts: Option<Vec<&str>> = Path::new(rest).components().map(normal).collect();
        let Some(parts) = parts else { return Err(vec![PathBuf::from(rest)]) };
        let ends = (0..parts.len().saturating_sub(1).max(1))
            .map(|skipped| parts[skipped..].iter().collect::<PathBuf>());
        let mut tried = Vec::new();
        for end in ends {
            for root in &self.roots {
                let path = root.join(&end);
                if path.is_file() {
                    return Ok(path);
                }
                if tried.len() < self.roots.len() {
                    tried.push(path);
                }
            }
        }
        Err(tried)
    }
}

/// A named part of a path: never one that leads upward or to the root.
fn normal(part: Component<'_>) -> Option<&str> {
    match part {
        Component::Normal(name) => name.to_str(),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_are_found_below_roots_above_the_file_and_by_their_end() {
        let folder = tempfile::tempdir().unwrap();
        let at = |path: &str| folder.path().join(path);
        for path in ["ws/my_hand/urdf", "ws/my_hand/meshes", "else/other/meshes"] {
            std::fs::create_dir_all(at(path)).unwrap();
        }
        for path in ["ws/my_hand/meshes/a.stl", "else/other/meshes/b.stl", "ws/my_hand/urdf/c.stl"] {
            std::fs::write(at(path), "x").unwrap();
        }
        let packages = Packages::new(&at("ws/my_hand/urdf/hand.urdf"), &[at("else")]);
        let found = |name: &str| packages.resolve(name).map(|path| path.canonicalize().unwrap());
        assert_eq!(
            found("package://my_hand/meshes/a.stl"),
            Ok(at("ws/my_hand/meshes/a.stl").canonicalize().unwrap())
        );
        assert_eq!(
            found("package://other/meshes/b.stl"),
            Ok(at("else/other/meshes/b.stl").canonicalize().unwrap())
        );
        assert_eq!(
            found("package://renamed/meshes/a.stl"),
            Ok(at("ws/my_hand/meshes/a.stl").canonicalize().unwrap())
        );
        assert_eq!(found("c.stl"), Ok(at("ws/my_hand/urdf/c.stl").canonicalize().unwrap()));
        assert!(found("../meshes/a.stl").is_ok(), "relative paths start at the URDF");
        assert!(found("package://my_hand\\meshes\\a.stl").is_ok() && found("..\\meshes\\a.stl").is_ok());
        assert!(found(&format!("file://{}", at("ws/my_hand/meshes/a.stl").display())).is_ok());
        let tried = packages.resolve("package://my_hand/meshes/none.stl").unwrap_err();
        assert!(tried.contains(&at("else/my_hand/meshes/none.stl")));
        assert!(packages.resolve("package://x/../../../etc/passwd").is_err());
        assert!(packages.resolve("package://").is_err());
    }
}
