//! A regrasp planner: a probabilistic roadmap over the joints of the finger that moves.

use regrasp_api::{
    Build, CallError, Configuration, Contact, Context, Entry, FingerIndex, FingerJoints, JointKind,
    LocalPlanner, LoneFinger, NoSettings, Path, Reached, Reason, Settings, Slot, Target, Task, TipRule,
    check_settings, inventory,
};

/// Postures that are drawn, and neighbours that each is joined to.
const SAMPLES: usize = 60;
const NEIGHBOURS: usize = 6;
type Way = Result<Vec<FingerJoints>, Reason>;

/// One regrasp of a finger.
struct Regrasp<'a> {
    task: &'a Task<'a>,
    from: &'a Configuration,
    finger: FingerIndex,
    alone: Box<dyn LoneFinger + 'a>,
}

impl Regrasp<'_> {
    /// From a contact up to lift height, both included; the posture alone where the finger is free.
    fn lift(&self, contact: Option<&Contact>, joints: &FingerJoints) -> Way {
        let (Some(contact), resolution) = (contact, self.task.resolution) else { return Ok(vec![*joints]) };
        let count = (2.0 * resolution.lift / resolution.regrasp_step).ceil() as usize;
        let mut way = vec![*joints];
        for step in 1..=count {
            let height = resolution.lift * step as f64 / count as f64;
            let p_OF = contact.tip_center(self.task.hand.fingertip_radius() + height);
            let p_HF = self.from.X_HO.transform_point(&p_OF.into()).coords;
            let posture = self.task.hand.inverse(self.finger, &p_HF, &way[step - 1]).ok_or(Reason::Reach)?;
            way.push(self.free(posture, 0.5 * height).ok_or(Reason::Collision)?);
        }
        Ok(way)
    }

    /// The posture, settled, if its fingertip keeps this distance (m), or the planner's, from the object.
    fn free(&self, mut posture: FingerJoints, clear: f64) -> Option<FingerJoints> {
        self.task.hand.settle(self.finger, &mut posture);
        let rule = TipRule::Clear(clear.min(self.task.resolution.clearance));
        self.alone.free(&posture, rule).is_ok().then_some(posture)
    }

    /// The postures of a straight motion, without the first; `None` where something is in the way.
    fn straight(&self, a: &FingerJoints, b: &FingerJoints) -> Option<Vec<FingerJoints>> {
        let model = self.task.hand.finger(self.finger);
        let lever = if model.joints[0].kind == JointKind::Prismatic { 1.0 } else { 2.0 * model.reach };
        let most = a.len() as f64 * lever * a.max_difference(b);
        let count = (most / self.task.resolution.regrasp_step).ceil().max(1.0) as usize;
        let at = |i| if i == count { *b } else { a.interpolate(b, i as f64 / count as f64) };
        (1..=count).map(|i| self.free(at(i), f64::INFINITY)).collect()
    }

    /// The postures from `a`, left out, to `b` over the roadmap: Dijkstra's algorithm, edges checked when
    /// they are wanted, those to the end from everywhere.
    fn cross(&self, [a, b]: [FingerJoints; 2], context: &mut Context<'_>) -> Option<Vec<FingerJoints>> {
        let mut nodes = vec![a, b];
        for _ in 0..SAMPLES {
            let mut posture = a.interpolate(&b, context.random.unit());
            for (x, joint) in posture.iter_mut().zip(&self.task.hand.finger(self.finger).joints) {
                let spread = 0.25 * (joint.upper - joint.lower) * context.random.normal();
                *x = (*x + spread).clamp(joint.lower, joint.upper);
            }
            nodes.extend(self.free(posture, f64::INFINITY));
        }
        context.note(Slot::RegraspPlanner, "roadmap_nodes", nodes.len() as f64);
        let mut best = vec![(f64::INFINITY, Vec::new()); nodes.len()];
        best[0].0 = 0.0;
        let mut open: Vec<usize> = (0..nodes.len()).collect();
        while let Some(place) = (0..open.len()).min_by(|&x, &y| best[open[x]].0.total_cmp(&best[open[y]].0)) {
            let node = open.swap_remove(place);
            let (cost, way) = best[node].clone();
            if node == 1 {
                return cost.is_finite().then_some(way);
            }
            let apart = |x: usize| nodes[node].max_difference(&nodes[x]);
            open.sort_by(|&x, &y| (x != 1).cmp(&(y != 1)).then(apart(x).total_cmp(&apart(y))));
            for &next in open.iter().take(NEIGHBOURS) {
                let through = cost + apart(next);
                let leg = || self.straight(&nodes[node], &nodes[next]);
                let Some(leg) = (through < best[next].0).then(leg).flatten() else { continue };
                best[next] = (through, way.iter().copied().chain(leg).collect());
            }
        }
        None
    }

    /// All postures after the first, or why there are none.
    fn way(&self, to: (Option<&Contact>, &FingerJoints), context: &mut Context<'_>) -> Way {
        let (here, start) = (self.from.contacts[self.finger].as_ref(), &self.from.joints[self.finger]);
        let (up, down) = (self.lift(here, start)?, self.lift(to.0, to.1)?);
        let between = self.cross([up[up.len() - 1], down[down.len() - 1]], context);
        let between = between.ok_or(Reason::Collision)?;
        Ok(up.into_iter().skip(1).chain(between).chain(down.into_iter().rev().skip(1)).collect())
    }
}

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
        let held = task.stability.test(&rest, &mut Default::default(), context)?.is_stable();
        let alone = task.clearance.lone_finger(finger, from, from.joints.fingers().collect());
        let regrasp = Regrasp { task, from, finger, alone };
        let found = if held { regrasp.way((contact, joints), context) } else { Err(Reason::Stability) };
        let (mut end, mut own) = (from.clone(), Path::default());
        let path = path.unwrap_or(&mut own);
        path.restart(from);
        let way = match found.map_err(|reason| context.reject(Slot::RegraspPlanner, reason)) {
            Ok(way) => way,
            Err(reason) => return Ok(Reached { end, fraction: 0.0, stop: Some(reason) }),
        };
        end.contacts[finger] = None;
        for posture in &way[..way.len() - 1] {
            end.joints[finger] = *posture;
            path.states.push(end.clone());
        }
        (end.joints[finger], end.contacts[finger]) = (*joints, contact.copied());
        path.states.push(end.clone());
        Ok(Reached { end, fraction: 1.0, stop: None })
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
    build: Build::LocalPlanner(|json, _| Ok(NoSettings::from_json(json).map(|_| Box::new(Roadmap))?)),
};
inventory::submit! { ENTRY }
