//! Straightening: the shortest path through a strip of facets, and through the strips around its bends.
//!
//! A strip is unfolded into the plane, where the funnel algorithm (Lee & Preparata, "Euclidean shortest paths
//! in the presence of rectilinear barriers", Networks 14, 1984) finds its shortest path. That path bends at
//! vertices only. Where the facets on the other side of such a vertex leave less than a straight angle, the
//! strip is led around that side, which is shorter, until no bend is left that can be improved (Xin & Wang,
//! "Efficiently determining a locally exact shortest path on polyhedral surfaces", Computer-Aided Design 39,
//! 2007). The result is locally shortest and never longer than the path that the strip came from.

use crate::lift::Leg;
use crate::polyhedron::{Planar, Polyhedron, next, previous};
use crate::rolling::Spot;
use std::f64::consts::{PI, TAU};

/// Rounds before straightening ends where it is; a dozen are common.
const MOST_ROUNDS: usize = 500;
/// Angles (rad) closer than this to a straight one count as straight.
const STRAIGHT: f64 = 1e-9;

/// A vertex at which a path through a strip bends.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// The crossing whose edge ends there.
    crossing: usize,
    is_left: bool,
    at: Planar,
}

/// The crossed edges of a path over facets, each as the half-edge of the facet that is entered, and memory to
/// straighten it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Strip {
    pub crossings: Vec<u32>,
    /// Left and right end of each crossed edge in the plane (m); the last one is the target twice.
    portals: Vec<[Planar; 2]>,
    bends: Vec<Bend>,
    start: Planar,
}

impl Strip {
    /// Appends a crossed edge; going back over the last one takes that back.
    pub fn cross(&mut self, polyhedron: &Polyhedron, half_edge: u32) {
        let twin = polyhedron.half_edges[half_edge as usize].twin;
        if self.crossings.last() == Some(&twin) {
            self.crossings.pop();
        } else {
            self.crossings.push(half_edge);
        }
    }

    /// The same path from its end to its start.
    pub fn reverse(&mut self, polyhedron: &Polyhedron) {
        self.crossings.reverse();
        for crossing in &mut self.crossings {
            *crossing = polyhedron.half_edges[*crossing as usize].twin;
        }
    }

    /// Shortens the path locally and writes its points, each with the facet of the piece that follows.
    ///
    /// `facet` holds both ends where no edge is crossed.
    pub fn straighten(
        &mut self,
        polyhedron: &Polyhedron,
        (start, end): (&Spot, &Spot),
        facet: u32,
        legs: &mut Vec<Leg>,
    ) {
        let mut only = facet;
        for round in 0..MOST_ROUNDS {
            self.trim(polyhedron, (start, end), &mut only);
            self.unfold(polyhedron, (start, end));
            self.pull();
            if round + 1 == MOST_ROUNDS || !self.improve(polyhedron) {
                break;
            }
        }
        self.write(polyhedron, start, only, legs);
    }

    /// Drops crossings of edges on which the path begins or ends.
    fn trim(&mut self, polyhedron: &Polyhedron, (start, end): (&Spot, &Spot), only: &mut u32) {
        let lies_on = |spot: &Spot, crossing: u32| {
            let edge = &polyhedron.half_edges[crossing as usize];
            let [x, y] = edge.unfold(&spot.contact.p_OC);
            y < polyhedron.snap && x > -polyhedron.snap && x < edge.length + polyhedron.snap
        };
        let first = self.crossings.iter().take_while(|&&crossing| lies_on(start, crossing)).count();
        if first > 0 {
            *only = self.crossings[first - 1] / 3;
            self.crossings.drain(..first);
        }
        while let Some(&last) = self.crossings.last().filter(|&&crossing| lies_on(end, crossing)) {
            *only = polyhedron.half_edges[last as usize].twin / 3;
            self.crossings.pop();
        }
        if let Some(&first) = self.crossings.first() {
            *only = polyhedron.half_edges[first as usize].twin / 3;
        }
    }

    /// Lays the strip out in the plane.
    fn unfold(&mut self, polyhedron: &Polyhedron, (start, end): (&Spot, &Spot)) {
        self.portals.clear();
        let (Some(&first), Some(&last)) = (self.crossings.first(), self.crossings.last()) else { return };
        let frame = &polyhedron.half_edges[first as usize];
        let [x, y] = frame.unfold(&start.contact.p_OC);
        self.start = [x, -y];
        let mut portal = [[0.0, 0.0], [frame.length, 0.0]];
        self.portals.push(portal);
        for pair in self.crossings.windows(2) {
            let apex = place(&portal, &polyhedron.half_edges[pair[0] as usize].apex);
            let crossed = polyhedron.half_edges[pair[1] as usize].twin;
            debug_assert!(crossed == next(pair[0]) || crossed == previous(pair[0]));
            portal = if crossed == next(pair[0]) { [apex, portal[1]] } else { [portal[0], apex] };
            self.portals.push(portal);
        }
        let target = place(&portal, &polyhedron.half_edges[last as usize].unfold(&end.contact.p_OC));
        self.portals.push([target, target]);
    }

    /// Finds the bends of the shortest path through the portals: each side of the funnel moves inwards until
    /// it crosses the other, whose end then is a bend and the funnel's new apex.
    fn pull(&mut self) {
        self.bends.clear();
        let mut apex = self.start;
        // Where the funnel's sides end: place and crossing.
        let mut sides = [(apex, 0), (apex, 0)];
        let mut index = 0;
        let mut fresh = true;
        while index < self.portals.len() {
            let portal = self.portals[index];
            if fresh {
                (sides, fresh) = ([(portal[0], index), (portal[1], index)], false);
                index += 1;
                continue;
            }
            let mut bend = None;
            for side in 0..2 {
                // Positive: inwards of this side, respectively still on the right side of the other.
                let sign = if side == 0 { -1.0 } else { 1.0 };
                if sign * turn(&apex, &sides[side].0, &portal[side]) < 0.0 {
                    continue;
                }
                if sign * turn(&apex, &sides[1 - side].0, &portal[side]) <= 0.0 || sides[1 - side].0 == apex {
                    sides[side] = (portal[side], index);
                } else {
                    bend = Some(1 - side);
                    break;
                }
            }
            match bend {
                Some(side) => {
                    let (at, crossing) = sides[side];
                    // By rounding the funnel may close at the target itself.
                    if crossing + 1 == self.portals.len() {
                        break;
                    }
                    self.bends.push(Bend { crossing, is_left: side == 0, at });
                    // Edges that end at the bend do not narrow the funnel behind it.
                    apex = at;
                    index = crossing + 1;
                    while index + 1 < self.portals.len() && self.portals[index][side] == at {
                        index += 1;
                    }
                    fresh = true;
                }
                None => index += 1,
            }
        }
    }

    /// Leads the strip around the other side of every bend where that is shorter; `false` if there is none.
    fn improve(&mut self, polyhedron: &Polyhedron) -> bool {
        let Some(&[target, _]) = self.portals.last() else { return false };
        let mut changed = false;
        let mut ahead = (target, usize::MAX);
        let bends = std::mem::take(&mut self.bends);
        for (index, bend) in bends.iter().enumerate().rev() {
            // What was led around a bend ahead has no crossings of this one any more: its turn comes in the
            // next round.
            if bend.crossing >= ahead.1 {
                ahead.0 = bend.at;
                continue;
            }
            let before = if index == 0 { self.start } else { bends[index - 1].at };
            let (first, last) = self.fan(polyhedron, bend);
            let vertex = end_of(polyhedron, self.crossings[bend.crossing], bend.is_left);
            let across = angle(&bend.at, &before, &ahead.0) - (TAU - polyhedron.total_angle[vertex as usize]);
            if last < ahead.1 && across < PI - STRAIGHT {
                let around = self.around(polyhedron, bend.is_left, first, last);
                self.crossings.splice(first..=last, around);
                changed = true;
                ahead = (bend.at, first);
            } else {
                ahead = (bend.at, ahead.1);
            }
        }
        self.bends = bends;
        let crossings = std::mem::take(&mut self.crossings);
        crossings.iter().for_each(|&crossing| self.cross(polyhedron, crossing));
        changed
    }

    /// The first and the last crossing of edges that end at a bend.
    fn fan(&self, polyhedron: &Polyhedron, bend: &Bend) -> (usize, usize) {
        let end = |index: usize| end_of(polyhedron, self.crossings[index], bend.is_left);
        let vertex = end(bend.crossing);
        let (mut first, mut last) = (bend.crossing, bend.crossing);
        while first > 0 && end(first - 1) == vertex {
            first -= 1;
        }
        while last + 1 < self.crossings.len() && end(last + 1) == vertex {
            last += 1;
        }
        (first, last)
    }

    /// The edges crossed by going around the fan's vertex on the other side.
    fn around(&self, polyhedron: &Polyhedron, is_left: bool, first: usize, last: usize) -> Vec<u32> {
        let twin = |half_edge: u32| polyhedron.half_edges[half_edge as usize].twin;
        let (first, last) = (self.crossings[first], self.crossings[last]);
        let mut around = Vec::new();
        if is_left {
            let mut at = next(twin(first));
            while at != last {
                around.push(twin(at));
                at = next(twin(at));
            }
        } else {
            let mut at = twin(first);
            while at != next(last) {
                at = polyhedron.counter_clockwise(at);
                around.push(at);
            }
        }
        around
    }

    /// The vertices beside the strip whose facets' angles differ from a full turn by more than `least` (rad):
    /// a crossed edge that ends at each, and whether on its left.
    ///
    /// Paths on both sides of such a vertex can be locally shortest.
    pub fn corners(&self, polyhedron: &Polyhedron, least: f64) -> Vec<(usize, bool)> {
        let mut corners = Vec::new();
        for is_left in [true, false] {
            let mut before = u32::MAX;
            for (index, &crossing) in self.crossings.iter().enumerate() {
                let vertex = end_of(polyhedron, crossing, is_left);
                if vertex != before && (TAU - polyhedron.total_angle[vertex as usize]).abs() > least {
                    corners.push((index, is_left));
                }
                before = vertex;
            }
        }
        corners
    }

    /// Leads the strip `other` around the other side of one of its corners, into this one.
    pub fn pass(&mut self, polyhedron: &Polyhedron, other: &Self, (crossing, is_left): (usize, bool)) {
        let (first, last) = other.fan(polyhedron, &Bend { crossing, is_left, at: [0.0; 2] });
        let around = other.around(polyhedron, is_left, first, last);
        self.crossings.clear();
        let (before, after) = (&other.crossings[..first], &other.crossings[last + 1..]);
        before.iter().chain(&around).chain(after).for_each(|&edge| self.cross(polyhedron, edge));
    }

    /// Writes the points of the pulled path.
    fn write(&self, polyhedron: &Polyhedron, start: &Spot, only: u32, legs: &mut Vec<Leg>) {
        legs.clear();
        let first = self
            .crossings
            .first()
            .map_or(only, |&crossing| polyhedron.half_edges[crossing as usize].twin / 3);
        legs.push(Leg { p_OP: start.contact.p_OC, facet: first });
        let Some(&[target, _]) = self.portals.last() else { return };
        let mut bends = self.bends.iter().peekable();
        let mut from = self.start;
        for (index, &crossing) in self.crossings.iter().enumerate() {
            let frame = &polyhedron.half_edges[crossing as usize];
            let [left, right] = self.portals[index];
            while let Some(bend) = bends.next_if(|bend| bend.crossing < index) {
                from = bend.at;
            }
            let to = bends.peek().map_or(target, |bend| bend.at);
            let side = |at: &Planar| turn(&from, &to, at);
            let (l, r) = (side(&left), side(&right));
            let t = if to == left || from == left {
                0.0
            } else if to == right || from == right {
                1.0
            } else if l - r > 0.0 {
                (l / (l - r)).clamp(0.0, 1.0)
            } else {
                0.5
            };
            legs.push(Leg { p_OP: frame.at(t * frame.length), facet: crossing / 3 });
        }
    }
}

/// The vertex at the left or the right end of a crossed edge.
fn end_of(polyhedron: &Polyhedron, crossing: u32, is_left: bool) -> u32 {
    polyhedron.half_edges[if is_left { crossing } else { next(crossing) } as usize].vertex
}

/// A point given along a portal and across it, in the strip's plane.
fn place(portal: &[Planar; 2], at: &Planar) -> Planar {
    let [[lx, ly], [rx, ry]] = *portal;
    let length = (rx - lx).hypot(ry - ly);
    let (x, y) = ((rx - lx) / length, (ry - ly) / length);
    [lx + x * at[0] - y * at[1], ly + y * at[0] + x * at[1]]
}

/// Twice the area of a triangle; positive if `c` lies to the left of the line from `a` to `b`.
fn turn(a: &Planar, b: &Planar, c: &Planar) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// The angle (rad) at `at` between two points.
fn angle(at: &Planar, a: &Planar, b: &Planar) -> f64 {
    let dot = (a[0] - at[0]) * (b[0] - at[0]) + (a[1] - at[1]) * (b[1] - at[1]);
    turn(at, a, b).abs().atan2(dot)
}
