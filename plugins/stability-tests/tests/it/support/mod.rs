//! Random, near-boundary and degenerate grasps, and checks of certificates by arithmetic alone.
#![allow(dead_code)] // every test file takes what it needs

use regrasp_api::{
    Assessment, CallError, Certificate, Cone, ConeEdge, Context, FingerIndex, Grasp, GraspContact, Hint,
    Random, Rotation, Stability, StabilityTest, Uninterrupted, Vec3,
};
use regrasp_stability_tests::{
    ForceClosure, ForceClosureSettings, Linearised, LinearisedSettings, Socp, SocpSettings, WrenchBall,
    WrenchBallSettings,
};

/// A contact as the tests build it: point, outward normal, friction, torsional radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    pub p: Vec3,
    pub n: Vec3,
    pub mu: f64,
    pub gamma: f64,
}

pub fn touch(p: [f64; 3], n: [f64; 3], mu: f64) -> Touch {
    Touch { p: Vec3::from(p), n: Vec3::from(n).normalize(), mu, gamma: 0.0 }
}

pub fn grasp_of(touches: &[Touch]) -> Grasp<'static> {
    let mut grasp = Grasp::new(Vec3::zeros());
    for (i, touch) in touches.iter().enumerate() {
        grasp.push(GraspContact {
            finger: FingerIndex(i as u8),
            p_OC: touch.p,
            n_O: touch.n,
            cone: Cone::Elliptic { mu: touch.mu, gamma: touch.gamma },
        });
    }
    grasp
}

pub fn force_closure() -> ForceClosure {
    ForceClosure::new(ForceClosureSettings::default()).unwrap()
}

pub fn socp() -> Socp {
    Socp::new(SocpSettings::default()).unwrap()
}

pub fn linearised(edges: usize) -> Linearised {
    Linearised::new(LinearisedSettings { edges }).unwrap()
}

pub fn wrench_ball(settings: WrenchBallSettings) -> WrenchBall {
    WrenchBall::new(settings, Vec3::zeros()).unwrap()
}

/// The verdict of any test, without a hint.
pub fn verdict_of(test: &dyn StabilityTest, grasp: &Grasp<'_>) -> Stability {
    with_context(|context| test.test(grasp, &mut Hint::default(), context))
}

/// The edges of each contact's cone replaced by `count` edges on it.
pub fn pyramids(touches: &[Touch], count: usize) -> Vec<Vec<ConeEdge>> {
    let edge = |touch: &Touch, j: usize| {
        let (sin, cos) = (std::f64::consts::TAU * j as f64 / count as f64).sin_cos();
        ConeEdge { tangential: [touch.mu * cos, touch.mu * sin], torsion: 0.0 }
    };
    touches.iter().map(|touch| (0..count).map(|j| edge(touch, j)).collect()).collect()
}

/// The grasp with those edges as cones.
pub fn polyhedral<'a>(touches: &[Touch], edges: &'a [Vec<ConeEdge>]) -> Grasp<'a> {
    let mut grasp = Grasp::new(Vec3::zeros());
    for (i, (touch, edges)) in touches.iter().zip(edges).enumerate() {
        let cone = Cone::Polyhedral(edges.as_slice().into());
        grasp.push(GraspContact { finger: FingerIndex(i as u8), p_OC: touch.p, n_O: touch.n, cone });
    }
    grasp
}

pub fn with_context<T>(call: impl FnOnce(&mut Context<'_>) -> Result<T, CallError>) -> T {
    call(&mut Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted))
        .expect("elliptic cones are supported")
}

pub fn verdict(touches: &[Touch]) -> Stability {
    with_context(|context| force_closure().test(&grasp_of(touches), &mut Hint::default(), context))
}

pub fn assess(test: &dyn StabilityTest, touches: &[Touch]) -> Assessment {
    with_context(|context| test.assess(&grasp_of(touches), None, None, context))
}

pub fn margins(touches: &[Touch], length: f64, center: Vec3) -> (f64, f64) {
    let grasp = grasp_of(touches);
    let found = with_context(|c| force_closure().assess(&grasp, Some(length), Some(center), c));
    (found.margin_lower, found.margin_upper)
}

/// Which contact models a random grasp mixes.
#[derive(Clone, Copy, Debug)]
pub enum Family {
    Pcwf,
    SoftFinger,
    Frictionless,
    Mixed,
}

/// `count` contacts on a sphere, an ellipsoid, a box or anywhere, of a size between a millimetre and a metre.
pub fn random_touches(random: &mut Random, count: usize, family: Family) -> Vec<Touch> {
    let kind = random.index(4);
    let size = 10_f64.powf(random.range(-3.0, 0.0));
    let semi_axes = Vec3::new(1.0, random.range(0.3, 1.0), random.range(0.3, 1.0));
    let mu = random.range(0.05, 1.2);
    let offset = random.direction() * random.range(0.0, 3.0);
    (0..count)
        .map(|_| {
            let (p, n) = match kind {
                0 => on_ellipsoid(random, Vec3::new(1.0, 1.0, 1.0)),
                1 => on_ellipsoid(random, semi_axes),
                2 => on_box(random, semi_axes),
                _ => (random.direction() * random.range(0.3, 1.0), random.direction()),
            };
            let (mu, gamma) = radii(random, family, mu);
            Touch { p: (p + offset) * size, n, mu, gamma: gamma * size }
        })
        .collect()
}

fn radii(random: &mut Random, family: Family, mu: f64) -> (f64, f64) {
    let gamma = random.range(0.01, 0.3);
    match family {
        Family::Pcwf => (mu, 0.0),
        Family::SoftFinger => (mu, gamma),
        Family::Frictionless => (0.0, 0.0),
        Family::Mixed => match random.index(4) {
            0 => (0.0, 0.0),
            1 => (mu, gamma),
            _ => (random.range(0.05, 1.2), 0.0),
        },
    }
}

fn on_ellipsoid(random: &mut Random, semi_axes: Vec3) -> (Vec3, Vec3) {
    let u = random.direction();
    (u.component_mul(&semi_axes), u.component_div(&semi_axes).normalize())
}

fn on_box(random: &mut Random, half: Vec3) -> (Vec3, Vec3) {
    let mut p = half.map(|h| random.range(-h, h));
    let axis = random.index(3);
    let sign = if random.index(2) == 0 { 1.0 } else { -1.0 };
    p[axis] = sign * half[axis];
    let mut n = Vec3::zeros();
    n[axis] = sign;
    (p, n)
}

/// The same contacts with every friction and torsional radius multiplied.
pub fn scaled_friction(touches: &[Touch], factor: f64) -> Vec<Touch> {
    let scale = |touch: &Touch| Touch { mu: touch.mu * factor, gamma: touch.gamma * factor, ..*touch };
    touches.iter().map(scale).collect()
}

/// The same contacts after a rigid motion of the object's frame.
pub fn moved(touches: &[Touch], R: &Rotation, t: Vec3) -> Vec<Touch> {
    touches.iter().map(|touch| Touch { p: R * touch.p + t, n: R * touch.n, ..*touch }).collect()
}

/// How deep the origin lies in the hull of the contacts' wrenches along a twist of any length; the least of
/// all is Q1.
pub fn depth_along(touches: &[Touch]) -> impl Fn(&[f64; 6]) -> f64 + '_ {
    let (center, length) = center_and_length(touches);
    move |w| {
        let norm = w.iter().map(|x| x * x).sum::<f64>().sqrt();
        let (a, b) = (Vec3::new(w[0], w[1], w[2]), Vec3::new(w[3], w[4], w[5]));
        let support = |touch: &Touch| {
            let v = a + b.cross(&((touch.p - center) / length));
            let normal = -v.dot(&touch.n);
            let tangential = (v + touch.n * normal).norm();
            normal + (touch.mu * tangential).hypot(touch.gamma / length * b.dot(&touch.n))
        };
        touches.iter().map(support).fold(f64::NEG_INFINITY, f64::max) / norm
    }
}

/// The centroid of the contacts and the largest distance from it.
pub fn center_and_length(touches: &[Touch]) -> (Vec3, f64) {
    let center = touches.iter().map(|touch| touch.p).sum::<Vec3>() / touches.len() as f64;
    let length = touches.iter().map(|touch| (touch.p - center).norm()).fold(0.0, f64::max);
    // Coincident contacts have no length of their own.
    (center, if length > 1e-12 { length } else { 1.0 })
}

/// The smallest singular value of the grasp map scaled by 1, μ, μ, γ and lengths over the grasp's own.
pub fn smallest_singular_value(touches: &[Touch]) -> f64 {
    let (center, length) = center_and_length(touches);
    let mut square = nalgebra::Matrix6::<f64>::zeros();
    let mut add = |f: Vec3, m: Vec3| {
        let column = nalgebra::Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z);
        square += column * column.transpose();
    };
    for touch in touches {
        let r = (touch.p - center) / length;
        let t1 = regrasp_api::any_orthogonal(&touch.n);
        let t2 = touch.n.cross(&t1);
        for f in [touch.n, t1 * touch.mu, t2 * touch.mu] {
            add(f, r.cross(&f));
        }
        add(Vec3::zeros(), touch.n * (touch.gamma / length));
    }
    square.symmetric_eigenvalues().min().max(0.0).sqrt()
}

/// Checks the certificate by its definition; panics with the reason where it proves nothing.
pub fn check_certificate(touches: &[Touch], found: &Assessment) {
    match (&found.certificate, found.stability) {
        (Certificate::InternalForce { forces_O, torsions }, Stability::Stable) => {
            check_internal_force(touches, forces_O, torsions);
        }
        (Certificate::SeparatingTwist { v_O, w_O }, Stability::Unstable) => {
            check_separating_twist(touches, *v_O, *w_O);
        }
        (Certificate::None, Stability::Undecided) => {}
        (certificate, stability) => panic!("{stability:?} with {certificate:?} for {touches:?}"),
    }
}

/// Balanced far more exactly than the slack and the rank need, and strictly inside every cone.
fn check_internal_force(touches: &[Touch], forces: &[Vec3], torsions: &[f64]) {
    let (center, length) = center_and_length(touches);
    let (mut f_sum, mut m_sum, mut slack) = (Vec3::zeros(), Vec3::zeros(), f64::INFINITY);
    for ((touch, &f), &m) in touches.iter().zip(forces).zip(torsions) {
        let inward = -touch.n;
        let normal = f.dot(&inward);
        let tangential = (f - inward * normal).norm();
        assert!(touch.gamma > 0.0 || m == 0.0, "a torsion that the contact cannot transmit");
        assert!(touch.mu > 0.0 || tangential <= 1e-14, "friction at a frictionless contact: {tangential}");
        let part = |x: f64, radius: f64| if radius > 0.0 { x / radius } else { 0.0 };
        slack = slack.min(normal - part(tangential, touch.mu).hypot(part(m, touch.gamma)));
        f_sum += f;
        m_sum += ((touch.p - center).cross(&f) + inward * m) / length;
    }
    let residual = (f_sum.norm_squared() + m_sum.norm_squared()).sqrt();
    let sigma = smallest_singular_value(touches);
    assert!(slack > 0.0 && sigma > 1e-9, "slack {slack}, sigma {sigma}: {touches:?}");
    // A correction of size residual / sigma keeps every force inside its cone: closure is proved.
    assert!(
        residual <= 0.6 * sigma * slack,
        "residual {residual}, sigma {sigma}, slack {slack}: {touches:?}"
    );
}

/// Nonzero, and every force in every cone has power of at least 0 on it.
fn check_separating_twist(touches: &[Touch], v: Vec3, w: Vec3) {
    let (center, length) = center_and_length(touches);
    let size = (v.norm_squared() + (w * length).norm_squared()).sqrt();
    assert!((0.5..2.0).contains(&size), "a twist of norm {size}");
    for touch in touches {
        let inward = -touch.n;
        let velocity = v + w.cross(&(touch.p - center));
        let normal = velocity.dot(&inward);
        let tangential = (velocity - inward * normal).norm();
        let least = normal - (touch.mu * tangential).hypot(touch.gamma * w.dot(&inward));
        assert!(least >= -1e-11 * size, "a contact resists the twist: {least}: {touches:?}");
    }
}
