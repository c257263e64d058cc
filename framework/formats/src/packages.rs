//! Where the mesh files are: what a `filename` means, against given folders and the robot's own surroundings.

use std::fs;
use std::path::{Component, Path, PathBuf};

/// How many folders above the robot's file are looked at.
const ANCESTORS: usize = 6;

/// Where to look.
#[derive(Debug)]
pub struct Packages {
    /// The folder of the robot's file, and whatever else relative names are looked for in.
    homes: Vec<PathBuf>,
    /// The given roots, then the folders above the file, nearest first.
    roots: Vec<PathBuf>,
}

/// Why a name leads to no file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoSuchFile {
    /// The places that were looked at.
    pub tried: Vec<PathBuf>,
    /// What would help.
    pub remedy: String,
}

/// What a `filename` is, before anything is looked for.
enum Name {
    /// Below some package: its path, the package's name first.
    Package(String),
    /// A path, relative to the robot's file or absolute.
    Path(String),
    /// Something on another machine.
    Remote,
}

impl Packages {
    /// The folders to look in for a robot's file: the given ones, then those above the file.
    pub fn new(robot: &Path, given: &[PathBuf]) -> Self {
        let parent = robot.parent().filter(|parent| !parent.as_os_str().is_empty());
        let home = parent.unwrap_or(Path::new(".")).to_owned();
        // A bare file name has no ancestors to go through: those of the whole path are meant.
        let whole = std::path::absolute(&home).unwrap_or_else(|_| home.clone());
        let above = whole.ancestors().take(ANCESTORS).map(Path::to_owned);
        let roots = given.iter().cloned().chain(above).collect();
        Self { homes: [home].into_iter().chain(given.iter().cloned()).collect(), roots }
    }

    /// The file that a `filename` means.
    ///
    /// `package://NAME/rest` is `NAME/rest` below a root, or `rest` in a root that is itself called NAME;
    /// where neither is there, the path's end (at least a folder and the file) below a root. Other names are
    /// relative to the robot's file, with or without `file://`. Escapes such as `%20` are decoded where the
    /// name as it is leads nowhere, and upper and lower case may differ.
    pub fn resolve(&self, name: &str) -> Result<PathBuf, NoSuchFile> {
        let mut tried = Vec::new();
        for name in spellings(name) {
            let found = match kind(&name) {
                Name::Remote => return Err(remote(&name)),
                Name::Package(rest) => self.below_roots(&rest, &mut tried),
                Name::Path(path) => self.at_home(&path, &mut tried),
            };
            if let Some(path) = found {
                return Ok(path);
            }
        }
        let remedy = match kind(name) {
            Name::Package(_) => {
                "give the folder that holds the package (`packages` under `[hand]`, `--packages` on the \
                 command line)"
                    .into()
            }
            _ if name.starts_with("file:") => {
                "it is a path of the machine that wrote the file: write one relative to this file \
                 instead"
                    .into()
            }
            _ => "it is looked for relative to the robot's file: put it there, or give the folder that it \
             is in (`packages` under \
                  `[hand]`, `--packages` on the command line)"
                .into(),
        };
        Err(NoSuchFile { tried, remedy })
    }

    fn at_home(&self, name: &str, tried: &mut Vec<PathBuf>) -> Option<PathBuf> {
        let homes = if Path::new(name).is_absolute() { &self.homes[..1] } else { &self.homes[..] };
        homes.iter().find_map(|home| look(home, Path::new(name), tried))
    }

    fn below_roots(&self, rest: &str, tried: &mut Vec<PathBuf>) -> Option<PathBuf> {
        let parts: Option<Vec<&str>> = Path::new(rest).components().map(normal).collect();
        let parts = parts.filter(|parts| !parts.is_empty())?;
        for skipped in 0..parts.len().saturating_sub(1).max(1) {
            let end: PathBuf = parts[skipped..].iter().collect();
            let mut beside = Vec::new();
            let places = if skipped == 0 { &mut *tried } else { &mut beside };
            if let Some(path) = self.roots.iter().find_map(|root| look(root, &end, places)) {
                return Some(path);
            }
        }
        None
    }
}

/// The name as it is, then with its escapes decoded.
fn spellings(name: &str) -> Vec<String> {
    // Exporters on Windows write its separators.
    let plain = name.trim().replace('\\', "/");
    let decoded = decoded(&plain);
    if decoded == plain { vec![plain] } else { vec![plain, decoded] }
}

fn kind(name: &str) -> Name {
    let after = |scheme: &str| {
        let head = name.get(..scheme.len())?;
        head.eq_ignore_ascii_case(scheme).then(|| name[scheme.len()..].to_owned())
    };
    let remote = ["http://", "https://", "ftp://"].into_iter().any(|scheme| after(scheme).is_some());
    let package = || after("package://").or_else(|| after("model://"));
    if remote {
        Name::Remote
    } else if let Some(rest) = package() {
        Name::Package(rest.trim_start_matches('/').to_owned())
    } else if let Some(rest) = after("file://") {
        // An address may name the machine: file://localhost/home/...
        Name::Path(rest.strip_prefix("localhost").unwrap_or(&rest).to_owned())
    } else {
        Name::Path(after("file:").unwrap_or_else(|| name.to_owned()))
    }
}

fn remote(name: &str) -> NoSuchFile {
    let file = name.rsplit('/').next().unwrap_or_default();
    let remedy = format!(
        "it is an address, and nothing is fetched from other machines: download it, and write its file \
         name, such as \
         filename=\"{file}\", relative to this file"
    );
    NoSuchFile { tried: Vec::new(), remedy }
}

/// With `%20` and the like as the characters that they stand for; as it is where that makes no text.
pub(crate) fn decoded(name: &str) -> String {
    let bytes = name.as_bytes();
    let hex = |i: usize| bytes.get(i).and_then(|&digit| char::from(digit).to_digit(16));
    let (mut out, mut i) = (Vec::with_capacity(bytes.len()), 0);
    while i < bytes.len() {
        match (bytes[i], hex(i + 1), hex(i + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((16 * high + low) as u8);
                i += 3;
            }
            (byte, ..) => {
                out.push(byte);
                i += 1;
            }
        }
    }
    String::from_utf8(out).unwrap_or_else(|_| name.to_owned())
}

/// The file `end` below `root`; where case alone differs, the one that there is.
fn look(root: &Path, end: &Path, tried: &mut Vec<PathBuf>) -> Option<PathBuf> {
    let path = root.join(end);
    if path.is_file() {
        return Some(path);
    }
    let found = in_any_case(root, end);
    tried.push(path);
    found
}

fn in_any_case(root: &Path, end: &Path) -> Option<PathBuf> {
    let mut place = root.to_owned();
    for part in end.components() {
        match part {
            Component::Normal(name) if !place.join(name).exists() => {
                let wanted = name.to_str()?.to_lowercase();
                let mut same: Vec<PathBuf> =
                    fs::read_dir(if place.as_os_str().is_empty() { Path::new(".") } else { &place })
                        .ok()?
                        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
                        .filter(|other| other.to_lowercase() == wanted)
                        .map(|other| place.join(other))
                        .collect();
                // Two files that differ by case alone: which is meant is not known.
                place = if same.len() == 1 { same.pop()? } else { return None };
            }
            other => place.push(other),
        }
    }
    place.is_file().then_some(place)
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

    struct Place(tempfile::TempDir);

    impl Place {
        fn new(files: &[&str]) -> Self {
            let place = Self(tempfile::tempdir().unwrap());
            for file in files {
                fs::create_dir_all(place.at(file).parent().unwrap()).unwrap();
                fs::write(place.at(file), "x").unwrap();
            }
            place
        }

        fn at(&self, path: &str) -> PathBuf {
            self.0.path().join(path)
        }

        fn found(&self, name: &str) -> Option<PathBuf> {
            let packages = Packages::new(&self.at("ws/my_hand/urdf/hand.urdf"), &[self.at("else")]);
            packages.resolve(name).ok().map(|path| path.canonicalize().unwrap())
        }

        #[track_caller]
        fn leads(&self, name: &str, file: &str) {
            assert_eq!(self.found(name), Some(self.at(file).canonicalize().unwrap()), "{name}");
        }
    }

    #[test]
    fn packages_are_found_below_roots_above_the_file_and_by_their_end() {
        let place =
            Place::new(&["ws/my_hand/meshes/a.stl", "else/other/meshes/b.stl", "ws/my_hand/urdf/c.stl"]);
        place.leads("package://my_hand/meshes/a.stl", "ws/my_hand/meshes/a.stl");
        place.leads("package://other/meshes/b.stl", "else/other/meshes/b.stl");
        place.leads("package://renamed/meshes/a.stl", "ws/my_hand/meshes/a.stl");
        place.leads("c.stl", "ws/my_hand/urdf/c.stl");
        place.leads("../meshes/a.stl", "ws/my_hand/meshes/a.stl");
        place.leads("package://my_hand\\meshes\\a.stl", "ws/my_hand/meshes/a.stl");
        let absolute = place.at("ws/my_hand/meshes/a.stl");
        place.leads(&format!("file://{}", absolute.display()), "ws/my_hand/meshes/a.stl");
        place.leads(&format!("file://localhost{}", absolute.display()), "ws/my_hand/meshes/a.stl");
        place.leads("file:../meshes/a.stl", "ws/my_hand/meshes/a.stl");
        for name in ["package://x/../../../etc/passwd", "package://", "package://my_hand/meshes/none.stl"] {
            assert_eq!(place.found(name), None, "{name}");
        }
    }

    #[test]
    fn blanks_escapes_and_case_are_as_they_are_meant() {
        let place = Place::new(&[
            "ws/my_hand/my meshes/a b.stl",
            "ws/my_hand/urdf/50%20.stl",
            "ws/my_hand/Meshes/C.STL",
        ]);
        place.leads("package://my_hand/my meshes/a b.stl", "ws/my_hand/my meshes/a b.stl");
        place.leads("package://my_hand/my%20meshes/a%20b.stl", "ws/my_hand/my meshes/a b.stl");
        place.leads("../my%20meshes/a b.stl", "ws/my_hand/my meshes/a b.stl");
        place.leads("50%20.stl", "ws/my_hand/urdf/50%20.stl");
        place.leads("package://my_hand/meshes/c.stl", "ws/my_hand/Meshes/C.STL");
        place.leads("Package://my_hand/meshes/C.stl", "ws/my_hand/Meshes/C.STL");
    }

    #[test]
    fn each_kind_of_name_gets_the_remedy_that_fits() {
        let place = Place::new(&["ws/my_hand/urdf/hand.urdf"]);
        let packages = Packages::new(&place.at("ws/my_hand/urdf/hand.urdf"), &[]);
        let remedy = |name: &str| packages.resolve(name).unwrap_err().remedy;
        assert!(remedy("http://x.org/meshes/y.stl").contains("download it"));
        assert!(remedy("http://x.org/meshes/y.stl").contains("filename=\"y.stl\""));
        assert!(remedy("package://x/y.stl").contains("--packages"));
        assert!(remedy("file:///home/me/y.stl").contains("relative to this file"));
        assert!(remedy("y.stl").contains("relative to the robot's file"));
    }
}
