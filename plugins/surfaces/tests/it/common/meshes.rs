//! Closed meshes of the kinds that objects have.

use regrasp_api::{Mesh, Random, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// A box about the origin with the given half lengths (m): 12 facets.
pub fn cuboid(half: Vec3) -> Mesh {
    let vertices = (0..8)
        .map(|i| {
            let sign = |bit: i32| f64::from(2 * (i >> bit & 1) - 1);
            Vec3::new(sign(0), sign(1), sign(2)).component_mul(&half)
        })
        .collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Mesh::new(vertices, triangles(&quads)).unwrap()
}

fn triangles(quads: &[[u32; 4]]) -> Vec<[u32; 3]> {
    quads.iter().flat_map(|q| [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]).collect()
}

/// Every facet cut into four.
pub fn subdivide(vertices: &mut Vec<Vec3>, facets: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = BTreeMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            vertices.push((vertices[a as usize] + vertices[b as usize]) / 2.0);
            vertices.len() as u32 - 1
        })
    };
    facets
        .iter()
        .flat_map(|&[a, b, c]| {
            let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
        })
        .collect()
}

/// A ball's icosahedron with each facet cut into 4^levels, vertices on the ball, then stretched along the
/// axes (m).
pub fn ellipsoid(semi_axes: Vec3, levels: usize) -> Mesh {
    let g = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut vertices = Vec::new();
    for (s, t) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        vertices.push(Vec3::new(s, t, 0.0));
    }
    for (s, t) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        vertices.push(Vec3::new(0.0, s, t));
    }
    for (s, t) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        vertices.push(Vec3::new(t, 0.0, s));
    }
    let mut facets = hull(&vertices);
    for _ in 0..levels {
        facets = subdivide(&mut vertices, &facets);
        vertices.iter_mut().for_each(|v| *v = v.normalize());
    }
    vertices.iter_mut().for_each(|v| *v = v.normalize().component_mul(&semi_axes));
    Mesh::new(vertices, facets).unwrap()
}

pub fn sphere(radius: f64, levels: usize) -> Mesh {
    ellipsoid(Vec3::repeat(radius), levels)
}

/// The facets of the convex hull of points in general position, by trying every triple.
fn hull(points: &[Vec3]) -> Vec<[u32; 3]> {
    let count = points.len() as u32;
    let mut facets = Vec::new();
    for a in 0..count {
        for b in 0..count {
            for c in 0..count {
                let [p, q, r] = [a, b, c].map(|i| points[i as usize]);
                let n = (q - p).cross(&(r - p));
                let first = a < b && a < c && b != c;
                let below = |d: u32| d == a || d == b || d == c || n.dot(&(points[d as usize] - p)) < 0.0;
                if first && n.norm() > 0.0 && (0..count).all(below) {
                    facets.push([a, b, c]);
                }
            }
        }
    }
    facets
}

/// The hull of random points between two balls.
pub fn random_hull(seed: u64, count: usize, size: f64) -> Mesh {
    let mut random = Random::from_key(seed, 1, 0, 0);
    let points: Vec<_> = (0..count).map(|_| random.direction() * size * random.range(0.9, 1.0)).collect();
    let facets = hull(&points);
    // Points inside the hull belong to no facet: keep the others only.
    let used: Vec<u32> = (0..count as u32).filter(|i| facets.iter().flatten().any(|j| i == j)).collect();
    let place = |i: u32| used.iter().position(|&j| i == j).unwrap() as u32;
    let facets = facets.iter().map(|facet| facet.map(place)).collect();
    Mesh::new(used.iter().map(|&i| points[i as usize]).collect(), facets).unwrap()
}

/// A ball whose radius varies with the direction: dents and bumps, not convex.
pub fn bumpy(radius: f64, depth: f64, levels: usize) -> Mesh {
    let ball = sphere(1.0, levels);
    let swell = |v: &Vec3| {
        v * radius * (1.0 + depth * (3.0 * v.x).sin() * (4.0 * v.y + 1.0).cos() + depth * (5.0 * v.z).sin())
    };
    Mesh::new(ball.vertices().iter().map(swell).collect(), ball.facets().to_vec()).unwrap()
}

/// A ring about z.
pub fn torus(ring: f64, tube: f64, around: u32, across: u32) -> Mesh {
    let mut vertices = Vec::new();
    for i in 0..around {
        let u = TAU * f64::from(i) / f64::from(around);
        for j in 0..across {
            let v = TAU * f64::from(j) / f64::from(across);
            let rho = ring + tube * v.cos();
            vertices.push(Vec3::new(rho * u.cos(), rho * u.sin(), tube * v.sin()));
        }
    }
    let at = |i: u32, j: u32| (i % around) * across + j % across;
    let quads: Vec<_> = (0..around)
        .flat_map(|i| (0..across).map(move |j| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]))
        .collect();
    Mesh::new(vertices, triangles(&quads)).unwrap()
}

/// A cylinder along z with fans on its ends.
pub fn cylinder(radius: f64, half_height: f64, around: u32) -> Mesh {
    let mut vertices = vec![Vec3::z() * -half_height, Vec3::z() * half_height];
    for i in 0..around {
        let u = TAU * f64::from(i) / f64::from(around);
        for z in [-half_height, half_height] {
            vertices.push(Vec3::new(radius * u.cos(), radius * u.sin(), z));
        }
    }
    let low = |i: u32| 2 + 2 * (i % around);
    let high = |i: u32| 3 + 2 * (i % around);
    let facets = (0..around).flat_map(|i| {
        let (j, k) = (i, i + 1);
        [[0, low(k), low(j)], [1, high(j), high(k)], [low(j), low(k), high(k)], [low(j), high(k), high(j)]]
    });
    Mesh::new(vertices, facets.collect()).unwrap()
}

/// An L: the square of the given size (m) without one quarter, extruded along z to the given height.
pub fn angle_block(size: f64, height: f64) -> Mesh {
    let half = size / 2.0;
    let outline = [(0.0, 0.0), (size, 0.0), (size, half), (half, half), (half, size), (0.0, size)];
    let mut vertices = Vec::new();
    for z in [0.0, height] {
        vertices.extend(outline.iter().map(|&(x, y)| Vec3::new(x, y, z)));
    }
    let cap = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]];
    let mut facets: Vec<[u32; 3]> = cap.iter().map(|&[a, b, c]| [a, c, b]).collect();
    facets.extend(cap.iter().map(|f| f.map(|i| i + 6)));
    for i in 0..6 {
        let j = (i + 1) % 6;
        facets.extend([[i, j, j + 6], [i, j + 6, i + 6]]);
    }
    Mesh::new(vertices, facets).unwrap()
}
