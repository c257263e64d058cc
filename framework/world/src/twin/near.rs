//! Whether points are near a mesh: asked millions of times with one tolerance, so answered by a grid.

use regrasp_api::{Mesh, Vec3};

/// Cells along the mesh's longest side, at most.
const MOST_CELLS: f64 = 128.0;

/// The facets of a mesh by the cells of a grid in which something is near them.
pub(super) struct Near<'m> {
    mesh: &'m Mesh,
    tolerance: f64,
    grid: Grid,
    /// Where each cell's facets begin in `facets`; one entry more than there are cells.
    begins: Vec<u32>,
    facets: Vec<u32>,
}

/// The cells of a box.
struct Grid {
    low: Vec3,
    /// Edge of a cell (m).
    cell: f64,
    counts: [usize; 3],
}

impl<'m> Near<'m> {
    /// For points at most `tolerance` (m) from the mesh.
    pub fn new(mesh: &'m Mesh, tolerance: f64) -> Self {
        let grid = Grid::around(mesh, tolerance);
        let all = 0..mesh.facets().len() as u32;
        let mut begins = vec![0; grid.counts.iter().product::<usize>() + 1];
        all.clone().for_each(|facet| grid.near(mesh, facet, tolerance, |cell| begins[cell + 1] += 1));
        for cell in 1..begins.len() {
            begins[cell] += begins[cell - 1];
        }
        let mut facets = vec![0; *begins.last().unwrap_or(&0) as usize];
        let mut next = begins.clone();
        all.for_each(|facet| {
            grid.near(mesh, facet, tolerance, |cell| {
                facets[next[cell] as usize] = facet;
                next[cell] += 1;
            });
        });
        Self { mesh, tolerance, grid, begins, facets }
    }

    /// Whether some facet is at most as far from `p` as the tolerance.
    pub fn has(&self, p: &Vec3) -> bool {
        let Some(cell) = self.grid.cell_of(p) else { return false };
        let there = &self.facets[self.begins[cell] as usize..self.begins[cell + 1] as usize];
        let most = self.tolerance * self.tolerance;
        there.iter().any(|&facet| squared_distance(p, self.mesh.corners(facet)) <= most)
    }
}

impl Grid {
    fn around(mesh: &Mesh, tolerance: f64) -> Self {
        let low = mesh.vertices().iter().copied().reduce(|a, b| a.inf(&b)).unwrap_or_default();
        let high = mesh.vertices().iter().copied().reduce(|a, b| a.sup(&b)).unwrap_or_default();
        let cell = ((high - low).max() / MOST_CELLS).max(2.0 * tolerance);
        // A cell to spare on each side: more than the tolerance.
        let low = low - Vec3::repeat(cell);
        let counts = [0, 1, 2].map(|axis| ((high[axis] - low[axis]) / cell) as usize + 2);
        Self { low, cell, counts }
    }

    fn index(&self, p: &Vec3) -> [i64; 3] {
        [0, 1, 2].map(|axis| ((p[axis] - self.low[axis]) / self.cell).floor() as i64)
    }

    fn cell_of(&self, p: &Vec3) -> Option<usize> {
        let index = self.index(p);
        let inside = index.iter().zip(&self.counts).all(|(&i, &count)| i >= 0 && i < count as i64);
        inside.then(|| self.number(index))
    }

    fn number(&self, [i, j, k]: [i64; 3]) -> usize {
        (i as usize * self.counts[1] + j as usize) * self.counts[2] + k as usize
    }

    /// Calls `visit` with each cell that may hold a point near the facet: column by column along the axis
    /// that crosses its plane most steeply.
    fn near(&self, mesh: &Mesh, facet: u32, tolerance: f64, mut visit: impl FnMut(usize)) {
        let (corners, n) = (mesh.corners(facet), mesh.normal(facet));
        let margin = Vec3::repeat(tolerance);
        let from = self.index(&(corners[0].inf(&corners[1]).inf(&corners[2]) - margin));
        let to = self.index(&(corners[0].sup(&corners[1]).sup(&corners[2]) + margin));
        let up = n.iamax();
        let [a, b] = [(up + 1) % 3, (up + 2) % 3];
        let middle = |axis: usize, i: i64| self.low[axis] + (i as f64 + 0.5) * self.cell;
        // Within a column the plane rises by at most one cell to either side, as its normal's other parts are
        // no larger; points that are near it lie within √3 tolerances of it along the column.
        let reach = self.cell + 1.8 * tolerance;
        for i in from[a]..=to[a] {
            for j in from[b]..=to[b] {
                let off = n[a] * (middle(a, i) - corners[0][a]) + n[b] * (middle(b, j) - corners[0][b]);
                let height = corners[0][up] - off / n[up] - self.low[up];
                let low = ((height - reach) / self.cell).floor() as i64;
                let high = ((height + reach) / self.cell).floor() as i64;
                for k in low.max(from[up])..=high.min(to[up]) {
                    let mut index = [0; 3];
                    (index[a], index[b], index[up]) = (i, j, k);
                    visit(self.number(index));
                }
            }
        }
    }
}

/// The squared distance of a point from a triangle.
///
/// By the region of the plane in which the point lies: C. Ericson, "Real-Time Collision Detection", Morgan
/// Kaufmann 2005, section 5.1.5.
fn squared_distance(p: &Vec3, [a, b, c]: [Vec3; 3]) -> f64 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ap.norm_squared();
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return bp.norm_squared();
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return (ap - ab * (d1 / (d1 - d3))).norm_squared();
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return cp.norm_squared();
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return (ap - ac * (d2 / (d2 - d6))).norm_squared();
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return (bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)))).norm_squared();
    }
    let sum = va + vb + vc;
    (ap - ab * (vb / sum) - ac * (vc / sum)).norm_squared()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::clearance::MeshSolid;
    use crate::primitive_mesh;
    use regrasp_api::{Primitive, Random};

    #[test]
    fn the_grid_says_what_distances_say() {
        let mut random = Random::from_key(5, 0, 0, 0);
        let shapes = [
            Primitive::Cuboid { half_size: Vec3::new(0.025, 0.015, 0.001) },
            Primitive::Torus { ring_radius: 0.03, tube_radius: 0.01 },
        ];
        for (shape, tolerance) in shapes.iter().flat_map(|shape| [(shape, 1e-4), (shape, 2e-3)]) {
            let mesh = primitive_mesh(shape, 300).unwrap();
            let (near, solid) = (Near::new(&mesh, tolerance), MeshSolid::new(&mesh));
            let mut found = 0;
            for _ in 0..20_000 {
                let facet = random.index(mesh.facets().len()) as u32;
                let [a, b, c] = mesh.corners(facet);
                let (u, v) = (random.unit(), random.unit());
                let on = a + (b - a) * u + (c - a) * v;
                let p = on + Vec3::from_fn(|_, _| random.range(-2.0, 2.0) * tolerance);
                let is_near = solid.signed_distance_within(&p, 1.0).abs() <= tolerance;
                assert_eq!(near.has(&p), is_near, "{shape:?} {p}");
                found += u32::from(is_near);
            }
            assert!((2_000..18_000).contains(&found), "{found}");
        }
    }
}
