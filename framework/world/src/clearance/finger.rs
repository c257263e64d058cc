//! A finger as bodies: its links' solids and the fingertip's ball.

use super::apart::farther;
use super::block;
use super::body::Placed;
use super::convex::Verdict;
use super::exact::Solid;
use super::fixed::Fixed;
use super::object::ObjectBody;
use super::ordered;
use super::rod::{Bounds, Rod};
use crate::error::WorldError;
use crate::hand::{ChainHand, LinkFrame};
use regrasp_api::{Body, BodyPair, FingerIndex, FingerJoints, Hand, Pose, TipRule};
use smallvec::SmallVec;
use std::sync::Arc;

/// One solid of a finger.
pub(crate) struct Part {
    pub body: Body,
    /// The link whose frame it moves with.
    link: usize,
    pub placed: Placed,
}

/// The solids of one finger, base to tip, the fingertip's ball last.
pub(crate) struct FingerBodies {
    hand: Arc<ChainHand>,
    finger: FingerIndex,
    pub parts: Vec<Part>,
    /// Pairs of parts of this finger that may not touch.
    pub pairs: Vec<(usize, usize)>,
    /// For each part whether it touches the palm by construction.
    on_palm: Vec<bool>,
    /// Whether any part touches another finger by construction.
    on_others: bool,
}

/// Where the solids of a finger are, at some joint positions.
pub(crate) struct PlacedFinger {
    pub finger: FingerIndex,
    joints: FingerJoints,
    /// A rod in H for each part: the part itself, or a bound.
    pub rods: SmallVec<[Rod; 6]>,
    /// A box in H that holds all parts.
    pub bounds: Bounds,
}

impl FingerBodies {
    pub fn new(hand: &Arc<ChainHand>, finger: FingerIndex) -> Result<Self, WorldError> {
        let mut parts = Vec::new();
        let last = hand.link_count(finger) - 1;
        for link in 0..=last {
            let key = format!("hand.finger[{}].joint[{link}].link", finger.index());
            for placed in Placed::read_all(hand.link_shapes(finger, link), &key)? {
                if matches!(placed.solid, Solid::HalfSpace { .. }) {
                    return Err(WorldError::value(key, "a half-space cannot be part of a link; use a box"));
                }
                parts.push(Part { body: Body::Link(finger, link as u8), link, placed });
            }
        }
        let p_LF = hand.description().finger[finger.index()].tip.into();
        let ball = Placed::rod(Rod::ball(p_LF, hand.fingertip_radius()));
        parts.push(Part { body: Body::Fingertip(finger), link: last, placed: ball });
        let pairs = compared_pairs(hand, finger, &parts);
        let on_palm = parts.iter().map(|part| hand.touching(Body::Palm, part.body)).collect();
        let on_others = hand.touches_other_finger(finger);
        Ok(Self { hand: hand.clone(), finger, parts, pairs, on_palm, on_others })
    }

    /// The largest radius of a part's rod (m).
    pub fn thickest(&self) -> f64 {
        self.parts.iter().map(|part| part.placed.rod.radius).fold(0.0, f64::max)
    }

    /// Takes the first link with a shape off the palm's list if the two touch in the resting posture.
    pub fn find_palm_contacts(&mut self, fixed: &[Fixed], clear: f64) {
        let base = self.parts[0].body;
        let rest = self.place(&self.hand.finger(self.finger).rest);
        let count = self.parts.iter().take_while(|part| part.body == base).count();
        let palm = || fixed.iter().filter(|fixed| fixed.body == Body::Palm);
        let touches = |part| palm().any(|fixed| !self.part_clear_of_fixed(&rest, part, fixed, clear));
        if matches!(base, Body::Link(..)) && (0..count).any(touches) {
            self.on_palm[..count].fill(true);
        }
    }

    /// Where the parts are at `joints`.
    #[inline]
    pub fn place(&self, joints: &FingerJoints) -> PlacedFinger {
        let mut room = LinkFrame::room();
        let frames = self.hand.link_frames(self.finger, joints, &mut room);
        let rods: SmallVec<[Rod; 6]> =
            self.parts.iter().map(|part| part.placed.rod.moved(&frames[part.link])).collect();
        let bounds = rods.iter().fold(Bounds::NOTHING, |all, rod| all.union(&rod.bounds()));
        PlacedFinger { finger: self.finger, joints: *joints, rods, bounds }
    }

    /// The exact solid of a part and its pose in H.
    pub fn solid(&self, placed: &PlacedFinger, part: usize) -> (&Solid, Pose) {
        let Part { link, placed: Placed { solid, X_BS, .. }, .. } = &self.parts[part];
        let mut room = LinkFrame::room();
        let frames = self.hand.link_frames(self.finger, &placed.joints, &mut room);
        (solid, frames[*link].pose() * X_BS)
    }

    /// Whether a part and a palm's solid touch by construction.
    pub fn by_construction(&self, part: usize, fixed: &Fixed) -> bool {
        fixed.body == Body::Palm && self.on_palm[part]
    }

    /// Whether a part and a part of another finger touch by construction.
    #[inline]
    pub fn touches_other(&self, part: usize, other: &Self, other_part: usize) -> bool {
        self.on_others && self.hand.touching(self.parts[part].body, other.parts[other_part].body)
    }

    /// Against one solid of palm or obstacles, with the distance `clear` (m) between them.
    pub fn clear_of_fixed(&self, placed: &PlacedFinger, fixed: &Fixed, clear: f64) -> Result<(), BodyPair> {
        let compared = (0..self.parts.len()).filter(|&part| !self.by_construction(part, fixed));
        refused(compared, |&part| self.part_clear_of_fixed(placed, part, fixed, clear))
            .map_err(|part| ordered(self.parts[part].body, fixed.body))
    }

    fn part_clear_of_fixed(&self, placed: &PlacedFinger, part: usize, fixed: &Fixed, clear: f64) -> bool {
        fixed.clear_of_rod(&placed.rods[part], clear)
            || !self.parts[part].placed.is_rod() && {
                let (solid, X_HS) = self.solid(placed, part);
                fixed.is_farther(solid, &X_HS, clear)
            }
    }

    /// Its own links and fingertip against each other, with the distance `clear` (m) between them.
    #[inline]
    pub fn clear_of_itself(&self, placed: &PlacedFinger, clear: f64) -> Result<(), BodyPair> {
        let clear_pair = |&(i, j): &(usize, usize)| clear_parts((self, placed, i), (self, placed, j), clear);
        refused(self.pairs.iter().copied(), clear_pair)
            .map_err(|(i, j)| ordered(self.parts[i].body, self.parts[j].body))
    }

    /// Against the object at `X_HO`, given also as a frame, with the distance `clear` (m) between them.
    #[inline]
    pub fn clear_of_object(
        &self,
        placed: &PlacedFinger,
        object: &ObjectBody,
        (X_HO, frame): (&Pose, &LinkFrame),
        clear: f64,
        tip: TipRule,
    ) -> Result<(), BodyPair> {
        let p_HMiddle = frame.point(&object.p_OMiddle);
        for (part, rod) in self.parts.iter().zip(&placed.rods) {
            let (wanted, is_tip) = match (part.body, tip) {
                (Body::Fingertip(_), TipRule::Touches) => continue,
                (Body::Fingertip(_), TipRule::Clear(wanted)) => (wanted.min(clear), true),
                _ => (clear, false),
            };
            let apart = rod.reach + object.radius + wanted;
            if (rod.middle() - p_HMiddle).norm_squared() > apart * apart {
                continue;
            }
            let rod_O = rod.seen_from(frame);
            let is_clear = match is_tip {
                true => object.clear_of_tip(&rod_O, wanted, clear),
                false => object.clear_of_rod(&rod_O, wanted),
            };
            if is_clear {
                continue;
            }
            if part.placed.is_rod() || !self.solid_clear_of_object(placed, part, object, (X_HO, frame), clear)
            {
                return Err(ordered(part.body, Body::Object));
            }
        }
        Ok(())
    }

    fn solid_clear_of_object(
        &self,
        placed: &PlacedFinger,
        part: &Part,
        object: &ObjectBody,
        (X_HO, frame): (&Pose, &LinkFrame),
        clear: f64,
    ) -> bool {
        let mut room = LinkFrame::room();
        let frames = self.hand.link_frames(self.finger, &placed.joints, &mut room);
        let X_HS = frames[part.link].pose() * part.placed.X_BS;
        match block::verdict(&part.placed, &X_HS, object, frame, clear) {
            Verdict::Free => true,
            Verdict::Close => false,
            Verdict::Unknown => farther(&part.placed.solid, &X_HS, &object.solid, X_HO, clear),
        }
    }
}

/// Two fingers against each other.
pub(crate) fn clear_of_each_other(
    (a, placed_a): (&FingerBodies, &PlacedFinger),
    (b, placed_b): (&FingerBodies, &PlacedFinger),
    clear: f64,
) -> Result<(), BodyPair> {
    let all = (0..a.parts.len()).flat_map(|i| (0..b.parts.len()).map(move |j| (i, j)));
    let pairs = all.filter(|&(i, j)| !a.touches_other(i, b, j));
    refused(pairs, |&(i, j)| clear_parts((a, placed_a, i), (b, placed_b, j), clear))
        .map_err(|(i, j)| ordered(a.parts[i].body, b.parts[j].body))
}

#[inline]
fn clear_parts(
    (a, placed_a, i): (&FingerBodies, &PlacedFinger, usize),
    (b, placed_b, j): (&FingerBodies, &PlacedFinger, usize),
    clear: f64,
) -> bool {
    if placed_a.rods[i].clear_of(&placed_b.rods[j], clear) {
        return true;
    }
    if a.parts[i].placed.is_rod() && b.parts[j].placed.is_rod() {
        return false;
    }
    let ((solid_a, X_HA), (solid_b, X_HB)) = (a.solid(placed_a, i), b.solid(placed_b, j));
    farther(solid_a, &X_HA, solid_b, &X_HB, clear)
}

/// The first item that fails, as an error.
#[inline]
fn refused<T>(mut items: impl Iterator<Item = T>, passes: impl Fn(&T) -> bool) -> Result<(), T> {
    items.find(|item| !passes(item)).map_or(Ok(()), Err)
}

/// The pairs of a finger's parts that do not touch by construction.
fn compared_pairs(hand: &ChainHand, finger: FingerIndex, parts: &[Part]) -> Vec<(usize, usize)> {
    let last_link = parts.iter().rev().find_map(|part| match part.body {
        Body::Link(_, link) => Some(usize::from(link)),
        _ => None,
    });
    let apart = |i: usize, j: usize| match (parts[i].body, parts[j].body) {
        (Body::Link(_, a), Body::Link(_, b)) => a != b && !hand.consecutive(finger, a.into(), b.into()),
        // The last link that has a shape carries the fingertip.
        (Body::Link(_, link), _) => Some(usize::from(link)) != last_link,
        _ => false,
    };
    let apart = |i: usize, j: usize| apart(i, j) && !hand.touching(parts[i].body, parts[j].body);
    (0..parts.len())
        .flat_map(|i| (i + 1..parts.len()).map(move |j| (i, j)))
        .filter(|&(i, j)| apart(i, j))
        .collect()
}
