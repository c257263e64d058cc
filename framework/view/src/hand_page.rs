//! A hand as one HTML page: joints to move, where each fingertip reaches, where a ball can be held.

use crate::ViewError;
use crate::hand::{HandData, hand};
use crate::html::{Kind, assembled};
use crate::mesh::thin;
use crate::number::nano;
use regrasp_api::{FingerIndex, FingerJoints, Hand, HandDescription};
use regrasp_world::ChainHand;
use serde::Serialize;

/// A hand, and what is told about it.
#[derive(Clone, Debug)]
pub struct HandView<'a> {
    /// The hand; meshes are in place.
    pub hand: &'a HandDescription,
    /// The ball that a place was looked for (m, its radius).
    pub ball_radius: f64,
    /// Where the fingers surround it best; absent where they do not.
    pub ball: Option<BallPlace>,
    /// What is said in a few words each: a name and its value.
    pub facts: Vec<(String, String)>,
    /// Headings, each with its lines.
    pub lists: Vec<(String, Vec<String>)>,
}

/// A place for a ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BallPlace {
    /// Its centre in the hand's frame (m).
    pub position: [f64; 3],
    /// How well the fingers surround it, in [0, 1].
    pub quality: f64,
}

#[derive(Serialize)]
struct PageData<'a> {
    name: &'a str,
    hand: HandData,
    ball_radius: f64,
    ball: Option<BallPlace>,
    facts: &'a [(String, String)],
    lists: &'a [(String, Vec<String>)],
    checks: Vec<Posture>,
}

/// Where the fingertips' centres are in a posture (m, in H): the page's kinematics are held against it.
#[derive(Serialize)]
struct Posture {
    joints: Vec<f64>,
    tips: Vec<[f64; 3]>,
}

/// The page that shows a hand: one HTML file that needs nothing else.
///
/// Where the fingertips reach is computed in the page, from the joints' ranges; collisions are not looked at.
pub fn hand_page(view: &HandView<'_>) -> Result<String, ViewError> {
    let chains = ChainHand::new(view.hand.clone())?;
    let mut data = PageData {
        name: &view.hand.name,
        hand: hand(view.hand)?,
        ball_radius: view.ball_radius,
        ball: view.ball,
        facts: &view.facts,
        lists: &view.lists,
        checks: [0.0, 0.4, 1.0].map(|share| posture(&chains, share)).into(),
    };
    thin(data.hand.meshes());
    Ok(assembled(Kind::Hand, data.name, &data))
}

/// All joints this share of the way from rest to their upper ends; driven ones follow.
fn posture(chains: &ChainHand, share: f64) -> Posture {
    let (mut joints, mut tips) = (Vec::new(), Vec::new());
    for (f, finger) in chains.description().finger.iter().enumerate() {
        let ends = finger.joint.iter().map(|joint| joint.upper);
        let own: Vec<f64> = finger.rest.iter().zip(ends).map(|(q, end)| q + share * (end - q)).collect();
        let driven = finger.joint.iter().zip(&own).map(|(joint, &q)| {
            let driver = |mimic: &regrasp_api::Mimic| {
                let at = finger.joint.iter().position(|other| other.name == mimic.joint);
                at.map(|at| mimic.multiplier * own[at] + mimic.offset)
            };
            joint.mimic.as_ref().and_then(driver).unwrap_or(q)
        });
        let q: Vec<f64> = driven.map(nano).collect();
        tips.push(chains.tip_center(FingerIndex(f as u8), &FingerJoints::from_slice(&q)).into());
        joints.extend(q);
    }
    Posture { joints, tips }
}
