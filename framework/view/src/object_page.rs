//! An object as one HTML page: its mesh, and the surface that fingertips touch in place of a rough one.

use crate::ViewError;
use crate::html::{Kind, assembled};
use crate::mesh::{MeshData, thin};
use crate::number::nano;
use regrasp_api::{Mesh, Twin};
use regrasp_world::signed_distances;
use serde::Serialize;

/// An object, and what is told about it.
#[derive(Clone, Debug)]
pub struct ObjectView<'a> {
    /// What it is called.
    pub name: &'a str,
    /// Its true surface.
    pub mesh: &'a Mesh,
    /// What fingertips touch in its place; absent where that is the mesh itself.
    pub twin: Option<&'a Twin>,
    /// The centre of mass (m).
    pub p_OCm: [f64; 3],
    /// The fingertips' radius (m).
    pub fingertip_radius: f64,
    /// What is said in a few words each: a name and its value.
    pub facts: Vec<(String, String)>,
}

#[derive(Serialize)]
struct PageData<'a> {
    name: &'a str,
    object: MeshData,
    twin: Option<TwinData>,
    center: [f64; 3],
    tip_radius: f64,
    facts: &'a [(String, String)],
}

#[derive(Serialize)]
struct TwinData {
    #[serde(flatten)]
    mesh: MeshData,
    /// How far a fingertip that touches the twin is at most from touching the mesh (m).
    bound: f64,
    /// How far each drawn vertex of the twin lies outside the true mesh (m); negative inside.
    heights: Vec<f64>,
    /// How far each drawn vertex of the true mesh lies outside the twin (m); negative inside.
    of_mesh: Vec<f64>,
}

/// The page that shows an object: one HTML file that needs nothing else.
pub fn object_page(view: &ObjectView<'_>) -> Result<String, ViewError> {
    let mut object = MeshData::new(view.mesh);
    let mut second = view.twin.map(|twin| MeshData::new(&twin.mesh));
    thin([&mut object].into_iter().chain(&mut second));
    let twin = second.zip(view.twin).map(|(mesh, twin)| TwinData {
        bound: nano(twin.bound),
        heights: rounded(&signed_distances(view.mesh, &mesh.points())),
        of_mesh: rounded(&signed_distances(&twin.mesh, &object.points())),
        mesh,
    });
    let data = PageData {
        name: view.name,
        object,
        twin,
        center: view.p_OCm,
        tip_radius: view.fingertip_radius,
        facts: &view.facts,
    };
    Ok(assembled(Kind::Object, view.name, &data))
}

fn rounded(distances: &[f64]) -> Vec<f64> {
    distances.iter().map(|&x| nano(x)).collect()
}
