//! What a fingertip's ball that touches a twin feels of the true mesh.

use super::places::{of_facet, on_vertices, round_place};
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
/// Where a gap or depth this near (m) to the largest was found, it is looked round more closely ...
const CLOSE: f64 = 8e-5;
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
    /// where it enters the mesh. `near` is a facet of the mesh that is likely to be close, and becomes the
    /// closest.
    pub fn gap(&self, p: &Vec3, n: &Vec3, near: &mut u32) -> f64 {
        let center = p + n * self.radius;
        self.solid.signed_distance_near(&center, 1.05 * self.radius, near) - self.radius
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
        let mut range = Range::new(self, own.as_ref(), most);
        let facets: Vec<u32> = (0..twin.facets().len() as u32).collect();
        let found = range.visit_all(&facets, |range, &facet| {
            let mut found = Vec::new();
            of_facet(twin, facet, (self.radius, spacing), &mut |facet, p, n| {
                found.extend(range.look((facet, p, n), spacing));
            });
            found
        });
        let mut deep: Vec<Deep> = found.into_iter().flatten().collect();
        on_vertices(twin, &mut |facet, p, n| deep.extend(range.look((facet, p, n), spacing)));
        if range.own.is_some() {
            // In a dent more may be found than was.
            let least = range.above.max(range.below) - CLOSE;
            deep.retain(|place| place.depth > least);
            range.visit_all(&deep, |range, place| {
                round_place(twin, (place.facet, &place.p), (spacing, spacing / CLOSER), &mut |p, n| {
                    range.visit(p, n, 0.0);
                });
            });
        }
        range.is_within().then_some((range.above, range.below))
    }
}

/// A place of a ball on a facet, and how large gap or depth are there (m).
struct Deep {
    facet: u32,
    p: Vec3,
    depth: f64,
}

/// What a ball feels at the places looked at so far.
#[derive(Clone)]
struct Range<'t> {
    touch: &'t Touch,
    /// The twin itself, where a ball on it may enter it elsewhere.
    own: Option<&'t MeshSolid>,
    /// No more is looked at beyond this (m).
    most: f64,
    above: f64,
    below: f64,
    /// Facets of mesh and twin at the last place.
    near: (u32, u32),
}

impl<'t> Range<'t> {
    fn new(touch: &'t Touch, own: Option<&'t MeshSolid>, most: f64) -> Self {
        Self { touch, own, most, above: 0.0, below: 0.0, near: (0, 0) }
    }

    fn is_within(&self) -> bool {
        f64::max(self.above, self.below) <= self.most
    }

    /// Visits facets or places, by two threads; what is returned of each. The largest of all is the same in
    /// any order.
    fn visit_all<P: Sync, T: Send>(
        &mut self,
        places: &[P],
        visit: impl Fn(&mut Self, &P) -> T + Sync,
    ) -> Vec<T> {
        let (some, others) = places.split_at(places.len() / 2);
        let visit_part = |range: &mut Self, part: &[P]| -> Vec<T> {
            part.iter().map(|place| visit(range, place)).collect()
        };
        let mut other = self.clone();
        let (mut found, more) = std::thread::scope(|scope| {
            let there = scope.spawn(|| visit_part(&mut other, others));
            let here = visit_part(self, some);
            (here, there.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
        });
        found.extend(more);
        (self.above, self.below) = (self.above.max(other.above), self.below.max(other.below));
        found
    }

    /// [`Self::visit`]; the place if it is worth a closer look.
    fn look(&mut self, (facet, p, n): (u32, &Vec3, &Vec3), cell: f64) -> Option<Deep> {
        let depth = self.visit(p, n, cell);
        (depth > 0.0).then_some(Deep { facet, p: *p, depth })
    }

    /// Looks at a place; how large gap or depth are there (m), or 0 where no place within `cell` (m) can tell
    /// more than is known.
    fn visit(&mut self, p: &Vec3, n: &Vec3, cell: f64) -> f64 {
        if !self.is_within() {
            return 0.0;
        }
        let gap = self.touch.gap(p, n, &mut self.near.0);
        let is_more = gap > self.above || -gap > self.below;
        if !is_more && gap.abs() <= self.above.max(self.below) - CLOSE {
            return 0.0;
        }
        let room = self.room(p, n);
        if room >= -SINK {
            self.above = self.above.max(gap);
            self.below = self.below.max(-gap);
        }
        // Where the ball moves by as much as the cell, its room grows by no more.
        if room < -SINK - cell { 0.0 } else { gap.abs() }
    }

    /// How far (m) the ball is from the twin elsewhere, negative where it enters it.
    fn room(&mut self, p: &Vec3, n: &Vec3) -> f64 {
        let Some(own) = self.own else { return f64::INFINITY };
        let radius = self.touch.radius;
        own.signed_distance_near(&(p + n * radius), 1.01 * radius, &mut self.near.1) - radius
    }
}
