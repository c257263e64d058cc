//! What a grasp must hold: the object's weight, and every disturbance of a set.

use super::bearing::{Bearing, Press, stacked};
use super::edged::{Edged, EdgesBalanced, Weights, balance, square, start};
use super::newton::{Balanced, Forces, Search};
use crate::force::Friction;
use nalgebra::{Cholesky, Matrix6, Vector6};
use regrasp_api::{FingerIndex, Grasp, Hint, MAX_FINGERS, Vec3};
use std::ops::AddAssign;

/// Vertices of the two icosahedra that enclose the disturbances.
const VERTICES: usize = 24;
/// The smallest pivot of the grasp map's square, relative to the largest, at which its rank is surely 6.
const FLAT: f64 = 1e-9;
/// Hint: the numbers are forces that held the last grasp.
const FORCES: u64 = 0x686f_6c64;
/// Numbers of a contact's force.
const OF_CONTACT: usize = 4;

/// The load on an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldLoad {
    /// Mass (kg); 0 where the weight does not count.
    pub mass: f64,
    /// Centre of mass in O (m).
    pub p_OCm: Vec3,
    /// What torques are divided by (m).
    pub length: f64,
    /// Largest disturbing force (N) and torque (N·m), as [`regrasp_api::Load`] has them; 0 for none.
    pub disturbance: (f64, f64),
    /// Bounds of the forces.
    pub press: Press,
}

/// The answer on one grasp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Forces that hold the weight, or why there are none. A disturbance that nothing resists gives its
    /// twist.
    pub balanced: Balanced,
    /// Whether the grasp holds the weight and every disturbance.
    pub holds: bool,
}

/// The answer on one grasp of which some cones are polyhedra.
#[derive(Clone, Debug, PartialEq)]
pub struct EdgesAnswer {
    /// Weights that hold the weight, or why there are none; see [`Answer::balanced`].
    pub balanced: EdgesBalanced,
    /// Whether the grasp holds the weight and every disturbance.
    pub holds: bool,
}

/// Contacts of a grasp as bearings, in place.
pub struct Bearings {
    all: [Bearing; MAX_FINGERS],
    count: usize,
}

impl std::ops::Deref for Bearings {
    type Target = [Bearing];
    fn deref(&self) -> &[Bearing] {
        &self.all[..self.count]
    }
}

impl HeldLoad {
    /// The contacts of a grasp, but that of `lifted`, with a part of their friction and of their torsional
    /// friction; `None` where a cone is not elliptic. `drag` is what part of [`Grasp::drag`] each contact
    /// drags with, in [-1, 1].
    pub fn bearings(
        &self,
        grasp: &Grasp<'_>,
        lifted: Option<FingerIndex>,
        (part, torsion_part): (f64, f64),
        drag: impl Fn(usize) -> f64,
    ) -> Option<Bearings> {
        let mut bearings = Bearings { all: [Bearing::NOTHING; MAX_FINGERS], count: 0 };
        for (i, contact) in grasp.contacts().iter().enumerate() {
            if Some(contact.finger) == lifted {
                continue;
            }
            let friction = Friction::of(&contact.cone)?.scaled(part, torsion_part);
            let drags = grasp.drag(i);
            let friction = if drags > 0.0 { friction.dragging(drags * drag(i)) } else { friction };
            let place = (&(contact.p_OC - self.p_OCm), &contact.n_O);
            let efforts = grasp.efforts(i).copied().unwrap_or_default();
            bearings.all[bearings.count] = Bearing::new(place, &friction, &efforts, &self.press, self.length);
            bearings.count += 1;
        }
        Some(bearings)
    }

    /// The contacts of a grasp, but that of `lifted`, whatever their cones, with a part of their friction and
    /// of their torsional friction.
    pub fn edged(&self, grasp: &Grasp<'_>, lifted: Option<FingerIndex>, parts: (f64, f64)) -> Vec<Edged> {
        let held = grasp.contacts().iter().enumerate().filter(|(_, contact)| Some(contact.finger) != lifted);
        let edged = |(i, contact): (usize, &regrasp_api::GraspContact<'_>)| {
            let place = (&(contact.p_OC - self.p_OCm), &contact.n_O);
            let efforts = grasp.efforts(i).copied().unwrap_or_default();
            Edged::new(place, &contact.cone, parts, &efforts, &self.press, self.length)
        };
        held.map(edged).collect()
    }

    /// Whether contacts with edges hold the load; see [`Self::held`].
    pub fn held_by_edges(&self, contacts: &[Edged], g_O: &Vec3, factor: f64) -> EdgesAnswer {
        let no = |balanced| EdgesAnswer { balanced, holds: false };
        if contacts.len() < 2 || !is_full(square(contacts)) {
            return no(EdgesBalanced::Unknown);
        }
        let wanted = self.wanted(g_O);
        let balanced = balance(contacts, &start(contacts), &wanted);
        let EdgesBalanced::Yes(weights) = balanced else { return no(balanced) };
        match self.lost_by_edges(contacts, &weights, &wanted, factor) {
            Some(lost) => no(lost),
            None => EdgesAnswer { balanced: EdgesBalanced::Yes(weights), holds: true },
        }
    }

    /// What becomes of the first disturbance that is not resisted.
    fn lost_by_edges(
        &self,
        contacts: &[Edged],
        weights: &Weights,
        wanted: &Vector6<f64>,
        factor: f64,
    ) -> Option<EdgesBalanced> {
        let (force, torque) = (self.disturbance.0 * factor, self.disturbance.1 * factor / self.length);
        if force <= 0.0 && torque <= 0.0 {
            return None;
        }
        let zero = Vec3::zeros();
        let pushes = icosahedron()
            .into_iter()
            .flat_map(|vertex| [stacked(&(vertex * force), &zero), stacked(&zero, &(vertex * torque))]);
        let mut answers = pushes.map(|push| balance(contacts, weights, &(wanted + push)));
        answers.find(|answer| !matches!(answer, EdgesBalanced::Yes(_)))
    }

    /// The wrench that contacts must give to hold the weight, under gravity `g_O` (m/s²).
    pub fn wanted(&self, g_O: &Vec3) -> Vector6<f64> {
        stacked(&(g_O * -self.mass), &Vec3::zeros())
    }

    /// Whether the contacts hold the load, all friction counted; `factor` multiplies the disturbances. The
    /// hint saves work, and decides nothing.
    pub fn held(&self, bearings: &[Bearing], g_O: &Vec3, factor: f64, hint: &mut Hint) -> Answer {
        let search = Search { bearings, share: 1.0 };
        if bearings.len() < 2 || !has_full_rank(bearings) {
            return Answer { balanced: Balanced::Unknown, holds: false };
        }
        let wanted = self.wanted(g_O);
        let start = recall(&search, hint).unwrap_or_else(|| search.start());
        let balanced = search.any(&start, &wanted);
        let Balanced::Yes(forces) = balanced else {
            *hint = Hint::default();
            return Answer { balanced, holds: false };
        };
        remember(&forces, bearings.len(), hint);
        self.resists(&search, &forces, &wanted, factor)
    }

    fn resists(&self, search: &Search<'_>, forces: &Forces, wanted: &Vector6<f64>, factor: f64) -> Answer {
        let yes = Answer { balanced: Balanced::Yes(*forces), holds: true };
        let (force, torque) = (self.disturbance.0 * factor, self.disturbance.1 * factor / self.length);
        if force <= 0.0 && torque <= 0.0 {
            return yes;
        }
        let Some(response) = search.response(forces) else { return Answer { holds: false, ..yes } };
        let count = search.bearings.len();
        for vertex in icosahedron() {
            for (column, push) in [(0, vertex * force), (3, vertex * torque)] {
                if search.inside(&response.after(forces, count, column, &push)) {
                    continue;
                }
                let mut wanted = *wanted;
                wanted.fixed_rows_mut::<3>(column).add_assign(&push);
                match search.any(forces, &wanted) {
                    Balanced::Yes(_) => {}
                    no => return Answer { balanced: no, holds: false },
                }
            }
        }
        yes
    }
}

fn has_full_rank(bearings: &[Bearing]) -> bool {
    let mut square = Matrix6::zeros();
    bearings.iter().for_each(|bearing| square += bearing.map * bearing.map.transpose());
    is_full(square)
}

fn is_full(square: Matrix6<f64>) -> bool {
    Cholesky::new(square).is_some_and(|factor| {
        let pivots = factor.l_dirty().diagonal();
        pivots.min().powi(2) > FLAT * pivots.max().powi(2)
    })
}

/// The forces that the hint holds, where they are inside all bounds of this grasp.
fn recall(search: &Search<'_>, hint: &Hint) -> Option<Forces> {
    let count = search.bearings.len();
    if hint.tag != FORCES || count * OF_CONTACT > Hint::VALUES {
        return None;
    }
    let mut forces = search.start();
    for (i, x) in forces.iter_mut().take(count).enumerate() {
        x.copy_from_slice(&hint.values[OF_CONTACT * i..OF_CONTACT * (i + 1)]);
        if !search.bearings[i].has_torsion() {
            x[3] = 0.0;
        }
    }
    // Close to a bound a search would begin slowly; so near the last grasp, well inside is where one is.
    search.well_inside(&forces).then_some(forces)
}

fn remember(forces: &Forces, count: usize, hint: &mut Hint) {
    *hint = Hint::default();
    if count * OF_CONTACT <= Hint::VALUES {
        hint.tag = FORCES;
        for (i, x) in forces.iter().take(count).enumerate() {
            hint.values[OF_CONTACT * i..OF_CONTACT * (i + 1)].copy_from_slice(x.as_slice());
        }
    }
}

/// The vertices of the regular icosahedron around the unit ball.
pub(crate) fn icosahedron() -> [Vec3; VERTICES / 2] {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    // The inscribed ball of (0, ±1, ±φ) has radius φ²/√3.
    let scale = 3.0_f64.sqrt() / (golden * golden);
    std::array::from_fn(|k| {
        let (axis, signs) = (k / 4, k % 4);
        let mut vertex = Vec3::zeros();
        vertex[(axis + 1) % 3] = if signs & 1 == 0 { scale } else { -scale };
        vertex[(axis + 2) % 3] = if signs & 2 == 0 { golden * scale } else { -golden * scale };
        vertex
    })
}
