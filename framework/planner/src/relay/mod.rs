//! The relay: towards a pose by rolls, each as far as it goes, and between them regrasps of those fingers
//! alone that bar the way, to where they can follow far.
//!
//! A best-first search over rolls. The successors of a roll regrasp some fingers at one of its states and
//! roll on. What a roll has cost is its regrasps; what it is worth is how far it has come, a regrasp being
//! worth a turn of [`TURN`]. Contacts are chosen by how far along the route their fingers can follow, beyond
//! the goal too: what comes next begins with the grasp in which this ends. Rolls are tried before the
//! regrasps that lead to them: they cost less, and tell more.

mod choice;
mod effort;
mod follow;
mod roll;
mod route;

pub(crate) use effort::{Effort, QUICK, THOROUGH};
pub(crate) use route::Route;

use crate::order::{has_order, regrasp_all};
use crate::segments::moves;
use crate::session::Work;
use choice::{Choice, Station};
use regrasp_api::{CallError, Configuration, Total};
use regrasp_plan::Segment;
use roll::Roll;

/// The turn of the object (rad) that a regrasp is worth.
const TURN: f64 = 0.3;
/// The parts of a roll after which fingers are regrasped, in turn: at its very end some finger is at its
/// limit.
const BACK_OFF: [f64; 4] = [0.85, 1.0, 0.6, 0.35];
/// Rolls that are tried at a station.
const ROLLS: usize = 4;

/// A roll, and how it is come by.
struct Node {
    /// The node before, and the state of its roll at which fingers are regrasped.
    before: Option<(usize, usize)>,
    /// The regrasps, once they are found.
    regrasps: Option<Vec<Segment>>,
    /// How many regrasps lead here from the beginning.
    count: usize,
    roll: Roll,
    /// Where it seems to roll to, beyond the target too.
    reach: f64,
    /// Stations that were tried on it.
    tries: usize,
}

/// The search.
struct Relay<'r> {
    route: &'r Route,
    effort: &'r Effort,
    nodes: Vec<Node>,
}

/// Steps from `from`, at the beginning of the route, to its target; `None` if it does not get there.
pub(crate) fn relay(
    work: &mut Work<'_>,
    from: &Configuration,
    route: &Route,
    effort: &Effort,
) -> Result<Option<Vec<Segment>>, CallError> {
    let roll = Roll::along(work, route, from, 0.0)?;
    let reach = roll.reached();
    let root = Node { before: None, regrasps: Some(Vec::new()), count: 0, roll, reach, tries: 0 };
    let mut relay = Relay { route, effort, nodes: vec![root] };
    let mut tried = 0;
    while let Some(best) = relay.best() {
        work.context.proceed()?;
        let is_complete = relay.nodes[best].roll.is_complete;
        let goes_on = !is_complete && tried < effort.stations;
        let Some((regrasps, next)) = relay.look(work, best, goes_on)? else {
            relay.nodes[best].tries = BACK_OFF.len();
            continue;
        };
        relay.nodes[best].regrasps = Some(regrasps);
        if is_complete {
            return Ok(Some(relay.steps(best)));
        }
        if !goes_on {
            break;
        }
        relay.nodes[best].tries += 1;
        relay.nodes.extend(next);
        tried += 1;
    }
    Ok(None)
}

/// The regrasps that lead to a node, and the nodes after it.
type Looked = (Vec<Segment>, Vec<Node>);

/// What is looked for at a node: what comes before it, and what may come after it.
enum Part {
    Before(Option<Vec<Segment>>),
    After(Vec<Node>),
}

impl Relay<'_> {
    /// What a motion is worth that has come to a place with so many regrasps: the less the better.
    fn worth(&self, count: usize, place: f64) -> f64 {
        count as f64 - place / self.route.of_turn(TURN)
    }

    /// The node to go on from.
    fn best(&self) -> Option<usize> {
        let open = (0..self.nodes.len()).filter(|&node| self.nodes[node].tries < BACK_OFF.len());
        open.min_by_key(|&node| {
            let Node { count, roll, tries, reach, .. } = &self.nodes[node];
            let place = if roll.is_complete { reach.max(roll.reached()) } else { roll.reached() };
            Total(self.worth(*count, place) + *tries as f64)
        })
    }

    /// The regrasps that lead to a node and, where the motion goes on from there, the nodes after it: of an
    /// idle thread nobody asks whether the first were found. `None` where no regrasps lead to it.
    fn look(&self, work: &mut Work<'_>, node: usize, goes_on: bool) -> Result<Option<Looked>, CallError> {
        let (session, task, word) = (work.session, work.task, work.context.random.word());
        let part = |i: usize, work: &mut Work<'_>| match i {
            0 => self.regrasps_to(work, node).map(Part::Before),
            _ => self.after(work, node).map(Part::After),
        };
        let count = 1 + usize::from(goes_on);
        let parts = session.ahead(count, |i| session.part(task, (word, i), |work| part(i, work)));
        let (mut before, mut after) = (Vec::new(), Vec::new());
        for found in parts {
            work.context.tally.add(&found.tally);
            match found.result? {
                Part::Before(None) => return Ok(None),
                Part::Before(Some(regrasps)) => before = regrasps,
                Part::After(nodes) => after = nodes,
            }
        }
        Ok(Some((before, after)))
    }

    /// The regrasps that lead to a node.
    fn regrasps_to(&self, work: &mut Work<'_>, node: usize) -> Result<Option<Vec<Segment>>, CallError> {
        let Node { before, regrasps, roll, .. } = &self.nodes[node];
        match (regrasps, *before) {
            (None, Some((before, index))) => {
                regrasp_all(work, &self.nodes[before].roll.states[index], &roll.states[0])
            }
            (known, _) => Ok(known.clone()),
        }
    }

    /// Nodes whose regrasps are made on the roll of this one, and after which the object rolls on.
    fn after(&self, work: &mut Work<'_>, node: usize) -> Result<Vec<Node>, CallError> {
        let Node { roll, count, tries, .. } = &self.nodes[node];
        let back = BACK_OFF[*tries];
        let (from, to) = (roll.places[0], roll.reached());
        let wanted = from + back * (to - from);
        let index = roll.places.partition_point(|&place| place < wanted).min(roll.places.len() - 1);
        let (q, place) = (&roll.states[index], roll.places[index]);
        let station = Station::new(work, self.route, (q, place), self.effort)?;
        let choices = station.choices(work, |moved, reach| self.worth(moved, reach))?;
        let node = |(choice, roll): (Choice, Roll)| Node {
            before: Some((node, index)),
            regrasps: None,
            count: count + choice.moved,
            roll,
            reach: choice.reach,
            tries: 0,
        };
        Ok(self.rolled(work, (q, place), choices)?.into_iter().map(node).collect())
    }

    /// The rolls of the first few choices that hold.
    fn rolled(
        &self,
        work: &mut Work<'_>,
        (q, place): (&Configuration, f64),
        choices: Vec<Choice>,
    ) -> Result<Vec<(Choice, Roll)>, CallError> {
        let (session, task, word) = (work.session, work.task, work.context.random.word());
        let rolls = session.ahead(choices.len(), |i| {
            session.part(task, (word, i), |work| {
                let there = &choices[i].q;
                has_order(work, q, there)?.then(|| Roll::along(work, self.route, there, place)).transpose()
            })
        });
        let (mut rolled, mut tried) = (Vec::new(), 0);
        for (choice, roll) in choices.iter().zip(rolls) {
            work.context.tally.add(&roll.tally);
            let Some(roll) = roll.result? else { continue };
            if roll.reached() > place {
                rolled.push((choice.clone(), roll));
            }
            tried += 1;
            if tried == ROLLS {
                break;
            }
        }
        Ok(rolled)
    }

    /// The whole way to the end of a node's roll.
    fn steps(&self, last: usize) -> Vec<Segment> {
        let (mut at, mut index) = (last, self.nodes[last].roll.states.len() - 1);
        let mut backwards = Vec::new();
        loop {
            let Node { before, regrasps, roll, .. } = &self.nodes[at];
            backwards.extend(roll.transfers(index).into_iter().rev());
            backwards.extend(regrasps.iter().flatten().rev().cloned());
            let Some((earlier, there)) = *before else { break };
            (at, index) = (earlier, there);
        }
        backwards.reverse();
        backwards.into_iter().filter(moves).collect()
    }
}
