//! Forces that balance a load inside cones and efforts: Newton's method to their analytic centre, or a proof
//! that there are none.

use super::barrier::{Barrier, Sums};
use super::bearing::{Bearing, Exerted};
use super::ldl::Ldl;
use nalgebra::{SMatrix, Vector6};
use regrasp_api::{MAX_FINGERS, Vec3};
use std::cell::RefCell;

/// The most Newton steps; about ten from the start, two or three from a centre nearby.
const MAX_STEPS: usize = 60;
/// The share of the way to the boundary that a step may go.
const SHY: f64 = 0.9;
/// A step shorter than this leaves forces near a bound, from where no step goes far.
const SHORT: f64 = 0.7;
/// The most steps back to the centre.
const RECENTRING: usize = 6;
/// Newton decrement at which a centre is as good as exact, for forces that must be continuous.
const CENTRED: f64 = 1e-4;
/// Room that accepted forces keep to every bound.
const ROOM: f64 = 1e-9;
/// Residual of balance, relative to the largest force, that is rounding.
const BALANCED: f64 = 1e-11;

/// One [`Exerted`] for each contact; those beyond the grasp's stay as they are.
pub type Forces = [Exerted; MAX_FINGERS];

/// Whether forces balance a load.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // it lives on the stack of an inner loop, which allocates nothing
pub enum Balanced {
    /// These do, strictly inside all bounds.
    Yes(Forces),
    /// None do. On this twist of the object, the joints giving way as they can, the load has more power than
    /// the efforts at their limits: force part, and torque part over the length.
    No(Vector6<f64>),
    /// Neither was proved.
    Unknown,
}

/// The linear response of forces to a change of the load.
pub(crate) struct Response {
    of_each: [SMatrix<f64, 4, 6>; MAX_FINGERS],
}

impl Response {
    /// The forces of `count` contacts after a push is wanted too: of forces from column 0, of torques from 3.
    pub fn after(&self, forces: &Forces, count: usize, column: usize, push: &Vec3) -> Forces {
        let mut forces = *forces;
        for (x, of) in forces.iter_mut().zip(&self.of_each).take(count) {
            *x += of.fixed_columns::<3>(column) * push;
        }
        forces
    }
}

/// One search: the contacts, and the share of the friction that forces may rely on.
#[derive(Clone, Copy)]
pub(crate) struct Search<'a> {
    pub bearings: &'a [Bearing],
    pub share: f64,
}

struct Step {
    multiplier: Vector6<f64>,
    change: Forces,
    /// The largest multiple of the change that stays inside.
    reach: f64,
    decrement: f64,
}

/// The barriers of all contacts, where the last step left them.
type Barriers = [Barrier; MAX_FINGERS];

thread_local! {
    /// Room for the barriers of a search: to fill five kilobytes anew took a tenth of one.
    static BARRIERS: RefCell<Barriers> = const { RefCell::new([Barrier::NOTHING; MAX_FINGERS]) };
}

impl Search<'_> {
    /// Where searches begin: pressing along the normals.
    pub fn start(&self) -> Forces {
        let mut forces = [Exerted::zeros(); MAX_FINGERS];
        for (x, bearing) in forces.iter_mut().zip(self.bearings) {
            x[0] = bearing.start;
        }
        forces
    }

    /// Looks for any forces whose wrench is `wanted`, from forces inside.
    pub fn any(&self, from: &Forces, wanted: &Vector6<f64>) -> Balanced {
        self.run(*from, wanted, f64::INFINITY)
    }

    /// Looks for the analytic centre of the forces whose wrench is `wanted`: unique, and continuous in all
    /// data.
    pub fn centre(&self, from: &Forces, wanted: &Vector6<f64>) -> Balanced {
        self.run(*from, wanted, CENTRED)
    }

    /// Whether forces are strictly inside all bounds.
    pub fn inside(&self, forces: &Forces) -> bool {
        forces.iter().zip(self.bearings).all(|(x, bearing)| bearing.room(x, self.share) >= ROOM)
    }

    /// Whether forces are so far inside that a search may begin there.
    pub fn well_inside(&self, forces: &Forces) -> bool {
        forces.iter().zip(self.bearings).all(|(x, bearing)| bearing.room(x, self.share) >= 1e-3)
    }

    /// How forces follow a change of the wrench that is wanted, by H⁻¹Gᵀ(G H⁻¹Gᵀ)⁻¹.
    pub fn response(&self, forces: &Forces) -> Option<Response> {
        BARRIERS.with_borrow_mut(|barriers| {
            let sums = self.sums(barriers, forces, &Vector6::zeros())?;
            let square = Ldl::new(&sums.square)?;
            let mut response = Response { of_each: [SMatrix::zeros(); MAX_FINGERS] };
            for k in 0..6 {
                let mut unit = [0.0; 6];
                unit[k] = 1.0;
                let multiplier = Vector6::from(square.solve(unit));
                let contacts = response.of_each.iter_mut().zip(barriers.iter()).take(self.bearings.len());
                contacts.for_each(|(of, barrier)| of.set_column(k, &barrier.follow(&multiplier)));
            }
            Some(response)
        })
    }

    /// The wrench that forces lack (force, torque over length).
    pub fn residual(&self, forces: &Forces, wanted: &Vector6<f64>) -> Vector6<f64> {
        let wrenches = forces.iter().zip(self.bearings).map(|(x, bearing)| bearing.map * x);
        wrenches.fold(*wanted, |left, wrench| left - wrench)
    }

    /// Newton's method from forces inside that need not balance (S. Boyd, L. Vandenberghe, "Convex
    /// Optimization", 2004, section 10.3).
    ///
    /// The Hessian is one block for each contact, since a finger's joints see its own contact alone: each
    /// step is one 6×6 system.
    fn run(&self, forces: Forces, wanted: &Vector6<f64>, precision: f64) -> Balanced {
        if self.bearings.is_empty() {
            return if *wanted == Vector6::zeros() { Balanced::Yes(forces) } else { Balanced::Unknown };
        }
        BARRIERS.with_borrow_mut(|barriers| self.run_in(barriers, forces, wanted, precision))
    }

    fn run_in(
        &self,
        barriers: &mut Barriers,
        mut forces: Forces,
        wanted: &Vector6<f64>,
        precision: f64,
    ) -> Balanced {
        let mut feasible = false;
        for _ in 0..MAX_STEPS {
            let Some(step) = self.step(barriers, &forces, wanted) else { return Balanced::Unknown };
            if !feasible && self.refutes(barriers, &step, wanted) {
                return Balanced::No(step.multiplier);
            }
            let t = self.advance(&mut forces, &step, feasible);
            feasible |= t >= 1.0;
            if feasible && step.decrement < precision && self.balances(&forces, wanted) {
                return Balanced::Yes(forces);
            }
            if t < SHORT
                && !feasible
                && let Some(proof) = self.recentre(barriers, &mut forces, wanted)
            {
                return Balanced::No(proof);
            }
        }
        if feasible && self.balances(&forces, wanted) { Balanced::Yes(forces) } else { Balanced::Unknown }
    }

    /// Takes a step as far as the bounds allow; how much of it.
    fn advance(&self, forces: &mut Forces, step: &Step, damped: bool) -> f64 {
        let damping = if damped && step.decrement > 0.3 { 1.0 / (1.0 + step.decrement) } else { 1.0 };
        let t = damping.min(SHY * step.reach);
        for (x, d) in forces.iter_mut().zip(&step.change).take(self.bearings.len()) {
            *x += d * t;
        }
        t
    }

    /// Brings forces that a short step left near a bound back to the centre of those with the same wrench; a
    /// proof where one is met.
    ///
    /// With it the search follows the path of centres from the wrench of the start to the one that is wanted:
    /// where that is out of reach, the path ends at the boundary, and the multiplier there is a proof.
    fn recentre(
        &self,
        barriers: &mut Barriers,
        forces: &mut Forces,
        wanted: &Vector6<f64>,
    ) -> Option<Vector6<f64>> {
        for _ in 0..RECENTRING {
            let here = -self.residual(forces, &Vector6::zeros());
            let step = self.step(barriers, forces, &here)?;
            if self.refutes(barriers, &step, wanted) {
                return Some(step.multiplier);
            }
            self.advance(forces, &step, true);
            if step.decrement < 0.5 {
                return None;
            }
        }
        None
    }

    fn balances(&self, forces: &Forces, wanted: &Vector6<f64>) -> bool {
        let largest = forces.iter().zip(self.bearings).map(|(x, _)| x.amax()).fold(wanted.amax(), f64::max);
        self.inside(forces) && self.residual(forces, wanted).amax() <= BALANCED * largest
    }

    /// Whether the load has more power on a step's multiplier than any forces within the bounds.
    fn refutes(&self, barriers: &Barriers, step: &Step, wanted: &Vector6<f64>) -> bool {
        let load = wanted.dot(&step.multiplier);
        if load <= 0.0 {
            return false;
        }
        let each = self.bearings.iter().zip(barriers).zip(&step.change);
        let power: f64 = each.map(|((bearing, barrier), d)| barrier.power(bearing, d)).sum();
        load > power * (1.0 + 1e-9)
    }

    fn step(&self, barriers: &mut Barriers, forces: &Forces, wanted: &Vector6<f64>) -> Option<Step> {
        let sums = self.sums(barriers, forces, wanted)?;
        let mut step = Step {
            multiplier: Ldl::new(&sums.square)?.solve(sums.right.into()).into(),
            change: [Exerted::zeros(); MAX_FINGERS],
            reach: f64::INFINITY,
            decrement: 0.0,
        };
        for (i, bearing) in self.bearings.iter().enumerate() {
            let (d, decrement) = barriers[i].change(&step.multiplier);
            step.reach = step.reach.min(barriers[i].reach(bearing, &forces[i], &d));
            step.decrement += decrement;
            step.change[i] = d;
        }
        step.decrement = step.decrement.max(0.0).sqrt();
        Some(step)
    }

    /// The contacts' barriers at these forces, summed.
    fn sums(&self, barriers: &mut Barriers, forces: &Forces, wanted: &Vector6<f64>) -> Option<Sums> {
        let mut sums = Sums { square: [[0.0; 6]; 6], right: *wanted };
        for ((barrier, x), bearing) in barriers.iter_mut().zip(forces).zip(self.bearings) {
            if !barrier.set(bearing, self.share, x) {
                return None;
            }
            barrier.add(&mut sums);
            sums.right -= bearing.map * x;
        }
        Some(sums)
    }
}
