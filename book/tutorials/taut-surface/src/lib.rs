//! A surface for convex objects: paths over points on the mesh's edges, pulled taut.
//!
//! The object has to be convex: at a concave edge a ball touches in two points.

// ANCHOR: uses
mod geometry;

use geometry::{closest_on_facet, closest_on_segment, facets, sharp_edges};
use regrasp_api::{
    Build, BuildError, CallError, Contact, Context, Entry, Mesh, Parts, Projection, Random, Settings, Slot,
    SurfaceParam, SurfacePath, Vec3, check_settings,
};
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};
// ANCHOR_END: uses

// ANCHOR: settings
/// Longest step of a walk (m).
const STEP: f64 = 2e-4;

/// Settings of [`Taut`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TautSettings {
    /// Points on each edge that the first path may go through. Edges that are long for the object get more.
    #[schemars(range(min = 1, max = 100))]
    pub points: usize,
    /// How often the whole path is pulled at most.
    #[schemars(range(max = 10_000))]
    pub rounds: usize,
}

impl Default for TautSettings {
    fn default() -> Self {
        Self { points: 2, rounds: 100 }
    }
}

impl Settings for TautSettings {}
// ANCHOR_END: settings

// ANCHOR: surface
/// A point on an edge that paths may go through.
#[derive(Clone, Copy)]
struct Gate {
    /// The ends of the edge (m).
    edge: [Vec3; 2],
    /// Where on it (m).
    at: Vec3,
}

/// The facets of a convex object.
pub struct Taut {
    mesh: Mesh,
    rounds: usize,
    /// Radius of the fingertips (m).
    radius: f64,
    /// Area of all facets up to and with each one (m²).
    areas: Vec<f64>,
    /// Ends of the sharp edges (m).
    sharp: Vec<[Vec3; 2]>,
    gates: Vec<Gate>,
    of_facet: Vec<Vec<usize>>,
    facets_of: Vec<[u32; 2]>,
}

impl Taut {
    /// The surface of an object; refuses one that is not convex.
    pub fn new(settings: TautSettings, parts: &Parts<'_>) -> Result<Self, BuildError> {
        settings.validate()?;
        let mesh = parts.object.contact_mesh().clone();
        if !mesh.is_locally_convex() {
            let reason = "the object is not convex; use `surface/geodesic`, which takes any closed mesh";
            return Err(BuildError::Unsupported(reason.into()));
        }
        let mut sum = 0.0;
        let areas = facets(&mesh).map(|facet| {
            sum += mesh.area(facet);
            sum
        });
        let mut surface = Self {
            rounds: settings.rounds,
            radius: parts.hand.fingertip_radius(),
            areas: areas.collect(),
            sharp: sharp_edges(&mesh),
            gates: Vec::new(),
            of_facet: vec![Vec::new(); mesh.facets().len()],
            facets_of: Vec::new(),
            mesh,
        };
        surface.put_gates(settings.points);
        Ok(surface)
    }

    /// Spreads gates evenly over the edges, between their ends: a shortest path on a convex object meets no
    /// corner.
    fn put_gates(&mut self, count: usize) {
        let mut first_facet: BTreeMap<[u32; 2], u32> = BTreeMap::new();
        let size = self.areas[self.areas.len() - 1].sqrt();
        for facet in facets(&self.mesh) {
            let corners = self.mesh.facets()[facet as usize];
            for k in 0..3 {
                let ends = [corners[k].min(corners[(k + 1) % 3]), corners[k].max(corners[(k + 1) % 3])];
                let Some(&other) = first_facet.get(&ends) else {
                    first_facet.insert(ends, facet);
                    continue;
                };
                let edge @ [from, to] = ends.map(|end| self.mesh.vertices()[end as usize]);
                let count = count.max(((to - from).norm() * (12 * count) as f64 / size) as usize);
                for i in 1..=count {
                    [facet, other].iter().for_each(|&f| self.of_facet[f as usize].push(self.gates.len()));
                    self.facets_of.push([facet, other]);
                    self.gates.push(Gate { edge, at: from.lerp(&to, i as f64 / (count + 1) as f64) });
                }
            }
        }
    }
}
// ANCHOR_END: surface

// ANCHOR: dijkstra
/// How a gate was reached: distance (m), the gate before it (`None`: the start), the facet crossed.
type Mark = (f64, Option<usize>, u32);

impl Taut {
    /// The facets that hold a point of the surface.
    fn facets_at(&self, p: &Vec3) -> Vec<u32> {
        let holds = |&facet: &u32| {
            // Cheap first: most facets' planes are far away.
            self.height(facet, p).abs() < 1e-9
                && (closest_on_facet(&self.mesh.corners(facet), p) - p).norm() < 1e-9
        };
        facets(&self.mesh).filter(holds).collect()
    }

    /// Height (m) of a point above the plane of a facet.
    fn height(&self, facet: u32, p: &Vec3) -> f64 {
        self.mesh.normal(facet).dot(&(p - self.mesh.corners(facet)[0]))
    }

    /// The facets that a path crosses, and the gates between them, by Dijkstra's algorithm.
    fn strip(&self, from: &Vec3, to: &Vec3) -> (Vec<u32>, Vec<Gate>) {
        let (starts, ends) = (self.facets_at(from), self.facets_at(to));
        if let Some(&facet) = starts.iter().find(|facet| ends.contains(facet)) {
            return (vec![facet], Vec::new());
        }
        let marks = self.spread(from, &starts, to, &ends);
        let last = |&facet: &u32| self.of_facet[facet as usize].iter().map(move |&gate| (facet, gate));
        let total = |gate: usize| marks[gate].0 + (self.gates[gate].at - to).norm();
        let closest = ends.iter().flat_map(last).min_by(|a, b| total(a.1).total_cmp(&total(b.1)));
        let (mut crossed, mut passed) = (Vec::new(), Vec::new());
        let mut next = closest.map(|(facet, gate)| (facet, Some(gate)));
        while let Some((facet, gate)) = next {
            crossed.push(facet);
            next = gate.map(|gate| {
                passed.push(self.gates[gate]);
                (marks[gate].2, marks[gate].1)
            });
        }
        crossed.reverse();
        passed.reverse();
        (crossed, passed)
    }

    /// Dijkstra's algorithm from a point, until every gate of the target's facets is settled; the straight
    /// distance to the target leads.
    fn spread(&self, from: &Vec3, starts: &[u32], to: &Vec3, ends: &[u32]) -> Vec<Mark> {
        let mut marks: Vec<Mark> = vec![(f64::INFINITY, None, 0); self.gates.len()];
        let mut left: usize = ends.iter().map(|&facet| self.of_facet[facet as usize].len()).sum();
        let mut queue = BinaryHeap::new();
        let offer = |marks: &mut Vec<Mark>, queue: &mut BinaryHeap<_>, gate: usize, mark: Mark| {
            if mark.0 < marks[gate].0 {
                marks[gate] = mark;
                // The bits of nonnegative numbers are ordered like the numbers.
                let estimate = mark.0 + (self.gates[gate].at - to).norm();
                queue.push(Reverse((estimate.to_bits(), mark.0.to_bits(), gate)));
            }
        };
        for &facet in starts {
            for &gate in &self.of_facet[facet as usize] {
                offer(&mut marks, &mut queue, gate, ((self.gates[gate].at - from).norm(), None, facet));
            }
        }
        while let Some(Reverse((_, distance, gate))) = queue.pop() {
            let distance = f64::from_bits(distance);
            if distance > marks[gate].0 {
                continue;
            }
            left -= self.facets_of[gate].iter().filter(|facet| ends.contains(facet)).count();
            if left == 0 {
                break;
            }
            for facet in self.facets_of[gate] {
                for &next in &self.of_facet[facet as usize] {
                    let length = distance + (self.gates[next].at - self.gates[gate].at).norm();
                    offer(&mut marks, &mut queue, next, (length, Some(gate), facet));
                }
            }
        }
        marks
    }
}
// ANCHOR_END: dijkstra

// ANCHOR: taut
/// Pulls a path through the gates taut: each gate in turn moves to where it is shortest between its
/// neighbours, again and again.
fn pull(from: &Vec3, gates: &mut [Gate], to: &Vec3, rounds: usize) {
    for _ in 0..rounds {
        let mut moved: f64 = 0.0;
        for i in 0..gates.len() {
            let before = if i == 0 { *from } else { gates[i - 1].at };
            let after = gates.get(i + 1).map_or(*to, |next| next.at);
            let at = straight_over(&gates[i].edge, &before, &after);
            moved = moved.max((at - gates[i].at).norm());
            gates[i].at = at;
        }
        if moved < 1e-9 {
            break;
        }
    }
}

/// Where the straight line from `a` to `b` meets an edge, once the facet with `b` is turned about it into the
/// plane of the one with `a`.
fn straight_over(edge: &[Vec3; 2], a: &Vec3, b: &Vec3) -> Vec3 {
    let along = edge[1] - edge[0];
    let place = |p: &Vec3| (p - edge[0]).dot(&along) / along.norm_squared();
    let height = |p: &Vec3| (p - edge[0] - along * place(p)).norm();
    let (over_a, over_b) = (height(a), height(b));
    if over_a + over_b < 1e-12 {
        return edge[0] + along * place(a).clamp(0.0, 1.0);
    }
    let s = (place(a) * over_b + place(b) * over_a) / (over_a + over_b);
    edge[0] + along * s.clamp(0.0, 1.0)
}
// ANCHOR_END: taut

// ANCHOR: role
impl SurfaceParam for Taut {
    fn sample(&self, random: &mut Random) -> Contact {
        let wanted = random.unit() * self.areas[self.areas.len() - 1];
        let facet = self.areas.partition_point(|&area| area <= wanted).min(self.areas.len() - 1) as u32;
        let [a, b, c] = self.mesh.corners(facet);
        let (mut s, mut t) = (random.unit(), random.unit());
        if s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        Contact { facet, p_OC: a + (b - a) * s + (c - a) * t, n_O: self.mesh.normal(facet) }
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::Surface);
        context.proceed()?;
        path.restart(*from);
        if from == to {
            return Ok(true);
        }
        let mut last = *from;
        let mut go = |path: &mut SurfacePath, next: Contact| {
            let turn = last.n_O.cross(&next.n_O).norm().atan2(last.n_O.dot(&next.n_O));
            let travelled = (next.p_OC - last.p_OC).norm() + self.radius * turn;
            if travelled > 1e-12 {
                path.push(next, travelled);
                path.length += (next.p_OC - last.p_OC).norm();
                last = next;
            }
        };
        let (crossed, mut gates) = self.strip(&from.p_OC, &to.p_OC);
        pull(&from.p_OC, &mut gates, &to.p_OC, self.rounds);
        let stops = std::iter::once(from.p_OC).chain(gates.iter().map(|gate| gate.at)).chain([to.p_OC]);
        let stops: Vec<Vec3> = stops.collect();
        for (&facet, piece) in crossed.iter().zip(stops.windows(2)) {
            // Around a corner the path crosses facets in a point.
            if (piece[1] - piece[0]).norm() > 1e-9 {
                let n_O = self.mesh.normal(facet);
                go(path, Contact { facet, p_OC: piece[0], n_O });
                go(path, Contact { facet, p_OC: piece[1], n_O });
            }
        }
        go(path, *to);
        // The path ends exactly where it was asked to.
        match path.waypoints.as_mut_slice() {
            [_] => path.push(*to, 0.0),
            waypoints => waypoints[waypoints.len() - 1].contact = *to,
        }
        Ok(true)
    }

    fn project(&self, p_OF: &Vec3, _hint: Option<u32>) -> Projection {
        let highest =
            facets(&self.mesh).max_by(|&a, &b| self.height(a, p_OF).total_cmp(&self.height(b, p_OF)));
        let highest = highest.expect("a mesh has facets");
        let height = self.height(highest, p_OF);
        if height <= 1e-9 {
            // Inside a convex object the closest plane holds the closest point.
            let n_O = self.mesh.normal(highest);
            return Projection {
                contact: Contact { facet: highest, p_OC: p_OF - n_O * height, n_O },
                distance: height,
            };
        }
        let (mut facet, mut point, mut distance) = (highest, Vec3::zeros(), f64::INFINITY);
        for candidate in facets(&self.mesh) {
            // Only facets that can be seen can be closest, and none is closer than its plane.
            let height = self.height(candidate, p_OF);
            if height > 0.0 && height < distance {
                let closest = closest_on_facet(&self.mesh.corners(candidate), p_OF);
                let apart = (p_OF - closest).norm();
                if apart < distance {
                    (facet, point, distance) = (candidate, closest, apart);
                }
            }
        }
        Projection { contact: Contact { facet, p_OC: point, n_O: (p_OF - point) / distance }, distance }
    }

    /// Small steps in the tangent plane, each projected back: they can only become shorter, by less than a
    /// thousandth.
    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        let steps = (distance / STEP).ceil() as usize;
        let (mut at, mut direction) = (*from, *direction_O);
        for _ in 0..steps {
            direction -= at.n_O * at.n_O.dot(&direction);
            let Some(along) = direction.try_normalize(1e-12) else { break };
            at = self.project(&(at.p_OC + along * (distance / steps as f64)), None).contact;
        }
        at
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        let apart = |[a, b]: &[Vec3; 2]| (closest_on_segment(a, b, &contact.p_OC) - contact.p_OC).norm();
        self.sharp.iter().map(apart).fold(f64::INFINITY, f64::min)
    }
}
// ANCHOR_END: role

// ANCHOR: entry
/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "surface/taut",
    slots: &[Slot::Surface],
    summary: "facets of a convex object (others are refused), paths over points on the edges, pulled taut",
    references: &[
        "Lanthier, Maheshwari, Sack, Approximating weighted shortest paths on polyhedral surfaces, SoCG 1997",
    ],
    schema: TautSettings::schema,
    check: check_settings::<TautSettings>,
    build: Build::Surface(|json, parts| Ok(Box::new(Taut::new(TautSettings::from_json(json)?, parts)?))),
};
regrasp_api::inventory::submit! { ENTRY }
// ANCHOR_END: entry

// ANCHOR: tests
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_over_one_edge_is_straight_once_the_edge_is_unfolded() {
        // Two unit squares that meet at a right angle in the y axis: unfolded, the ends are 1 and 3 along it,
        // 1 to each side.
        let edge = [Vec3::zeros(), Vec3::new(0.0, 4.0, 0.0)];
        let (a, b) = (Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 3.0, -1.0));
        assert!((straight_over(&edge, &a, &b) - Vec3::new(0.0, 2.0, 0.0)).norm() < 1e-12);
        let far = Vec3::new(0.0, 30.0, -1.0);
        assert_eq!(straight_over(&edge, &a, &far), edge[1], "it stays on the edge");
    }

    #[test]
    fn a_slack_path_becomes_straight() {
        // Parallel edges in a plane, so that nothing has to be unfolded.
        let gate = |x: f64, y: f64| Gate {
            edge: [Vec3::new(x, -9.0, 0.0), Vec3::new(x, 9.0, 0.0)],
            at: Vec3::new(x, y, 0.0),
        };
        let mut gates = [gate(1.0, 5.0), gate(2.0, -3.0), gate(3.0, 4.0)];
        pull(&Vec3::zeros(), &mut gates, &Vec3::new(4.0, 4.0, 0.0), 100);
        for (gate, y) in gates.iter().zip([1.0, 2.0, 3.0]) {
            assert!((gate.at.y - y).abs() < 1e-6, "{}", gate.at);
        }
    }
}
// ANCHOR_END: tests
