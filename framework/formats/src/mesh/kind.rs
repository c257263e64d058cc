//! The formats of mesh files, by a file's name and by its content.

use super::{Raw, collada, gltf, obj, ply, stl, threemf};
use std::path::Path;

/// A format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Stl,
    Obj,
    Ply,
    Collada,
    Gltf,
    Glb,
    ThreeMf,
}

impl Kind {
    const ALL: [Self; 7] =
        [Self::Stl, Self::Obj, Self::Ply, Self::Collada, Self::Gltf, Self::Glb, Self::ThreeMf];

    /// What a file's name ends in.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Stl => "stl",
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Collada => "dae",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
            Self::ThreeMf => "3mf",
        }
    }

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Stl => "an STL file",
            Self::Obj => "an OBJ file",
            Self::Ply => "a PLY file",
            Self::Collada => "a COLLADA file",
            Self::Gltf => "a glTF file",
            Self::Glb => "a GLB file",
            Self::ThreeMf => "a 3MF file",
        }
    }

    /// The format that a file's name tells.
    pub(super) fn of_name(path: &Path) -> Result<Self, String> {
        let Some(ending) = path.extension().and_then(|ending| ending.to_str()) else {
            return Err(format!("its name has no ending that tells the format ({})", endings()));
        };
        let ending = ending.to_ascii_lowercase();
        let known = Self::ALL.into_iter().find(|kind| kind.ending() == ending);
        known.ok_or_else(|| format!("`.{ending}` is not one of {}; convert the file", endings()))
    }

    /// The format that a file's beginning looks like.
    pub fn of_content(bytes: &[u8]) -> Option<Self> {
        let head = bytes[..bytes.len().min(2000)].to_ascii_lowercase();
        let start = head.trim_ascii_start();
        let holds = |word: &[u8]| head.windows(word.len()).any(|part| part == word);
        let begins_line = |word: &[u8]| head.split(|b| *b == b'\n').any(|line| line.starts_with(word));
        match () {
            () if start.starts_with(b"ply") => Some(Self::Ply),
            () if start.starts_with(b"gltf") => Some(Self::Glb),
            () if start.starts_with(b"pk\x03\x04") => Some(Self::ThreeMf),
            () if start.starts_with(b"<") && holds(b"<collada") => Some(Self::Collada),
            () if start.starts_with(b"{") && holds(b"\"asset\"") => Some(Self::Gltf),
            () if holds(b"facet") && holds(b"vertex") => Some(Self::Stl),
            () if begins_line(b"v ") && std::str::from_utf8(bytes).is_ok() => Some(Self::Obj),
            () => None,
        }
    }

    /// What a file holds; `path` is where it lies, for those that name further files.
    pub(super) fn parse(self, bytes: &[u8], path: &Path) -> Result<Raw, String> {
        match self {
            Self::Stl => stl::parse(bytes),
            Self::Obj => obj::parse(bytes),
            Self::Ply => ply::parse(bytes),
            Self::Collada => collada::parse(bytes),
            Self::Gltf | Self::Glb => gltf::parse(bytes, path.parent().unwrap_or(Path::new(""))),
            Self::ThreeMf => threemf::parse(bytes),
        }
    }
}

fn endings() -> String {
    let all: Vec<String> = Kind::ALL.iter().map(|kind| format!(".{}", kind.ending())).collect();
    all.join(", ")
}
