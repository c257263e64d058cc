//! Shortest paths over points on a mesh's edges, by Dijkstra's algorithm.
//!
//! E. Dijkstra, "A note on two problems in connexion with graphs", Numerische Mathematik 1959; the points on
//! edges are those of M. Lanthier, A. Maheshwari, J.-R. Sack, "Approximating weighted shortest paths on
//! polyhedral surfaces", SoCG 1997.

use regrasp_api::{Mesh, Vec3};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// A straight piece of a path: its facet, start and end (m).
pub(super) type Leg = (u32, Vec3, Vec3);

/// Points on the edges; those of one facet are joined by straight lines.
pub(super) struct SteinerGraph {
    points: Vec<Vec3>,
    /// The points of each facet.
    of_facet: Vec<Vec<usize>>,
    /// The facets of each point.
    facets_of: Vec<Vec<u32>>,
}

impl SteinerGraph {
    /// Points at most `spacing` m apart on every edge, vertices included.
    pub fn new(mesh: &Mesh, spacing: f64) -> Self {
        let mut points = mesh.vertices().to_vec();
        let mut on_edge: BTreeMap<(u32, u32), Vec<usize>> = BTreeMap::new();
        let mut of_facet = Vec::new();
        for &corners in mesh.facets() {
            let mut all: Vec<usize> = corners.iter().map(|&v| v as usize).collect();
            for k in 0..3 {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let ends = (a.min(b), a.max(b));
                let between = on_edge.entry(ends).or_insert_with(|| split(&mut points, ends, spacing));
                all.extend(between.iter());
            }
            of_facet.push(all);
        }
        let mut facets_of = vec![Vec::new(); points.len()];
        for (facet, all) in of_facet.iter().enumerate() {
            all.iter().for_each(|&point| facets_of[point].push(facet as u32));
        }
        Self { points, of_facet, facets_of }
    }

    /// Length (m) and pieces of the shortest path between two points, each given with the facets that hold
    /// it.
    pub fn shortest(&self, from: &(Vec3, Vec<u32>), to: &(Vec3, Vec<u32>)) -> Option<(f64, Vec<Leg>)> {
        if let Some(&facet) = from.1.iter().find(|facet| to.1.contains(facet)) {
            return Some(((to.0 - from.0).norm(), vec![(facet, from.0, to.0)]));
        }
        // For each point the distance so far, the point before it (none: the start) and the facet crossed.
        let mut reached: Vec<(f64, Option<usize>, u32)> = vec![(f64::INFINITY, None, 0); self.points.len()];
        let mut queue = BinaryHeap::new();
        for &facet in &from.1 {
            for &point in &self.of_facet[facet as usize] {
                let distance = (self.points[point] - from.0).norm();
                if distance < reached[point].0 {
                    reached[point] = (distance, None, facet);
                    queue.push(Reverse((distance.to_bits(), point)));
                }
            }
        }
        self.spread(&mut reached, &mut queue);
        let ends = to.1.iter().flat_map(|&f| self.of_facet[f as usize].iter().map(move |&point| (f, point)));
        let total = |point: usize| reached[point].0 + (self.points[point] - to.0).norm();
        let (facet, last) = ends.min_by(|a, b| total(a.1).total_cmp(&total(b.1)))?;
        let mut legs = vec![(facet, self.points[last], to.0)];
        let mut at = last;
        loop {
            let (_, before, facet) = reached[at];
            legs.push((facet, before.map_or(from.0, |point| self.points[point]), self.points[at]));
            let Some(point) = before else { break };
            at = point;
        }
        legs.reverse();
        total(last).is_finite().then(|| (total(last), legs))
    }

    fn spread(
        &self,
        reached: &mut [(f64, Option<usize>, u32)],
        queue: &mut BinaryHeap<Reverse<(u64, usize)>>,
    ) {
        // The bits of nonnegative numbers are ordered like the numbers.
        while let Some(Reverse((bits, point))) = queue.pop() {
            let distance = f64::from_bits(bits);
            if distance > reached[point].0 {
                continue;
            }
            for &facet in &self.facets_of[point] {
                for &next in &self.of_facet[facet as usize] {
                    let longer = distance + (self.points[next] - self.points[point]).norm();
                    if longer < reached[next].0 {
                        reached[next] = (longer, Some(point), facet);
                        queue.push(Reverse((longer.to_bits(), next)));
                    }
                }
            }
        }
    }
}

/// Adds points inside an edge and returns their numbers.
fn split(points: &mut Vec<Vec3>, ends: (u32, u32), spacing: f64) -> Vec<usize> {
    let (a, b) = (points[ends.0 as usize], points[ends.1 as usize]);
    let pieces = ((b - a).norm() / spacing).ceil().max(2.0) as usize;
    let first = points.len();
    points.extend((1..pieces).map(|k| a.lerp(&b, k as f64 / pieces as f64)));
    (first..points.len()).collect()
}
