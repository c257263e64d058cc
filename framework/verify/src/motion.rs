//! How far bodies move at most over a step: in the hand's frame, and as seen from the object.

use crate::scene::Scene;
use crate::shape::Core;
use crate::track::{Frames, Leg, SAMPLES};
use nalgebra::Point3;
use regrasp_api::{Body, Vec3, angle_between};

/// The motions of all bodies over one step.
///
/// A pair of bodies nears by no more than both move in sum, in whatever frame. While a hand turns an object,
/// links and object move a lot, and hardly at all against each other.
pub(crate) struct Motions {
    /// How far any point of a body moves at most from sample to sample (m).
    in_hand: Vec<f64>,
    /// How far the joints before a body turn in sum from sample to sample (rad).
    turning: Vec<f64>,
    /// The same as seen from the object, where it was asked for in this step.
    from_object: Vec<Option<[f64; SAMPLES]>>,
    /// How far each joint moves from sample to sample (rad; m).
    steps: Vec<f64>,
    /// How far the object turns (rad) and shifts (m) from sample to sample.
    turn: f64,
    shift: f64,
}

impl Motions {
    pub(crate) fn new(scene: &Scene) -> Self {
        let count = scene.bodies.len();
        let nothing = vec![0.0; count];
        let (turning, from_object) = (nothing.clone(), vec![None; count]);
        Self { in_hand: nothing, turning, from_object, steps: Vec::new(), turn: 0.0, shift: 0.0 }
    }

    /// Begins the step after a state.
    pub(crate) fn step(&mut self, scene: &Scene, leg: &Leg<'_>, state: usize) {
        let (from, to) = (&leg.states[state].X_HO, &leg.states[state + 1].X_HO);
        self.turn = angle_between(&from.rotation, &to.rotation) / SAMPLES as f64;
        self.shift = (to.translation.vector - from.translation.vector).norm() / SAMPLES as f64;
        let steps = leg.joint_steps(state).map(|step| step / SAMPLES as f64);
        self.steps.clear();
        self.steps.extend(steps);
        for (body, this) in scene.bodies.iter().enumerate() {
            (self.in_hand[body], self.turning[body]) = match this.body {
                Body::Object => (self.shift + self.turn * scene.object_reach, self.turn),
                _ => this.motion(&self.steps),
            };
        }
        self.from_object.fill(None);
    }

    /// How far two bodies move in sum from one sample to the next (m), at an even speed or below it.
    pub(crate) fn of_pair(&self, (a, b): (usize, usize)) -> f64 {
        self.in_hand[a] + self.in_hand[b]
    }

    /// The same for the samples before `sample` and this one, or less, as seen from the object.
    pub(crate) fn of_pair_seen(
        &mut self,
        scene: &Scene,
        (a, b): (usize, usize),
        sample: usize,
        frames: &[Frames],
    ) -> f64 {
        let in_hand = self.of_pair((a, b));
        if self.turn == 0.0 && self.shift == 0.0 {
            return in_hand;
        }
        let seen = self.seen(scene, a, frames)[sample - 1] + self.seen(scene, b, frames)[sample - 1];
        in_hand.min(seen)
    }

    /// How far any point of a body moves at most as seen from the object, from each sample to the next (m);
    /// infinite for what is no point, segment or the object itself.
    fn seen(&mut self, scene: &Scene, body: usize, frames: &[Frames]) -> &[f64; SAMPLES] {
        if self.from_object[body].is_none() {
            self.from_object[body] = Some(self.look(scene, body, frames));
        }
        self.from_object[body].as_ref().expect("it was just looked at")
    }

    /// A point's path r in O is no chord: its length is at most the chord's plus half of the largest |r''|
    /// (time in samples). With r = Rᵀ (p - x), the object turning at an even ω and shifting at an even x',
    /// |r''| ≤ |p''| + 2 ω |p' - x'| + ω² |p - x|. And of a chain whose joints move at even rates and turn by
    /// w in sum, |p''| ≤ 3 w |p'|: axes and arms each turn with what is before them. Points between the ends
    /// of a segment move no farther than these.
    fn look(&self, scene: &Scene, body: usize, frames: &[Frames]) -> [f64; SAMPLES] {
        let ends = match &scene.bodies[body].core {
            _ if scene.bodies[body].body == Body::Object => return [0.0; SAMPLES],
            Core::Point(p) => [*p, *p],
            Core::Segment(p, q) => [*p, *q],
            _ => return [f64::INFINITY; SAMPLES],
        };
        let (speed, turn) = (self.in_hand[body], self.turn);
        let relative = speed + self.shift;
        let at = |sample: usize| {
            let X_OB = frames[sample].X_HO.inv_mul(scene.pose(body, &frames[sample]));
            ends.map(|end| (X_OB * Point3::from(end)).coords)
        };
        let mut before = at(0);
        std::array::from_fn(|k| {
            let after = at(k + 1);
            let longest = |f: &dyn Fn(usize) -> Vec3| f(0).norm().max(f(1).norm());
            let chord = longest(&|end| after[end] - before[end]);
            let far = longest(&|end| before[end]) + relative;
            let bend = 3.0 * self.turning[body] * speed + 2.0 * turn * relative + turn * turn * far;
            before = after;
            chord + bend / 2.0
        })
    }
}
