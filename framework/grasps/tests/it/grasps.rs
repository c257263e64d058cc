//! What is found, on a ball and on a cube: sound, distinct, the same on any number of threads, and resumable.

use crate::support;

use regrasp_api::{Context, FingerSet};
use regrasp_grasps::{BulkGrasp, GraspSource, GraspsError, Journal, Search, Stopped, Twins, Wish, collect};
use regrasp_run::{NeverStops, Setup};
use std::fs;
use support::{Silent, found, scenario, with};

fn wish(count: usize) -> Wish {
    Wish { count, ..Wish::default() }
}

#[test]
fn grasps_are_sound() {
    for name in ["sphere", "allegro-cube"] {
        with(name, &wish(60), |setup, source| {
            let (grasps, ending) = found(source, 1);
            assert_eq!((grasps.len(), ending.stopped), (60, Stopped::Enough), "{name}");
            assert_eq!(ending.counts.refused, 0, "{name}: the verifier refused some");
            grasps.iter().for_each(|grasp| assert_sound(setup, grasp));
        });
    }
}

/// By the services and the planner's own test, which the verifier shares nothing with.
fn assert_sound(setup: &Setup<'_>, grasp: &BulkGrasp) {
    let (task, q) = (setup.task(), &grasp.q);
    let all = FingerSet::first(q.joints.len());
    assert_eq!(task.clearance.configuration_free(q, all, true), Ok(()));
    for finger in q.holding().iter() {
        let p_HF = q.contact_tip_center(finger, task.hand.fingertip_radius()).expect("it holds");
        assert!((task.hand.tip_center(finger, &q.joints[finger]) - p_HF).norm() < 1e-8);
        assert!(task.hand.within_limits(finger, &q.joints[finger]));
    }
    let mut context = Context::seeded(0);
    let grip = task.grasp(q, q.holding());
    assert!(task.stability.test(&grip, &mut Default::default(), &mut context).unwrap().is_stable());
    for finger in q.holding().iter() {
        let lifted = task.stability.stable_without(&grip, finger, &mut context).unwrap();
        assert_eq!(grasp.liftable.contains(finger), lifted);
    }
    assert!(grasp.margin > 0.0 && grasp.clearance > 0.0);
}

#[test]
fn forces_hold_the_weight_within_the_efforts() {
    with("allegro-cube", &wish(60), |setup, source| {
        let (grasps, _) = found(source, 1);
        let (object, g_H) = (setup.task().object, setup.task().g_H);
        for grasp in &grasps {
            let held = grasp.held.as_ref().expect("what the scenario asks for is that it is held");
            let weight_O = grasp.q.X_HO.rotation.inverse() * (g_H * object.mass);
            let sum = held.forces_O.iter().filter_map(|(_, f)| *f).sum::<regrasp_api::Vec3>() + weight_O;
            assert!(sum.norm() < 1e-6, "{sum}");
            assert!(held.friction <= 0.7 * object.friction + 1e-9 && held.effort_share <= 1.0, "{held:?}");
        }
    });
}

#[test]
fn threads_change_nothing_and_fewer_are_the_first_of_more() {
    with("sphere", &wish(200), |_, source| {
        let (one, ending) = found(source, 1);
        let (three, other) = found(source, 3);
        assert_eq!(one, three);
        assert_eq!(ending, other);
        with("sphere", &wish(50), |_, fewer| assert_eq!(found(fewer, 2).0, one[..50]));
    });
    let seed = |seed| Wish { seed, ..wish(5) };
    with("sphere", &seed(1), |_, one| {
        with("sphere", &seed(2), |_, two| assert_ne!(found(one, 1).0, found(two, 1).0))
    });
}

#[test]
fn no_two_are_nearer_than_the_spread() {
    let asked = Wish { spread: 0.012, ..wish(150) };
    with("sphere", &asked, |setup, source| {
        let (grasps, _) = found(source, 1);
        let radius = setup.task().object.mesh.radius();
        for (i, a) in grasps.iter().enumerate() {
            for b in &grasps[..i] {
                assert!(apart(a, b, radius) >= 0.012, "{a:?}\n{b:?}");
            }
        }
    });
}

/// The measure as its documentation has it.
fn apart(a: &BulkGrasp, b: &BulkGrasp, radius: f64) -> f64 {
    if a.q.holding() != b.q.holding() {
        return f64::INFINITY;
    }
    let (X, Y) = (&a.q.X_HO, &b.q.X_HO);
    let moved = (X.translation.vector - Y.translation.vector).norm();
    let turned = regrasp_api::angle_between(&X.rotation, &Y.rotation) * radius;
    let points = a.q.holding().iter().map(|finger| {
        let point = |grasp: &BulkGrasp| grasp.q.contacts[finger].expect("it holds").p_OC;
        (point(a) - point(b)).norm()
    });
    points.fold(moved.max(turned), f64::max)
}

#[test]
fn twins_are_found_in_other_cells_too() {
    with("sphere", &wish(1), |_, source| {
        let grasp = found(source, 1).0.remove(0);
        let mut twins = Twins::new(0.01, 0.03);
        twins.add(&grasp);
        let moved = |x: f64| {
            let mut q = grasp.q.clone();
            q.X_HO.translation.vector.x += x;
            q
        };
        assert!(twins.has_twin(&moved(0.0099)) && twins.has_twin(&moved(-0.0099)));
        assert!(!twins.has_twin(&moved(0.0101)) && !twins.has_twin(&moved(-0.0101)));
    });
}

#[test]
fn facets_have_their_quota() {
    let asked = Wish { per_facets: Some(2), ..wish(60) };
    with("allegro-cube", &asked, |_, source| {
        let (grasps, _) = found(source, 1);
        let facets = |grasp: &BulkGrasp| {
            grasp.q.contacts.iter().map(|(_, contact)| contact.map(|c| c.facet)).collect::<Vec<_>>()
        };
        for grasp in &grasps {
            let same = grasps.iter().filter(|other| facets(other) == facets(grasp)).count();
            assert!(same <= 2, "{same} of {:?}", facets(grasp));
        }
    });
}

#[test]
fn regrasps_move_one_finger_that_the_others_do_without() {
    let asked = Wish { graph: true, ..wish(60) };
    with("sphere", &asked, |_, source| {
        let mut kept = support::Keeps::default();
        let mut search = Search::new(source);
        collect(&mut search, 2, &NeverStops, &Silent, &mut kept).unwrap();
        assert!(kept.edges.len() > 10, "{}", kept.edges.len());
        for edge in &kept.edges {
            let (a, b) = (&kept.grasps[edge.from as usize], &kept.grasps[edge.to as usize]);
            assert_eq!(a.pose, b.pose);
            for finger in a.q.joints.fingers().filter(|finger| *finger != edge.finger) {
                assert_eq!(a.q.contacts[finger], b.q.contacts[finger]);
                assert_eq!(a.q.joints[finger], b.q.joints[finger]);
            }
            for grasp in [a, b] {
                assert!(grasp.q.contacts[edge.finger].is_none() || grasp.liftable.contains(edge.finger));
            }
        }
    });
}

#[test]
fn a_killed_search_goes_on_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("g.npz.part");
    with("sphere", &wish(120), |_, source| {
        let whole = found(source, 1).0;
        let run = || {
            let mut journal = Journal::open(&path, "me", source.layout(), false).unwrap();
            let mut search = Search::new(source);
            journal.resume(&mut search).unwrap();
            let there = search.grasps();
            collect(&mut search, 1, &NeverStops, &Silent, &mut journal).unwrap();
            let mut all = Vec::new();
            regrasp_grasps::write::Rows::each(&journal, &mut |grasp| {
                all.push(grasp.clone());
                Ok(())
            })
            .unwrap();
            (there, all)
        };
        assert_eq!(run(), (0, whole.clone()));
        let length = fs::metadata(&path).unwrap().len();
        // Cut in the middle of a block, of a number, and spoilt.
        for cut in [length / 2, length - 3] {
            fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(cut).unwrap();
            let (there, all) = run();
            assert!(there < 120 && all == whole, "{there}");
        }
        let mut bytes = fs::read(&path).unwrap();
        let last = bytes.len() - 40;
        bytes[last] ^= 1;
        fs::write(&path, bytes).unwrap();
        assert_eq!(run().1, whole);
        let other = Journal::open(&path, "another", source.layout(), false);
        assert!(matches!(other, Err(GraspsError::OtherSearch { .. })));
        fs::write(&path, [0xff_u8; 40]).unwrap();
        assert!(Journal::open(&path, "me", source.layout(), false).is_err());
        assert!(Journal::open(&path, "me", source.layout(), true).is_ok());
    });
}

#[test]
fn wishes_out_of_range_are_refused() {
    let scenario = scenario("sphere");
    let setup = support::setup(&scenario);
    let refused = |wish: Wish| GraspSource::new(&setup, &wish).err().expect("it is refused").to_string();
    assert!(refused(wish(0)).contains("`count` = 0"));
    assert!(refused(Wish { spread: f64::NAN, ..wish(1) }).contains("`spread`"));
    assert!(refused(Wish { per_pose: 0, ..wish(1) }).contains("`per_pose`"));
    let fingers = refused(Wish { fingers: Some((2, 4)), ..wish(1) });
    assert!(fingers.contains("needs 3, the hand has 4"), "{fingers}");
}
