//! Two random trees that grow towards each other in the joint space of one finger (Kuffner & LaValle, ICRA
//! 2000).

use super::RrtSettings;
use crate::regrasp::Flight;
use regrasp_api::{CallError, Context, FingerJoints, Random};

#[derive(Clone, Copy)]
struct Node {
    joints: FingerJoints,
    /// Index in the same tree; the root is its own parent.
    parent: usize,
}

/// One tree from each end.
#[derive(Default)]
pub(crate) struct Trees {
    sides: [Vec<Node>; 2],
    route: Vec<FingerJoints>,
}

/// How a tree grew towards a wish.
enum Growth {
    /// Not at all: something is in the way.
    Trapped,
    /// By one edge, to this node.
    Advanced(usize),
    /// As far as the wish, at this node.
    Reached(usize),
}

/// How coarsely edges are looked at while the trees grow (m of travel); the final way is looked at again,
/// finely.
fn stride(flight: &Flight<'_>) -> f64 {
    2.0 * flight.task.resolution.regrasp_step
}

fn random_posture(flight: &Flight<'_>, random: &mut Random) -> FingerJoints {
    let joints = &flight.task.hand.finger(flight.finger).joints;
    let mut posture = FingerJoints::zeros(joints.len());
    posture.iter_mut().zip(joints).for_each(|(q, joint)| *q = random.range(joint.lower, joint.upper));
    flight.task.hand.settle(flight.finger, &mut posture);
    posture
}

impl Trees {
    /// Appends a way from `a`, without it, to `b` to the postures; false if none was found within the budget.
    pub fn search(
        &mut self,
        flight: &Flight<'_>,
        settings: &RrtSettings,
        (a, b): (&FingerJoints, &FingerJoints),
        postures: &mut Vec<FingerJoints>,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        self.restart(a, b);
        if settings.nodes == 0 || !self.meet(flight, settings, context)? {
            return Ok(false);
        }
        self.shorten(flight, settings, &mut context.random);
        Ok(self.route.windows(2).all(|leg| flight.straight(&leg[0], &leg[1], postures).is_ok()))
    }

    fn restart(&mut self, a: &FingerJoints, b: &FingerJoints) {
        for (side, root) in self.sides.iter_mut().zip([a, b]) {
            side.clear();
            side.push(Node { joints: *root, parent: 0 });
        }
        self.route.clear();
    }

    /// Grows until the trees meet; then `route` is the way from root to root.
    fn meet(
        &mut self,
        flight: &Flight<'_>,
        settings: &RrtSettings,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        // Straight ahead first.
        let target = self.sides[1][0].joints;
        if let Growth::Reached(end) = self.connect(0, &target, flight, settings) {
            self.join((0, end), 0);
            return Ok(true);
        }
        let mut growing = 0;
        for _ in 0..settings.nodes {
            context.proceed()?;
            if self.sides[0].len() + self.sides[1].len() >= settings.nodes + 2 {
                break;
            }
            let wish = random_posture(flight, &mut context.random);
            if let Growth::Advanced(new) | Growth::Reached(new) =
                self.extend(growing, &wish, flight, settings)
            {
                let joints = self.sides[growing][new].joints;
                if let Growth::Reached(end) = self.connect(1 - growing, &joints, flight, settings) {
                    self.join((growing, new), end);
                    return Ok(true);
                }
            }
            growing = 1 - growing;
        }
        Ok(false)
    }

    /// One edge of one tree from its nearest node towards the wish.
    fn extend(
        &mut self,
        side: usize,
        wish: &FingerJoints,
        flight: &Flight<'_>,
        settings: &RrtSettings,
    ) -> Growth {
        let tree = &mut self.sides[side];
        let distances = tree.iter().map(|node| flight.travel(&node.joints, wish)).enumerate();
        let (parent, distance) = distances.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a tree has a root");
        if distance == 0.0 {
            return Growth::Reached(parent);
        }
        let from = tree[parent].joints;
        let reached = distance <= settings.extend;
        let joints = if reached { *wish } else { from.interpolate(wish, settings.extend / distance) };
        if !flight.free_in_air(&joints) || !flight.free_between(&from, &joints, stride(flight)) {
            return Growth::Trapped;
        }
        tree.push(Node { joints, parent });
        let new = tree.len() - 1;
        if reached { Growth::Reached(new) } else { Growth::Advanced(new) }
    }

    /// Edge after edge of one tree towards the wish.
    fn connect(
        &mut self,
        side: usize,
        wish: &FingerJoints,
        flight: &Flight<'_>,
        settings: &RrtSettings,
    ) -> Growth {
        loop {
            match self.extend(side, wish, flight, settings) {
                Growth::Advanced(_) => {}
                end => return end,
            }
        }
    }

    /// Lays the route through a node of one tree and a node of the other at the same place.
    fn join(&mut self, (side, node): (usize, usize), other: usize) {
        let (first, second) = if side == 0 { (node, other) } else { (other, node) };
        self.climb_down(0, first);
        self.route.reverse();
        let middle = self.route.len();
        self.climb_down(1, second);
        self.route.remove(middle);
    }

    /// Appends the postures from a node down to its root.
    fn climb_down(&mut self, side: usize, mut node: usize) {
        let tree = &self.sides[side];
        loop {
            self.route.push(tree[node].joints);
            if node == 0 {
                return;
            }
            node = tree[node].parent;
        }
    }

    /// Cuts corners between random nodes of the route.
    fn shorten(&mut self, flight: &Flight<'_>, settings: &RrtSettings, random: &mut Random) {
        for _ in 0..settings.shortcuts {
            if self.route.len() < 3 {
                return;
            }
            let first = random.index(self.route.len() - 2);
            let last = first + 2 + random.index(self.route.len() - first - 2);
            if flight.free_between(&self.route[first], &self.route[last], stride(flight)) {
                self.route.drain(first + 1..last);
            }
        }
    }
}
