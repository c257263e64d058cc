//! Verdicts and shares against a conic program, and what every answer must prove.

use super::*;
use crate::force::Friction;
use clarabel::algebra::CscMatrix;
use clarabel::solver::SupportedConeT::{NonnegativeConeT, SecondOrderConeT, ZeroConeT};
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SupportedConeT};
use nalgebra::Vector6;
use regrasp_api::{EffortBounds, JointBound, Random, Vec3};

const PRESS: Press = Press { max_normal_force: None, effort_share: 1.0 };

/// `count` contacts on a ball of 30 mm, three or four joints behind each, and a weight.
fn random_grasp(random: &mut Random, count: usize, gamma: f64) -> (Vec<Bearing>, Vector6<f64>) {
    let friction = Friction::round(random.range(0.2, 1.0), gamma);
    let contact = |random: &mut Random| {
        let n_O = random.direction();
        let joints = 3 + random.index(2);
        let joint = |_| JointBound {
            column_O: random.direction() * random.range(0.01, 0.12),
            spin: random.range(-1.0, 1.0),
            limit: random.range(0.02, 0.6),
        };
        let bounds = EffortBounds::from_joints((0..joints).map(joint));
        Bearing::new((&(n_O * 0.03), &n_O), &friction, &bounds, &PRESS, 0.03)
    };
    let bearings = (0..count).map(|_| contact(random)).collect();
    let weight = random.direction() * random.range(0.1, 4.0);
    (bearings, stacked(&weight, &Vec3::zeros()))
}

/// The largest t ≤ 1 (N) with s μ f_n - |(f_t, m/λ)| ≥ t and 1 - |a·f| ≥ t for forces that balance; its sign
/// is the verdict.
fn conic_margin(bearings: &[Bearing], wanted: &Vector6<f64>, share: f64) -> f64 {
    let (n, mut entries, mut b): (usize, Vec<(usize, usize, f64)>, Vec<f64>) =
        (4 * bearings.len() + 1, vec![], vec![]);
    let mut cones: Vec<SupportedConeT<f64>> = vec![ZeroConeT(6)];
    for (i, bearing) in bearings.iter().enumerate() {
        for (row, column) in (0..6).flat_map(|row| (0..4).map(move |column| (row, column))) {
            entries.push((row, 4 * i + column, bearing.map[(row, column)]));
        }
    }
    b.extend(wanted.iter());
    let first = b.len();
    for (i, bearing) in bearings.iter().enumerate() {
        for (row, sign) in bearing.rows().iter().flat_map(|row| [(row, 1.0), (row, -1.0)]) {
            (0..4).for_each(|k| entries.push((b.len(), 4 * i + k, sign * row[k])));
            entries.push((b.len(), n - 1, 1.0));
            b.push(1.0);
        }
    }
    entries.push((b.len(), n - 1, 1.0));
    b.push(1.0);
    cones.push(NonnegativeConeT(b.len() - first));
    for (i, bearing) in bearings.iter().enumerate() {
        entries.push((b.len(), 4 * i, -share * bearing.mu));
        entries.push((b.len(), n - 1, 1.0));
        (1..4).for_each(|k| entries.push((b.len() + k, 4 * i + k, -1.0)));
        b.resize(b.len() + 4, 0.0);
        cones.push(SecondOrderConeT(4));
    }
    entries.retain(|entry| entry.2 != 0.0);
    let (rows, columns, values) = entries.iter().copied().fold((vec![], vec![], vec![]), |mut all, entry| {
        all.0.push(entry.0);
        all.1.push(entry.1);
        all.2.push(entry.2);
        all
    });
    let A = CscMatrix::new_from_triplets(b.len(), n, rows, columns, values);
    let P = CscMatrix::zeros((n, n));
    let mut q = vec![0.0; n];
    q[n - 1] = -1.0;
    let settings = DefaultSettings { verbose: false, ..Default::default() };
    let mut solver = DefaultSolver::new(&P, &q, &A, &b, &cones, settings).unwrap();
    solver.solve();
    solver.solution.x[n - 1]
}

/// How much a twist is worth as a proof: the load's power on it, less the most that any allowed forces have,
/// found by the conic program's cousin: forces that have the most power, contact by contact, by brute force
/// over the cone's rim and the efforts' bounds.
fn refutes(bearings: &[Bearing], wanted: &Vector6<f64>, share: f64, twist: &Vector6<f64>) -> bool {
    let most: f64 = bearings.iter().map(|bearing| most_power(bearing, share, twist)).sum();
    wanted.dot(twist) > most * (1.0 + 1e-3) - 1e-12
}

/// The most power of one contact without torsion on a twist, from below: along rays of the cone as far as the
/// efforts allow.
fn most_power(bearing: &Bearing, share: f64, twist: &Vector6<f64>) -> f64 {
    let seen = bearing.map.transpose() * twist;
    let ray = |turn: f64, part: f64| {
        let rim = share * bearing.mu * part;
        let x = Exerted::new(1.0, rim * turn.cos(), rim * turn.sin(), 0.0);
        seen.dot(&x).max(0.0) / bearing.effort_share(&x).max(1e-12)
    };
    let turns = (0..180).map(|k| f64::from(k) * std::f64::consts::TAU / 180.0);
    let rays = turns.flat_map(|turn| (0..=8).map(move |part| (turn, f64::from(part) / 8.0)));
    rays.map(|(turn, part)| ray(turn, part)).fold(0.0, f64::max)
}

#[test]
fn verdicts_are_those_of_a_conic_program() {
    let mut random = Random::from_key(17, 0, 0, 0);
    let (mut yes, mut no, mut unknown) = (0, 0, 0);
    for k in 0..1500 {
        let gamma = if k % 3 == 2 { 0.004 } else { 0.0 };
        let (bearings, wanted) = random_grasp(&mut random, 3 + k % 3, gamma);
        let margin = conic_margin(&bearings, &wanted, 1.0);
        let search = Search { bearings: &bearings, share: 1.0 };
        match search.any(&search.start(), &wanted) {
            Balanced::Yes(forces) => {
                assert!(margin > -1e-6, "{k}: {margin}");
                assert!(search.inside(&forces) && search.residual(&forces, &wanted).norm() < 1e-9);
                yes += 1;
            }
            Balanced::No(twist) => {
                assert!(margin < 1e-6, "{k}: {margin}");
                assert!(gamma > 0.0 || refutes(&bearings, &wanted, 1.0, &twist), "{k}");
                no += 1;
            }
            Balanced::Unknown => {
                assert!(margin.abs() < 1e-4, "{k}: {margin} {count} {gamma}", count = bearings.len());
                unknown += 1;
            }
        }
    }
    assert!(yes > 200 && no > 200 && unknown < 15, "{yes} {no} {unknown}");
}

#[test]
fn the_smallest_share_is_that_of_a_conic_program() {
    let mut random = Random::from_key(18, 0, 0, 0);
    let mut found = 0;
    for k in 0..300 {
        let (bearings, wanted) = random_grasp(&mut random, 4, 0.0);
        let smallest = smallest_share(&bearings, &wanted, 1.0);
        let Some(Smallest { share, forces }) = smallest else {
            assert!(conic_margin(&bearings, &wanted, 7.9) < 1e-6, "{k}");
            continue;
        };
        found += 1;
        assert!(share_of(&bearings, &forces) <= share + 1e-12);
        assert!(conic_margin(&bearings, &wanted, share * 1.001) > -1e-7, "{k}");
        assert!(share <= 0.021 || conic_margin(&bearings, &wanted, share * 0.95) < 1e-6, "{k} {share}");
    }
    assert!(found > 100, "{found}");
}

#[test]
fn the_centre_is_the_same_from_wherever_the_search_begins() {
    let mut random = Random::from_key(19, 0, 0, 0);
    let mut compared = 0;
    for _ in 0..200 {
        let (bearings, wanted) = random_grasp(&mut random, 4, 0.003);
        let search = Search { bearings: &bearings, share: 1.0 };
        let Balanced::Yes(cold) = search.centre(&search.start(), &wanted) else { continue };
        let Balanced::Yes(other) = search.any(&search.start(), &(wanted * 0.9)) else { continue };
        let Balanced::Yes(warm) = search.centre(&other, &wanted) else { panic!("it was found cold") };
        let apart = cold.iter().zip(&warm).map(|(a, b)| (a - b).amax()).fold(0.0, f64::max);
        assert!(apart < 1e-3 * cold.iter().map(|x| x.amax()).fold(0.0, f64::max), "{apart}");
        compared += 1;
    }
    assert!(compared > 50, "{compared}");
}
