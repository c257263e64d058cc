//! What fingertips touch of a mesh, chosen as the scenario wishes, and kept beside the mesh's file.

use regrasp_api::{
    ContactSurface, ContactSurfaceWord, Mesh, ObjectDescription, ObjectModel, ObjectShape, Twin, mesh_digest,
};
use regrasp_world::{automatic_twin, twin_within};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Changes whenever twins are made otherwise: what older programs kept is then made anew.
const MAKER: u32 = 3;
/// Twins that are made faster than those of this many facets are not kept.
const WORTH_KEEPING: usize = 4000;

/// Gives the object its contact surface for fingertips of a radius (m); returns what a user should know of
/// it.
pub(super) fn settle(
    object: &mut ObjectModel,
    description: &ObjectDescription,
    radius: f64,
    folder: &Path,
) -> Vec<String> {
    let ObjectShape::Mesh(source) = &description.shape else { return Vec::new() };
    let wish = description.contact_surface.unwrap_or(ContactSurface::Word(ContactSurfaceWord::Auto));
    if wish == ContactSurface::Word(ContactSurfaceWord::Exact) || radius <= 0.0 {
        return Vec::new();
    }
    let file = source.file.as_ref().filter(|_| object.mesh.facets().len() >= WORTH_KEEPING);
    let place = file.map(|file| beside(&folder.join(file)));
    let key = Key { maker: MAKER, digest: mesh_digest(&object.mesh), radius, wish };
    let mut remarks = Vec::new();
    object.twin = match place.as_ref().and_then(|place| kept(place, &key)) {
        Some(kept) => kept.twin(),
        None => {
            let twin = made(&object.mesh, radius, wish);
            remarks.extend(place.and_then(|place| keep(&place, key, twin.as_ref())));
            twin
        }
    };
    remark(object, wish).into_iter().chain(remarks).collect()
}

fn made(mesh: &Mesh, radius: f64, wish: ContactSurface) -> Option<Twin> {
    match wish {
        ContactSurface::Word(_) => automatic_twin(mesh, radius),
        ContactSurface::Within(nearness) => twin_within(mesh, radius, nearness.tolerance),
    }
}

/// Which surface is used and how far off it is; nothing where it is the mesh, and nobody asked for another.
fn remark(object: &ObjectModel, wish: ContactSurface) -> Option<String> {
    match (&object.twin, wish) {
        (Some(twin), _) => Some(format!(
            "contacts live on a twin of the mesh ({} of {} facets); a fingertip that touches it is within \
             {:.2} mm of \
             touching the mesh (`object.contact_surface`)",
            twin.mesh.facets().len(),
            object.mesh.facets().len(),
            (twin.bound * 1e5).ceil() / 100.0,
        )),
        (None, ContactSurface::Within(nearness)) => Some(format!(
            "no twin within {:.2} mm is simpler than the mesh, so contacts live on the mesh itself; a larger \
             `object.contact_surface.tolerance` may help",
            nearness.tolerance * 1e3
        )),
        (None, ContactSurface::Word(_)) => None,
    }
}

/// What a kept twin was made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Key {
    maker: u32,
    digest: String,
    radius: f64,
    wish: ContactSurface,
}

/// The file beside a mesh's.
#[derive(Serialize, Deserialize)]
struct Kept {
    key: Key,
    tolerance: f64,
    bound: f64,
    /// Empty where the mesh itself is touched.
    vertices: Vec<[f64; 3]>,
    facets: Vec<[u32; 3]>,
}

impl Kept {
    fn twin(self) -> Option<Twin> {
        let vertices = self.vertices.into_iter().map(Into::into).collect();
        let mesh = Mesh::new(vertices, self.facets).ok()?;
        Some(Twin { mesh, bound: self.bound, tolerance: self.tolerance })
    }

    fn is_sound(&self) -> bool {
        let vertices = self.vertices.iter().map(|&v| v.into()).collect();
        self.facets.is_empty() || Mesh::new(vertices, self.facets.clone()).is_ok()
    }
}

fn beside(mesh: &Path) -> PathBuf {
    let mut name = mesh.file_name().unwrap_or_default().to_owned();
    name.push(".contact-surface.json");
    mesh.with_file_name(name)
}

/// What is kept for exactly this mesh, fingertip and wish; whatever else the file holds is passed over.
fn kept(place: &Path, key: &Key) -> Option<Kept> {
    let kept: Kept = serde_json::from_slice(&std::fs::read(place).ok()?).ok()?;
    (kept.key == *key && kept.is_sound()).then_some(kept)
}

/// Writes the file; the answer is what to tell where that fails.
fn keep(place: &Path, key: Key, twin: Option<&Twin>) -> Option<String> {
    let kept = Kept {
        key,
        tolerance: twin.map_or(0.0, |twin| twin.tolerance),
        bound: twin.map_or(0.0, |twin| twin.bound),
        vertices: twin.map_or(Vec::new(), |twin| twin.mesh.vertices().iter().map(|&v| v.into()).collect()),
        facets: twin.map_or(Vec::new(), |twin| twin.mesh.facets().to_vec()),
    };
    let text = serde_json::to_vec(&kept).ok()?;
    let error = std::fs::write(place, text).err()?;
    Some(format!(
        "the contact surface is made anew each time: `{}` cannot be written ({error})",
        place.display()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_serves_its_own_mesh_alone() {
        let folder = tempfile::tempdir().unwrap();
        let place = beside(&folder.path().join("part.stl"));
        assert!(place.ends_with("part.stl.contact-surface.json"));
        let wish = ContactSurface::Word(ContactSurfaceWord::Auto);
        let key = Key { maker: MAKER, digest: "ab".into(), radius: 0.01, wish };
        assert_eq!(keep(&place, key.clone(), None), None);
        assert!(kept(&place, &key).is_some_and(|kept| kept.twin().is_none()));
        assert!(kept(&place, &Key { digest: "cd".into(), ..key.clone() }).is_none());
        assert!(kept(&place, &Key { radius: 0.02, ..key.clone() }).is_none());
        std::fs::write(&place, "{").unwrap();
        assert!(kept(&place, &key).is_none());
        let nowhere = folder.path().join("none").join("x.json");
        assert!(keep(&nowhere, key, None).is_some_and(|note| note.contains("cannot be written")));
    }
}
