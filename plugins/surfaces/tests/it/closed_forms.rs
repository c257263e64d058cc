//! The closed forms behind `surface/parametric`, against independent formulas.

use crate::common;

use common::{anywhere, length, meshes, reference};
use regrasp_api::{Primitive, Random, SurfaceParam, Vec3};
use regrasp_surfaces::geodesic::{Geodesic, GeodesicSettings};
use regrasp_surfaces::parametric::{ClosedForm, Curve};
use std::f64::consts::PI;

fn curve(form: &ClosedForm, a: &Vec3, b: &Vec3) -> Curve {
    let mut curve = Curve::default();
    form.shortest(a, b, 1e-3, &mut curve);
    assert_eq!((curve.points[0], curve.points[curve.points.len() - 1]), (*a, *b));
    let step = curve.points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
    assert!(step <= 1e-3 * (1.0 + 1e-9), "{step} m between two points");
    curve
}

#[test]
fn a_ball_has_great_circles() {
    let form = ClosedForm::new(&Primitive::Sphere { radius: 0.03 });
    let mut random = Random::from_key(1, 0, 0, 0);
    for i in 0..500 {
        let u = random.direction();
        // Also nearly the same and nearly opposite points.
        let v = match i % 4 {
            0 => (u + random.direction() * 1e-6).normalize(),
            1 => (-u + random.direction() * 1e-6).normalize(),
            2 => random.direction(),
            _ => -u,
        };
        let (a, b) = (u * 0.03, v * 0.03);
        let curve = curve(&form, &a, &b);
        let arc = 0.03 * 2.0 * ((u - v).norm() / 2.0).min(1.0).asin();
        let near_opposite = (u + v).norm() < 1e-3;
        assert!((curve.length - arc).abs() < if near_opposite { 1e-6 } else { 1e-12 });
        let plane = u.cross(&v);
        for p in &curve.points {
            assert!((p.norm() - 0.03).abs() < 1e-15);
            assert!(plane.norm() < 1e-3 || plane.normalize().dot(p).abs() < 1e-12);
        }
        let other = 0.03 * (PI - 2.0 * ((u + v).norm() / 2.0).min(1.0).asin());
        assert!(!near_opposite || (curve.length - other).abs() < 1e-12);
    }
}

#[test]
fn over_a_box_all_unfoldings_are_tried() {
    // Dudeney's spider and fly, in feet: 40, over five of the six faces.
    let form = ClosedForm::new(&Primitive::Cuboid { half_size: Vec3::new(15.0, 6.0, 6.0) });
    let mut path = Curve::default();
    form.shortest(&Vec3::new(15.0, 0.0, 5.0), &Vec3::new(-15.0, 0.0, -5.0), 1.0, &mut path);
    assert!((path.length - 40.0).abs() < 1e-12, "{}", path.length);
    let mut random = Random::from_key(2, 0, 0, 0);
    for half in [Vec3::repeat(0.0225), Vec3::new(0.04, 0.015, 0.006), Vec3::new(0.03, 0.03, 0.002)] {
        let mesh = meshes::cuboid(half);
        let form = ClosedForm::new(&Primitive::Cuboid { half_size: half });
        for _ in 0..150 {
            let [from, to] = [(); 2].map(|()| anywhere(&mesh, &mut random));
            let best = reference::shortest(&mesh, &from, &to);
            let length = curve(&form, &from.p_OC, &to.p_OC).length;
            assert!((length - best).abs() < 1e-9, "{length} instead of {best}: {from:?} {to:?}");
        }
    }
}

/// The least value over all pairs of angles, by grids that close in on the best places; knows nothing of
/// derivatives.
fn least_of_pairs(f: impl Fn(f64, f64) -> f64) -> f64 {
    const GRID: usize = 120;
    let mut tried = Vec::new();
    for i in 0..GRID {
        for j in 0..GRID {
            let at = [i, j].map(|k| 2.0 * PI * k as f64 / GRID as f64);
            tried.push((f(at[0], at[1]), at));
        }
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let close_in = |start: &(f64, [f64; 2])| {
        let (mut best, mut step) = (*start, 2.0 * PI / GRID as f64);
        while step > 1e-10 {
            let moves = (0..9).map(|k| [f64::from(k / 3 - 1), f64::from(k % 3 - 1)]);
            let around = moves.map(|m| [best.1[0] + m[0] * step, best.1[1] + m[1] * step]);
            let next = around.map(|at| (f(at[0], at[1]), at)).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            if next.0 < best.0 { best = next } else { step /= 2.0 }
        }
        best.0
    };
    tried.iter().take(40).map(close_in).fold(f64::INFINITY, f64::min)
}

/// A random point of a tube's side or of one of its caps, now and then on a rim, and its cap's sign (0 on the
/// side).
fn on_tube(radius: f64, half_height: f64, round: bool, random: &mut Random) -> (Vec3, f64) {
    let angle = random.range(-PI, PI);
    let out = |rho: f64, z: f64| Vec3::new(rho * angle.cos(), rho * angle.sin(), z);
    let sign = [1.0, -1.0][random.index(2)];
    match random.index(7) {
        0..=2 => (out(radius, half_height * random.range(-1.0, 1.0)), 0.0),
        3 => (out(radius, half_height * sign), 0.0),
        _ if round => {
            let up = random.unit();
            (out(radius * (1.0 - up * up).sqrt(), sign * (half_height + radius * up)), sign)
        }
        _ => (out(radius * random.unit().sqrt(), half_height * sign), sign),
    }
}

/// The angle between two vectors (rad), exact also where it is small.
fn arc(a: &Vec3, b: &Vec3) -> f64 {
    a.cross(b).norm().atan2(a.dot(b))
}

#[test]
fn tubes_are_crossed_where_their_rims_are_crossed_best() {
    let (R, H) = (0.02, 0.03);
    for (round, H) in [(false, H), (true, H), (false, 0.004), (true, 0.002)] {
        let primitive = match round {
            false => Primitive::Cylinder { radius: R, half_height: H },
            true => Primitive::Capsule { radius: R, half_height: H },
        };
        let form = ClosedForm::new(&primitive);
        let mut random = Random::from_key(5, 0, 0, 0);
        let angle = |p: &Vec3| p.y.atan2(p.x);
        let turned = |x: f64| (x + PI).rem_euclid(2.0 * PI) - PI;
        let helix = |a: f64, z: f64, b: f64, y: f64| (R * turned(b - a)).hypot(y - z);
        let over = |p: &Vec3, sign: f64, b: f64| {
            let rim = Vec3::new(R * b.cos(), R * b.sin(), sign * H);
            let middle = Vec3::z() * (sign * H);
            if round { R * arc(&(p - middle), &(rim - middle)) } else { (p - rim).norm() }
        };
        for _ in 0..60 {
            let ((p, s), (q, t)) = (on_tube(R, H, round, &mut random), on_tube(R, H, round, &mut random));
            let (a, b) = (angle(&p), angle(&q));
            let best = match (s == 0.0, t == 0.0) {
                (true, true) => {
                    let rim = |x: f64, sign: f64| Vec3::new(R * x.cos(), R * x.sin(), sign * H);
                    let detour = |sign: f64| {
                        least_of_pairs(|x, y| {
                            helix(a, p.z, x, sign * H)
                                + over(&rim(x, sign), sign, y)
                                + helix(y, sign * H, b, q.z)
                        })
                    };
                    helix(a, p.z, b, q.z).min(detour(1.0)).min(detour(-1.0))
                }
                (true, false) => least_of_pairs(|x, _| helix(a, p.z, x, t * H) + over(&q, t, x)),
                (false, true) => least_of_pairs(|x, _| helix(b, q.z, x, s * H) + over(&p, s, x)),
                _ if s == t && round => R * arc(&(p - Vec3::z() * s * H), &(q - Vec3::z() * s * H)),
                _ if s == t => (p - q).norm(),
                _ => least_of_pairs(|x, y| over(&p, s, x) + helix(x, s * H, y, t * H) + over(&q, t, y)),
            };
            let found = curve(&form, &p, &q);
            assert!(
                (found.length - best).abs() < 1e-8 * R,
                "{} instead of {best}: {p:?} {q:?}",
                found.length
            );
            // The points add up to the length and lie on the tube.
            let sum: f64 = found.points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
            assert!(sum <= found.length * (1.0 + 1e-12) && sum > found.length * (1.0 - 2e-4));
            assert!(found.points.iter().all(|x| (form.outward(x) - x).norm() < 1e-15));
        }
    }
}

/// Simpson's rule.
fn integral(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let count = 2000;
    let h = (to - from) / f64::from(count);
    let weight = |i: i32| if i == 0 || i == count { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=count).map(|i| weight(i) * f(from + h * f64::from(i))).sum::<f64>() * h / 3.0
}

/// A geodesic of a spheroid from its equator by quadrature (Karney, "Algorithms for geodesics", J. Geodesy
/// 87, 2013, equations 7 and 8): the place after the arc σ on the auxiliary sphere, the length, and the
/// longitude (rad).
fn on_spheroid(a: f64, c: f64, azimuth: f64, sigma: f64) -> (Vec3, f64, f64) {
    let (sin, cos) = azimuth.sin_cos();
    let f = (a - c) / a;
    let k2 = (a * a / (c * c) - 1.0) * cos * cos;
    let root = |x: f64| (1.0 + k2 * x.sin().powi(2)).sqrt();
    let s = c * integral(0.0, sigma, root);
    let omega = (sin * sigma.sin()).atan2(sigma.cos());
    let lambda = omega - f * sin * integral(0.0, sigma, |x| (2.0 - f) / (1.0 + (1.0 - f) * root(x)));
    let sin_beta = cos * sigma.sin();
    let cos_beta = (1.0 - sin_beta * sin_beta).sqrt();
    (Vec3::new(a * cos_beta * lambda.cos(), a * cos_beta * lambda.sin(), c * sin_beta), s, lambda)
}

#[test]
fn geodesics_of_spheroids_are_those_of_the_quadrature() {
    let mut random = Random::from_key(6, 0, 0, 0);
    for (a, c) in [(0.03, 0.03), (0.03, 0.02), (0.03, 0.008), (0.02, 0.03), (0.01, 0.04)] {
        let form = ClosedForm::new(&Primitive::Ellipsoid { semi_axes: Vec3::new(a, a, c) });
        for _ in 0..40 {
            // Shortest as long as the geodesic reaches neither the equator again nor the opposite meridian.
            let (azimuth, sigma) = (random.range(-0.9, 0.9), random.range(0.01, 2.6));
            let (to, length, longitude) = on_spheroid(a, c, azimuth, sigma);
            if longitude.abs() > 3.1 {
                continue;
            }
            let found = curve(&form, &(Vec3::x() * a), &to);
            let error = (found.length / length - 1.0).abs();
            assert!(error < 2e-7, "{} instead of {length} ({a}, {c}, {azimuth}, {sigma})", found.length);
            // Its middle, too.
            let middle = found.points.len() / 2;
            let share = middle as f64 / (found.points.len() - 1) as f64;
            let (mut low, mut high) = (0.0, sigma);
            for _ in 0..60 {
                let mean = 0.5 * (low + high);
                if on_spheroid(a, c, azimuth, mean).1 < share * length { low = mean } else { high = mean }
            }
            let truth = on_spheroid(a, c, azimuth, low).0;
            assert!((found.points[middle] - truth).norm() < 1e-7 * a, "{:?} {truth:?}", found.points[middle]);
        }
    }
}

#[test]
fn over_the_rim_of_a_flat_spheroid_chains_take_no_short_cut_through_it() {
    let (a, c) = (0.04, 0.002);
    let form = ClosedForm::new(&Primitive::Ellipsoid { semi_axes: Vec3::new(a, a, c) });
    let speed = |x: f64| (a * x.sin()).hypot(c * x.cos());
    let at = |x: f64, turn: f64| Vec3::new(a * x.cos() * turn.cos(), a * x.cos() * turn.sin(), c * x.sin());
    for (from, to) in [(0.9, -0.9), (1.0, -0.5), (0.3, -1.1)] {
        let truth = integral(to, from, speed);
        let length = curve(&form, &at(from, 0.7), &at(to, 0.7)).length;
        assert!((length / truth - 1.0).abs() < 1e-6, "{length} instead of {truth}");
    }
    // From one side to the other anywhere: the points follow each other at equal distances.
    let form = ClosedForm::new(&Primitive::Ellipsoid { semi_axes: Vec3::new(a, a, a / 4.0) });
    let at = |x: f64, turn: f64| form.outward(&at(x, turn));
    let mut random = Random::from_key(10, 0, 0, 0);
    for _ in 0..60 {
        let [x, y, s, t] = [(); 4].map(|()| random.unit());
        let found = curve(&form, &at(0.1 + 1.4 * x, 3.0 * s), &at(-0.1 - 1.4 * y, 3.0 * t));
        let sum: f64 = found.points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum();
        assert!(sum < found.length * (1.0 + 1e-9) && sum > 0.95 * found.length, "{sum} {}", found.length);
    }
}

/// The spread of a quantity along a curve, relative to the largest that it could be.
fn spread(points: &[Vec3], quantity: impl Fn(&Vec3, &Vec3) -> f64) -> f64 {
    let values: Vec<f64> = points
        .windows(5)
        .map(|w| quantity(&w[2], &((w[0] - w[4] + (w[3] - w[1]) * 8.0).normalize())))
        .collect();
    let (low, high) = values.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &v| (l.min(v), h.max(v)));
    high - low
}

#[test]
fn geodesics_of_ellipsoids_keep_joachimsthals_invariant_and_are_shortest() {
    let axes = Vec3::new(0.04, 0.025, 0.015);
    let form = ClosedForm::new(&Primitive::Ellipsoid { semi_axes: axes });
    let (coarse, fine) = (meshes::ellipsoid(axes, 3), meshes::ellipsoid(axes, 4));
    let exact = GeodesicSettings { tolerance: 1e-6, ..GeodesicSettings::default() };
    let [coarse, fine] = [coarse, fine].map(|mesh| Geodesic::new(&exact, &mesh, 0.0).unwrap());
    let mut random = Random::from_key(7, 0, 0, 0);
    for i in 0..60 {
        // Also nearly opposite points, with several geodesics of nearly the same length.
        let u = random.direction();
        let v = if i % 2 == 0 { random.direction() } else { (random.direction() * 0.3 - u).normalize() };
        let (a, b) = (u.component_mul(&axes), v.component_mul(&axes));
        let found = curve(&form, &a, &b);
        assert!(found.points.iter().all(|p| (p.component_div(&axes).norm() - 1.0).abs() < 1e-12));
        if found.points.len() > 8 {
            let invariant = |p: &Vec3, t: &Vec3| {
                let (g, s) = (p.component_div(&axes).component_div(&axes), t.component_div(&axes));
                g.norm_squared() * s.norm_squared() * axes.min().powi(4)
            };
            let off = spread(&found.points, invariant);
            // Differences over a millimetre are not exact where the ellipsoid is sharpest.
            assert!(off < 1e-4, "Joachimsthal's invariant changes by {off}");
        }
        let over = |surface: &Geodesic| {
            let touch = |p: &Vec3| surface.project(p, None).contact;
            length(surface, &touch(&a), &touch(&b))
        };
        // The facets' depth falls to a quarter with each level.
        let [rough, better] = [over(&coarse), over(&fine)];
        let best = better + (better - rough) / 3.0;
        assert!((found.length / best - 1.0).abs() < 2e-3, "{} instead of {best}: {a:?} {b:?}", found.length);
    }
}

#[test]
fn geodesics_of_rings_keep_clairauts_relation_and_are_shortest() {
    let (ring, tube) = (0.03, 0.012);
    let form = ClosedForm::new(&Primitive::Torus { ring_radius: ring, tube_radius: tube });
    let at = |u: f64, v: f64| {
        let out = ring + tube * v.cos();
        Vec3::new(out * u.cos(), out * u.sin(), tube * v.sin())
    };
    // Along the inner side, along the outer side, around the tube.
    for (from, to, length) in [
        (at(0.0, PI), at(2.5, PI), 2.5 * (ring - tube)),
        (at(0.0, 0.0), at(0.9, 0.0), 0.9 * (ring + tube)),
        (at(1.0, 2.0), at(1.0, -1.0), 3.0 * tube),
    ] {
        let found = curve(&form, &from, &to).length;
        assert!((found - length).abs() < 1e-8 * length, "{found} instead of {length}");
    }
    let exact = GeodesicSettings { tolerance: 1e-6, ..GeodesicSettings::default() };
    let over = |around: u32| {
        let mesh = meshes::torus(ring, tube, 2 * around, around);
        Geodesic::new(&exact, &mesh, 0.0).unwrap()
    };
    let (coarse, fine) = (over(24), over(48));
    let mut random = Random::from_key(8, 0, 0, 0);
    for _ in 0..60 {
        let [a, b] = [(); 2].map(|()| at(random.range(-PI, PI), random.range(-PI, PI)));
        let found = curve(&form, &a, &b);
        if found.points.len() > 8 {
            let off = spread(&found.points, |p, t| (p.x * t.y - p.y * t.x).abs() / ring);
            assert!(off < 1e-5, "Clairaut's constant changes by {off}");
        }
        let over = |surface: &Geodesic| {
            let touch = |p: &Vec3| surface.project(p, None).contact;
            length(surface, &touch(&a), &touch(&b))
        };
        let [rough, better] = [over(&coarse), over(&fine)];
        let best = better + (better - rough) / 3.0;
        assert!((found.length / best - 1.0).abs() < 3e-3, "{} instead of {best}: {a:?} {b:?}", found.length);
    }
}

#[test]
fn curves_are_the_same_both_ways_and_walks_retrace_them() {
    let mut random = Random::from_key(9, 0, 0, 0);
    for primitive in [
        Primitive::Sphere { radius: 0.03 },
        Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.03, 0.025) },
        Primitive::Cuboid { half_size: Vec3::new(0.02, 0.03, 0.015) },
        Primitive::Cylinder { radius: 0.02, half_height: 0.03 },
        Primitive::Capsule { radius: 0.02, half_height: 0.02 },
        Primitive::Torus { ring_radius: 0.03, tube_radius: 0.012 },
    ] {
        let form = ClosedForm::new(&primitive);
        for _ in 0..30 {
            let [a, b] = [(); 2].map(|()| form.outward(&(random.direction() * 0.035)));
            let (there, back) = (curve(&form, &a, &b), curve(&form, &b, &a));
            assert_eq!(there.length, back.length);
            assert!(there.points.iter().eq(back.points.iter().rev()), "{primitive:?}");
            if there.points.len() < 3 {
                continue;
            }
            // Straight ahead from the middle of the path's first piece.
            let start = form.outward(&there.points[0].lerp(&there.points[1], 1e-3));
            let begun = curve(&form, &start, &b);
            let mut walked = Curve::default();
            let ahead = begun.points[1] - begun.points[0];
            let first_normal = form.normal(&start);
            let flat = ahead - first_normal * first_normal.dot(&ahead);
            // A chord leads aside by the square of its length.
            form.walk(&start, &flat, begun.length, 1e-3, &mut walked);
            let end = walked.points[walked.points.len() - 1];
            assert!((end - b).norm() < 3e-2 * begun.length, "{primitive:?}: {end:?} instead of {b:?}");
            assert!((walked.length - begun.length).abs() < 1e-12);
        }
    }
}
