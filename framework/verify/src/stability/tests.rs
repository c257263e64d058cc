use super::force::{Contact, Force, Forces, margin, prove};
use super::{best, socp};
use regrasp_api::{MAX_FINGERS, Random, Vec3};

fn contact(p: Vec3, outward: Vec3, mu: f64, gamma: f64) -> Contact {
    Contact { r: p, n: -outward.normalize(), mu, gamma, drag: 0.0, more: None }
}

/// Three contacts of a cube held across edges: rounding stops the solver before its own tolerances are met.
fn across_edges() -> Vec<Contact> {
    let contacts = [
        ([0.0225, -0.010526041957050402, -0.019535116802749473], [1.0, 0.0, 0.0]),
        ([0.0225, 0.0225, 0.011301045533201479], [0.9860954241964934, 0.1661800661292976, 0.0]),
        ([-0.0225, -0.0225, 0.0011355850580869326], [-0.31803964570149246, -0.9480774144351658, 0.0]),
    ];
    let length = 0.03897114317029974;
    contacts.map(|(p, n)| contact(Vec3::from(p) / length, Vec3::from(n), 0.8, 0.0)).to_vec()
}

#[test]
fn a_closed_grasp_is_proved_though_the_solver_doubts_its_own_answer() {
    let proof = best(&across_edges()).expect("closed: forces of slack 0.06 hold it");
    assert!(proof.slack > 0.05, "{}", proof.slack);
}

/// Contacts on the unit ball.
fn on_ball(directions: &[Vec3], mu: f64, gamma: f64) -> Vec<Contact> {
    directions.iter().map(|d| contact(d.normalize(), *d, mu, gamma)).collect()
}

fn random_grasp(random: &mut Random, count: usize, mu: f64, gamma: f64) -> Vec<Contact> {
    let one = |random: &mut Random| {
        let normal = random.direction() * 0.4 + random.direction();
        contact(random.direction(), normal, mu, gamma)
    };
    (0..count).map(|_| one(random)).collect()
}

/// An upper bound of Q1 = min over |w| = 1 of max_i h_i(w): the least over many directions, improved by
/// random steps, from several starts.
fn sampled_margin(contacts: &[Contact], random: &mut Random) -> f64 {
    let value = |w: &(Vec3, Vec3)| {
        let support = |c: &Contact| {
            let v = w.0 + w.1.cross(&c.r);
            let (v_n, spin) = (v.dot(&c.n), w.1.dot(&c.n));
            let v_t = (v - c.n * v_n).norm();
            v_n + (c.mu * v_t).hypot(c.gamma * spin)
        };
        contacts.iter().map(support).fold(f64::NEG_INFINITY, f64::max)
    };
    let draw = |random: &mut Random, about: &(Vec3, Vec3), width: f64| {
        let noise = |random: &mut Random| Vec3::from_fn(|_, _| random.normal() * width);
        let w = (about.0 + noise(random), about.1 + noise(random));
        let norm = w.0.norm().hypot(w.1.norm());
        (w.0 / norm, w.1 / norm)
    };
    let origin = (Vec3::zeros(), Vec3::zeros());
    let mut least = f64::INFINITY;
    for _ in 0..12 {
        let mut best = (f64::INFINITY, origin);
        for step in 0..800 {
            let (about, width) =
                if step < 60 { (origin, 1.0) } else { (best.1, 0.4 * (-step as f64 / 80.0).exp()) };
            let w = draw(random, &about, width);
            best = if value(&w) < best.0 { (value(&w), w) } else { best };
        }
        least = least.min(best.0);
    }
    least
}

#[test]
fn known_grasps_get_their_verdicts() {
    let (x, y, z) = (Vec3::x(), Vec3::y(), Vec3::z());
    let triangle = [x, -x * 0.5 + y * 0.866, -x * 0.5 - y * 0.866];
    assert!(best(&on_ball(&triangle, 0.5, 0.0)).is_ok());
    assert!(best(&on_ball(&[x, -x, y, -y], 0.3, 0.0)).is_ok());
    // Two point contacts never hold: nothing resists turning about their line. Two soft fingers do.
    assert!(best(&on_ball(&[x, -x], 0.8, 0.0)).is_err());
    assert!(best(&on_ball(&[x, -x], 0.8, 0.1)).is_ok());
    // Three contacts on one face push one way only; on one side of the ball too.
    let face = [x * 0.5, y * 0.5, -x * 0.5 - y * 0.5].map(|p| contact(p + z, z, 0.8, 0.0));
    assert!(best(&face).is_err());
    assert!(best(&on_ball(&[x + z * 2.0, y + z * 2.0, z * 2.0 - x - y], 0.3, 0.0)).is_err());
    // Four contacts without friction do not hold, seven on a body with edges may.
    assert!(best(&on_ball(&[x + y + z, x - y - z, y - x - z, z - x - y], 0.0, 0.0)).is_err());
    assert!(best(&[]).is_err());
}

#[test]
fn duplicated_contacts_add_nothing() {
    let x = Vec3::x();
    assert!(best(&on_ball(&[x, x, -x, -x], 0.8, 0.0)).is_err());
}

#[test]
fn margins_are_below_the_true_one_and_positive() {
    let mut random = Random::from_key(11, 0, 0, 0);
    let (mut stable, mut loosest) = (0, 0.0_f64);
    for round in 0..150 {
        let gamma = if round % 3 == 0 { 0.2 } else { 0.0 };
        let count = 3 + round % 3;
        let mu = 0.4 + 0.6 * random.unit();
        let contacts = random_grasp(&mut random, count, mu, gamma);
        let sampled = sampled_margin(&contacts, &mut random);
        match best(&contacts) {
            Ok(proof) => {
                stable += 1;
                let lower = margin(&contacts, &proof);
                assert!(sampled > 0.0 && lower > 0.0 && lower <= sampled, "{lower} {sampled}");
                loosest = loosest.max(sampled / lower);
            }
            Err(_) => assert!(sampled < 0.02, "a grasp with margin {sampled} was not proved"),
        }
    }
    assert!((30..120).contains(&stable), "{stable} of 150");
    assert!(loosest < 100.0, "{loosest}");
}

#[test]
fn arithmetic_proves_no_grasp_that_the_solver_refutes() {
    let mut random = Random::from_key(12, 0, 0, 0);
    let mut proved = 0;
    for _ in 0..2000 {
        let contacts = random_grasp(&mut random, 4, 0.7, 0.0);
        let mut forces: Forces = [Force::default(); MAX_FINGERS];
        for force in &mut forces[..4] {
            *force = Force { normal: random.unit(), tangential: random.direction() * 0.1, spin: 0.0 };
        }
        if let Some(proof) = prove(&contacts, &forces) {
            proved += 1;
            let (_, slack) = socp::best_forces(&contacts).unwrap();
            assert!(slack >= proof.slack - 1e-7, "{slack} {}", proof.slack);
        }
    }
    assert!(proved > 20, "{proved}");
}

#[test]
fn a_force_is_carried_to_a_grasp_close_by() {
    let directions = [Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y() + Vec3::z() * 0.2];
    let proof = best(&on_ball(&directions, 0.6, 0.0)).unwrap();
    let mut random = Random::from_key(13, 0, 0, 0);
    let moved = directions.map(|d| d + random.direction() * 0.01);
    let carried = prove(&on_ball(&moved, 0.6, 0.0), &proof.forces).unwrap();
    assert!((carried.slack - proof.slack).abs() < 0.05);
    assert!(
        prove(&on_ball(&directions, 0.01, 0.0), &proof.forces).is_none(),
        "less friction needs another force"
    );
}

/// Torques of drag are part of what forces balance, in the solver, in the correction and in the proof.
#[test]
fn forces_balance_the_drag_of_spinning_contacts() {
    let held = |drag: f64| {
        let contact = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / 3.0).sin_cos();
            Contact { drag, ..contact(Vec3::new(cos, sin, 0.0), Vec3::new(cos, sin, 0.0), 0.8, 0.0) }
        };
        let mut contacts: Vec<Contact> = (0..3).map(contact).collect();
        contacts[1].drag = -drag;
        contacts
    };
    for drag in [0.0, 0.1, 0.3] {
        let contacts = held(drag);
        let (forces, slack) = socp::best_forces(&contacts).expect("friction bears it");
        let proof = prove(&contacts, &forces).expect("and that is proved");
        assert!(slack > 0.01 && proof.slack > 0.01, "{slack} {}", proof.slack);
        let torque: Vec3 = contacts
            .iter()
            .zip(&proof.forces)
            .map(|(contact, y)| {
                let f = contact.n * y.normal + y.tangential * contact.mu;
                contact.r.cross(&f) + contact.n * (contact.drag * y.normal)
            })
            .sum();
        assert!(torque.norm() < 1e-9, "{torque}");
    }
    // No friction bears a drag of more than twice its lever.
    let contacts = held(2.0);
    assert!(socp::best_forces(&contacts).is_none_or(|(forces, _)| prove(&contacts, &forces).is_none()));
}
