//! What a fingertip's ball that touches a twin feels of the true mesh.

use super::places::{on_facet, places};
use crate::clearance::{Field, MeshSolid};
use regrasp_api::{Mesh, Vec3};
use std::sync::Arc;

/// Places of the ball that are looked at are at most this far apart, in radii ...
const SPACING: f64 = 0.08;
/// ... or as many as this over the whole surface.
const MOST_PLACES: f64 = 60_000.0;
/// How deep (m) the ball may sink into the twin itself at a place that counts as one where it can be.
const SINK: f64 = 1e-6;
/// What may lie between the places (m), added to the bound that was found ...
const BETWEEN: f64 = 5e-6;
/// ... and in dents, as a part of the tolerance: there a ball rolls along where two facets hold it, and feels
/// what no place on one of them tells.
const BETWEEN_IN_DENTS: f64 = 0.2;
/// Facets on which a gap or depth this near (m) to the largest was found are looked at more closely ...
const CLOSE: f64 = 4e-5;
/// ... at places so many times nearer to each other: in a dent the ball lies deepest just beside the edge.
const CLOSER: f64 = 4.0;

/// The true mesh, and a ball.
pub(super) struct Touch {
    solid: Arc<MeshSolid>,
    pub radius: f64,
}

impl Touch {
    pub fn new(mesh: &Mesh, radius: f64) -> Self {
        Self { solid: Arc::new(MeshSolid::new(mesh)), radius }
    }

    /// How far (m) the ball is from the mesh that touches a twin at `p` with the outward normal `n`; negative
    /// where it enters the mesh.
    pub fn gap(&self, p: &Vec3, n: &Vec3) -> f64 {
        let center = p + n * self.radius;
        self.solid.signed_distance_within(&center, 1.05 * self.radius) - self.radius
    }

    /// Bounds of the distance from the mesh wherever the centre of a ball that touches it can be.
    pub fn field(&self) -> Field {
        Field::new(self.solid.clone(), 1.5 * self.radius)
    }

    /// The signed distance (m) of a point from the mesh, which is likely to be small.
    pub fn height(&self, p: &Vec3) -> f64 {
        self.solid.signed_distance_within(p, 0.1 * self.radius)
    }

    /// The largest gap, or depth, of the ball over all places where it touches `twin` and enters it nowhere
    /// (m); `None` where it is more than `most`.
    pub fn bound(&self, twin: &Mesh, most: f64) -> Option<f64> {
        let (above, below) = self.range(twin, most)?;
        let found = above.max(below);
        let between = if twin.is_locally_convex() { BETWEEN } else { BETWEEN_IN_DENTS * most };
        (found + between <= most).then_some(found + between)
    }

    /// How far (m) the ball is from the mesh at most, and how deep it enters it, over all places where it
    /// touches `twin` and enters it nowhere; `None` where either is more than `most`.
    pub fn range(&self, twin: &Mesh, most: f64) -> Option<(f64, f64)> {
        let own = (!twin.is_locally_convex()).then(|| MeshSolid::new(twin));
        let area: f64 = (0..twin.facets().len() as u32).map(|facet| twin.area(facet)).sum();
        let spacing = (SPACING * self.radius).max((area / MOST_PLACES).sqrt());
        let deepest = vec![0.0; twin.facets().len()];
        let mut range = Range { touch: self, own, most, above: 0.0, below: 0.0, deepest };
        places(twin, self.radius, spacing, &mut |facet, p, n| range.visit(facet, p, n));
        for facet in range.close() {
            let n = twin.normal(facet);
            on_facet(twin.corners(facet), spacing / CLOSER, |p| range.visit(facet, p, &n));
        }
        range.is_within().then_some((range.above, range.below))
    }
}

/// What a ball feels at the places looked at so far.
struct Range<'t> {
    touch: &'t Touch,
    /// The twin itself, where a ball on it may enter it elsewhere.
    own: Option<MeshSolid>,
    /// No more is looked at beyond this (m).
    most: f64,
    above: f64,
    below: f64,
    /// The largest gap or depth on each facet (m), whether the ball can be there or not.
    deepest: Vec<f64>,
}

impl Range<'_> {
    fn is_within(&self) -> bool {
        f64::max(self.above, self.below) <= self.most
    }

    fn visit(&mut self, facet: u32, p: &Vec3, n: &Vec3) {
        if !self.is_within() {
            return;
        }
        let gap = self.touch.gap(p, n);
        let deep = &mut self.deepest[facet as usize];
        *deep = deep.max(gap.abs());
        if (gap > self.above || -gap > self.below) && self.is_free(p, n) {
            self.above = self.above.max(gap);
            self.below = self.below.max(-gap);
        }
    }

    /// Whether the ball enters the twin nowhere.
    fn is_free(&self, p: &Vec3, n: &Vec3) -> bool {
        let Some(own) = &self.own else { return true };
        let radius = self.touch.radius;
        own.signed_distance_within(&(p + n * radius), 1.01 * radius) >= radius - SINK
    }

    /// The facets of a twin with dents on which more may be found than was.
    fn close(&self) -> Vec<u32> {
        let least = self.above.max(self.below) - CLOSE;
        let facets = 0..if self.own.is_some() { self.deepest.len() as u32 } else { 0 };
        facets.filter(|&facet| self.deepest[facet as usize] > least).collect()
    }
}
