//! Closed triangle meshes with their topology.

mod sides;

use crate::{Mat3, Vec3};
use sides::{Sides, ends};
use thiserror::Error;

/// A closed, oriented, manifold triangle mesh with outward normals.
///
/// Edge `k` of a facet runs from its vertex `k` to its vertex `(k + 1) % 3`.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    vertices: Vec<Vec3>,
    facets: Vec<[u32; 3]>,
    normals: Vec<Vec3>,
    neighbors: Vec<[Neighbor; 3]>,
}

/// What lies across an edge of a facet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The facet on the other side.
    pub facet: u32,
    /// Which of its edges is shared.
    pub edge: u8,
    /// The angle from this facet's normal to the neighbour's (rad), in [-π, π]: positive at a convex edge.
    pub bend: f64,
}

/// Why a mesh is refused.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum MeshError {
    /// No facets.
    #[error("the mesh has no facets")]
    Empty,
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// Which vertex, counted from 0.
        vertex: usize,
    },
    /// A facet names a vertex that does not exist.
    #[error("facet {facet} names vertex {vertex}, but there are only {count}")]
    NoSuchVertex {
        /// Which facet, counted from 0.
        facet: usize,
        /// The vertex that it names.
        vertex: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// A facet without area.
    #[error("facet {facet} has no area (vertices {vertices:?}); remove it or merge its vertices")]
    ZeroArea {
        /// Which facet, counted from 0.
        facet: usize,
        /// Its vertices.
        vertices: [u32; 3],
    },
    /// Edges with one facet only.
    #[error(
        "the mesh is not closed: {count} edges have one facet only, the first from {from:.5?} to {to:.5?}; \
         fill the holes"
    )]
    Open {
        /// How many edges are open.
        count: usize,
        /// Start of the first open edge (m).
        from: [f64; 3],
        /// End of the first open edge (m).
        to: [f64; 3],
    },
    /// A vertex lies on an open edge.
    #[error(
        "the mesh is not closed: the vertex at {vertex:.5?} lies on the edge from {from:.5?} to {to:.5?} \
         and splits it on one side only (a T-junction); split the facet on the other side there, too"
    )]
    TJunction {
        /// The vertex (m).
        vertex: [f64; 3],
        /// Start of the open edge (m).
        from: [f64; 3],
        /// Its end (m).
        to: [f64; 3],
    },
    /// Two vertices that nearly meet.
    #[error(
        "the mesh is not closed: the vertices at {a:.6?} and {b:.6?} are {apart:.1e} m apart and not one; \
         merge vertices that are so near"
    )]
    Seam {
        /// One vertex (m).
        a: [f64; 3],
        /// The other (m).
        b: [f64; 3],
        /// Their distance (m).
        apart: f64,
    },
    /// Two facets with the same corners.
    #[error(
        "facets {first} and {second} have the same corners, near {at:.5?}; remove one of them, or both if \
         they form a wall without thickness"
    )]
    Duplicated {
        /// One facet, counted from 0.
        first: usize,
        /// The other.
        second: usize,
        /// Where they are (m).
        at: [f64; 3],
    },
    /// An edge with more than two facets, or two facets of opposite orientation.
    #[error(
        "the edge from {from:.5?} to {to:.5?} belongs to more than two facets or to facets of opposite \
         orientation; orient and repair the mesh"
    )]
    NotManifold {
        /// Start of the edge (m).
        from: [f64; 3],
        /// End of the edge (m).
        to: [f64; 3],
    },
    /// The normals point inward.
    #[error(
        "the mesh is inside out (volume {volume:.3e} m³); set `flip = true` or reverse the order of each \
         facet's vertices"
    )]
    InsideOut {
        /// The signed volume (m³).
        volume: f64,
    },
}

/// Volume, centre of mass and inertia of a solid of density 1 kg/m³.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Volume (m³), which at this density is the mass (kg).
    pub volume: f64,
    /// Centre of mass Cm in the mesh's frame (m).
    pub p_OCm: Vec3,
    /// Inertia about the centre of mass, in the mesh's frame (kg·m²).
    pub inertia_OCm: Mat3,
}

impl Mesh {
    /// Builds the topology of `vertices` (m, in the object's frame) and refuses what is not a closed,
    /// outward, manifold mesh.
    pub fn new(vertices: Vec<Vec3>, facets: Vec<[u32; 3]>) -> Result<Self, MeshError> {
        check_indices(&vertices, &facets)?;
        let normals = normals(&vertices, &facets)?;
        let neighbors = neighbors(&vertices, &facets, &normals)?;
        let mesh = Self { vertices, facets, normals, neighbors };
        let volume = mesh.mass_properties().volume;
        if volume > 0.0 { Ok(mesh) } else { Err(MeshError::InsideOut { volume }) }
    }

    /// The vertices (m).
    pub fn vertices(&self) -> &[Vec3] {
        &self.vertices
    }

    /// The facets, as counter-clockwise indices of vertices seen from outside.
    pub fn facets(&self) -> &[[u32; 3]] {
        &self.facets
    }

    /// The corners of a facet (m).
    pub fn corners(&self, facet: u32) -> [Vec3; 3] {
        self.facets[facet as usize].map(|vertex| self.vertices[vertex as usize])
    }

    /// The outward unit normal of a facet.
    pub fn normal(&self, facet: u32) -> Vec3 {
        self.normals[facet as usize]
    }

    /// What lies across the three edges of a facet.
    pub fn neighbors(&self, facet: u32) -> &[Neighbor; 3] {
        &self.neighbors[facet as usize]
    }

    /// The area of a facet (m²).
    pub fn area(&self, facet: u32) -> f64 {
        let [a, b, c] = self.corners(facet);
        (b - a).cross(&(c - a)).norm() / 2.0
    }

    /// Whether no edge is concave by more than rounding (1e-9 rad) and every vertex lies below every facet's
    /// neighbour planes.
    pub fn is_locally_convex(&self) -> bool {
        self.neighbors.iter().flatten().all(|neighbor| neighbor.bend > -1e-9)
    }

    /// The largest distance of a vertex from the frame's origin (m).
    pub fn radius(&self) -> f64 {
        self.vertices.iter().map(|v| v.norm()).fold(0.0, f64::max)
    }

    /// Volume, centre of mass and inertia of the enclosed solid, exact up to rounding.
    ///
    /// Sum over the tetrahedra between the centroid of the vertices and each facet (Tonon, "Explicit exact
    /// formulas for the 3-D tetrahedron inertia tensor", J. Math. Stat. 2004).
    pub fn mass_properties(&self) -> MassProperties {
        let origin = self.vertices.iter().sum::<Vec3>() / self.vertices.len() as f64;
        let (mut volume, mut moment, mut second) = (0.0, Vec3::zeros(), Mat3::zeros());
        for facet in 0..self.facets.len() as u32 {
            let [a, b, c] = self.corners(facet).map(|corner| corner - origin);
            let v = a.dot(&b.cross(&c)) / 6.0;
            let sum = a + b + c;
            volume += v;
            moment += sum * (v / 4.0);
            // ∫ x xᵀ over the tetrahedron (0, a, b, c).
            second += (sum * sum.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose())
                * (v / 20.0);
        }
        let center = moment / volume;
        let central = second - center * center.transpose() * volume;
        MassProperties {
            volume,
            p_OCm: origin + center,
            inertia_OCm: Mat3::identity() * central.trace() - central,
        }
    }
}

fn check_indices(vertices: &[Vec3], facets: &[[u32; 3]]) -> Result<(), MeshError> {
    if facets.is_empty() {
        return Err(MeshError::Empty);
    }
    if let Some(vertex) = vertices.iter().position(|v| !v.iter().all(|x| x.is_finite())) {
        return Err(MeshError::NotFinite { vertex });
    }
    let count = vertices.len();
    for (facet, corners) in facets.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|&&vertex| vertex as usize >= count) {
            return Err(MeshError::NoSuchVertex { facet, vertex, count });
        }
    }
    Ok(())
}

fn normals(vertices: &[Vec3], facets: &[[u32; 3]]) -> Result<Vec<Vec3>, MeshError> {
    let normal = |(facet, corners): (usize, &[u32; 3])| {
        let [a, b, c] = corners.map(|vertex| vertices[vertex as usize]);
        let cross = (b - a).cross(&(c - a));
        let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        // A height below 1e-9 of the longest edge is rounding, not a facet.
        if cross.norm() > 1e-9 * longest * longest && longest > 0.0 {
            Ok(cross.normalize())
        } else {
            Err(MeshError::ZeroArea { facet, vertices: *corners })
        }
    };
    facets.iter().enumerate().map(normal).collect()
}

fn neighbors(
    vertices: &[Vec3],
    facets: &[[u32; 3]],
    normals: &[Vec3],
) -> Result<Vec<[Neighbor; 3]>, MeshError> {
    let end = |vertex: u32| -> [f64; 3] { vertices[vertex as usize].into() };
    let sides = Sides::new(vertices.len(), facets);
    if let Some(side) = sides.first_doubled() {
        let [from, to] = ends(facets, side);
        return Err(MeshError::NotManifold { from: end(from), to: end(to) });
    }
    let nobody = Neighbor { facet: u32::MAX, edge: 0, bend: 0.0 };
    let mut all = vec![[nobody; 3]; facets.len()];
    let mut open = Vec::new();
    for side in 0..3 * facets.len() as u32 {
        let [from, to] = ends(facets, side);
        let Some(across) = sides.find(to, from) else {
            open.push((from, to));
            continue;
        };
        let bend = match across > side {
            true => {
                let along = (vertices[to as usize] - vertices[from as usize]).normalize();
                let (n, m) = (normals[side as usize / 3], normals[across as usize / 3]);
                n.cross(&m).dot(&along).atan2(n.dot(&m))
            }
            // Seen from the other side both factors change their signs.
            false => all[across as usize / 3][across as usize % 3].bend,
        };
        let neighbor = Neighbor { facet: across / 3, edge: (across % 3) as u8, bend };
        all[side as usize / 3][side as usize % 3] = neighbor;
    }
    match open.first() {
        None => Ok(all),
        Some(&(from, to)) => Err(MeshError::Open { count: open.len(), from: end(from), to: end(to) }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A unit cube with its corner at the origin, outward.
    fn cube() -> (Vec<Vec3>, Vec<[u32; 3]>) {
        let vertices =
            (0..8).map(|i| Vec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64)).collect();
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let facets = quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect();
        (vertices, facets)
    }

    #[test]
    fn a_cube_has_its_mass_properties_and_right_angles() {
        let (vertices, facets) = cube();
        let mesh = Mesh::new(vertices, facets).unwrap();
        let mass = mesh.mass_properties();
        assert!((mass.volume - 1.0).abs() < 1e-12);
        assert!((mass.p_OCm - Vec3::repeat(0.5)).norm() < 1e-12);
        assert!((mass.inertia_OCm - Mat3::identity() / 6.0).norm() < 1e-12);
        assert!(mesh.is_locally_convex());
        let right =
            mesh.neighbors.iter().flatten().filter(|n| (n.bend - std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert_eq!(right.count(), 24);
    }

    #[test]
    fn damaged_meshes_are_refused_with_the_reason() {
        let (vertices, facets) = cube();
        let open = Mesh::new(vertices.clone(), facets[1..].to_vec());
        assert!(matches!(open, Err(MeshError::Open { count: 3, .. })), "{open:?}");
        let flipped: Vec<_> = facets.iter().map(|&[a, b, c]| [a, c, b]).collect();
        assert!(matches!(Mesh::new(vertices.clone(), flipped), Err(MeshError::InsideOut { .. })));
        let mut one_flipped = facets.clone();
        one_flipped[0].swap(1, 2);
        assert!(matches!(Mesh::new(vertices.clone(), one_flipped), Err(MeshError::NotManifold { .. })));
        let mut flat = facets.clone();
        flat[3] = [4, 4, 5];
        assert!(matches!(Mesh::new(vertices.clone(), flat), Err(MeshError::ZeroArea { facet: 3, .. })));
        let mut nan = vertices.clone();
        nan[2].x = f64::NAN;
        assert!(matches!(Mesh::new(nan, facets.clone()), Err(MeshError::NotFinite { vertex: 2 })));
        assert!(matches!(Mesh::new(vertices.clone(), vec![]), Err(MeshError::Empty)));
        assert!(matches!(
            Mesh::new(vertices, vec![[0, 1, 9]]),
            Err(MeshError::NoSuchVertex { vertex: 9, .. })
        ));
    }
}
