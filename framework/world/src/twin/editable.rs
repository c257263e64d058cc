//! A closed mesh whose edges can be turned over and whose vertices can be merged.

use regrasp_api::{Mesh, Vec3};

/// A height below this part of the longest edge makes a sliver.
const THINNEST: f64 = 1e-4;

/// Vertices, facets, and the facets round each vertex. What was removed leaves a gap that [`Editable::mesh`]
/// closes.
pub(super) struct Editable {
    pub vertices: Vec<Vec3>,
    pub facets: Vec<Option<[u32; 3]>>,
    /// The facets at each vertex; empty for vertices that were removed.
    pub stars: Vec<Vec<u32>>,
}

impl Editable {
    pub fn new(mesh: &Mesh) -> Self {
        let mut stars = vec![Vec::new(); mesh.vertices().len()];
        for (index, facet) in mesh.facets().iter().enumerate() {
            facet.iter().for_each(|&vertex| stars[vertex as usize].push(index as u32));
        }
        let facets = mesh.facets().iter().copied().map(Some).collect();
        Self { vertices: mesh.vertices().to_vec(), facets, stars }
    }

    /// What is left as a mesh; `None` if that is no closed, outward mesh.
    pub fn mesh(&self) -> Option<Mesh> {
        let mut place = vec![u32::MAX; self.vertices.len()];
        let mut vertices = Vec::new();
        let mut facets = Vec::new();
        for facet in self.facets.iter().flatten() {
            facets.push(facet.map(|vertex| {
                let place = &mut place[vertex as usize];
                if *place == u32::MAX {
                    *place = vertices.len() as u32;
                    vertices.push(self.vertices[vertex as usize]);
                }
                *place
            }));
        }
        Mesh::new(vertices, facets).ok()
    }

    pub fn point(&self, vertex: u32) -> Vec3 {
        self.vertices[vertex as usize]
    }

    /// Facets that hold all of some vertices.
    pub fn facets_with<'a>(&'a self, vertex: u32, other: u32) -> impl Iterator<Item = u32> + 'a {
        self.stars[vertex as usize].iter().copied().filter(move |&facet| self.corners(facet).contains(&other))
    }

    pub fn corners(&self, facet: u32) -> [u32; 3] {
        self.facets[facet as usize].unwrap_or([u32::MAX; 3])
    }

    /// The vertices that share an edge with one, each once, in the order of their numbers.
    pub fn around(&self, vertex: u32) -> Vec<u32> {
        let corners = self.stars[vertex as usize].iter().flat_map(|&facet| self.corners(facet));
        let mut around: Vec<u32> = corners.filter(|&other| other != vertex).collect();
        around.sort_unstable();
        around.dedup();
        around
    }

    /// The facet whose boundary runs from `a` to `b`, and its third corner.
    pub fn beside(&self, a: u32, b: u32) -> Option<(u32, u32)> {
        self.stars[a as usize].iter().find_map(|&facet| {
            let c = self.corners(facet);
            let k = (0..3).find(|&k| c[k] == a && c[(k + 1) % 3] == b)?;
            Some((facet, c[(k + 2) % 3]))
        })
    }

    pub fn remove(&mut self, facet: u32) {
        for vertex in self.corners(facet) {
            self.stars[vertex as usize].retain(|&other| other != facet);
        }
        self.facets[facet as usize] = None;
    }

    pub fn put(&mut self, facet: u32, corners: [u32; 3]) {
        self.facets[facet as usize] = Some(corners);
        corners.iter().for_each(|&vertex| self.stars[vertex as usize].push(facet));
    }

    /// The unit normal of a triangle; `None` for a sliver.
    pub fn normal(&self, corners: [u32; 3]) -> Option<Vec3> {
        unit_normal(corners.map(|vertex| self.point(vertex)))
    }
}

/// The unit normal of a triangle; `None` for a sliver.
pub(super) fn unit_normal([a, b, c]: [Vec3; 3]) -> Option<Vec3> {
    let cross = (b - a).cross(&(c - a));
    let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    (cross.norm() > THINNEST * longest).then(|| cross.normalize())
}
