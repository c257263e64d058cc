//! From links and joints to the hand's description.

use crate::fingers::{Chain, Fingers};
use crate::joints::{self, JointReader};
use crate::needs::Needs;
use crate::options::HandOptions;
use crate::posture::{Posture, drive};
use crate::report::HandReport;
use crate::solids::{Piece, Shaper};
use crate::tip::{self, End, Tip};
use crate::tree::Tree;
use crate::trim::Seen;
use regrasp_api::{FingerDescription, Fingertip, HandDescription, JointDescription, PlacedShape, Pose, Vec3};
use regrasp_formats::{Kind, RobotFault as Fault};

/// Where a link belongs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Owner {
    Palm,
    /// Finger, and which of its moving joints.
    Finger(usize, usize),
}

/// A link of the hand, its pose in the frame B of what it belongs to, and its shapes in B.
struct Part {
    owner: Owner,
    link: usize,
    X_BL: Pose,
    pieces: Vec<Piece>,
}

/// The radius of the fingertips' balls.
#[derive(Clone, Copy)]
struct Radius {
    /// (m).
    value: f64,
    /// Whether it was fitted to shapes, which the balls then stand for.
    is_fitted: bool,
}

/// The shapes of parts.
fn placed<'p>(parts: impl Iterator<Item = &'p Part>) -> Vec<PlacedShape> {
    parts.flat_map(|part| part.pieces.iter().map(Piece::placed)).collect()
}

/// Reads the hand whose fingers were found.
pub(crate) struct Reader<'a> {
    pub tree: &'a Tree<'a>,
    pub fingers: &'a Fingers,
    pub posture: &'a Posture,
    pub options: &'a HandOptions,
    pub shaper: Shaper,
    pub report: HandReport,
    pub needs: Needs,
}

impl Reader<'_> {
    pub fn hand(&mut self) -> Result<HandDescription, Fault> {
        let (tree, fingers) = (self.tree, self.fingers);
        let name = |link: usize| tree.link_of(link).name.clone();
        self.report.palm = name(fingers.palm);
        self.report.tips = fingers.chains.iter().map(|chain| name(chain.tip)).collect();
        self.report.tips_guessed = fingers.guessed;
        self.report.notes.extend(fingers.left_out.iter().cloned());
        let count = (self.options.tip_offset.len(), fingers.chains.len());
        if count.0 > 1 && count.0 != count.1 {
            let message = format!(
                "`tip_offset` has {} entries; give one, or one for each of the {} fingers",
                count.0, count.1
            );
            return Err(Fault::of_key("tip_offset", message));
        }
        let owned = self.owned()?;
        let ends = self.ends(&owned);
        let radius = self.radius(&ends);
        let palm = placed(owned.iter().filter(|part| part.owner == Owner::Palm));
        let finger = fingers.chains.iter().enumerate();
        let finger = finger
            .map(|(f, chain)| self.finger(f, chain, &owned, &ends[f], radius))
            .collect::<Result<_, _>>()?;
        Ok(HandDescription {
            name: tree.model.name.clone(),
            references: Vec::new(),
            fingertip_radius: radius.value,
            fingertip: Fingertip::Ball,
            palm,
            finger,
            touching: self.excluded(&owned),
        })
    }

    /// The pieces of every link that is part of the hand, each in the frame of what it belongs to.
    fn owned(&mut self) -> Result<Vec<Part>, Fault> {
        let tree = self.tree;
        let mut owned = Vec::new();
        let mut open = vec![(self.fingers.palm, Owner::Palm, Pose::identity())];
        self.upward(&mut open);
        while let Some((link, owner, X_BL)) = open.pop() {
            let pieces = self.shaper.pieces(tree.link_of(link))?;
            let pieces = pieces.into_iter().map(|piece| piece.moved(&X_BL)).collect();
            owned.push(Part { owner, link, X_BL, pieces });
            for &index in tree.below(link).iter().rev() {
                // What is above the palm was looked at already.
                if tree.path(self.fingers.palm).contains(&index) {
                    continue;
                }
                let next = match self.fingers.owner(index) {
                    Some((finger, place)) => (Owner::Finger(finger, place), Pose::identity()),
                    None => (owner, X_BL * self.held(index)),
                };
                open.push((tree.child(index), next.0, next.1));
            }
        }
        Ok(owned)
    }

    /// The pairs that the file excludes, as `touching` names bodies; those of one body are none.
    fn excluded(&self, owned: &[Part]) -> Vec<[String; 2]> {
        let bodies = |name: &String| -> Vec<String> {
            let Some(part) = owned.iter().find(|part| self.tree.link_of(part.link).name == *name) else {
                return Vec::new();
            };
            let Owner::Finger(f, place) = part.owner else { return vec!["palm".into()] };
            let chain = &self.fingers.chains[f];
            let link = self.tree.joint(chain.moving[place]).name.clone();
            let is_last = place + 1 == chain.moving.len();
            [link].into_iter().chain(is_last.then(|| self.finger_name(chain))).collect()
        };
        let mut pairs = Vec::new();
        for [a, b] in &self.tree.model.excluded {
            let (first, second) = (bodies(a), bodies(b));
            let all = first.iter().flat_map(|a| second.iter().map(move |b| [a.clone(), b.clone()]));
            pairs.extend(all.filter(|[a, b]| a != b));
        }
        pairs.sort();
        pairs.dedup();
        pairs
    }

    /// The links above the palm that are fixed to it.
    fn upward(&mut self, open: &mut Vec<(usize, Owner, Pose)>) {
        let (mut link, mut X_HL) = (self.fingers.palm, Pose::identity());
        while let Some(index) = self.tree.above(link) {
            let joint = self.tree.joint(index);
            link = self.tree.parent(index);
            if joint.kind != Kind::Fixed {
                self.report.ignored.push(format!(
                    "everything above joint `{}`, which moves the palm: link `{}` and what hangs on it",
                    joint.name,
                    self.tree.link_of(link).name
                ));
                return;
            }
            X_HL *= joint.X_PJ.inverse();
            open.push((link, Owner::Palm, X_HL));
        }
    }

    /// The pose of a joint's child in its parent, where the joint is fixed or belongs to no finger.
    fn held(&mut self, index: usize) -> Pose {
        let joint = self.tree.joint(index);
        if joint.kind != Kind::Fixed {
            let q = self.posture.position(index);
            let mut said = format!("joint `{}` belongs to no finger: it is held at {q}", joint.name);
            if let Ok(Some(drive)) = drive(self.tree, joint) {
                let driver = &self.tree.joint(drive.joint).name;
                said += &format!(", where `{driver}` has it");
                if self.fingers.owner(drive.joint).is_some() {
                    self.report.notes.push(format!(
                        "joint `{}` follows `{driver}`, which moves with a finger, but is held at {q}, \
                         where it stands while `{driver}` is at \
                         {}: keep clear of what hangs on it",
                        joint.name,
                        self.posture.position(drive.joint)
                    ));
                }
            }
            self.report.ignored.push(said);
        }
        self.posture.pose(self.tree, index)
    }

    fn finger(
        &mut self,
        finger: usize,
        chain: &Chain,
        owned: &[Part],
        end: &End,
        radius: Radius,
    ) -> Result<FingerDescription, Fault> {
        let mut reader = JointReader {
            tree: self.tree,
            posture: self.posture,
            options: self.options,
            notes: &mut self.report.notes,
            needs: &mut self.needs,
        };
        let joints::FingerJoints { base, mut joints, X_LTip } = reader.joints(chain)?;
        let last = joints.len() - 1;
        for (place, joint) in joints.iter_mut().enumerate().take(last) {
            joint.link = placed(owned.iter().filter(|part| part.owner == Owner::Finger(finger, place)));
        }
        let tip = self.tip((finger, chain), &X_LTip, owned, (end, radius), &mut joints[last]);
        let at = chain.moving.iter().map(|&index| self.posture.position(index));
        let rest = at.zip(&joints).map(|(q, joint)| q.clamp(joint.lower, joint.upper)).collect();
        let mut finger = FingerDescription {
            name: self.finger_name(chain),
            base,
            joint: joints,
            tip: tip.center.into(),
            rest,
        };
        settle_rest(&mut finger);
        Ok(finger)
    }

    /// Puts the ball, and gives the last link the shapes that remain beside it.
    fn tip(
        &mut self,
        (finger, chain): (usize, &Chain),
        X_LTip: &Pose,
        owned: &[Part],
        (end, radius): (&End, Radius),
        joint: &mut JointDescription,
    ) -> Tip {
        let is_fitted = radius.is_fitted;
        let radius = radius.value;
        let place = chain.moving.len() - 1;
        let last = || owned.iter().filter(|part| part.owner == Owner::Finger(finger, place));
        let pieces = |parts: &mut dyn Iterator<Item = &Part>| -> Vec<Piece> {
            parts.flat_map(|part| part.pieces.clone()).collect()
        };
        let own = pieces(&mut last().filter(|part| part.link == chain.tip));
        let all = pieces(&mut last());
        let has_own_link = chain.path.last() != chain.moving.last();
        let offset = match self.options.tip_offset[..] {
            [] => None,
            [one] => Some(one),
            ref each => Some(each[finger]),
        };
        let tip = Tip::new(X_LTip, offset, (&own, &all), radius, has_own_link);
        let tip =
            if is_fitted && offset.is_none() { tip.fitted(end, radius, &mut self.report.notes) } else { tip };
        let name = self.finger_name(chain);
        let beside = if tip.is_ball {
            let behind = pieces(&mut last().filter(|part| part.link != chain.tip));
            let seen = self.seen(chain, last());
            seen.trimmed(&tip, behind, radius, &mut self.report.notes, &name)
        } else {
            all
        };
        let kept = if is_fitted {
            tip.freed(&tip.cut(beside, radius, &mut Vec::new(), &name), radius, &mut self.report.notes, &name)
        } else {
            tip.cut(beside, radius, &mut self.report.notes, &name)
        };
        let free = tip.free(&kept, radius).to_degrees();
        let how = &tip.how;
        self.report
            .tip_centers
            .push(format!("`{name}`: {how}; free up to {free:.0}° from the finger's direction"));
        joint.link = kept.iter().map(Piece::placed).collect();
        tip
    }

    /// The shapes at the end of each finger: the tip link's own, or all that move with it.
    fn ends(&self, owned: &[Part]) -> Vec<End> {
        let end = |(f, chain): (usize, &Chain)| {
            let last = Owner::Finger(f, chain.moving.len() - 1);
            let of = |tip_only: bool| -> Vec<Piece> {
                let parts =
                    owned.iter().filter(|part| part.owner == last && (!tip_only || part.link == chain.tip));
                parts.flat_map(|part| part.pieces.iter().cloned()).collect()
            };
            let own = of(true);
            let pieces = if own.is_empty() { of(false) } else { own };
            let tip = owned.iter().find(|part| part.owner == last && part.link == chain.tip);
            let frame = tip.map_or(Vec3::zeros(), |part| part.X_BL.translation.vector);
            let outward = tip::outward(&frame, &pieces);
            End { name: self.tree.link_of(chain.tip).name.clone(), pieces, outward }.or_its_last_piece()
        };
        self.fingers.chains.iter().enumerate().map(end).collect()
    }

    /// The fingertips' radius: as given, that of their own balls, or fitted; something, and a need, where
    /// there is none.
    fn radius(&mut self, ends: &[End]) -> Radius {
        let known = self.options.fingertip_radius.or_else(|| tip::own_balls(self.tree, self.fingers));
        if let Some(value) = known {
            return Radius { value, is_fitted: false };
        }
        let value = tip::fitted_radius(ends).unwrap_or_else(|(why, suggestion)| {
            self.needs.radius(why, suggestion);
            suggestion
        });
        Radius { value, is_fitted: true }
    }

    /// What is seen of the links that move with the tip.
    fn seen<'p>(&mut self, chain: &Chain, parts: impl Iterator<Item = &'p Part>) -> Seen {
        let mut seen = Seen { tip: Vec::new(), behind: Vec::new() };
        for part in parts {
            let pieces = self.shaper.seen(self.tree.link_of(part.link));
            let pieces = pieces.into_iter().map(|piece| piece.moved(&part.X_BL));
            if part.link == chain.tip { seen.tip.extend(pieces) } else { seen.behind.extend(pieces) }
        }
        seen
    }

    /// The tip link's name, unless a joint or the palm is called so too: `touching` needs names that are
    /// different.
    fn finger_name(&self, chain: &Chain) -> String {
        let name = &self.tree.link_of(chain.tip).name;
        let taken = name == "palm" || self.tree.joint_named(name).is_some();
        if taken { format!("finger {name}") } else { name.clone() }
    }
}

/// Driven joints rest where their drivers have them.
fn settle_rest(finger: &mut FingerDescription) {
    for driven in 0..finger.joint.len() {
        let Some(mimic) = &finger.joint[driven].mimic else { continue };
        let driver = finger.joint.iter().position(|joint| joint.name == mimic.joint);
        let position = driver.map_or(0.0, |driver| finger.rest[driver]);
        finger.rest[driven] = mimic.multiplier * position + mimic.offset;
    }
}
