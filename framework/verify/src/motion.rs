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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hand::Chains;
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
                let said = *motions.seen(&scene, body, &frames);
                for (k, said) in said.iter().enumerate() {
                    let mut fine = Frames::new(&hand);
                    let mut at = |i: usize| {
                        fine.place(&hand, &leg, 0, (k as f64 + i as f64 / 40.0) / SAMPLES as f64);
                        points(&scene, body, &fine)
                    };
                    let path: Vec<Vec<Vec3>> = (0..=40).map(&mut at).collect();
                    for point in 0..path[0].len() {
                        let length: f64 = path.windows(2).map(|w| (w[1][point] - w[0][point]).norm()).sum();
                        assert!(length <= *said, "{length} {said}");
                        tightest = tightest.max(length / said);
                    }
                }
            }
        }
        // A bound that says nothing would pass, too.
        assert!(tightest > 0.7, "{tightest}");
    }
}
