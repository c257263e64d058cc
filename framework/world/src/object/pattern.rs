//! Facet patterns of the primitives: closed, outward, every vertex on the true surface.

use regrasp_api::{Primitive, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// Vertices (m) and facets, counter-clockwise seen from outside.
pub(super) type Facets = (Vec<Vec3>, Vec<[u32; 3]>);

/// How much longer than wide the cells of a straight side may be: longer cells would make slivers, shorter
/// ones waste facets where the surface is straight.
const CELL_ASPECT: f64 = 4.0;

/// The pattern of `primitive` whose number of facets comes nearest to `wished`.
pub(super) fn facets_of(primitive: &Primitive, wished: usize) -> Facets {
    match *primitive {
        Primitive::Sphere { radius } => icosphere(Vec3::repeat(radius), wished),
        Primitive::Ellipsoid { semi_axes } => icosphere(semi_axes, wished),
        Primitive::Cuboid { half_size } => cuboid(half_size),
        Primitive::Cylinder { radius, half_height } => {
            nearest(wished, 3, |sides| cylinder_profile(radius, half_height, sides))
        }
        Primitive::Capsule { radius, half_height } => {
            nearest(wished, 4, |sides| capsule_profile(radius, half_height, sides))
        }
        Primitive::Torus { ring_radius, tube_radius } => torus(ring_radius, tube_radius, wished),
    }
}

/// An icosahedron whose facets are quartered k times (20 · 4^k facets), its vertices pushed onto the
/// ellipsoid.
fn icosphere(semi_axes: Vec3, wished: usize) -> Facets {
    let (mut vertices, mut facets) = icosahedron();
    // The next finer pattern is nearer as soon as the wish exceeds the mean of the two.
    while wished > facets.len() * 5 / 2 {
        (vertices, facets) = quartered(vertices, &facets);
    }
    vertices.iter_mut().for_each(|v| *v = v.component_mul(&semi_axes));
    (vertices, facets)
}

fn icosahedron() -> Facets {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut vertices = Vec::with_capacity(12);
    for axis in 0..3 {
        for (a, b) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut v = Vec3::zeros();
            (v[(axis + 1) % 3], v[(axis + 2) % 3]) = (a, b);
            vertices.push(v.normalize());
        }
    }
    let edge = 2.0 / (1.0 + golden * golden).sqrt();
    let near = |a: Vec3, b: Vec3| ((a - b).norm() - edge).abs() < 1e-9;
    let mut facets = Vec::with_capacity(20);
    for i in 0..12_u32 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                let [a, b, c] = [i, j, k].map(|v| vertices[v as usize]);
                if near(a, b) && near(b, c) && near(c, a) {
                    let outward = (b - a).cross(&(c - a)).dot(&a) > 0.0;
                    facets.push(if outward { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    (vertices, facets)
}

/// Every facet of a unit sphere's mesh cut into four at the middles of its edges.
fn quartered(mut vertices: Vec<Vec3>, facets: &[[u32; 3]]) -> Facets {
    let mut middles = BTreeMap::new();
    let mut finer = Vec::with_capacity(4 * facets.len());
    for &[a, b, c] in facets {
        let mut middle = |i: u32, j: u32| {
            *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                vertices.push((vertices[i as usize] + vertices[j as usize]).normalize());
                vertices.len() as u32 - 1
            })
        };
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        finer.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    (vertices, finer)
}

fn cuboid(half_size: Vec3) -> Facets {
    let sign = |bit: u32| if bit & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i: u32| Vec3::new(sign(i), sign(i >> 1), sign(i >> 2)).component_mul(&half_size);
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let facets = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    ((0..8).map(corner).collect(), facets)
}

/// Rings of a surface of revolution about z, bottom to top, as (radius, z), without the poles that close it.
struct Profile {
    rings: Vec<[f64; 2]>,
    poles: [f64; 2],
}

fn cylinder_profile(radius: f64, half_height: f64, sides: usize) -> Profile {
    let rings = side_heights(radius, half_height, sides).map(|z| [radius, z]).collect();
    Profile { rings, poles: [-half_height, half_height] }
}

fn capsule_profile(radius: f64, half_height: f64, sides: usize) -> Profile {
    let steps = (sides as f64 / 4.0).round().max(1.0) as usize;
    let arc = |i: usize| (PI / 2.0 * i as f64 / steps as f64).sin_cos();
    let mut rings: Vec<_> =
        (1..steps).map(arc).map(|(sin, cos)| [radius * sin, -half_height - radius * cos]).collect();
    rings.extend(side_heights(radius, half_height, sides).map(|z| [radius, z]));
    rings.extend((1..steps).rev().map(arc).map(|(sin, cos)| [radius * sin, half_height + radius * cos]));
    Profile { rings, poles: [-half_height - radius, half_height + radius] }
}

/// The heights of the rings of a straight side, both ends included.
fn side_heights(radius: f64, half_height: f64, sides: usize) -> impl Iterator<Item = f64> {
    let width = TAU * radius / sides as f64;
    // A long thin side must not eat the facets that make it round.
    let cells = (2.0 * half_height / (CELL_ASPECT * width)).round().clamp(1.0, 1.0 + sides as f64) as usize;
    (0..=cells).map(move |i| half_height * (2.0 * i as f64 / cells as f64 - 1.0))
}

/// The revolved profile whose number of facets comes nearest to `wished`, with at least `fewest` sides.
fn nearest(wished: usize, fewest: usize, profile: impl Fn(usize) -> Profile) -> Facets {
    let count = |sides: usize| 2 * sides * profile(sides).rings.len();
    // The count grows with the number of sides: find the first that is too many by doubling and halving.
    let mut high = fewest + 1;
    while count(high) < wished {
        high *= 2;
    }
    let mut low = fewest;
    while high - low > 1 {
        let middle = (low + high) / 2;
        if count(middle) < wished { low = middle } else { high = middle }
    }
    let sides = if wished.abs_diff(count(low)) <= wished.abs_diff(count(high)) { low } else { high };
    revolved(&profile(sides), sides)
}

fn revolved(profile: &Profile, sides: usize) -> Facets {
    let ring = |&[radius, z]: &[f64; 2]| {
        (0..sides).map(move |i| {
            let (sin, cos) = (TAU * i as f64 / sides as f64).sin_cos();
            Vec3::new(radius * cos, radius * sin, z)
        })
    };
    let mut vertices: Vec<Vec3> = profile.rings.iter().flat_map(ring).collect();
    let (count, n) = (profile.rings.len() as u32, sides as u32);
    let (bottom, top) = (count * n, count * n + 1);
    vertices.extend(profile.poles.map(|z| Vec3::new(0.0, 0.0, z)));
    let mut facets = Vec::with_capacity((2 * n * count) as usize);
    for i in 0..n {
        let next = (i + 1) % n;
        facets.push([bottom, next, i]);
        for k in 0..count - 1 {
            facets.extend(quad([k * n + i, k * n + next, (k + 1) * n + next, (k + 1) * n + i]));
        }
        facets.push([top, (count - 1) * n + i, (count - 1) * n + next]);
    }
    (vertices, facets)
}

fn quad([a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
    [[a, b, c], [a, c, d]]
}

/// Two facets for each cell of a grid about the ring and about the tube, the cells about as wide as high.
fn torus(ring_radius: f64, tube_radius: f64, wished: usize) -> Facets {
    let cells = wished as f64 / 2.0;
    let m = (cells * tube_radius / ring_radius).sqrt().round().clamp(3.0, (cells / 3.0).max(3.0));
    let n = (cells / m).round().max(3.0);
    let (m, n) = (m as u32, n as u32);
    let vertex = |index: u32| {
        let (sin_ring, cos_ring) = (TAU * f64::from(index / m) / f64::from(n)).sin_cos();
        let (sin_tube, cos_tube) = (TAU * f64::from(index % m) / f64::from(m)).sin_cos();
        let radius = ring_radius + tube_radius * cos_tube;
        Vec3::new(radius * cos_ring, radius * sin_ring, tube_radius * sin_tube)
    };
    let mut facets = Vec::with_capacity((2 * n * m) as usize);
    for i in 0..n {
        for k in 0..m {
            let (next_i, next_k) = ((i + 1) % n * m, (k + 1) % m);
            facets.extend(quad([i * m + k, next_i + k, next_i + next_k, i * m + next_k]));
        }
    }
    ((0..n * m).map(vertex).collect(), facets)
}
