//! The forces that hold an object: balanced, inside the cones, within the joints' efforts.
use crate::support;

use regrasp_api::*;
use regrasp_physics::*;
use regrasp_world::ChainHand;
use support::{G, hand, object, ring, shapes};

const FRICTION: Friction = Friction { mu: 0.7, gamma: 0.004, grain: None, drag: 0.0 };

/// One state of a transfer and of a regrasp of finger 1, with the forces in each.
fn held(object: &ObjectModel, friction: Friction) -> (Configuration, [Held; 2]) {
    let hand = hand();
    let states = [ring(&hand, object)];
    let stage = |moving| Stage { states: &states, times: &[0.0], moving, forces: &[] };
    let stages = [stage(None), stage(Some(FingerIndex(1)))];
    let all = grasp_forces((&hand, object, G), friction, &stages, &SimulationSettings::default()).unwrap();
    let [transfer, regrasp] = [0, 1].map(|stage: usize| all[stage][0].clone().expect("a full grasp map"));
    (states[0].clone(), [transfer, regrasp])
}

/// Resultant force (N) and torque about the centre of mass (N·m), in H.
fn resultant(q: &Configuration, object: &ObjectModel, held: &Held) -> (Vec3, Vec3) {
    let mut sum = (Vec3::zeros(), Vec3::zeros());
    for (finger, exerted) in held.forces.iter() {
        let Some(exerted) = exerted else { continue };
        let contact = q.contacts[finger].expect("only contacts exert forces");
        let r_H = q.X_HO.rotation * (contact.p_OC - object.p_OCm);
        sum.0 += exerted.force;
        sum.1 += r_H.cross(&exerted.force) + q.X_HO.rotation * contact.n_O * exerted.spin;
    }
    sum
}

#[test]
fn forces_balance_the_weight_inside_their_cones() {
    for object in shapes() {
        let (q, [transfer, regrasp]) = held(&object, FRICTION);
        for (held, friction, holding) in [(transfer, Friction::point(0.7), 4), (regrasp, FRICTION, 3)] {
            let (force, torque) = resultant(&q, &object, &held);
            assert!((force + G * object.mass).norm() < 1e-6 && torque.norm() < 1e-7, "{force} {torque}");
            let forces = held.forces.iter().filter_map(|(finger, exerted)| Some((finger, (*exerted)?)));
            let margins = forces.map(|(finger, exerted)| {
                let n_H = q.X_HO.rotation * q.contacts[finger].expect("it holds").n_O;
                friction.margin(&n_H, &exerted)
            });
            let margins: Vec<f64> = margins.collect();
            assert_eq!(margins.len(), holding);
            let least = margins.iter().copied().fold(f64::INFINITY, f64::min);
            assert!(held.margin > 0.1 && (least - held.margin).abs() < 1e-12, "{least} {}", held.margin);
        }
    }
}

/// Virtual work: the efforts do as much along a motion of the joints as the force does on the point that it
/// moves.
#[test]
fn efforts_do_the_work_of_the_forces() {
    let (hand, object) = (hand(), object("{ kind = \"sphere\", radius = 0.03 }"));
    let (q, [held, _]) = held(&object, Friction::point(0.7));
    for (finger, exerted) in held.forces.iter() {
        let exerted = exerted.expect("all hold");
        let n_H = q.X_HO.rotation * q.contacts[finger].expect("all hold").n_O;
        for joint in 0..q.joints[finger].len() {
            let (h, mut joints) = (1e-6, q.joints[finger]);
            let before = hand.tip_kinematics(finger, &joints);
            joints[joint] += h;
            let after = hand.tip_kinematics(finger, &joints);
            let lever_F = before.R_HF.inverse() * (n_H * -hand.fingertip_radius());
            let point = |tip: &TipKinematics| tip.p_HF + tip.R_HF * lever_F;
            let work = exerted.force.dot(&((point(&after) - point(&before)) / h));
            assert!((work - held.efforts[finger][joint]).abs() < 1e-5, "{work}");
        }
    }
}

#[test]
fn what_a_finger_does_not_hold_it_does_not_press() {
    let (_, [_, regrasp]) = held(&object("{ kind = \"sphere\", radius = 0.03 }"), FRICTION);
    assert_eq!(regrasp.forces[FingerIndex(1)], None);
    assert!(regrasp.efforts[FingerIndex(1)].iter().all(|effort| *effort == 0.0));
}

#[test]
fn friction_outside_its_range_is_refused() {
    let (hand, object) = (hand(), object("{ kind = \"sphere\", radius = 0.03 }"));
    let forces = |mu, gamma| {
        grasp_forces((&hand, &object, G), Friction::round(mu, gamma), &[], &SimulationSettings::default())
    };
    assert_eq!(forces(0.5, 0.0), Ok(vec![]));
    for (mu, gamma) in [(0.0, 0.0), (-1.0, 0.0), (f64::NAN, 0.0), (0.5, -1e-3), (0.5, f64::INFINITY)] {
        assert!(matches!(forces(mu, gamma), Err(PhysicsError::Range { .. })), "{mu} {gamma}");
    }
}

/// A transfer in which the object turns by `turn` (rad) about the contact of finger 0, which spins, so, by as
/// much the other way.
fn spun(hand: &ChainHand, object: &ObjectModel, turn: f64) -> [Configuration; 3] {
    let q = ring(hand, object);
    let n_O = q.contacts[FingerIndex(0)].expect("all hold").n_O;
    [0.0, turn, turn].map(|turn| {
        let mut q = q.clone();
        q.X_HO.rotation *= Rotation::from_scaled_axis(n_O * turn);
        q
    })
}

#[test]
fn a_spinning_contact_drags_with_its_torsion_and_the_others_balance_it() {
    let (hand, object) = (hand(), object("{ kind = \"sphere\", radius = 0.03 }"));
    for turn in [0.2, -0.2] {
        let states = spun(&hand, &object, turn);
        let stages = [Stage { states: &states, times: &[0.0, 0.1, 0.2], moving: None, forces: &[] }];
        let settings = SimulationSettings::default();
        let held = &dragged_forces((&hand, &object, G), FRICTION, &stages, &settings).unwrap()[0];
        for (k, (q, held)) in states.iter().zip(held).enumerate() {
            let held = held.as_ref().expect("a full grasp map");
            let (force, torque) = resultant(q, &object, held);
            assert!((force + G * object.mass).norm() < 1e-6 && torque.norm() < 1e-7, "{force} {torque}");
            assert!(held.share < 1.0, "{}", held.share);
            let exerted = held.forces[FingerIndex(0)].expect("it holds");
            let n_H = q.X_HO.rotation * q.contacts[FingerIndex(0)].expect("it holds").n_O;
            // Nothing has spun yet in the first state; then the fingertip has, against the object.
            let sign = if k == 0 { 0.0 } else { -turn.signum() };
            let drag = -exerted.force.dot(&n_H) * FRICTION.gamma * sign;
            assert!((exerted.spin - drag).abs() < 1e-9, "{} for {drag}", exerted.spin);
        }
    }
}

/// The fingertip goes on before by what the limit surface says, along its force.
#[test]
fn creep_is_that_of_the_limit_surface() {
    let (hand, object) = (hand(), object("{ kind = \"sphere\", radius = 0.03 }"));
    let (finger, spin) = (FingerIndex(0), 0.05);
    let states = spun(&hand, &object, spin);
    let stages = [Stage { states: &states, times: &[0.0, 0.1, 0.2], moving: None, forces: &[] }];
    let all = dragged_forces((&hand, &object, G), FRICTION, &stages, &SimulationSettings::default()).unwrap();
    let ahead = &creep(&hand, FRICTION, &stages, &all)[0];
    assert!(ahead[0][finger].iter().all(|joint| *joint == 0.0), "nothing has crept yet");
    let (q, held) = (&states[0], all[0][0].as_ref().expect("a full grasp map"));
    let n_O = q.contacts[finger].expect("it holds").n_O;
    let force_O = q.X_HO.rotation.inverse() * held.forces[finger].expect("it holds").force;
    let tangential = force_O - n_O * n_O.dot(&force_O);
    let u = tangential.norm() / (FRICTION.mu * -n_O.dot(&force_O));
    let slid = FRICTION.gamma / FRICTION.mu * u / (1.0 - u * u).sqrt() * spin;
    let bounds = EffortBounds::at(&hand, finger, &q.joints[finger], &q.X_HO, &n_O);
    let each = bounds.joints().iter().zip(ahead[1][finger].iter());
    let moved: Vec3 = each.map(|(joint, change)| joint.column_O * *change).sum();
    assert!((moved - tangential.normalize() * slid).norm() < 1e-9, "{moved} for {slid}");
    assert_eq!(ahead[2][finger], ahead[1][finger], "who rests does not creep");
}

/// Pyramids of many edges are nearly the cone round them: forces that balance, and need as little.
#[test]
fn edges_hold_nearly_as_the_cone_round_them() {
    let edge = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 16.0).sin_cos();
        ConeEdge { tangential: [0.7 * cos, 0.7 * sin], torsion: 0.0 }
    };
    let pyramid = Cone::Polyhedral((0..16).map(edge).collect());
    for object in shapes() {
        let hand = hand();
        let states = [ring(&hand, &object)];
        let stage = |moving| Stage { states: &states, times: &[0.0], moving, forces: &[] };
        let stages = [stage(None), stage(Some(FingerIndex(1)))];
        let cones = vec![vec![Some(pyramid.clone()); 4]];
        let (parts, settings) = ((&hand as &dyn Hand, &object, G), SimulationSettings::default());
        let found = edge_forces(parts, &stages, &[cones.clone(), cones], &settings).unwrap();
        let round = grasp_forces(parts, Friction::point(0.7), &stages, &settings).unwrap();
        for (found, round) in found.iter().flatten().zip(round.iter().flatten()) {
            let (found, round) = (found.as_ref().expect("it holds"), round.as_ref().expect("it holds"));
            let (mut force, mut torque, mut most) = (G * object.mass, Vec3::zeros(), 0.0_f64);
            for (finger, exerted) in found.forces.iter() {
                assert_eq!(exerted.is_some(), round.forces[finger].is_some());
                let Some(exerted) = exerted else { continue };
                let contact = states[0].contacts[finger].expect("it holds");
                let f_n = -contact.n_O.dot(exerted);
                let share = (exerted + contact.n_O * f_n).norm() / (0.7 * f_n);
                assert!(f_n > 0.0 && share <= found.share + 1e-9, "{share} {}", found.share);
                most = most.max(share);
                force += exerted;
                torque += (contact.p_OC - object.p_OCm).cross(exerted);
            }
            assert!(force.norm() < 1e-6 && torque.norm() < 1e-7, "{force} {torque}");
            // The centre of the edges' weights is not that of the forces, but neither is near the rim.
            assert!((most - round.share).abs() < 0.1, "{most} {}", round.share);
        }
    }
}

/// One grasp by itself: with half of the friction where that is enough, else with little more than the least,
/// and nothing where all that may be relied on holds nothing.
#[test]
fn one_grasp_needs_half_or_little_more_than_the_least() {
    let (hand, friction) = (hand(), Friction::point(0.7));
    for mut object in shapes() {
        let mut shares = Vec::new();
        for mass in [0.02, 0.1, 0.3, 0.6, 1.0, 1.5, 3.0, 300.0] {
            object.mass = mass;
            let q = ring(&hand, &object);
            let (settings, parts) = (SimulationSettings::default(), (&hand as &dyn Hand, &object, G));
            let held = grasp_forces_at(parts, friction, &q, 0.5, &settings).unwrap();
            let states = [q.clone()];
            let stage = Stage { states: &states, times: &[0.0], moving: None, forces: &[] };
            let least = grasp_forces(parts, friction, &[stage], &settings).unwrap()[0][0].clone();
            let Some(held) = held else {
                assert!(least.is_none_or(|least| least.share > 0.98), "{mass} kg is held by some forces");
                continue;
            };
            let (force, torque) = resultant(&q, &object, &held);
            assert!((force + G * mass).norm() < 1e-6 && torque.norm() < 1e-7, "{force} {torque}");
            assert!(held.share <= 1.0 && held.effort_share <= 1.0, "{held:?}");
            let needed = least.expect("what is held is held with the least").share.max(0.5);
            assert!(held.share <= 1.2 * needed, "{} where {needed} would do", held.share);
            shares.push(held.share);
        }
        assert!(!shares.is_empty() && shares.len() < 8, "{shares:?}");
    }
}
