//! Lower bounds of distances that cost little: at an instant by balls, boxes and planes, and over whole steps
//! by how little bodies bend from their straight way.

use crate::motion::Motions;
use crate::scene::{Scene, Solidity};
use crate::shape::Core;
use crate::solid::Gap;
use crate::supported::Supported;
use crate::touch::Touch;
use crate::track::Frames;
use nalgebra::Point3;
use regrasp_api::{Body, MAX_FINGERS, Pose, Vec3};

/// Where everything is at the samples of a step, and its contacts there.
#[derive(Clone, Copy)]
pub(crate) struct Samples<'f> {
    pub(crate) frames: &'f [Frames],
    pub(crate) touches: &'f [[Option<Touch>; MAX_FINGERS]],
}

/// What bounds are found with.
pub(crate) struct Bounds<'s> {
    scene: &'s Scene,
    /// How far the bodies move over the step.
    pub(crate) motions: Motions,
    /// For each pair of object and segment what the two planes between them were put up by.
    supports: Vec<[Supported; 2]>,
}

impl<'s> Bounds<'s> {
    pub(crate) fn new(scene: &'s Scene) -> Self {
        let supports = (0..scene.pairs.len()).map(|_| Default::default()).collect();
        Self { scene, motions: Motions::new(scene), supports }
    }

    /// A lower bound of a pair's distance (m) from balls around both, or the box that one of them is.
    pub(crate) fn balls(&self, pair: usize, frames: &Frames) -> f64 {
        let (a, b) = self.scene.pairs[pair];
        let (first, second) = (&self.scene.bodies[a], &self.scene.bodies[b]);
        let (X_HA, X_HB) = (self.scene.pose(a, frames), self.scene.pose(b, frames));
        match (first.ball, second.ball) {
            (Some((p, r)), Some((q, s))) => {
                let [p, q] = [(X_HA, p), (X_HB, q)].map(|(X, p)| (X * Point3::from(p)).coords);
                let balls = (p - q).norm() - r - s;
                balls.max(first.core.box_to(X_HA, &q) - s).max(second.core.box_to(X_HB, &p) - r)
            }
            _ => f64::NEG_INFINITY,
        }
    }

    /// The same of a rod and a ball around the other body; minus infinity where neither is a rod. For a round
    /// object it is nearly the distance itself.
    pub(crate) fn rods(&self, pair: usize, frames: &Frames) -> f64 {
        let (a, b) = self.scene.pairs[pair];
        let (first, second) = (&self.scene.bodies[a], &self.scene.bodies[b]);
        let (X_HA, X_HB) = (self.scene.pose(a, frames), self.scene.pose(b, frames));
        let bound = |(ball, X_HBall): (Option<(Vec3, f64)>, &Pose), (rod, X_HRod): (&Solidity, &Pose)| {
            let (Some((p, r)), Core::Segment(..)) = (ball, &rod.core) else { return f64::NEG_INFINITY };
            let p_H = (X_HBall * Point3::from(p)).coords;
            rod.core.rod_to(X_HRod, &p_H) - rod.radius - r
        };
        bound((first.ball, X_HA), (second, X_HB)).max(bound((second.ball, X_HB), (first, X_HA)))
    }

    /// The same at two samples and all the time between, of a box that does not move, and a rod or a ball: by
    /// what does not bend between samples, and how far the rod may be from its straight way. Minus infinity
    /// for others.
    pub(crate) fn boxes(&self, pair: usize, (from, to): (usize, usize), seen: Samples<'_>) -> f64 {
        let (a, b) = self.scene.pairs[pair];
        let is_box = |body: usize| matches!(self.scene.bodies[body].core, Core::Cuboid { .. });
        let (fixed, rod) = if is_box(a) { (a, b) } else { (b, a) };
        let (first, second) = (&self.scene.bodies[fixed], &self.scene.bodies[rod]);
        let is_fixed = matches!(first.body, Body::Palm | Body::Obstacle(_));
        let Some(ends) = second.core.ends().filter(|_| from == to || is_fixed) else {
            return f64::NEG_INFINITY;
        };
        let at = |sample: usize| {
            let X_HR = self.scene.pose(rod, &seen.frames[sample]);
            ends.map(|end| (X_HR * Point3::from(end)).coords)
        };
        let ([p, q], [u, v]) = (at(to), if from == to { at(to) } else { at(from) });
        let play = self.motions.play(rod, to - from);
        let X_HB = self.scene.pose(fixed, &seen.frames[to]);
        first.core.box_to_points(X_HB, &[p, q, u, v], play) - first.radius - second.radius
    }

    /// The same of object and segment: by planes across the normal where the finger touches, and across the
    /// direction in which they were closest, which rest in the object.
    pub(crate) fn planes(
        &mut self,
        (pair, nearest): (usize, &Gap),
        (from, to): (usize, usize),
        seen: Samples<'_>,
        floor: f64,
    ) -> f64 {
        let (_, b) = self.scene.pairs[pair];
        let second = &self.scene.bodies[b];
        let ends = |motions: &mut Motions, at: usize| motions.ends(self.scene, b, at, seen.frames);
        let (Some([p, q]), Some(before)) = (ends(&mut self.motions, to), ends(&mut self.motions, from))
        else {
            return f64::NEG_INFINITY;
        };
        let play = self.motions.play_seen(b, &before, to - from);
        let touch = match second.body {
            Body::Link(finger, _) => seen.touches[to][finger.index()].map(|touch| touch.n_O),
            _ => None,
        };
        let mut bound = f64::NEG_INFINITY;
        let nearest = Some(nearest.direction).filter(|n| *n != Vec3::zeros());
        for (k, n) in [touch, nearest].into_iter().enumerate() {
            let Some(n) = n else { continue };
            let lowest = [p, q, before[0], before[1]].map(|end| end.dot(&n)).into_iter();
            let above = lowest.fold(f64::INFINITY, f64::min) - play - second.radius;
            let (object, reach) = (&self.scene.object, self.scene.object_reach);
            let support = self.supports[pair][k].support(object, &n, reach, above - floor);
            bound = bound.max(above - support);
            if bound > floor {
                break;
            }
        }
        bound
    }
}
