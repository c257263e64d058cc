//! Shortest paths by brute force: every strip of facets that a straight line can run through, every chain of
//! vertices.
//!
//! Exponential, without bounds or labels: for meshes of a few dozen facets.

use regrasp_api::{Contact, Mesh, Vec3};

/// Two-dimensional coordinates in an unfolded plane (m).
type P2 = [f64; 2];

fn sub(a: P2, b: P2) -> P2 {
    [a[0] - b[0], a[1] - b[1]]
}
fn cross(a: P2, b: P2) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
fn norm(a: P2) -> f64 {
    a[0].hypot(a[1])
}

/// A line of sight through unfolded facets.
struct Sight<'a> {
    mesh: &'a Mesh,
    target: Vec3,
    target_facets: Vec<u32>,
    visited: Vec<bool>,
    best: f64,
}

/// The facets that hold a point (m), to 1e-10 m.
pub fn facets_with(mesh: &Mesh, p: &Vec3) -> Vec<u32> {
    (0..mesh.facets().len() as u32).filter(|&f| distance_to_facet(mesh, f, p) < 1e-10).collect()
}

/// Distance (m) of a point from a facet, from the three half-planes and the plane: exact for points in the
/// plane's slab.
fn distance_to_facet(mesh: &Mesh, facet: u32, p: &Vec3) -> f64 {
    let corners = mesh.corners(facet);
    let n = mesh.normal(facet);
    let outside = (0..3).map(|k| {
        let along = (corners[(k + 1) % 3] - corners[k]).normalize();
        along.cross(&n).dot(&(p - corners[k]))
    });
    outside.fold(n.dot(&(p - corners[0])).abs(), f64::max)
}

/// Where a point with the given distances from two unfolded points lies, to the left of the line from `a` to
/// `b`.
fn locate(a: P2, b: P2, to_a: f64, to_b: f64) -> P2 {
    let d = sub(b, a);
    let length = norm(d);
    let x = (to_a * to_a - to_b * to_b + length * length) / (2.0 * length);
    let y = (to_a * to_a - x * x).max(0.0).sqrt();
    [a[0] + (d[0] * x - d[1] * y) / length, a[1] + (d[1] * x + d[0] * y) / length]
}

impl Sight<'_> {
    /// Looks from the origin into `facet`, whose edge from vertex `v[0]` to `v[1]` is unfolded to `a`, `b`,
    /// between the rays towards `left` and `right`.
    fn look(&mut self, facet: u32, v: [u32; 2], a: P2, b: P2, right: P2, left: P2) {
        if self.visited[facet as usize] {
            return;
        }
        let corners = self.mesh.facets()[facet as usize];
        let k = (0..3).find(|&k| corners[k] == v[0]).unwrap();
        assert_eq!(corners[(k + 1) % 3], v[1]);
        let (p, q) = (self.mesh.vertices()[v[0] as usize], self.mesh.vertices()[v[1] as usize]);
        if self.target_facets.contains(&facet) {
            let t = locate(a, b, (self.target - p).norm(), (self.target - q).norm());
            if cross(right, t) >= -1e-12 && cross(t, left) >= -1e-12 {
                self.best = self.best.min(norm(t));
            }
        }
        let apex = corners[(k + 2) % 3];
        let c = self.mesh.vertices()[apex as usize];
        let top = locate(a, b, (c - p).norm(), (c - q).norm());
        self.visited[facet as usize] = true;
        // The facet lies to the left of a → b, so a is on the left side seen from the origin... its edges b →
        // top and top → a.
        self.cross_edge(facet, (k + 1) % 3, b, top, right, left);
        self.cross_edge(facet, (k + 2) % 3, top, a, right, left);
        self.visited[facet as usize] = false;
    }

    /// Goes on through edge `k` of `facet`, unfolded from `from` to `to` (counter-clockwise in the facet).
    fn cross_edge(&mut self, facet: u32, k: usize, from: P2, to: P2, right: P2, left: P2) {
        let right = if cross(right, from) > 0.0 { from } else { right };
        let left = if cross(to, left) > 0.0 { to } else { left };
        if cross(right, left) <= 0.0 {
            return;
        }
        let corners = self.mesh.facets()[facet as usize];
        let across = self.mesh.neighbors(facet)[k].facet;
        self.look(across, [corners[(k + 1) % 3], corners[k]], to, from, right, left);
    }
}

/// The shortest straight line from `s` to `t` through unfolded facets, passing no vertex (m); infinite if
/// there is none.
fn straight(mesh: &Mesh, s: &Vec3, t: &Vec3) -> f64 {
    let (starts, target_facets) = (facets_with(mesh, s), facets_with(mesh, t));
    assert!(!starts.is_empty() && !target_facets.is_empty());
    if starts.iter().any(|facet| target_facets.contains(facet)) {
        return (s - t).norm();
    }
    let mut sight = Sight {
        mesh,
        target: *t,
        target_facets,
        visited: vec![false; mesh.facets().len()],
        best: f64::INFINITY,
    };
    for &facet in &starts {
        let corners = mesh.corners(facet);
        let e1 = (corners[1] - corners[0]).normalize();
        let e2 = mesh.normal(facet).cross(&e1);
        let flat = corners.map(|c| [(c - s).dot(&e1), (c - s).dot(&e2)]);
        sight.visited[facet as usize] = true;
        for k in 0..3 {
            let (from, to) = (flat[k], flat[(k + 1) % 3]);
            if cross(from, to) > 1e-12 * norm(sub(to, from)) {
                sight.cross_edge(facet, k, from, to, from, to);
            }
        }
        sight.visited[facet as usize] = false;
    }
    sight.best
}

/// The exact distance between two points of the surface (m).
pub fn shortest(mesh: &Mesh, from: &Contact, to: &Contact) -> f64 {
    let mut stops: Vec<Vec3> = vec![from.p_OC, to.p_OC];
    let saddles = saddle_vertices(mesh);
    stops.extend(saddles.iter().map(|&v| mesh.vertices()[v]));
    let count = stops.len();
    let mut length = vec![f64::INFINITY; count];
    let mut done = vec![false; count];
    length[0] = 0.0;
    // Dijkstra over start, target and saddle vertices.
    while let Some(i) = (0..count)
        .filter(|&i| !done[i] && length[i].is_finite())
        .min_by(|&a, &b| length[a].total_cmp(&length[b]))
    {
        if i == 1 {
            break;
        }
        done[i] = true;
        for j in (0..count).filter(|&j| j != i) {
            if !done[j] && (stops[i] - stops[j]).norm() + length[i] < length[j] {
                length[j] = length[j].min(length[i] + straight(mesh, &stops[i], &stops[j]));
            }
        }
    }
    length[1]
}

/// The vertices with more than a full turn of facets.
fn saddle_vertices(mesh: &Mesh) -> Vec<usize> {
    let mut angle = vec![0.0; mesh.vertices().len()];
    for (facet, corners) in mesh.facets().iter().enumerate() {
        let p = mesh.corners(facet as u32);
        for k in 0..3 {
            angle[corners[k] as usize] += (p[(k + 1) % 3] - p[k]).angle(&(p[(k + 2) % 3] - p[k]));
        }
    }
    (0..angle.len()).filter(|&v| angle[v] > std::f64::consts::TAU + 1e-9).collect()
}

/// Distance (m) of a point from the mesh, by trying every facet with every edge.
pub fn distance(mesh: &Mesh, p: &Vec3) -> f64 {
    (0..mesh.facets().len() as u32).map(|facet| from_facet(mesh, facet, p)).fold(f64::INFINITY, f64::min)
}

fn from_facet(mesh: &Mesh, facet: u32, p: &Vec3) -> f64 {
    let corners = mesh.corners(facet);
    let n = mesh.normal(facet);
    let height = n.dot(&(p - corners[0]));
    let foot = p - n * height;
    let inside =
        (0..3).all(|k| n.cross(&(corners[(k + 1) % 3] - corners[k])).dot(&(foot - corners[k])) >= 0.0);
    if inside {
        return height.abs();
    }
    let edges = (0..3).map(|k| {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        let t = ((p - a).dot(&(b - a)) / (b - a).norm_squared()).clamp(0.0, 1.0);
        (a + (b - a) * t - p).norm()
    });
    edges.fold(f64::INFINITY, f64::min)
}

/// Distances (m) on a graph with many points on every edge (Lanthier, Maheshwari & Sack, "Approximated
/// weighted shortest paths on polyhedral surfaces", SoCG 1997): never too short, too long by less and less
/// with more points.
pub struct EdgePoints<'a> {
    mesh: &'a Mesh,
    places: Vec<Vec3>,
    of_facet: Vec<Vec<usize>>,
}

impl<'a> EdgePoints<'a> {
    pub fn new(mesh: &'a Mesh, per_edge: usize) -> Self {
        let mut places = mesh.vertices().to_vec();
        let mut of_facet: Vec<Vec<usize>> =
            mesh.facets().iter().map(|corners| corners.iter().map(|&v| v as usize).collect()).collect();
        for facet in 0..mesh.facets().len() as u32 {
            let corners = mesh.corners(facet);
            for (k, neighbor) in mesh.neighbors(facet).iter().enumerate().filter(|(_, n)| n.facet > facet) {
                for i in 1..=per_edge {
                    of_facet[facet as usize].push(places.len());
                    of_facet[neighbor.facet as usize].push(places.len());
                    places.push(corners[k].lerp(&corners[(k + 1) % 3], i as f64 / (per_edge + 1) as f64));
                }
            }
        }
        Self { mesh, places, of_facet }
    }

    /// The distances from a start to every place.
    pub fn from(&self, start: &Vec3) -> Vec<f64> {
        let mut facets = vec![Vec::new(); self.places.len()];
        for (facet, places) in self.of_facet.iter().enumerate() {
            places.iter().for_each(|&place| facets[place].push(facet));
        }
        let mut length = vec![f64::INFINITY; self.places.len()];
        let mut queue = std::collections::BinaryHeap::new();
        // Positive numbers have the order of their bits.
        let key = |length: f64, place: usize| std::cmp::Reverse((length.to_bits(), place));
        for facet in facets_with(self.mesh, start) {
            for &place in &self.of_facet[facet as usize] {
                length[place] = (self.places[place] - start).norm();
                queue.push(key(length[place], place));
            }
        }
        while let Some(std::cmp::Reverse((bits, place))) = queue.pop() {
            if f64::from_bits(bits) > length[place] {
                continue;
            }
            for &next in facets[place].iter().flat_map(|&facet| &self.of_facet[facet]) {
                let through = length[place] + (self.places[next] - self.places[place]).norm();
                if through < length[next] {
                    length[next] = through;
                    queue.push(key(through, next));
                }
            }
        }
        length
    }

    /// The distance to a point, given the distances to the places.
    pub fn to(&self, length: &[f64], start: &Vec3, target: &Vec3) -> f64 {
        let (starts, ends) = (facets_with(self.mesh, start), facets_with(self.mesh, target));
        if starts.iter().any(|facet| ends.contains(facet)) {
            return (start - target).norm();
        }
        ends.iter()
            .flat_map(|&facet| &self.of_facet[facet as usize])
            .map(|&place| length[place] + (self.places[place] - target).norm())
            .fold(f64::INFINITY, f64::min)
    }
}
