//! Grasps whose verdict is known by hand: degenerate ones that must never count as closed, and classical
//! closed ones.

use crate::support;

use regrasp_api::{
    CallError, Certificate, Cone, ConeEdge, Context, FingerIndex, Grasp, GraspContact, Hint, Random,
    Stability, StabilityTest, Uninterrupted, Vec3,
};
use support::{
    Touch, assess, check_certificate, force_closure, grasp_of, moved, socp, touch, verdict, with_context,
};

/// Not closed, in every position of the object and with friction from small to large, with a proof where
/// there is a verdict.
fn never_closed(name: &str, at: impl Fn(f64) -> Vec<Touch>) {
    let mut random = Random::from_key(11, 0, 0, 0);
    for mu in [0.0, 0.01, 0.3, 0.8, 1.0, 1.5, 4.0] {
        for _ in 0..20 {
            let touches = moved(&at(mu), &random.rotation(), random.direction() * random.range(0.0, 10.0));
            let found = assess(&force_closure(), &touches);
            assert_ne!(found.stability, Stability::Stable, "{name}, mu {mu}: {touches:?}");
            assert!(found.margin_lower <= 0.0);
            if found.stability == Stability::Unstable {
                check_certificate(&touches, &found);
            }
        }
    }
}

#[test]
fn three_contacts_on_one_face_are_never_closed() {
    never_closed("one face", |mu| {
        [[1.0, 0.0], [-0.5, 0.8], [-0.5, -0.8]].map(|[x, y]| touch([x, y, 0.0], [0.0, 0.0, 1.0], mu)).to_vec()
    });
}

#[test]
fn four_contacts_on_one_face_are_never_closed() {
    never_closed("one face, four", |mu| {
        let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        corners.map(|[x, y]| touch([x, y, 0.0], [0.0, 0.0, 1.0], mu)).to_vec()
    });
}

#[test]
fn an_antipodal_pair_with_a_third_that_does_not_straddle_is_never_closed() {
    // The third pushes along +y beside the pair's line; its cone reaches both sides of the line only for mu ≥
    // 4 here.
    let grasp = |mu: f64| {
        vec![
            touch([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], mu),
            touch([-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], mu),
            touch([0.0, -0.2, 1.0], [0.0, -1.0, 0.0], mu),
        ]
    };
    never_closed("not straddling", |mu| grasp(mu.min(1.5)));
    // Moments about the line have both signs once mu > |y| / |z| ... of the lever (−0.2, 1): mu > 5.
    assert_eq!(verdict(&grasp(4.9)), Stability::Unstable);
    assert_eq!(verdict(&grasp(5.1)), Stability::Stable);
}

#[test]
fn collinear_contacts_are_never_closed() {
    never_closed("collinear", |mu| {
        let at = |x: f64, n: [f64; 3]| touch([x, 0.0, 0.0], n, mu);
        vec![
            at(1.0, [1.0, 0.0, 0.0]),
            at(-1.0, [-1.0, 0.0, 0.0]),
            at(0.3, [0.0, 1.0, 0.0]),
            at(-0.2, [0.0, -1.0, 0.0]),
        ]
    });
}

#[test]
fn duplicated_contacts_are_never_closed() {
    let pair =
        |mu| [touch([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], mu), touch([-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], mu)];
    never_closed("one thrice", |mu| vec![pair(mu)[0]; 3]);
    never_closed("pair and a copy", |mu| vec![pair(mu)[0], pair(mu)[1], pair(mu)[1]]);
    never_closed("pair twice", |mu| [pair(mu), pair(mu)].concat());
}

#[test]
fn too_few_contacts_are_never_closed() {
    never_closed("one", |mu| vec![touch([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], mu)]);
    never_closed("two", |mu| {
        vec![touch([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], mu), touch([-1.0, 0.1, 0.0], [-1.0, 0.0, 0.0], mu)]
    });
    let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    never_closed("six without friction", |_| {
        axes.into_iter().flat_map(|n| [touch(n, n, 0.0), touch(n.map(|x| -x), n.map(|x| -x), 0.0)]).collect()
    });
}

#[test]
fn frictionless_contacts_never_hold_a_ball() {
    let mut random = Random::from_key(12, 0, 0, 0);
    for _ in 0..200 {
        let touches: Vec<_> = (0..8)
            .map(|_| random.direction())
            .map(|n| Touch { p: n * 0.03, n, mu: 0.0, gamma: 0.0 })
            .collect();
        let found = assess(&force_closure(), &touches);
        assert_eq!(found.stability, Stability::Unstable);
        check_certificate(&touches, &found);
    }
}

#[test]
fn a_regular_tetrahedron_of_contacts_closes_with_any_friction() {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    for mu in [1e-3, 0.1, 0.8] {
        let touches: Vec<_> = corners.iter().map(|&p| touch(p, p, mu)).collect();
        let found = assess(&force_closure(), &touches);
        assert_eq!(found.stability, Stability::Stable, "mu {mu}");
        check_certificate(&touches, &found);
    }
    let without: Vec<_> = corners.iter().map(|&p| touch(p, p, 0.0)).collect();
    assert_eq!(verdict(&without), Stability::Unstable);
}

#[test]
fn the_margin_of_two_antipodal_soft_fingers_is_that_of_theory() {
    // Contacts at ±x. A turn u about x is felt by γ u at both. A motion s across x and s about the axis
    // across both leaves one contact at rest and moves the other by 2s; with δ along x the two feel δ and 2μs
    // - δ, the least at δ = μs: μ / sqrt(2 + μ²).
    for (mu, gamma) in [(0.5, 0.2), (0.5, 0.7), (0.3, 0.1)] {
        let one = Touch { gamma, ..touch([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], mu) };
        let other = Touch { gamma, ..touch([-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], mu) };
        let found = assess(&force_closure(), &[one, other]);
        let least = gamma.min(mu / f64::sqrt(2.0 + mu * mu));
        assert_eq!(found.stability, Stability::Stable);
        assert!(found.margin_lower <= least * (1.0 + 1e-9) && found.margin_lower > 0.2 * least, "{found:?}");
        assert!((found.margin_upper - least).abs() < 1e-5, "{found:?} but theory says {least}");
    }
    // Without torsion nothing resists the turn about the line.
    let two = [touch([1.0, 0.0, 0.0], [1.0, 0.0, 0.0], 0.5), touch([-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], 0.5)];
    assert_eq!(verdict(&two), Stability::Unstable);
}

#[test]
fn polyhedral_cones_are_refused_with_what_to_use() {
    let edges = [ConeEdge { tangential: [0.5, 0.0], torsion: 0.0 }; 3];
    let mut grasp = Grasp::new(Vec3::zeros());
    grasp.push(GraspContact {
        finger: FingerIndex(0),
        p_OC: Vec3::x(),
        n_O: Vec3::x(),
        cone: Cone::Polyhedral(edges[..].into()),
    });
    let mut context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    match socp().test(&grasp, &mut Hint::default(), &mut context) {
        Err(CallError::Unsupported { plugin, reason }) => {
            assert_eq!(plugin, "stability-test/socp");
            assert!(reason.contains("elliptic contact model"), "{reason}");
            assert!(reason.contains("`stability-test/equilibrium`, which take polyhedral cones"), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn liftable_fingers_are_those_without_which_the_rest_is_stable() {
    let mut random = Random::from_key(13, 0, 0, 0);
    let test = force_closure();
    let mut lifted = [0; 6];
    for _ in 0..500 {
        let touches = support::random_touches(&mut random, 5, support::Family::Mixed);
        let grasp = grasp_of(&touches);
        let found = with_context(|context| test.liftable(&grasp, 0, context));
        for (i, finger) in grasp.contacts().iter().map(|contact| contact.finger).enumerate() {
            let mut rest = touches.clone();
            rest.remove(i);
            assert_eq!(found.contains(finger), verdict(&rest).is_stable());
        }
        lifted[found.len()] += 1;
        // Asked for more than there are, it may stop early but never claims one that is not.
        let early = with_context(|context| test.liftable(&grasp, found.len() + 1, context));
        assert_eq!(early.intersection(found), early);
    }
    assert!(lifted[0] > 20 && lifted[5] > 20, "{lifted:?}");
}

#[test]
fn a_grasp_without_answer_has_no_certificate_that_claims_one() {
    // Pair exactly at the edge of its cones: friction equals the slope, margin 0.
    let touches = [
        touch([1.0, 0.5, 0.0], [1.0, 0.0, 0.0], 0.5),
        touch([-1.0, -0.5, 0.0], [-1.0, 0.0, 0.0], 0.5),
        touch([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 0.5),
    ];
    let found = assess(&force_closure(), &touches);
    assert_ne!(found.stability, Stability::Stable);
    assert!(!matches!(found.certificate, Certificate::InternalForce { .. }));
}
