//! The wrenches that a grasp's contacts can transmit at unit normal force: round, with a ring of edges
//! inside, or polyhedral as given.

use crate::contacts::{ScaledContact, ScaledGrasp, Twist};
use regrasp_api::{Cone, ConeEdge, FingerIndex, Grasp, MAX_FINGERS, Vec3, tangents};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The most edges of a linearised cone, as the schemas of the settings have it.
const MAX_EDGES: usize = 64;
/// Latitudes at which a soft finger's edges lie, for the most edges: both poles and sixteen steps to each
/// from the equator.
const MAX_LATITUDES: usize = MAX_EDGES / 2 + 1;

/// Where the edges of linearised cones lie: on the circle |f_t| = μ f_n or, for soft fingers, on the
/// ellipsoid |f_t|²/μ² + m²/γ² = f_n².
///
/// m longitudes in equal steps; on the ellipsoid also latitudes in steps of about the same angle, both poles
/// included. All edges lie on the cone's surface, so that the linearised cone is inside the round one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ring {
    count: usize,
    longitudes: [[f64; 2]; MAX_EDGES],
    latitude_count: usize,
    latitudes: [[f64; 2]; MAX_LATITUDES],
    /// Radius of the ball inside the polyhedron inscribed in the unit ball.
    inner: f64,
}

impl Ring {
    /// A ring of `count` edges, 3 to [`MAX_EDGES`].
    pub fn new(count: usize) -> Self {
        let half = ((count + 2) / 4).max(1);
        let cos_sin = |angle: f64| [angle.cos(), angle.sin()];
        let mut longitudes = [[0.0; 2]; MAX_EDGES];
        let mut latitudes = [[0.0; 2]; MAX_LATITUDES];
        for (j, edge) in longitudes.iter_mut().enumerate().take(count) {
            *edge = cos_sin(TAU * j as f64 / count as f64);
        }
        for (k, edge) in latitudes.iter_mut().enumerate().take(2 * half + 1) {
            *edge = cos_sin(FRAC_PI_2 * (k as f64 / half as f64 - 1.0));
        }
        // The poles lie on the axis exactly.
        (latitudes[0][0], latitudes[2 * half][0]) = (0.0, 0.0);
        let inner = (PI / count as f64).cos() * (0.5 * FRAC_PI_2 / half as f64).cos();
        Self { count, longitudes, latitude_count: 2 * half + 1, latitudes, inner }
    }

    /// The edge farthest along (x, y): its direction, and how far.
    #[inline]
    fn farthest(&self, x: f64, y: f64) -> ([f64; 2], f64) {
        best(&self.longitudes[..self.count], x, y)
    }

    /// The latitude farthest along (radial, axial).
    #[inline]
    fn steepest(&self, radial: f64, axial: f64) -> ([f64; 2], f64) {
        best(&self.latitudes[..self.latitude_count], radial, axial)
    }
}

#[inline]
fn best(directions: &[[f64; 2]], x: f64, y: f64) -> ([f64; 2], f64) {
    let mut found = ([0.0; 2], f64::NEG_INFINITY);
    for &direction in directions {
        let reach = direction[0] * x + direction[1] * y;
        if reach > found.1 {
            found = (direction, reach);
        }
    }
    found
}

/// A wrench of one contact at unit normal force: the one farthest along a twist, or an inner one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extreme {
    /// Its power on the twist.
    pub value: f64,
    /// Which contact.
    pub contact: usize,
    /// Force, in O.
    pub f: Vec3,
    /// Torque about the inward normal over the length.
    pub m: f64,
}

impl Extreme {
    /// Nothing.
    pub const NONE: Self = Self { value: f64::NEG_INFINITY, contact: 0, f: Vec3::new(0.0, 0.0, 0.0), m: 0.0 };
}

/// The contacts' sets of wrenches at unit normal force.
#[derive(Clone, Copy)]
pub(crate) struct WrenchSet<'a> {
    /// Points, normals and round cones; polyhedral ones stand as frictionless there.
    pub grasp: ScaledGrasp,
    edges: [Option<&'a [ConeEdge]>; MAX_FINGERS],
    tangents: [[Vec3; 2]; MAX_FINGERS],
    /// How round cones are replaced by edges; round if `None`.
    ring: Option<&'a Ring>,
    polyhedral: bool,
}

impl<'a> WrenchSet<'a> {
    /// The contacts of `grasp` except those of `lifted`.
    pub fn gather(grasp: &'a Grasp<'_>, lifted: Option<FingerIndex>, ring: Option<&'a Ring>) -> Self {
        let zero = Vec3::zeros();
        let mut set = Self {
            grasp: ScaledGrasp::gather_points(grasp, lifted),
            edges: [None; MAX_FINGERS],
            tangents: [[zero, zero]; MAX_FINGERS],
            ring,
            polyhedral: false,
        };
        let held = grasp.contacts().iter().filter(|contact| Some(contact.finger) != lifted);
        for (i, contact) in held.enumerate() {
            set.tangents[i] = tangents(&-contact.n_O);
            if let Cone::Polyhedral(edges) = &contact.cone {
                set.edges[i] = Some(edges);
                set.polyhedral = true;
            }
        }
        set
    }

    /// The contacts.
    pub fn contacts(&self) -> &[ScaledContact] {
        self.grasp.contacts()
    }

    /// Whether some cone came as a list of edges.
    pub fn is_polyhedral(&self) -> bool {
        self.polyhedral
    }

    /// The edges of contact `i`, if its cone came as a list.
    pub fn edges_of(&self, i: usize) -> Option<&'a [ConeEdge]> {
        self.edges[i]
    }

    /// How much of a round cone is certainly inside its edges.
    pub fn inner(&self) -> f64 {
        self.ring.map_or(1.0, |ring| ring.inner)
    }

    /// The wrench of one edge of contact `i`'s list.
    pub fn edge(&self, i: usize, edge: &ConeEdge) -> Extreme {
        let [t1, t2] = self.tangents[i];
        let f = self.contacts()[i].n + t1 * edge.tangential[0] + t2 * edge.tangential[1];
        Extreme { value: 0.0, contact: i, f, m: edge.torsion / self.grasp.length }
    }

    /// A wrench well inside the set of contact `i`: the unit normal force, or the mean of the edges.
    pub fn central(&self, i: usize) -> Extreme {
        let Some(edges) = self.edges[i] else {
            return Extreme { value: 0.0, contact: i, f: self.contacts()[i].n, m: 0.0 };
        };
        let mut mean = Extreme { value: 0.0, contact: i, f: Vec3::zeros(), m: 0.0 };
        for edge in edges {
            let edge_wrench = self.edge(i, edge);
            mean.f += edge_wrench.f / edges.len() as f64;
            mean.m += edge_wrench.m / edges.len() as f64;
        }
        mean
    }

    /// Force and scaled torque of a contact's wrench about the centroid.
    #[inline]
    pub fn wrench(&self, extreme: &Extreme) -> Twist {
        let contact = &self.contacts()[extreme.contact];
        Twist { a: extreme.f, b: contact.r.cross(&extreme.f) + contact.n * extreme.m }
    }

    /// The wrench of any contact at unit normal force that has most power on `w`.
    #[inline]
    pub fn farthest(&self, w: &Twist) -> Extreme {
        let mut best = Extreme::NONE;
        for i in 0..self.contacts().len() {
            let candidate = self.farthest_of(i, w);
            if candidate.value > best.value {
                best = candidate;
            }
        }
        best
    }

    #[inline]
    fn farthest_of(&self, i: usize, w: &Twist) -> Extreme {
        let contact = &self.contacts()[i];
        let v = w.a + w.b.cross(&contact.r);
        if let Some(edges) = self.edges[i] {
            return self.farthest_edge(i, edges, &v, w);
        }
        let v_n = v.dot(&contact.n);
        let beta = contact.gamma * w.b.dot(&contact.n);
        let Some(ring) = self.ring else { return round(i, contact, &v, v_n, beta) };
        if contact.mu <= 0.0 && contact.gamma <= 0.0 && !contact.grained {
            return Extreme { value: v_n, contact: i, f: contact.n, m: 0.0 };
        }
        if let Some(axes) = contact.axes() {
            return grained(i, contact, ring, &axes, &v, beta);
        }
        let [t1, t2] = self.tangents[i];
        let ([cos, sin], across) = ring.farthest(v.dot(&t1), v.dot(&t2));
        let (mut radial, mut axial, mut reach) = (contact.mu, 0.0, contact.mu * across);
        if contact.gamma > 0.0 {
            // Whatever the latitude, the best longitude is the same.
            let (latitude, along) = ring.steepest(reach, beta);
            (radial, axial, reach) = (contact.mu * latitude[0], contact.gamma * latitude[1], along);
        }
        let f = contact.n + (t1 * cos + t2 * sin) * radial;
        Extreme { value: v_n + reach, contact: i, f, m: axial }
    }

    fn farthest_edge(&self, i: usize, edges: &[ConeEdge], v: &Vec3, w: &Twist) -> Extreme {
        let contact = &self.contacts()[i];
        let [t1, t2] = self.tangents[i];
        let (x, y, v_n) = (v.dot(&t1), v.dot(&t2), v.dot(&contact.n));
        let beta = w.b.dot(&contact.n) / self.grasp.length;
        let power =
            |edge: &ConeEdge| v_n + x * edge.tangential[0] + y * edge.tangential[1] + beta * edge.torsion;
        let Some(edge) = edges.iter().max_by(|a, b| power(a).total_cmp(&power(b))) else {
            return Extreme::NONE;
        };
        Extreme { value: power(edge), ..self.edge(i, edge) }
    }
}

/// The farthest edge of a cone with a grain: the ring's, stretched along and across it.
fn grained(
    i: usize,
    contact: &ScaledContact,
    ring: &Ring,
    [(a, along), (b, across)]: &[(Vec3, f64); 2],
    v: &Vec3,
    beta: f64,
) -> Extreme {
    let ([cos, sin], level) = ring.farthest(v.dot(a) * along, v.dot(b) * across);
    let (latitude, reach) =
        if contact.gamma > 0.0 { ring.steepest(level, beta) } else { ([1.0, 0.0], level) };
    let f = contact.n + (a * (cos * along) + b * (sin * across)) * latitude[0];
    Extreme { value: v.dot(&contact.n) + reach, contact: i, f, m: contact.gamma * latitude[1] }
}

/// The farthest wrench of an elliptic cone: the support function's point of contact.
#[inline]
fn round(i: usize, contact: &ScaledContact, v: &Vec3, v_n: f64, beta: f64) -> Extreme {
    let tangential = v - contact.n * v_n;
    let reach = (contact.form(&tangential, &tangential) + beta * beta).sqrt();
    let scale = if reach > 0.0 { 1.0 / reach } else { 0.0 };
    let f = contact.n + contact.squared(&tangential) * scale;
    Extreme { value: v_n + reach, contact: i, f, m: contact.gamma * beta * scale }
}
