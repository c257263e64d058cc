//! A regrasp planner: a probabilistic roadmap over the joints of the finger that moves, the object and the
//! other fingers resting.

use regrasp_api::{
    Build, CallError, Configuration, Contact, Context, Entry, FingerIndex, FingerJoints, JointKind,
    LocalPlanner, LoneFinger, NoSettings, Path, Reached, Reason, Settings, Slot, Target, Task, TipRule,
    check_settings, inventory,
};

/// Postures that are drawn, and neighbours that each is joined to.
const SAMPLES: usize = 60;
const NEIGHBOURS: usize = 6;

/// One regrasp of a finger.
struct Regrasp<'a> {
    task: &'a Task<'a>,
    from: &'a Configuration,
    finger: FingerIndex,
    alone: Box<dyn LoneFinger + 'a>,
}

impl Regrasp<'_> {
    /// From a contact up to lift height, both included; the posture alone where the finger is free.
    fn lift(&self, contact: Option<&Contact>, joints: &FingerJoints) -> Result<Vec<FingerJoints>, Reason> {
        let (Some(contact), resolution) = (contact, self.task.resolution) else { return Ok(vec![*joints]) };
        let count = (2.0 * resolution.lift / resolution.regrasp_step).ceil() as usize;
        let mut way = vec![*joints];
        for step in 1..=count {
            let height = resolution.lift * step as f64 / count as f64;
            let p_OF = contact.tip_center(self.task.hand.fingertip_radius() + height);
            let p_HF = self.from.X_HO.rotation * p_OF + self.from.X_HO.translation.vector;
            let posture = self.task.hand.inverse(self.finger, &p_HF, &way[step - 1]).ok_or(Reason::Reach)?;
            let rule = TipRule::Clear((0.5 * height).min(resolution.clearance));
            self.alone.free(&posture, rule).map_err(|_| Reason::Collision)?;
            way.push(posture);
        }
        Ok(way)
    }

    /// Whether the finger may be there, settled.
    fn free(&self, mut posture: FingerJoints) -> Option<FingerJoints> {
        self.task.hand.settle(self.finger, &mut posture);
        let rule = TipRule::Clear(self.task.resolution.clearance);
        self.alone.free(&posture, rule).is_ok().then_some(posture)
    }

    /// The postures of a straight motion, without the first; `None` where something is in the way.
    fn straight(&self, a: &FingerJoints, b: &FingerJoints) -> Option<Vec<FingerJoints>> {
        let model = self.task.hand.finger(self.finger);
        let lever = |kind| if kind == JointKind::Prismatic { 1.0 } else { 2.0 * model.reach };
        let moves =
            a.iter().zip(b.iter()).zip(&model.joints).map(|((a, b), j)| (b - a).abs() * lever(j.kind));
        let count = (moves.sum::<f64>() / self.task.resolution.regrasp_step).ceil().max(1.0) as usize;
        let at = |i| if i == count { *b } else { a.interpolate(b, i as f64 / count as f64) };
        (1..=count).map(|i| self.free(at(i))).collect()
    }

    /// A random posture within the limits, about the straight motion between two.
    fn draw(&self, a: &FingerJoints, b: &FingerJoints, context: &mut Context<'_>) -> FingerJoints {
        let mut posture = a.interpolate(b, context.random.unit());
        for (x, joint) in posture.iter_mut().zip(&self.task.hand.finger(self.finger).joints) {
            let spread = 0.25 * (joint.upper - joint.lower) * context.random.normal();
            *x = (*x + spread).clamp(joint.lower, joint.upper);
        }
        posture
    }

    /// The postures from `a`, left out, to `b` over the roadmap: Dijkstra's algorithm, edges checked when
    /// they are wanted.
    fn cross(
        &self,
        a: FingerJoints,
        b: FingerJoints,
        context: &mut Context<'_>,
    ) -> Option<Vec<FingerJoints>> {
        let mut nodes = vec![a, b];
        nodes.extend((0..SAMPLES).filter_map(|_| self.free(self.draw(&a, &b, context))));
        context.note(Slot::RegraspPlanner, "roadmap_nodes", nodes.len() as f64);
        let mut best = vec![(f64::INFINITY, Vec::new()); nodes.len()];
        best[0].0 = 0.0;
        let mut open: Vec<usize> = (0..nodes.len()).collect();
        while let Some(place) = (0..open.len()).min_by(|&x, &y| best[open[x]].0.total_cmp(&best[open[y]].0)) {
            let node = open.swap_remove(place);
            let (cost, way) = best[node].clone();
            if node == 1 || cost.is_infinite() {
                break;
            }
            let apart = |x: usize| nodes[node].max_difference(&nodes[x]);
            let mut near = open.clone();
            // The end is tried from everywhere.
            near.sort_by(|&x, &y| (x != 1).cmp(&(y != 1)).then(apart(x).total_cmp(&apart(y))));
            for next in near.into_iter().take(NEIGHBOURS) {
                let through = cost + apart(next);
                if through < best[next].0
                    && let Some(leg) = self.straight(&nodes[node], &nodes[next])
                {
                    best[next] = (through, way.iter().copied().chain(leg).collect());
                }
            }
        }
        (best[1].0.is_finite()).then(|| best.swap_remove(1).1)
    }

    /// All postures after the first, or why there are none.
    fn way(
        &self,
        (contact, joints): (Option<&Contact>, &FingerJoints),
        context: &mut Context<'_>,
    ) -> Result<Vec<FingerJoints>, Reason> {
        let (here, start) = (self.from.contacts[self.finger].as_ref(), &self.from.joints[self.finger]);
        let (up, down) = (self.lift(here, start)?, self.lift(contact, joints)?);
        let between = self.cross(up[up.len() - 1], down[down.len() - 1], context).ok_or(Reason::Collision)?;
        Ok(up.into_iter().skip(1).chain(between).chain(down.into_iter().rev().skip(1)).collect())
    }
}

/// The planner.
struct Roadmap;

impl LocalPlanner for Roadmap {
    fn connect(
        &self,
        task: &Task<'_>,
        from: &Configuration,
        to: &Target<'_>,
        path: Option<&mut Path>,
        context: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        context.count_call(Slot::RegraspPlanner);
        context.proceed()?;
        let &Target::Regrasp { finger, contact, joints } = to else {
            let reason = "it moves one finger; use it as `local-planner.regrasp`".into();
            return Err(CallError::Unsupported { plugin: ENTRY.id.into(), reason });
        };
        let rest = task.grasp(from, from.holding().without(finger));
        let held = !rest.contacts().is_empty()
            && task.stability.test(&rest, &mut Default::default(), context)?.is_stable();
        let alone = task.clearance.lone_finger(finger, from, from.joints.fingers().collect());
        let regrasp = Regrasp { task, from, finger, alone };
        let found = if held { regrasp.way((contact, joints), context) } else { Err(Reason::Stability) };
        let mut states = vec![from.clone()];
        let stop = found.map(|way| {
            let mut q = from.clone();
            q.contacts[finger] = None;
            states.extend(way.into_iter().map(|posture| {
                q.joints[finger] = posture;
                q.clone()
            }));
            let last = states.len() - 1;
            (states[last].joints[finger], states[last].contacts[finger]) = (*joints, contact.copied());
        });
        let (fraction, end) = (if stop.is_ok() { 1.0 } else { 0.0 }, states[states.len() - 1].clone());
        let stop = stop.err().map(|reason| context.reject(Slot::RegraspPlanner, reason));
        if let Some(path) = path {
            path.states = states;
        }
        Ok(Reached { end, fraction, stop })
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "local-planner/roadmap",
    slots: &[Slot::RegraspPlanner],
    summary: "regrasps over a probabilistic roadmap of the finger's joints",
    references: &["Kavraki, Svestka, Latombe, Overmars, Probabilistic roadmaps for path planning, T-RA 1996"],
    schema: NoSettings::schema,
    check: check_settings::<NoSettings>,
    build: Build::LocalPlanner(|json, _parts| {
        NoSettings::from_json(json)?;
        Ok(Box::new(Roadmap))
    }),
};
inventory::submit! { ENTRY }
