//! The laws of contact models.

use crate::fixtures::{Bench, grasps};
use crate::law::{Law, Subject, pure, random};
use crate::reference::{Closure, closure};
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{
    Build, Cone, Contact, ContactModel, FingerIndex, Grasp, GraspContact, MAX_FINGERS, Random, Vec3, tangents,
};
use regrasp_audit::laws::{self, Broken};

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
        name: "torsion-bounded",
        why: "a torsional radius is a length in metres: one in millimetres holds everything",
        check: torsion_bounded,
    },
    Law {
        name: "tangent-frames",
        why: "tangents are a convention: a cone that follows them turns on the object where they change \
            branch",
        check: tangent_frames,
    },
    Law {
        name: "facet-numbers",
        why: "facets are numbered as the mesh happens to be cut, and transfers carry the number along",
        check: facet_numbers,
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

/// Contacts all over a ball, on the six faces of a cube, where a projected grain may have no direction, and
/// two at one place: on a sharp edge normals turn, and the place stays.
fn contacts() -> Vec<Contact> {
    let mut random = random(1);
    let contact = |random: &mut Random| {
        let n_O = random.direction();
        Contact { facet: random.index(100) as u32, p_OC: n_O * 0.03, n_O }
    };
    let round: Vec<Contact> = (0..12).map(|_| contact(&mut random)).collect();
    let faces = [Vec3::x(), Vec3::y(), Vec3::z()].into_iter().flat_map(|axis| [axis, -axis]);
    let face = |(k, n_O): (usize, Vec3)| Contact { facet: k as u32, p_OC: n_O * 0.0225, n_O };
    let edge = |n_O: Vec3| Contact { facet: 6, p_OC: Vec3::new(0.0225, 0.0225, 0.004), n_O };
    let edges = [Vec3::new(1.0, 1.0, 0.0).normalize(), Vec3::new(0.6, 0.8, 0.0)].map(edge);
    round.into_iter().chain(faces.enumerate().map(face)).chain(edges).collect()
}

/// Directions over the slice: along the axes, and spread.
fn directions() -> Vec<Vec3> {
    let mut random = random(2);
    let axes = [Vec3::x(), -Vec3::x(), Vec3::y(), -Vec3::y(), Vec3::z(), -Vec3::z()];
    axes.into_iter().chain((0..60).map(|_| random.direction())).chain(laws::directions()).collect()
}

/// Which contact, for messages.
fn place(contact: &Contact, mu: f64) -> String {
    format!("facet {}, normal {:.2?}, μ = {mu}", contact.facet, contact.n_O.as_slice())
}

/// Tries something on every contact, finger and friction coefficient.
fn on_cones(
    subject: &Subject<'_>,
    check: impl Fn(&dyn ContactModel, FingerIndex, &Contact, f64) -> Result<(), Broken>,
) -> Finding {
    let model = build(subject)?;
    for (i, contact) in contacts().iter().enumerate() {
        // The kit's hand has four fingers.
        let finger = FingerIndex((i % 4) as u8);
        for mu in FRICTIONS {
            check(&*model, finger, contact, mu).map_err(|fault| {
                Fault::Broken(format!("finger {}, {}: {}", finger.0, place(contact, mu), fault.what))
            })?;
        }
    }
    Ok(())
}

fn cone_valid(subject: &Subject<'_>) -> Finding {
    on_cones(subject, |model, finger, contact, mu| {
        laws::cone_valid(&model.cone(finger, contact, mu), &contact.n_O)
    })
}

fn cone_monotone(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    for contact in contacts() {
        for pair in FRICTIONS.windows(2) {
            for w in directions() {
                // Values are copied out at once: a model may own one buffer of edges only for each friction.
                let low = laws::support(&model.cone(FINGER, &contact, pair[0]), &contact.n_O, &w);
                let high = laws::support(&model.cone(FINGER, &contact, pair[1]), &contact.n_O, &w);
                ensure(high >= low - 1e-12, || {
                    format!("along {w:?} the cone shrinks from {low} to {high} as μ grows over {pair:?}")
                })?;
            }
        }
    }
    Ok(())
}

fn cone_within_friction(subject: &Subject<'_>) -> Finding {
    on_cones(subject, |model, finger, contact, mu| {
        laws::cone_within_friction(&model.cone(finger, contact, mu), mu)
    })
}

/// The torsional radius of a patch: more than this is no fingertip's, whatever its material.
const MOST_TORSION: f64 = 0.1;

fn torsion_bounded(subject: &Subject<'_>) -> Finding {
    on_cones(subject, |model, finger, contact, mu| {
        let cone = model.cone(finger, contact, mu);
        let reach = [1.0, -1.0].map(|sign| laws::support(&cone, &contact.n_O, &Vec3::new(0.0, 0.0, sign)));
        let most = reach[0].max(reach[1]);
        laws::ensure("torsion-bounded", most <= MOST_TORSION, || {
            format!("a torque of {most:.3} N·m per newton; γ is a length in metres, at most {MOST_TORSION} m")
        })
    })
}

fn spinning_cone(subject: &Subject<'_>) -> Finding {
    on_cones(subject, |model, finger, contact, mu| {
        let (spinning, resting) = (model.spinning_cone(finger, contact, mu), model.cone(finger, contact, mu));
        // A cone at rest that is none is `cone-valid`'s matter.
        if laws::cone_valid(&resting, &contact.n_O).is_err() {
            return Ok(());
        }
        laws::cone_valid(&spinning, &contact.n_O)?;
        laws::ensure("spinning-cone", !spinning.carries_torsion(), || {
            format!("{spinning:?} carries torsion")
        })?;
        laws::cone_inside("spinning-cone", &contact.n_O, &spinning, &resting)?;
        // Who forgets what a contact keeps that spins is left with a frictionless one.
        let lost =
            reach(&spinning, &contact.n_O) == 0.0 && reach(&resting.without_torsion(), &contact.n_O) > 1e-6;
        laws::ensure("spinning-cone", !lost, || {
            "it keeps no friction at all, though the cone without torsion has some".into()
        })
    })
}

/// The largest tangential force.
fn reach(cone: &Cone<'_>, n_O: &Vec3) -> f64 {
    let ring = (0..32).map(|k| (std::f64::consts::TAU * f64::from(k) / 32.0).sin_cos());
    ring.map(|(sin, cos)| laws::support(cone, n_O, &Vec3::new(cos, sin, 0.0))).fold(0.0, f64::max)
}

/// The largest force along a tangent given in O.
fn reach_along(cone: &Cone<'_>, contact: &Contact, direction_O: &Vec3) -> f64 {
    let [t1, t2] = tangents(&-contact.n_O);
    laws::support(cone, &contact.n_O, &Vec3::new(direction_O.dot(&t1), direction_O.dot(&t2), 0.0))
}

/// A cone is a fact about the object: two contacts with all but the same normal have all but the same cone in
/// O, whichever way their tangents point. Where [`tangents`] changes branch, a model that fixes its edges to
/// them jumps.
fn tangent_frames(subject: &Subject<'_>) -> Finding {
    let model = build(subject)?;
    // |n.x| = 0.6 is where `any_orthogonal` takes another axis.
    for (y, z) in [(0.8_f64, 0.0_f64), (0.0, 0.8), (0.48, -0.64), (-0.64, 0.48)] {
        let contact = |x: f64| {
            let n_O = Vec3::new(x, y, z).normalize();
            Contact { facet: 0, p_OC: n_O * 0.03, n_O }
        };
        let (here, there) = (contact(0.6 - 1e-7), contact(0.6 + 1e-7));
        let [a, b] = [&here, &there].map(|contact| model.cone(FINGER, contact, 0.76));
        for k in 0..16 {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 16.0).sin_cos();
            let [t1, t2] = tangents(&-here.n_O);
            let direction = t1 * cos + t2 * sin;
            let reaches = [reach_along(&a, &here, &direction), reach_along(&b, &there, &direction)];
            ensure((reaches[0] - reaches[1]).abs() <= 0.05, || {
                let [x, y] = reaches;
                format!(
                    "the reach along one direction in O jumps from {x:.3} to {y:.3} where the tangents \
                     change branch"
                )
            })?;
        }
    }
    Ok(())
}

/// A cone belongs to a place, not to the number of a facet: a mesh that is cut another way has the same.
fn facet_numbers(subject: &Subject<'_>) -> Finding {
    // Fresh objects: what one remembers is another law's.
    let fresh = |contact: &Contact| {
        let model = build(subject)?;
        Ok::<_, Fault>(format!("{:?}", model.cone(FINGER, contact, 0.76)))
    };
    for contact in contacts() {
        let other = Contact { facet: contact.facet ^ 5, ..contact };
        let (a, b) = (fresh(&contact)?, fresh(&other)?);
        ensure(a == b, || {
            format!("{}: another cone for facet number {}", place(&contact, 0.76), other.facet)
        })?;
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
    let (model, fresh) = (build(subject)?, build(subject)?);
    let contacts = contacts();
    let count = contacts.len() * FRICTIONS.len();
    let cone = |model: &dyn ContactModel, i: usize| {
        let (contact, mu) = (&contacts[i / FRICTIONS.len()], FRICTIONS[i % FRICTIONS.len()]);
        format!("{:?}", model.cone(FingerIndex((i % 4) as u8), contact, mu))
    };
    // A fresh object that is asked in reverse order answers the same.
    let forward: Vec<String> = (0..count).map(|i| cone(&*model, i)).collect();
    for (i, before) in forward.iter().enumerate().rev() {
        ensure(cone(&*fresh, i) == *before, || {
            let at = place(&contacts[i / FRICTIONS.len()], FRICTIONS[i % FRICTIONS.len()]);
            format!("{at}: a fresh object, asked in another order, gives another cone")
        })?;
    }
    pure(count, |i| Ok::<_, Fault>((cone(&*model, i), model.fewest_contacts())))
}
