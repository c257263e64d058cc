//! What a command would write is checked before anything is computed, so that no file of the user's is lost.
//!
//! Three rules: an output is none of the inputs, however either is spelt; two outputs are two files; a file
//! that is there already is replaced only by its own kind, unless `--force` says otherwise.

use crate::Failure;
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// How many bytes of a file tell its kind.
const HEAD: u64 = 1 << 16;

/// Whether files that this program did not write may be replaced.
#[derive(Clone, Copy, Debug, clap::Args)]
pub struct OverwriteArgs {
    /// Replace files that this program did not write, too; inputs are never replaced.
    #[arg(long)]
    pub force: bool,
}

/// The kinds of files that commands write, known by what stands near their beginning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A plan file.
    Plan,
    /// A page for the browser.
    Page,
    /// Grasps, as JSON or as NumPy arrays.
    Grasps,
    /// Grasps that are still being looked for.
    BegunGrasps,
    /// A roadmap.
    Roadmap,
    /// A file of an atlas.
    Atlas,
    /// The results of a protocol.
    Suite,
    /// A picture or the list of a gallery.
    Gallery,
    /// The result of a replay.
    Replay,
    /// A hand file.
    Hand,
    /// A scenario.
    Scenario,
    /// A file for another program.
    Export,
    /// A call that broke a law, as an audit keeps it.
    Case,
}

impl Kind {
    /// What it is called in messages.
    fn name(self) -> &'static str {
        match self {
            Kind::Plan => "plan file",
            Kind::Page => "page",
            Kind::Grasps => "file of grasps",
            Kind::BegunGrasps => "begun search for grasps",
            Kind::Roadmap => "roadmap",
            Kind::Atlas => "file of an atlas",
            Kind::Suite => "results of a protocol",
            Kind::Gallery => "file of a gallery",
            Kind::Replay => "file of a replay",
            Kind::Hand => "hand file",
            Kind::Scenario => "scenario",
            Kind::Export => "exported file",
            Kind::Case => "kept case",
        }
    }

    /// Texts of which one stands in the first [`HEAD`] bytes of each file of this kind that this program
    /// wrote.
    fn marks(self) -> &'static [&'static str] {
        match self {
            Kind::Plan => &["\"regrasp-plan\""],
            Kind::Page => &["content=\"regrasp view\""],
            Kind::Grasps => &[
                "\"regrasp-grasps\"",
                "component.npy",
                "grasps_info.npy",
                "{\"grasp\":0,",
                "<!-- regrasp-grasps -->",
            ],
            Kind::BegunGrasps => &["\"regrasp-grasps-part\""],
            Kind::Roadmap => &["regrasp-roadmap\n"],
            Kind::Atlas => &[
                "content=\"regrasp atlas\"",
                "\"regrasp-atlas\"",
                "\"regrasp-atlas-part\"",
                "hand,shape,size_mm,friction,mass_kg,",
            ],
            Kind::Suite => &["\"regrasp-suite\"", "\"regrasp-suite-part\"", "<!-- regrasp-suite -->"],
            Kind::Gallery => &["<!-- regrasp-gallery -->"],
            Kind::Replay => &["\"regrasp-replay\""],
            Kind::Hand => &[HAND_MARK],
            Kind::Scenario => &[SCENARIO_MARK],
            Kind::Export => &["regrasp", "moving_finger.npy"],
            Kind::Case => &["regrasp-audit-case"],
        }
    }

    fn is(self, head: &[u8]) -> bool {
        let holds = |mark: &&str| head.windows(mark.len()).any(|part| part == mark.as_bytes());
        self.marks().iter().any(holds)
    }
}

/// The first line of the hand files that are written.
pub const HAND_MARK: &str = "# A hand file, written by `regrasp hand`.";

/// The first line of the scenarios that are written.
pub const SCENARIO_MARK: &str = "# A scenario, written by Regrasp.";

/// Refuses outputs that would destroy something; nothing is written or computed yet.
pub fn check(inputs: &[PathBuf], outputs: &[(&Path, Kind)], force: OverwriteArgs) -> Result<(), Failure> {
    let outputs: Vec<&(&Path, Kind)> = outputs.iter().filter(|(path, _)| !is_standard(path)).collect();
    for (number, (output, kind)) in outputs.iter().enumerate() {
        if let Some(input) = inputs.iter().find(|input| same(input, output)) {
            return Err(refused(
                output,
                &format!("it is an input (`{}`); name another file", input.display()),
            ));
        }
        if outputs[..number].iter().any(|(earlier, _)| same(earlier, output)) {
            return Err(refused(output, "two outputs would be this one file; name another for one of them"));
        }
        if !force.force && !may_replace(output, *kind) {
            return Err(foreign(output, *kind));
        }
        regrasp::plan::check_place(output).map_err(Failure::bad_input)?;
    }
    Ok(())
}

/// Whether `-` is given, which stands for standard output.
pub fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Refuses `-` where a folder is meant.
pub fn check_folder(path: &Path) -> Result<(), Failure> {
    match is_standard(path) {
        true => Err(refused(path, "the files need a folder, and `-` is standard output; name a folder")),
        false => Ok(()),
    }
}

/// Refuses to replace a file that is there already by an exported one, unless both begin alike or it is ours.
pub fn check_export(path: &Path, bytes: &[u8], force: OverwriteArgs) -> Result<(), Failure> {
    let first = |bytes: &[u8]| bytes.split(|&byte| byte == b'\n').next().unwrap_or_default().to_vec();
    let alike = || head(path).is_some_and(|old| first(&old) == first(bytes));
    match force.force || may_replace(path, Kind::Export) || alike() {
        true => Ok(()),
        false => Err(foreign(path, Kind::Export)),
    }
}

fn foreign(path: &Path, kind: Kind) -> Failure {
    let kind = kind.name();
    let reason = format!("it exists and is no {kind} of this program; name another file, or give `--force`");
    refused(path, &reason)
}

/// The first bytes of a file; `None` where it cannot be read.
fn head(path: &Path) -> Option<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path).ok()?.take(HEAD).read_to_end(&mut head).ok()?;
    Some(head)
}

/// Whether there is nothing to lose: no file, an empty one, a device, or one of the same kind.
pub fn may_replace(path: &Path, kind: Kind) -> bool {
    let Ok(found) = fs::metadata(path) else { return true };
    if !found.is_file() || found.len() == 0 {
        return true;
    }
    // What cannot be read cannot be known to be ours.
    head(path).is_some_and(|head| kind.is(&head))
}

/// Whether two paths are one file: through links and other spellings, and also where it is not there yet.
fn same(a: &Path, b: &Path) -> bool {
    let device = |path: &Path| fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
    if device(a) || device(b) {
        return false;
    }
    identity(a).is_some_and(|a| identity(b) == Some(a))
}

/// What tells one file from another.
#[derive(PartialEq)]
enum Identity {
    #[cfg(unix)]
    There(u64, u64),
    Path(PathBuf),
}

fn identity(path: &Path) -> Option<Identity> {
    #[cfg(unix)]
    if let Ok(found) = fs::metadata(path) {
        use std::os::unix::fs::MetadataExt;
        return Some(Identity::There(found.dev(), found.ino()));
    }
    if let Ok(real) = fs::canonicalize(path) {
        return Some(Identity::Path(real));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    Some(Identity::Path(fs::canonicalize(folder).ok()?.join(path.file_name()?)))
}

fn refused(path: &Path, reason: &str) -> Failure {
    Failure::bad_input(format!("`{}` is not written: {reason}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEEP: OverwriteArgs = OverwriteArgs { force: false };
    const FORCE: OverwriteArgs = OverwriteArgs { force: true };

    #[test]
    #[cfg(unix)]
    fn inputs_are_known_by_any_name() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("part.stl"), "solid").unwrap();
        fs::create_dir(at("deep")).unwrap();
        std::os::unix::fs::symlink(at("part.stl"), at("link.stl")).unwrap();
        fs::hard_link(at("part.stl"), at("hard.stl")).unwrap();
        for name in ["part.stl", "deep/../part.stl", "./part.stl", "link.stl", "hard.stl"] {
            let outputs = [(&*at(name), Kind::Plan)];
            assert!(check(&[at("part.stl")], &outputs, FORCE).is_err(), "{name}");
        }
        assert!(check(&[at("part.stl")], &[(&*at("plan.json"), Kind::Plan)], KEEP).is_ok());
    }

    #[test]
    fn two_outputs_are_two_files_also_before_they_are_there() {
        let folder = tempfile::tempdir().unwrap();
        let (a, b) = (folder.path().join("p.json"), folder.path().join(".").join("p.json"));
        assert!(check(&[], &[(&a, Kind::Plan), (&b, Kind::Grasps)], FORCE).is_err());
    }

    #[test]
    fn only_its_own_kind_is_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path().join("out");
        let allowed = |content: &str, kind, force| {
            fs::write(&at, content).unwrap();
            check(&[], &[(&*at, kind)], force).is_ok()
        };
        assert!(allowed("", Kind::Plan, KEEP));
        assert!(allowed("{\"format\": \"regrasp-plan\"", Kind::Plan, KEEP));
        assert!(!allowed("{\"format\": \"regrasp-replay\"", Kind::Plan, KEEP));
        assert!(!allowed("my thesis", Kind::Plan, KEEP));
        assert!(allowed("my thesis", Kind::Plan, FORCE));
        assert!(!allowed("name = \"my hand\"", Kind::Hand, KEEP));
    }
}
