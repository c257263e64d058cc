//! How far contacts slip from touch-down to lift, by the claimed law, and whether their points move
//! continuously.
//!
//! Slip is a sum over segments, so it is taken in the order of the motion: what was seen of each contact
//! comes as [`Event`]s from whoever looked at a stretch of the plan.

use crate::hand::Chains;
use crate::track::{Leg, SAMPLES};
use crate::verdict::{Check, Gauge, Side};
use nalgebra::Point3;
use regrasp_api::{LONGEST_JUMP, MAX_FINGERS, Pose, Tolerances, Vec3};
use regrasp_plan::{Extreme, Place, TransferLaw};

/// What a contact did.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Event {
    /// It holds at a sample.
    Holds(Hold),
    /// Its finger was lifted: what comes next is another contact.
    Lifted {
        /// Which finger.
        finger: usize,
    },
}

/// A finger that holds at one sample.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hold {
    pub(crate) finger: usize,
    /// The sample after the state: 0 to [`SAMPLES`].
    pub(crate) state: usize,
    pub(crate) sample: usize,
    /// The surface's point closest to the fingertip's centre, the outward normal, the centre (m), and the
    /// frame of the last link, in O.
    pub(crate) p_OC: Vec3,
    pub(crate) n_O: Vec3,
    pub(crate) p_OTip: Vec3,
    pub(crate) X_OL: Pose,
}

impl Hold {
    /// How far (m, in O) the material point of the fingertip that is the contact at this instant slips while
    /// its link moves from `from` to `to`: its displacement relative to the object, whose own points rest in
    /// O, along the tangent plane. The midpoint rule, second order.
    fn slip(&self, from: &Pose, to: &Pose) -> Vec3 {
        let p_L = self.X_OL.inverse_transform_point(&Point3::from(self.p_OC));
        tangential(&(to * p_L - from * p_L), &self.n_O)
    }
}

fn tangential(v: &Vec3, n: &Vec3) -> Vec3 {
    v - n * n.dot(v)
}

/// How one contact has moved since its finger touched down.
#[derive(Clone, Copy)]
struct Rolling {
    /// Where it touched first, and where its centre was then (m, in O).
    first: (Vec3, Vec3),
    /// The last sample.
    last: Hold,
    /// The last link at the last even sample, and the contact half-way from there to the next.
    X_OL: Pose,
    half_way: Option<Hold>,
    /// The sum of the differences of the two material points' displacements, tangential parts, in O (m).
    slip_O: Vec3,
}

impl Rolling {
    /// How far (m) contact point or fingertip's centre are from where they began on the object, whichever is
    /// more.
    fn strayed(&self) -> f64 {
        let (p_OC, p_OTip) = &self.first;
        (self.last.p_OC - p_OC).norm().max((self.last.p_OTip - p_OTip).norm())
    }
}

/// Follows all contacts along the plan.
pub(crate) struct SlipCheck {
    slip: Gauge,
    jumps: Gauge,
    law: TransferLaw,
    rolling: [Option<Rolling>; MAX_FINGERS],
}

impl SlipCheck {
    pub(crate) fn new(hand: &Chains, tolerances: &Tolerances, law: TransferLaw) -> Self {
        let longest = tolerances.closure.max(LONGEST_JUMP * hand.tip_radius);
        Self {
            slip: Gauge::new("slip", "m", Side::AtMost, tolerances.slip),
            jumps: Gauge::new("contact-jumps", "m", Side::AtMost, longest),
            law,
            rolling: [None; MAX_FINGERS],
        }
    }

    /// Takes in what contacts did next in a segment.
    pub(crate) fn take(&mut self, leg: &Leg<'_>, event: &Event) {
        match event {
            Event::Lifted { finger } => self.rolling[*finger] = None,
            Event::Holds(hold) => self.follow(leg, hold),
        }
    }

    /// Measures the slip since touch-down: what rolling adds up, or how far a fixed point has strayed from
    /// where it was then.
    fn follow(&mut self, leg: &Leg<'_>, hold: &Hold) {
        let fraction = hold.sample as f64 / SAMPLES as f64;
        let place = || Place { finger: Some(hold.finger), ..leg.between(hold.state, fraction) };
        let Some(now) = &mut self.rolling[hold.finger] else {
            let (first, slip_O) = ((hold.p_OC, hold.p_OTip), Vec3::zeros());
            let rolling = Rolling { first, last: *hold, X_OL: hold.X_OL, half_way: None, slip_O };
            self.rolling[hold.finger] = Some(rolling);
            self.slip.note(0.0, place);
            return;
        };
        // Closest points of a convex surface move no farther than the centre does: more is a jump over a
        // concave edge, where the ball touches on both sides. Over a mild one it rolls on: the grasps before
        // and behind are both looked at, and the material points of neither side move.
        let step = (hold.p_OTip - now.last.p_OTip).norm();
        self.jumps.note(((hold.p_OC - now.last.p_OC).norm() - step).max(0.0), place);
        if hold.sample == 0 {
            // A segment begins where the last one ended, but for a finger that moved without being lifted.
            now.slip_O += tangential(&(hold.p_OTip - now.last.p_OTip), &hold.n_O);
            (now.X_OL, now.half_way) = (hold.X_OL, None);
        } else if let Some(half_way) = now.half_way.take() {
            now.slip_O += half_way.slip(&now.X_OL, &hold.X_OL);
            now.X_OL = hold.X_OL;
        } else {
            now.half_way = Some(*hold);
        }
        now.last = *hold;
        let slip = match self.law {
            TransferLaw::FixedPoint => now.strayed(),
            _ => now.slip_O.norm(),
        };
        self.slip.note(slip, place);
    }

    /// Largest slip, for the certificate.
    pub(crate) fn extreme(&self) -> Option<Extreme> {
        self.slip.extreme()
    }

    pub(crate) fn checks(self) -> [Check; 2] {
        [self.slip, self.jumps].map(Gauge::check)
    }
}
