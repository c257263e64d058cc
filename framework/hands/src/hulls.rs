//! The convex hulls or pieces of mesh files, each made once, on all processors.

use regrasp_api::{Mesh, Vec3};
use regrasp_formats::{FormatError, Packages, read_points};
use regrasp_world::{coarse_hull, convex_pieces};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Meshes reach no farther (m) from their origin.
const FARTHEST: f64 = 10.0;
/// How far (m) a hull may stay behind the true one for having fewer corners.
const COARSE: f64 = 1.5e-4;

/// The box along the axes around points, at least a micrometre thick: its lowest and highest corner.
pub(crate) fn around(points: &[Vec3]) -> (Vec3, Vec3) {
    let low = points.iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
    let high = points.iter().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default();
    (low - Vec3::repeat(1e-6), high + Vec3::repeat(1e-6))
}

/// What stands for a mesh.
#[derive(Clone, Debug)]
pub(crate) struct Convex {
    /// Convex meshes, in the file's frame (m).
    pub parts: Vec<Mesh>,
    /// For a mesh without volume the box around it: its lowest and highest corner (m).
    pub flat: Option<(Vec3, Vec3)>,
    /// What was done, for people.
    pub what: String,
}

/// A file and a scale (as bits, to be a key).
type Key = (PathBuf, [u64; 3]);

/// Hulls by file and scale.
#[derive(Debug)]
pub(crate) struct Hulls {
    packages: Packages,
    /// The most convex pieces of a mesh; with 1 its hull is taken.
    most_pieces: usize,
    made: BTreeMap<Key, Result<Convex, String>>,
}

impl Hulls {
    /// Makes those of the given meshes at once.
    pub fn new<'a>(
        packages: Packages,
        most_pieces: usize,
        meshes: impl Iterator<Item = (&'a str, [f64; 3])>,
    ) -> Self {
        let mut wanted: Vec<Key> = meshes
            .filter_map(|(name, scale)| Some((packages.resolve(name).ok()?, scale.map(f64::to_bits))))
            .collect();
        wanted.sort();
        wanted.dedup();
        let made = in_parallel(&wanted, |(path, scale)| make(path, scale.map(f64::from_bits), most_pieces));
        Self { packages, most_pieces, made: wanted.into_iter().zip(made).collect() }
    }

    /// What stands for a mesh, or why nothing can.
    pub(super) fn of(&mut self, name: &str, scale: [f64; 3]) -> Result<&Convex, String> {
        let path = self.packages.resolve(name).map_err(|missing| {
            let tried: Vec<String> =
                missing.tried.iter().take(4).map(|path| format!("`{}`", path.display())).collect();
            let looked =
                if tried.is_empty() { String::new() } else { format!("; looked at {}", tried.join(", ")) };
            format!("the mesh `{name}` is not there{looked}; {}", missing.remedy)
        })?;
        let key = (path, scale.map(f64::to_bits));
        let most = self.most_pieces;
        let made = self.made.entry(key).or_insert_with_key(|(path, _)| make(path, scale, most));
        made.as_ref().map_err(Clone::clone)
    }
}

/// The results of a pure function, in the order of its arguments.
fn in_parallel<A: Sync, R: Send>(arguments: &[A], work: impl Fn(&A) -> R + Sync) -> Vec<R> {
    let (next, done) = (AtomicUsize::new(0), Mutex::new(Vec::with_capacity(arguments.len())));
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(arguments.len());
    let run = || {
        while let Some((index, argument)) = {
            let index = next.fetch_add(1, Ordering::Relaxed);
            arguments.get(index).map(|argument| (index, argument))
        } {
            let result = work(argument);
            done.lock().expect("no thread panics while it holds the lock").push((index, result));
        }
    };
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(run))));
    let mut done = done.into_inner().expect("no thread panics while it holds the lock");
    done.sort_by_key(|(index, _)| *index);
    done.into_iter().map(|(_, result)| result).collect()
}

fn make(path: &Path, scale: [f64; 3], most_pieces: usize) -> Result<Convex, String> {
    let (points, facets) = read_points(path).map_err(|error| match error {
        FormatError::File { path, reason, .. } => {
            format!("cannot read the mesh `{}`: {reason}", path.display())
        }
        other => other.to_string(),
    })?;
    let count = points.len() as u32;
    if count == 0 || facets.iter().flatten().any(|&vertex| vertex >= count) {
        return Err(format!("the mesh `{}` has no facets, or names corners that it lacks", path.display()));
    }
    let points: Vec<Vec3> = points.iter().map(|p| p.component_mul(&Vec3::from(scale))).collect();
    let reach = points.iter().map(|p| p.norm()).fold(0.0, f64::max);
    if reach >= FARTHEST {
        return Err(format!(
            "the mesh `{}` reaches {reach:.1} m from its origin, no hand is as large; is it in millimetres? \
             then write \
             scale=\"0.001 0.001 0.001\", or give `mesh_scale` = 0.001 (`--mesh-scale`) for all meshes",
            path.display()
        ));
    }
    let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let parts = if most_pieces > 1 { convex_pieces(&points, &facets, most_pieces) } else { Vec::new() };
    let facets = facets.len();
    let done = |parts, what| Ok(Convex { parts, flat: None, what });
    match (parts.len(), coarse_hull(&points, COARSE)) {
        (count @ 2.., _) => done(parts, format!("{count} convex pieces of {file} ({facets} facets)")),
        (_, Some((whole, 0.0))) => done(vec![whole], format!("the convex hull of {file} ({facets} facets)")),
        (_, Some((whole, error))) => {
            let corners = whole.vertices().len();
            let what = format!(
                "the convex hull of {file} ({facets} facets), by {corners} of its corners: at most {:.2} mm \
                 inside",
                1e3 * error
            );
            done(vec![whole], what)
        }
        (_, None) => Ok(Convex {
            parts,
            flat: Some(around(&points)),
            what: format!("the box around {file}, which is flat"),
        }),
    }
}
