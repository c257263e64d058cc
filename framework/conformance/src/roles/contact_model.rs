//! The laws of contact models.

use crate::fixtures::{Bench, grasps};
use crate::law::{Law, Subject, pure, random};
use crate::reference::{Closure, closure};
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{
    Build, Cone, Contact, ContactModel, FingerIndex, Grasp, GraspContact, MAX_FINGERS, Random, Vec3,
};

pub(crate) const LAWS: &[Law] = &[
    Law {
        name: "cone-valid",
        why: "a stability test relies on finite cones that hold the contact's own normal",
        check: cone_valid,
    },
    Law {
        name: "cone-monotone",
        why: "planning with a smaller friction is how a plan keeps a margin",
        check: cone_monotone,
    },
    Law {
        name: "cone-within-friction",
        why: "a cone wider than Coulomb's makes plans that slip",
        check: cone_within_friction,
    },
    Law {
        name: "spinning-cone",
        why: "a contact that spins transmits no torsion, and no more of anything than one at rest",
        check: spinning_cone,
    },
    Law {
        name: "fewest-contacts",
        why: "the planner searches in GS_n with n one more: too few finds nothing, too many wastes fingers",
        check: fewest_contacts,
    },
    Law {
        name: "contact-model-pure",
        why: "threads share the model, and the same plan must come out on any number of them",
        check: model_pure,
    },
];

/// The finger that touches.
const FINGER: FingerIndex = FingerIndex(0);
/// Friction coefficients in ascending order.
const FRICTIONS: [f64; 6] = [0.0, 0.05, 0.3, 0.76, 1.0, 4.0];

fn build(subject: &Subject<'_>) -> Finding<Box<dyn ContactModel>> {
    let Build::ContactModel(build) = subject.entry.build else { return broken("it builds another role") };
    Ok(build(&subject.demands.settings, &Bench::free_sphere().parts())?)
}

fn contacts() -> Vec<Contact> {
    let mut random = random(1);
    let contact = |random: &mut Random| {
        let n_O = random.direction();
        Contact { facet: random.index(100) as u32, p_OC: n_O * 0.03, n_O }
    };
    (0..12).map(|_| contact(&mut random)).collect()
}

/// The largest value over the cone's slice at unit normal force of the product with `w` = (t1, t2, torsion / m).
pub(crate) fn support(cone: &Cone<'_>, w: &Vec3) -> f64 {
    match cone {
        Cone::Elliptic { mu, gamma } => (mu * mu * (w.x * w.x + w.y * w.y) + (gamma * w.z).powi(2)).sqrt(),
        Cone::Polyhedral(edges) => {
            let value = |t: [f64; 2], torsion: f64| t[0] * w.x + t[1] * w.y + torsion * w.z;
            edges.iter().map(|e| value(e.tangential, e.torsion)).fold(f64::NEG_INFINITY, f64::max)
        }
    }
}

/// Directions over the slice: along the axes, and spread.
fn directions() -> Vec<Vec3> {
    let mut random = random(2);
    let axes = [Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y(), Vec3::z(), -Vec3::z()];
    axes.into_iter().chain((0..60).map(|_| random.direction())).collect()
}

fn cone_valid(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    for contact in contacts() {
        for mu in FRICTIONS {
            let cone = model.cone(FINGER, &contact, mu);
            let text = || format!("the cone at μ = {mu}: {cone:?}");
            let finite = match &cone {
                Cone::Elliptic { mu, gamma } => {
                    mu.is_finite() && gamma.is_finite() && *mu >= 0.0 && *gamma >= 0.0
                }
                Cone::Polyhedral(edges) => {
                    let finite = |x: &f64| x.is_finite();
                    edges.iter().all(|e| e.tangential.iter().all(finite) && e.torsion.is_finite())
                        && !edges.is_empty()
                }
            };
            ensure(finite, text)?;
            ensure(directions().iter().all(|w| support(&cone, w) >= -1e-12), text)?;
        }
    }
    Ok(())
}

fn cone_monotone(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    for contact in contacts() {
        for pair in FRICTIONS.windows(2) {
            for w in directions() {
                // Values are copied out at once: a model may own one buffer of edges only for each friction.
                let low = support(&model.cone(FINGER, &contact, pair[0]), &w);
                let high = support(&model.cone(FINGER, &contact, pair[1]), &w);
                ensure(high >= low - 1e-12, || {
                    format!("along {w:?} the cone shrinks from {low} to {high} as μ grows over {pair:?}")
                })?;
            }
        }
    }
    Ok(())
}

fn cone_within_friction(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    for contact in contacts() {
        for mu in FRICTIONS {
            for k in 0..64 {
                let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 64.0).sin_cos();
                let reach = support(&model.cone(FINGER, &contact, mu), &Vec3::new(cos, sin, 0.0));
                ensure(reach <= mu + 1e-9, || format!("tangential forces up to {reach} at μ = {mu}"))?;
            }
        }
    }
    Ok(())
}

fn spinning_cone(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    for contact in contacts() {
        for mu in FRICTIONS {
            // Frictionless contacts may stand in for cones whose torsion cannot be told apart.
            let spinning = model.spinning_cone(FINGER, &contact, mu);
            ensure(!spinning.carries_torsion(), || format!("{spinning:?} at μ = {mu} carries torsion"))?;
            for w in directions() {
                let (low, high) = (support(&spinning, &w), support(&model.cone(FINGER, &contact, mu), &w));
                ensure(low <= high + 1e-12, || {
                    format!(
                        "along {w:?} the spinning cone reaches {low}, the resting one {high}, at μ = {mu}"
                    )
                })?;
            }
        }
    }
    Ok(())
}

fn fewest_contacts(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    let fewest = model.fewest_contacts();
    ensure((1..=MAX_FINGERS).contains(&fewest), || format!("{fewest} contacts: not in 1..={MAX_FINGERS}"))?;
    ensure(fewest < 2 || !some_closed(&*model, fewest - 1), || {
        format!("says {fewest}, but {} contacts can hold", fewest - 1)
    })?;
    ensure(some_closed(&*model, fewest), || format!("says {fewest}, but found no such grasp that holds"))
}

/// Whether one of many grasps with this many contacts is force closure under the model.
fn some_closed(model: &dyn ContactModel, contacts: usize) -> bool {
    let mut random = random(3);
    let even = grasps::equator(contacts, 0.0);
    let others = (0..800).map(|_| grasps::random(&mut random, contacts));
    std::iter::once(even).chain(others).any(|touches| {
        let mut grasp = Grasp::new(Vec3::zeros());
        for (i, touch) in touches.iter().enumerate() {
            let contact = Contact { facet: 0, p_OC: touch.p, n_O: touch.n };
            let cone = model.cone(FINGER, &contact, 0.8);
            let finger = FingerIndex(i as u8);
            grasp.push(GraspContact { finger, p_OC: touch.p, n_O: touch.n, cone });
        }
        closure(&grasp) == Closure::Closed
    })
}

fn model_pure(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    let contacts = contacts();
    pure(contacts.len() * FRICTIONS.len(), |i| {
        let (contact, mu) = (&contacts[i / FRICTIONS.len()], FRICTIONS[i % FRICTIONS.len()]);
        Ok::<_, Fault>((format!("{:?}", model.cone(FINGER, contact, mu)), model.fewest_contacts()))
    })
}
