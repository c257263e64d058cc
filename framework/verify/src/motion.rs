//! How far bodies move at most over a step: in the hand's frame, and as seen from the object.

use crate::scene::Scene;
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
    /// The ends of each body's core in O at each sample, where they were asked for in this step (m).
    ends_O: Vec<[Option<[Vec3; 2]>; SAMPLES + 1]>,
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
        let (turning, ends_O) = (nothing.clone(), vec![[None; SAMPLES + 1]; count]);
        Self { in_hand: nothing, turning, ends_O, steps: Vec::new(), turn: 0.0, shift: 0.0 }
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
        self.ends_O.fill([None; SAMPLES + 1]);
    }

    /// How far two bodies move in sum from one sample to the next (m), at an even speed or below it.
    pub(crate) fn of_pair(&self, (a, b): (usize, usize)) -> f64 {
        self.in_hand[a] + self.in_hand[b]
    }

    /// The same from one sample to another of the step, or less, as seen from the object.
    pub(crate) fn of_pair_between(
        &mut self,
        scene: &Scene,
        (a, b): (usize, usize),
        (from, to): (usize, usize),
        frames: &[Frames],
    ) -> f64 {
        let in_hand = self.of_pair((a, b)) * (to - from) as f64;
        if self.turn == 0.0 && self.shift == 0.0 {
            return in_hand;
        }
        let seen = |motions: &mut Self, body: usize| motions.seen(scene, body, (from, to), frames);
        in_hand.min(seen(self, a) + seen(self, b))
    }

    /// How far any point of a body moves at most as seen from the object, from one sample to another (m);
    /// infinite for what is no point, segment or the object itself.
    ///
    /// A point's path r in O is no chord: its length is at most the chord's plus half of the largest |r''|
    /// (times the duration squared). Points between the ends of a segment move no farther than these.
    fn seen(&mut self, scene: &Scene, body: usize, (from, to): (usize, usize), frames: &[Frames]) -> f64 {
        if scene.bodies[body].body == Body::Object {
            return 0.0;
        }
        let (Some(before), Some(after)) =
            (self.ends(scene, body, from, frames), self.ends(scene, body, to, frames))
        else {
            return f64::INFINITY;
        };
        let duration = (to - from) as f64;
        let chord = (after[0] - before[0]).norm().max((after[1] - before[1]).norm());
        chord + self.bend_seen(body, &before, duration) * duration * duration / 2.0
    }

    /// The largest |r''| of the ends of a body as seen from the object, which are at `before` at first (time
    /// in samples).
    ///
    /// With r = Rᵀ (p - x), the object turning at an even ω and shifting at an even x',
    /// |r''| ≤ |p''| + 2 ω |p' - x'| + ω² |p - x|.
    fn bend_seen(&self, body: usize, before: &[Vec3; 2], duration: f64) -> f64 {
        let relative = self.in_hand[body] + self.shift;
        let far = before[0].norm().max(before[1].norm()) + relative * duration;
        self.bend(body) + 2.0 * self.turn * relative + self.turn * self.turn * far
    }

    /// The same in H: of a chain whose joints move at even rates and turn by w in sum, |p''| ≤ 3 w |p'|, as
    /// axes and arms each turn with what is before them.
    fn bend(&self, body: usize) -> f64 {
        3.0 * self.turning[body] * self.in_hand[body]
    }

    /// How far points of a link are at most from the straight way between two samples (m): an eighth of the
    /// largest second derivative, times the duration squared. In H ...
    pub(crate) fn play(&self, body: usize, duration: usize) -> f64 {
        self.bend(body) * (duration * duration) as f64 / 8.0
    }

    /// ... and as seen from the object, from `before` on.
    pub(crate) fn play_seen(&self, body: usize, before: &[Vec3; 2], duration: usize) -> f64 {
        self.bend_seen(body, before, duration as f64) * (duration * duration) as f64 / 8.0
    }

    /// The ends of a body's core in O at a sample (m).
    pub(crate) fn ends(
        &mut self,
        scene: &Scene,
        body: usize,
        sample: usize,
        frames: &[Frames],
    ) -> Option<[Vec3; 2]> {
        let [p, q] = scene.bodies[body].core.ends()?;
        let place = || {
            let frames = &frames[sample];
            let X_HB = scene.pose(body, frames);
            let in_O = |end: &Vec3| frames.X_HO.inverse_transform_point(&(X_HB * Point3::from(*end))).coords;
            let first = in_O(&p);
            [first, if p == q { first } else { in_O(&q) }]
        };
        Some(*self.ends_O[body][sample].get_or_insert_with(place))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Chains;
    use crate::shape::Core;
    use crate::track;
    use regrasp_api::{FingerIndex, Random};
    use regrasp_plan::{PoseRecord, StateRecord};

    /// A finger of three joints on a turned base, with a slanted rod on its last link, and a ball.
    fn problem() -> regrasp_api::Problem {
        let text = r#"{
            "hand": {"name": "h", "fingertip_radius": 0.01, "finger": [{
                "name": "f", "tip": [0.03, 0.0, 0.01], "rest": [0, 0, 0],
                "base": {"position": [0.02, -0.03, 0.01], "axis": [1, 2, 3], "angle_deg": 70},
                "joint": [
                    {"name": "a", "axis": [0, 1, 0], "lower": -3, "upper": 3},
                    {"name": "b", "kind": "prismatic", "axis": [1, 0, 0], "lower": -0.05, "upper": 0.05},
                    {"name": "c", "axis": [0, 0, 1], "lower": -3, "upper": 3,
                     "origin": {"position": [0.04, 0, 0]},
                     "link": [{"shape": {"kind": "capsule", "from": [0, 0.01, 0], "to": [0.03, 0, 0.01],
                                         "radius": 0.004}}]}
                ]
            }]},
            "object": {"shape": {"kind": "sphere", "radius": 0.03}, "friction": 0.8},
            "start": {"pose": {}}, "goal": []
        }"#;
        serde_json::from_str(text).unwrap()
    }

    fn record(random: &mut Random, turn: f64) -> StateRecord {
        let joints = vec![vec![random.range(-1.0, 1.0), random.range(-0.02, 0.02), random.range(-1.0, 1.0)]];
        let half = random.direction() * (turn / 2.0).sin();
        let object = PoseRecord {
            position: (random.direction() * 0.01).into(),
            orientation: [(turn / 2.0).cos(), half.x, half.y, half.z],
        };
        let (velocities, forces, cones) = (None, None, None);
        StateRecord { time: 0.0, object, joints, velocities, contacts: vec![None], forces, cones }
    }

    /// The rod's ends and the fingertip's centre, in O.
    fn points(scene: &Scene, body: usize, frames: &Frames) -> Vec<Vec3> {
        let X_OB = frames.X_HO.inv_mul(scene.pose(body, frames));
        let ends = match &scene.bodies[body].core {
            Core::Point(p) => vec![*p],
            Core::Segment(p, q) => vec![*p, *q, (p + q) / 2.0],
            _ => vec![],
        };
        ends.iter().map(|p| (X_OB * Point3::from(*p)).coords).collect()
    }

    #[test]
    fn no_point_moves_farther_than_is_said_as_seen_from_the_object() {
        let mut random = Random::from_key(23, 0, 0, 0);
        let problem = problem();
        let hand = Chains::new(&problem.hand).unwrap();
        let object = regrasp_world::load_object(&problem.object).unwrap();
        let scene = Scene::new(&problem, &object, &hand, &[3.0, 0.05, 3.0]).unwrap();
        let moved = [Body::Link(FingerIndex(0), 2), Body::Fingertip(FingerIndex(0))];
        let mut tightest = 0.0_f64;
        for _ in 0..60 {
            // Up to steps far longer than plans have, so that paths bend.
            let scale = random.range(0.02, 1.0);
            let (from, mut to) = (record(&mut random, 0.0), record(&mut random, 0.8 * scale));
            for (a, b) in from.joints[0].iter().zip(&mut to.joints[0]) {
                *b = a + (*b - a) * scale;
            }
            for (a, b) in from.object.position.iter().zip(&mut to.object.position) {
                *b = a + (*b - a) * scale;
            }
            let states = [&from, &to].map(|record| track::state(record, &hand).unwrap());
            let leg = Leg { index: 0, moving: None, states: states.into() };
            let mut frames = vec![Frames::new(&hand); SAMPLES + 1];
            for (k, frames) in frames.iter_mut().enumerate() {
                frames.place(&hand, &leg, 0, k as f64 / SAMPLES as f64);
            }
            let mut motions = Motions::new(&scene);
            motions.step(&scene, &leg, 0);
            for body in (0..scene.bodies.len()).filter(|&b| moved.contains(&scene.bodies[b].body)) {
                for (from, to) in (0..SAMPLES).map(|k| (k, k + 1)).chain([(0, 5), (5, 10), (0, 10)]) {
                    let said = motions.seen(&scene, body, (from, to), &frames);
                    let mut fine = Frames::new(&hand);
                    let count = 40 * (to - from);
                    let mut at = |i: usize| {
                        fine.place(&hand, &leg, 0, (from as f64 + i as f64 / 40.0) / SAMPLES as f64);
                        points(&scene, body, &fine)
                    };
                    let path: Vec<Vec<Vec3>> = (0..=count).map(&mut at).collect();
                    let duration = to - from;
                    let before = motions.ends(&scene, body, from, &frames).unwrap();
                    let play = motions.play_seen(body, &before, duration);
                    for point in 0..path[0].len() {
                        let (first, last) = (path[0][point], path[count][point]);
                        for (i, place) in path.iter().enumerate() {
                            let straight = first + (last - first) * (i as f64 / count as f64);
                            assert!((place[point] - straight).norm() <= play + 1e-12);
                        }
                        let length: f64 = path.windows(2).map(|w| (w[1][point] - w[0][point]).norm()).sum();
                        assert!(length <= said, "{length} {said}");
                        tightest = tightest.max(length / said);
                    }
                }
            }
        }
        // A bound that says nothing would pass, too.
        assert!(tightest > 0.7, "{tightest}");
    }
}
