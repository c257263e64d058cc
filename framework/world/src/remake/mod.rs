//! A closed surface out of facets that do not make one: scans with holes, walls that cross, seams.
//!
//! What is inside is told by the winding number of the facets (A. Jacobson, L. Kavan, O. Sorkine-Hornung,
//! "Robust inside-outside segmentation using generalized winding numbers", SIGGRAPH 2013), which needs no
//! closed surface; its boundary is drawn on a grid cut into tetrahedra (A. Doi, A. Koide, "An efficient
//! method of triangulating equi-valued surfaces by using tetrahedral cells", IEICE 1991): what comes out is
//! always closed and crosses itself nowhere. Where facets are near, it lies on them; sharp edges become blunt
//! by a part of the grid's step.

mod grid;
mod tetrahedra;
mod winding;

use crate::bodies::{RigidBody, rigid_body};
use crate::twin::coarser;
use grid::Grid;
use parry3d_f64::math::Vector;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::TriMesh;
use regrasp_api::{Mesh, Vec3};
use winding::Winding;

/// Steps of the grid along the longest side.
const STEPS: usize = 96;
/// How far (steps) the surface may move when it is given fewer facets.
const MOVED: f64 = 0.08;
/// How far (steps) beside a facet inside and outside are looked for.
const BESIDE: f64 = 0.25;

/// A surface that was made anew.
#[derive(Clone, Debug, PartialEq)]
pub struct Remade {
    /// The surface (m).
    pub mesh: Mesh,
    /// The grid's step (m): details and walls thinner than it are lost.
    pub step: f64,
    /// How far (m) the surface is from the facets that were given: in the median, and at most, which is in
    /// holes.
    pub off: (f64, f64),
}

impl Remade {
    /// What was done, for people.
    pub fn remark(&self) -> String {
        let [step, median, most] = [self.step, self.off.0, self.off.1].map(|x| 1e3 * x);
        format!(
            "the surface was made anew, closed, on a grid of {step:.3} mm: details and walls thinner than \
             that are lost; it is within {median:.3} mm of the file's facets in the median, and {most:.3} \
             mm at most, where holes were closed"
        )
    }
}

/// The surface around what the facets enclose; `None` where they enclose nothing, or several bodies.
///
/// Facets may be open, crossing, doubled; most of them must look outward. Cost: some two seconds.
pub fn remake(vertices: &[Vec3], facets: &[[u32; 3]]) -> Option<Remade> {
    let facets = sound(vertices, facets);
    let winding = Winding::new(vertices, &facets)?;
    let grid = Grid::around(vertices, STEPS)?;
    let glam = |v: &Vec3| Vector::new(v.x, v.y, v.z);
    let border = border(vertices, facets, &winding, BESIDE * grid.step);
    let surface = TriMesh::new(vertices.iter().map(glam).collect(), border).ok()?;
    let distance = |p: &Vec3| surface.distance_to_local_point(glam(p), false);
    let values = grid.values(&winding, &distance);
    let (corners, triangles) = tetrahedra::surface(&grid, &values);
    let whole = Mesh::new(corners, triangles).ok()?;
    let RigidBody { mesh, .. } = rigid_body(grid.without_specks(whole)?, false).ok()?;
    let fewer = coarser(&mesh, MOVED * grid.step).and_then(|mesh| rigid_body(mesh, false).ok());
    let mesh = fewer.map_or(mesh, |body| body.mesh);
    let mut off: Vec<f64> = mesh.vertices().iter().map(&distance).collect();
    off.sort_by(f64::total_cmp);
    let off = (off[off.len() / 2], *off.last()?);
    Some(Remade { mesh, step: grid.step, off })
}

/// The facets that have the inside on one side and the outside on the other, so far (m) from them: others lie
/// within, or hang in the air.
fn border(vertices: &[Vec3], facets: Vec<[u32; 3]>, winding: &Winding, beside: f64) -> Vec<[u32; 3]> {
    let is_border = |facet: &[u32; 3]| {
        let [a, b, c] = facet.map(|vertex| vertices[vertex as usize]);
        let (middle, off) = ((a + b + c) / 3.0, (b - a).cross(&(c - a)).normalize() * beside);
        (winding.at(&(middle + off)) > 0.5) != (winding.at(&(middle - off)) > 0.5)
    };
    facets.into_iter().filter(is_border).collect()
}

/// The facets that have an area and corners that are there.
fn sound(vertices: &[Vec3], facets: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let is_sound = |facet: &&[u32; 3]| {
        let corners = facet.map(|vertex| vertices.get(vertex as usize));
        let [Some(a), Some(b), Some(c)] = corners else { return false };
        let area = (b - a).cross(&(c - a)).norm();
        area > 0.0 && area.is_finite()
    };
    facets.iter().filter(is_sound).copied().collect()
}

#[cfg(test)]
mod tests;
