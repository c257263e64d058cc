//! A box: straight lines over unfolded faces.

use super::curve::{Curve, Form};
use crate::polyhedron::Planar;
use regrasp_api::Vec3;

/// Points closer to an edge than this fraction of the box lie on it.
const ON_EDGE: f64 = 1e-12;
/// Edges that a walk crosses before it ends where it is.
const MOST_EDGES: usize = 100_000;

/// A box about the origin, along the axes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cuboid {
    /// Half the edge lengths (m).
    pub half: Vec3,
}

/// One of the six faces: the axis of its normal and on which side it lies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Face {
    axis: usize,
    sign: f64,
}

impl Face {
    const ALL: [Self; 6] = [
        Self { axis: 0, sign: 1.0 },
        Self { axis: 0, sign: -1.0 },
        Self { axis: 1, sign: 1.0 },
        Self { axis: 1, sign: -1.0 },
        Self { axis: 2, sign: 1.0 },
        Self { axis: 2, sign: -1.0 },
    ];

    fn number(self) -> usize {
        2 * self.axis + usize::from(self.sign < 0.0)
    }

    /// The two axes in the face's plane.
    fn across(self) -> [usize; 2] {
        [(self.axis + 1) % 3, (self.axis + 2) % 3]
    }

    fn normal(self) -> Vec3 {
        let mut n = Vec3::zeros();
        n[self.axis] = self.sign;
        n
    }
}

/// A face laid out in the plane of the first one.
#[derive(Clone, Copy, Debug)]
struct Sheet {
    face: Face,
    /// Where the face's middle lies.
    middle: Planar,
    /// Where the unit vectors along the axes point; that of the face's own axis is of no use.
    axes: [Planar; 3],
}

impl Sheet {
    fn place(&self, p: &Vec3) -> Planar {
        let [i, j] = self.face.across();
        let along = |k: usize| self.middle[k] + self.axes[i][k] * p[i] + self.axes[j][k] * p[j];
        [along(0), along(1)]
    }

    /// The neighbour over the edge at the side `sign` of axis `i`, turned about that edge.
    fn over(&self, i: usize, sign: f64, half: &Vec3) -> Self {
        let k = self.face.axis;
        let out = self.axes[i].map(|x| x * sign);
        let mut axes = self.axes;
        axes[k] = out.map(|x| -self.face.sign * x);
        let reach = half[i] + half[k];
        let middle = [self.middle[0] + out[0] * reach, self.middle[1] + out[1] * reach];
        Self { face: Face { axis: i, sign }, middle, axes }
    }
}

/// An edge that a straight line crosses: its ends in the plane, right and left of the line, and in O.
#[derive(Clone, Copy, Debug)]
struct Portal {
    flat: [Planar; 2],
    ends: [Vec3; 2],
}

fn turn(a: &Planar, b: &Planar) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// Looks from a point through all sequences of different faces for another.
///
/// A shortest path visits no face of a convex solid twice, and is a straight line through the edges that it
/// crosses when their faces are laid out (Sharir & Schorr, "On shortest paths in polyhedral spaces", SIAM J.
/// Comput. 15, 1986).
struct Look<'a> {
    half: &'a Vec3,
    target: Vec3,
    source: Planar,
    portals: Vec<Portal>,
    best: f64,
    route: Vec<Vec3>,
}

impl Look<'_> {
    /// Looks into a laid out face between two rays.
    fn enter(&mut self, sheet: &Sheet, visited: [bool; 6], cone: Option<[Planar; 2]>) {
        if is_on(self.half, sheet.face, &self.target) {
            self.arrive(&sheet.place(&self.target), cone);
        }
        for i in sheet.face.across() {
            for sign in [1.0, -1.0] {
                if !visited[(Face { axis: i, sign }).number()] {
                    self.through(sheet, visited, cone, (i, sign));
                }
            }
        }
    }

    /// Looks through one edge.
    fn through(
        &mut self,
        sheet: &Sheet,
        mut visited: [bool; 6],
        cone: Option<[Planar; 2]>,
        (i, sign): (usize, f64),
    ) {
        let Some(portal) = self.portal(sheet, i, sign) else { return };
        let [mut right, mut left] = portal.flat.map(|end| self.seen(&end));
        if let Some([least, most]) = cone {
            right = if turn(&least, &right) > 0.0 { right } else { least };
            left = if turn(&left, &most) > 0.0 { left } else { most };
            if turn(&right, &left) <= 0.0 {
                return;
            }
        }
        let next = sheet.over(i, sign, self.half);
        visited[next.face.number()] = true;
        self.portals.push(portal);
        self.enter(&next, visited, Some([right, left]));
        self.portals.pop();
    }

    /// The edge as seen from the source; `None` where the source lies on its line.
    fn portal(&self, sheet: &Sheet, i: usize, sign: f64) -> Option<Portal> {
        let k = sheet.face.axis;
        let mut corner = Vec3::zeros();
        (corner[i], corner[k]) = (sign * self.half[i], sheet.face.sign * self.half[k]);
        let j = 3 - i - k;
        let mut ends = [corner; 2];
        (ends[0][j], ends[1][j]) = (self.half[j], -self.half[j]);
        let mut flat = ends.map(|end| sheet.place(&end));
        let [a, b] = flat.map(|end| self.seen(&end));
        if turn(&a, &b) < 0.0 {
            ends.swap(0, 1);
            flat.swap(0, 1);
        }
        let height = turn(&a, &b).abs() / (2.0 * self.half[j]);
        (height > ON_EDGE * self.half.max()).then_some(Portal { flat, ends })
    }

    /// A point relative to the source.
    fn seen(&self, p: &Planar) -> Planar {
        [p[0] - self.source[0], p[1] - self.source[1]]
    }

    /// Takes a straight line to the target, if it stays in the cone and is the shortest so far.
    fn arrive(&mut self, at: &Planar, cone: Option<[Planar; 2]>) {
        let line = self.seen(at);
        let length = line[0].hypot(line[1]);
        let slack = ON_EDGE * self.half.max();
        // How far the target lies beyond a ray.
        let beyond = |ray: &Planar, side: f64| side * turn(ray, &line) < -slack * ray[0].hypot(ray[1]);
        if length >= self.best || cone.is_some_and(|[right, left]| beyond(&right, 1.0) || beyond(&left, -1.0))
        {
            return;
        }
        self.best = length;
        self.route.clear();
        for portal in &self.portals {
            let [right, left] = portal.flat.map(|end| turn(&line, &self.seen(&end)));
            let t = (right / (right - left)).clamp(0.0, 1.0);
            self.route.push(portal.ends[0].lerp(&portal.ends[1], t));
        }
    }
}

fn is_on(half: &Vec3, face: Face, p: &Vec3) -> bool {
    (face.sign * p[face.axis] - half[face.axis]).abs() <= ON_EDGE * half.max()
}

impl Cuboid {
    fn faces_at<'a>(&'a self, p: &'a Vec3) -> impl Iterator<Item = Face> + 'a {
        Face::ALL.into_iter().filter(move |&face| is_on(&self.half, face, p))
    }

    /// The face into which a direction leads from a point, and the direction in it.
    fn head_out(&self, p: &Vec3, along: &Vec3) -> Option<(Face, Vec3)> {
        let into = |face: Face| {
            let flat = along - face.normal() * face.normal().dot(along);
            let leads_out = |other: Face| other != face && other.normal().dot(&flat) > 0.0;
            let stays = !self.faces_at(p).any(leads_out);
            (stays && flat.norm() > 0.0).then_some((face, flat))
        };
        let found = self.faces_at(p).filter_map(into);
        found.max_by(|a, b| a.1.norm().total_cmp(&b.1.norm())).map(|(face, flat)| (face, flat.normalize()))
    }

    /// Where a line leaves a face: the axis of the edge's other face, and the distance (m).
    fn way_out(&self, face: Face, p: &Vec3, along: &Vec3) -> (usize, f64) {
        let run = |i: usize| ((self.half[i].copysign(along[i]) - p[i]) / along[i]).max(0.0);
        let ways = face.across().map(|i| (i, if along[i] == 0.0 { f64::INFINITY } else { run(i) }));
        if ways[1].1 < ways[0].1 { ways[1] } else { ways[0] }
    }
}

impl Form for Cuboid {
    fn outward(&self, p: &Vec3) -> Vec3 {
        let mut point = p.zip_map(&self.half, |x, h| x.clamp(-h, h));
        let gap = |&i: &usize| self.half[i] - point[i].abs();
        let nearest = (0..3).min_by(|i, j| gap(i).total_cmp(&gap(j))).unwrap_or(0);
        point[nearest] = self.half[nearest].copysign(p[nearest]);
        point
    }

    fn core(&self, _: &Vec3) -> Vec3 {
        Vec3::zeros()
    }

    fn normal(&self, p: &Vec3) -> Vec3 {
        let height = |face: &Face| face.sign * p[face.axis] - self.half[face.axis];
        let highest = Face::ALL.into_iter().max_by(|a, b| height(a).total_cmp(&height(b)));
        highest.map_or(Vec3::z(), Face::normal)
    }

    fn shortest(&self, a: &Vec3, b: &Vec3, spacing: f64, curve: &mut Curve) {
        curve.restart(a);
        let mut look = Look {
            half: &self.half,
            target: *b,
            source: [0.0; 2],
            portals: Vec::new(),
            best: f64::INFINITY,
            route: Vec::new(),
        };
        for face in self.faces_at(a) {
            let [i, j] = face.across();
            let mut axes = [[0.0; 2]; 3];
            (axes[i], axes[j]) = ([1.0, 0.0], [0.0, 1.0]);
            let sheet = Sheet { face, middle: [0.0; 2], axes };
            look.source = sheet.place(a);
            let mut visited = [false; 6];
            visited[face.number()] = true;
            look.enter(&sheet, visited, None);
        }
        look.route.iter().for_each(|crossing| curve.line(spacing, crossing));
        curve.line(spacing, b);
    }

    fn walk(&self, from: &Vec3, along: &Vec3, distance: f64, spacing: f64, curve: &mut Curve) {
        let Some((mut face, mut along)) = self.head_out(from, along) else { return };
        let (mut p, mut left) = (*from, distance);
        for _ in 0..MOST_EDGES {
            let (i, run) = self.way_out(face, &p, &along);
            p += along * run.min(left);
            if run >= left {
                break;
            }
            left -= run;
            let over = Face { axis: i, sign: along[i].signum() };
            p[i] = self.half[i] * over.sign;
            curve.line(spacing, &p);
            along[face.axis] = -face.sign * along[i].abs();
            along[i] = 0.0;
            face = over;
        }
        curve.line(spacing, &p);
    }
}
