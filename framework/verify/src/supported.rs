//! How far the object reaches in a direction, where each one asked about is hardly another than the last.

use crate::solid::{Solid, highest};
use regrasp_api::Vec3;

/// Within this of a direction (the length of the difference) the outermost vertex is one of those kept.
const WIDTH: f64 = 0.1;
/// Solids of more vertices have a tree that finds the outermost one faster.
const MOST_VERTICES: usize = 1000;

/// What is remembered of the last directions.
#[derive(Clone, Default)]
pub(crate) struct Supported {
    n_O: Vec3,
    support: f64,
    /// The vertices that can be outermost within [`WIDTH`] of a direction.
    about_O: Vec3,
    vertices: Vec<Vec3>,
}

impl Supported {
    /// The largest of `n_O · v` over the solid's vertices (m), which are at most `reach` from the origin, or
    /// an upper bound of it that is no more than `enough`.
    pub(crate) fn support(&mut self, solid: &Solid, n_O: &Vec3, reach: f64, enough: f64) -> f64 {
        // Turned by so much, no vertex rises by more than that times its distance.
        let loose = self.support + reach * (n_O - self.n_O).norm();
        if loose <= enough {
            return loose;
        }
        self.n_O = *n_O;
        self.support = match solid.vertices.len() {
            0..=MOST_VERTICES => self.of_few(solid, n_O, reach),
            _ => solid.support(n_O),
        };
        self.support
    }

    /// A vertex that is `2 · reach · WIDTH` below the outermost one in a direction is below it in every other
    /// within [`WIDTH`], too: both heights change by at most `reach` times the difference.
    fn of_few(&mut self, solid: &Solid, n_O: &Vec3, reach: f64) -> f64 {
        if self.vertices.is_empty() || (n_O - self.about_O).norm() > WIDTH {
            let least = solid.support(n_O) - 2.0 * reach * WIDTH * (1.0 + 1e-9);
            self.about_O = *n_O;
            self.vertices.clear();
            self.vertices.extend(solid.vertices.iter().filter(|v| n_O.dot(v) >= least));
        }
        highest(&self.vertices, n_O)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Mesh, Random};

    #[test]
    fn the_outermost_vertex_is_found_in_every_direction() {
        let mut random = Random::from_key(19, 0, 0, 0);
        let shape = serde_json::json!({ "kind": "ellipsoid", "semi_axes": [0.03, 0.02, 0.04] });
        let description = serde_json::json!({ "shape": shape, "mass": 0.1, "friction": 0.5 });
        let object = regrasp_world::load_object(&serde_json::from_value(description).unwrap()).unwrap();
        let mesh: &Mesh = &object.mesh;
        let (solid, reach) = (Solid::new(mesh), mesh.radius());
        let mut supported = Supported::default();
        let mut n = Vec3::z();
        for step in 0..3000 {
            let width = if step % 50 == 0 { 2.0 } else { 0.03 };
            n = (n + random.direction() * width * random.unit()).normalize();
            let exact = mesh.vertices().iter().map(|v| n.dot(v)).fold(f64::NEG_INFINITY, f64::max);
            let enough = if step % 3 == 0 { exact + 1e-3 } else { f64::NEG_INFINITY };
            let found = supported.support(&solid, &n, reach, enough);
            assert!(found >= exact && (found == exact || found <= enough), "{found} {exact}");
        }
    }
}
