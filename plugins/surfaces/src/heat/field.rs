//! Distances to a point by two sparse systems, both factorised once.
//!
//! K. Crane, C. Weischedel, M. Wardetzky, "Geodesics in heat", ACM TOG 32, 2013, algorithm 1.

use super::delaunay::Triangles;
use super::fine::{Fine, FinePoint};
use crate::polyhedron::{Planar, planar_norm};
use faer::Side;
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Llt;
use faer::sparse::{SparseColMat, Triplet};
use regrasp_api::{BuildError, Vec3};

/// Share of the mass matrix that makes the singular Laplacian definite, relative to the inverse of the
/// object's size squared.
const REGULAR: f64 = 1e-8;

/// A triangle of the Delaunay triangulation.
#[derive(Clone, Copy, Debug)]
struct Element {
    corners: [u32; 3],
    /// Area (m²).
    area: f64,
    /// The gradients (1/m) of the functions that are 1 at one corner and 0 at the others, in the triangle's
    /// plane.
    hats: [Planar; 3],
}

impl Element {
    fn new(triangles: &Triangles, index: usize) -> Self {
        let flat = triangles.flat(index);
        let area = flat[1][0] * flat[2][1] / 2.0;
        let hats = [0, 1, 2].map(|k: usize| {
            let (a, b) = (flat[(k + 1) % 3], flat[(k + 2) % 3]);
            // The edge opposite to the corner, turned inwards.
            [(a[1] - b[1]) / (2.0 * area), (b[0] - a[0]) / (2.0 * area)]
        });
        Self { corners: triangles.corners[index], area, hats }
    }

    fn slope(&self, values: &[f64]) -> Planar {
        let along = |axis: usize| (0..3).map(|k| self.hats[k][axis] * values[self.corners[k] as usize]).sum();
        [along(0), along(1)]
    }
}

/// The heat method on a fine mesh.
#[derive(Clone)]
pub(super) struct Field {
    elements: Vec<Element>,
    heat: Llt<usize, f64>,
    laplace: Llt<usize, f64>,
}

impl Field {
    /// Factorises both systems; the time of the heat flow is `smoothing` times the mean edge's length
    /// squared.
    pub fn new(fine: &Fine, smoothing: f64) -> Result<Self, BuildError> {
        let polyhedron = &fine.polyhedron;
        let triangles = Triangles::delaunay(polyhedron);
        // Triangles of needles may be flat to rounding; they carry no heat.
        let elements: Vec<_> = (0..triangles.corners.len())
            .map(|index| Element::new(&triangles, index))
            .filter(|element| element.area > 0.0)
            .collect();
        let total: f64 = polyhedron.half_edges.iter().map(|edge| edge.length).sum();
        let mean = total / polyhedron.half_edges.len() as f64;
        let count = polyhedron.mesh.vertices().len();
        let regular = REGULAR / polyhedron.radius.powi(2);
        Ok(Self {
            heat: factorise(count, &elements, 1.0, smoothing * mean * mean)?,
            laplace: factorise(count, &elements, regular, 1.0)?,
            elements,
        })
    }

    /// Fills `phi` with the distances (m) of all vertices from a point; 0 there.
    ///
    /// Crane et al., algorithm 1: heat flows for a short time, its gradient gives the direction to the
    /// source, and the function with those unit gradients is the distance.
    pub fn distances(&self, fine: &Fine, from: &FinePoint, phi: &mut Vec<f64>, divergence: &mut Vec<f64>) {
        let mesh = &fine.polyhedron.mesh;
        let corners = &mesh.facets()[from.facet as usize];
        for values in [&mut *phi, &mut *divergence] {
            values.clear();
            values.resize(mesh.vertices().len(), 0.0);
        }
        for (&vertex, weight) in corners.iter().zip(from.weights) {
            phi[vertex as usize] = weight;
        }
        solve(&self.heat, phi);
        for element in &self.elements {
            let slope = element.slope(phi);
            let norm = planar_norm(slope[0], slope[1]);
            // Where no heat came there is no direction.
            if norm > 0.0 {
                for (&vertex, hat) in element.corners.iter().zip(element.hats) {
                    divergence[vertex as usize] -=
                        element.area * (hat[0] * slope[0] + hat[1] * slope[1]) / norm;
                }
            }
        }
        solve(&self.laplace, divergence);
        std::mem::swap(phi, divergence);
        let here: f64 =
            corners.iter().zip(from.weights).map(|(&vertex, weight)| phi[vertex as usize] * weight).sum();
        phi.iter_mut().for_each(|value| *value -= here);
    }
}

/// The gradient of values at the vertices in a facet of the fine mesh.
pub(super) fn gradient(fine: &Fine, facet: u32, values: &[f64]) -> Vec3 {
    let (mesh, n) = (&fine.polyhedron.mesh, fine.polyhedron.mesh.normal(facet));
    let parts = (0..3).map(|k| {
        let opposite = &fine.polyhedron.half_edges[3 * facet as usize + (k + 1) % 3];
        n.cross(&opposite.along_O) * (values[mesh.facets()[facet as usize][k] as usize] / opposite.apex[1])
    });
    parts.sum()
}

/// Cholesky factors of `mass` M + `stiffness` L, with the lumped mass matrix M and the (cotangent) Laplacian
/// L.
fn factorise(
    count: usize,
    elements: &[Element],
    mass: f64,
    stiffness: f64,
) -> Result<Llt<usize, f64>, BuildError> {
    let mut entries = Vec::with_capacity(9 * elements.len());
    for Element { corners, area, hats } in elements {
        for i in 0..3 {
            for j in 0..3 {
                let lumped = if i == j { mass * area / 3.0 } else { 0.0 };
                let product = hats[i][0] * hats[j][0] + hats[i][1] * hats[j][1];
                let value = lumped + stiffness * area * product;
                entries.push(Triplet::new(corners[i] as usize, corners[j] as usize, value));
            }
        }
    }
    let failed = |reason: String| {
        BuildError::Unsupported(format!(
            "the mesh's Laplacian cannot be factorised ({reason}); use `surface/geodesic` or \
                `surface/steiner`"
        ))
    };
    let matrix = SparseColMat::<usize, f64>::try_new_from_triplets(count, count, &entries)
        .map_err(|error| failed(format!("{error:?}")))?;
    matrix.sp_cholesky(Side::Lower).map_err(|error| failed(format!("{error:?}")))
}

fn solve(factors: &Llt<usize, f64>, values: &mut [f64]) {
    factors.solve_in_place(faer::ColMut::from_slice_mut(values).as_mat_mut());
}
