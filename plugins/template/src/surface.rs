//! A surface: the facets of a convex object, everything by brute force.
//!
//! An object that is not convex is refused: a fingertip could not reach every
//! point of it, the plane of a facet that faces it would not tell which is closest, and paths would have to
//! go round what the ball cannot enter (`surface/geodesic` does all that).
//!
//! Shortest paths run over points on the edges (Lanthier, Maheshwari, Sack, "Approximating weighted shortest
//! paths on polyhedral surfaces", SoCG 1997), found by Dijkstra's algorithm; with few points an edge they are
//! some percent longer than the shortest.

use regrasp_api::{
    Build, BuildError, CallError, Contact, Context, Entry, Mesh, Parts, Projection, Random, Settings, Slot,
    SurfaceParam, SurfacePath, Vec3, check_settings,
};
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// An edge at which the normal turns by more than this is sharp (rad): 30°.
const SHARP: f64 = std::f64::consts::PI / 6.0;
/// Longest step of a walk (m).
const STEP: f64 = 2e-4;

/// Settings of [`Facets`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FacetsSettings {
    /// Points that a path may cross an edge at; more make paths shorter and slower. Edges that are long for
    /// the object get more.
    #[schemars(range(min = 1, max = 100))]
    pub points: usize,
}

impl Default for FacetsSettings {
    fn default() -> Self {
        Self { points: 3 }
    }
}

impl Settings for FacetsSettings {}

/// The facets of a convex object.
pub struct Facets {
    mesh: Mesh,
    /// Radius of the fingertips (m).
    radius: f64,
    /// Area of all facets up to and with each one (m²).
    areas: Vec<f64>,
    /// Ends of the sharp edges (m).
    sharp: Vec<[Vec3; 2]>,
    /// The points that paths may go through (m): vertices, and points on edges.
    points: Vec<Vec3>,
    of_facet: Vec<Vec<usize>>,
    facets_of: Vec<Vec<u32>>,
}

/// How a point was reached: distance (m), the point before it (`None`: the start), the facet crossed.
type Mark = (f64, Option<usize>, u32);

impl Facets {
    /// The surface of an object; refuses one that is not convex.
    pub fn new(settings: FacetsSettings, parts: &Parts<'_>) -> Result<Self, BuildError> {
        settings.validate()?;
        let mesh = parts.object.contact_mesh().clone();
        if !mesh.is_locally_convex() {
            let reason = "the object is not convex; use `surface/geodesic`, which takes any closed mesh";
            return Err(BuildError::Unsupported(reason.into()));
        }
        let mut sum = 0.0;
        let mut surface = Self {
            radius: parts.hand.fingertip_radius(),
            areas: facets(&mesh)
                .map(|facet| {
                    sum += mesh.area(facet);
                    sum
                })
                .collect(),
            sharp: sharp_edges(&mesh),
            points: mesh.vertices().to_vec(),
            of_facet: Vec::new(),
            facets_of: Vec::new(),
            mesh,
        };
        surface.put_points_on_edges(settings.points);
        Ok(surface)
    }

    fn put_points_on_edges(&mut self, count: usize) {
        let mut on_edge: BTreeMap<[u32; 2], Vec<usize>> = BTreeMap::new();
        let size = self.areas[self.areas.len() - 1].sqrt();
        for facet in facets(&self.mesh) {
            let corners = self.mesh.facets()[facet as usize];
            let mut here: Vec<usize> = corners.iter().map(|&corner| corner as usize).collect();
            for k in 0..3 {
                let (a, b) = (corners[k].min(corners[(k + 1) % 3]), corners[k].max(corners[(k + 1) % 3]));
                let points = &mut self.points;
                let between = on_edge.entry([a, b]).or_insert_with(|| {
                    let (from, to) = (points[a as usize], points[b as usize]);
                    let count = count.max(((to - from).norm() * (12 * count) as f64 / size) as usize);
                    let first = points.len();
                    points.extend((1..=count).map(|i| from.lerp(&to, i as f64 / (count + 1) as f64)));
                    (first..points.len()).collect()
                });
                here.extend(between.iter());
            }
            self.of_facet.push(here);
        }
        self.facets_of = vec![Vec::new(); self.points.len()];
        for (facet, here) in self.of_facet.iter().enumerate() {
            here.iter().for_each(|&point| self.facets_of[point].push(facet as u32));
        }
    }

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

    /// The straight pieces of a path, each in one facet.
    fn pieces(&self, from: &Vec3, to: &Vec3) -> Vec<(u32, Vec3, Vec3)> {
        let (starts, ends) = (self.facets_at(from), self.facets_at(to));
        if let Some(&facet) = starts.iter().find(|facet| ends.contains(facet)) {
            return vec![(facet, *from, *to)];
        }
        let marks = self.spread(from, &starts, to, &ends);
        let last = |&facet: &u32| self.of_facet[facet as usize].iter().map(move |&point| (facet, point));
        let total = |point: usize| marks[point].0 + (self.points[point] - to).norm();
        let closest = ends.iter().flat_map(last).min_by(|a, b| total(a.1).total_cmp(&total(b.1)));
        let Some((mut facet, mut point)) = closest else { return Vec::new() };
        let (mut pieces, mut end) = (Vec::new(), *to);
        loop {
            pieces.push((facet, self.points[point], end));
            end = self.points[point];
            let (_, before, across) = marks[point];
            facet = across;
            let Some(before) = before else { break };
            point = before;
        }
        pieces.push((facet, *from, end));
        pieces.reverse();
        pieces
    }

    /// Dijkstra's algorithm from a point, until every point of the target's facets is settled; the straight
    /// distance to the target leads.
    fn spread(&self, from: &Vec3, starts: &[u32], to: &Vec3, ends: &[u32]) -> Vec<Mark> {
        let mut marks: Vec<Mark> = vec![(f64::INFINITY, None, 0); self.points.len()];
        let mut left: usize = ends.iter().map(|&facet| self.of_facet[facet as usize].len()).sum();
        let mut queue = BinaryHeap::new();
        let offer = |marks: &mut Vec<Mark>, queue: &mut BinaryHeap<_>, point: usize, mark: Mark| {
            if mark.0 < marks[point].0 {
                marks[point] = mark;
                // The bits of nonnegative numbers are ordered like the numbers.
                let estimate = mark.0 + (self.points[point] - to).norm();
                queue.push(Reverse((estimate.to_bits(), mark.0.to_bits(), point)));
            }
        };
        for &facet in starts {
            for &point in &self.of_facet[facet as usize] {
                offer(&mut marks, &mut queue, point, ((self.points[point] - from).norm(), None, facet));
            }
        }
        while let Some(Reverse((_, distance, point))) = queue.pop() {
            let distance = f64::from_bits(distance);
            if distance > marks[point].0 {
                continue;
            }
            left -= self.facets_of[point].iter().filter(|facet| ends.contains(facet)).count();
            if left == 0 {
                break;
            }
            for &facet in &self.facets_of[point] {
                for &next in &self.of_facet[facet as usize] {
                    let length = distance + (self.points[next] - self.points[point]).norm();
                    offer(&mut marks, &mut queue, next, (length, Some(point), facet));
                }
            }
        }
        marks
    }
}

fn facets(mesh: &Mesh) -> impl Iterator<Item = u32> + use<> {
    0..mesh.facets().len() as u32
}

fn sharp_edges(mesh: &Mesh) -> Vec<[Vec3; 2]> {
    let of_facet = |facet: u32| {
        let corners = mesh.corners(facet);
        let sharp = (0..3).filter(move |&k| mesh.neighbors(facet)[k].bend.abs() > SHARP);
        sharp.map(move |k| [corners[k], corners[(k + 1) % 3]])
    };
    facets(mesh).flat_map(of_facet).collect()
}

fn closest_on_segment(a: &Vec3, b: &Vec3, p: &Vec3) -> Vec3 {
    let along = b - a;
    a + along * ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0)
}

/// The point of a triangle closest to `p`: its foot on the plane if that lies inside, else on the nearest
/// side.
fn closest_on_facet(corners: &[Vec3; 3], p: &Vec3) -> Vec3 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a));
    let inside = |a: &Vec3, b: &Vec3| normal.dot(&(b - a).cross(&(p - a))) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) {
        return p - normal * (normal.dot(&(p - a)) / normal.norm_squared());
    }
    let sides = [(a, b), (b, c), (c, a)].map(|(a, b)| closest_on_segment(a, b, p));
    let far = |q: &&Vec3| (*q - p).norm_squared();
    *sides.iter().min_by(|q, r| far(q).total_cmp(&far(r))).expect("a triangle has three sides")
}

impl SurfaceParam for Facets {
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
        for (facet, a, b) in self.pieces(&from.p_OC, &to.p_OC) {
            let n_O = self.mesh.normal(facet);
            go(path, Contact { facet, p_OC: a, n_O });
            go(path, Contact { facet, p_OC: b, n_O });
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

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "surface/template",
    slots: &[Slot::Surface],
    summary: "facets of a convex object (others are refused) by brute force, paths over points on the edges",
    references: &[
        "Lanthier, Maheshwari, Sack, Approximating weighted shortest paths on polyhedral surfaces, SoCG 1997",
    ],
    schema: FacetsSettings::schema,
    check: check_settings::<FacetsSettings>,
    build: Build::Surface(|json, parts| Ok(Box::new(Facets::new(FacetsSettings::from_json(json)?, parts)?))),
};
