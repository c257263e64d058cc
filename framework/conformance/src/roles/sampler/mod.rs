//! The laws of samplers.

mod close;
mod spread;

use crate::fixtures::{Bench, to_object};
use crate::law::{Always, Law, Subject, context, counted_once, pure, random};
use crate::reference::{RejectionSampler, closest_on_mesh};
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{
    Build, CallError, ClosedChainSampler, Configuration, Context, FingerIndex, FingerSet, Hand, Pose,
    PoseRequest, Reason, Slot, angle_between,
};

pub(crate) const LAWS: &[Law] = &[
    Law {
        name: "sample-succeeds",
        why: "a sampler that finds nothing where grasps abound starves the planner",
        check: succeeds,
    },
    Law {
        name: "sample-closed",
        why: "every node is taken for a closed chain, to far less than a plan's tolerance",
        check: closed,
    },
    Law {
        name: "sample-holding",
        why: "the fingers that hold are what GS_n is made of",
        check: holding_exact,
    },
    Law { name: "sample-limits", why: "no joint can leave its limits", check: within_limits },
    Law { name: "sample-admissible", why: "a node that cannot be left makes a dead end", check: admissible },
    Law {
        name: "sample-pose",
        why: "goals are given by their pose, and local search stays local",
        check: respects_pose,
    },
    Law { name: "sample-varies", why: "a sampler that repeats itself never covers the space", check: varies },
    Law {
        name: "sample-spreads",
        why: "poses and sides of the object that are never drawn are never reached",
        check: spread::spreads,
    },
    Law {
        name: "close-exact",
        why: "closing chains for given contacts must keep contacts and pose as they are given",
        check: close::close_exact,
    },
    Law {
        name: "close-refuses",
        why: "a finger that cannot reach is an answer, not an error",
        check: close::close_refuses,
    },
    Law {
        name: "sampler-reasons",
        why: "a search that fails is explained by its counted rejections",
        check: counts_reasons,
    },
    Law {
        name: "sampler-counted",
        why: "every call is counted once, by the plugin itself, or the statistics of a run are wrong",
        check: counted,
    },
    Law { name: "sampler-interrupt", why: "Ctrl-C and deadlines end a run soon", check: interrupt },
    Law {
        name: "sampler-pure",
        why: "samples are drawn ahead on other threads, and the same plan must come out",
        check: sampler_pure,
    },
];

/// Closure of a sampled chain (m).
const CLOSED: f64 = 1e-6;

/// The plugin under test.
pub(super) fn build(subject: &Subject<'_>, bench: &Bench) -> Finding<Box<dyn ClosedChainSampler>> {
    let Build::Sampler(build) = subject.entry.build else { return broken("it builds another role") };
    Ok(build(&subject.demands.settings, &bench.parts())?)
}

/// The benches of every law.
fn usual() -> [&'static Bench; 4] {
    [Bench::free_sphere(), Bench::hand_sphere(), Bench::hand_ellipsoid(), Bench::soft_sphere()]
}

/// Those, and the ones with a peculiarity.
fn benches() -> impl Iterator<Item = &'static Bench> {
    let peculiar = [
        Bench::point_sphere(),
        Bench::free_bar(),
        Bench::free_ring(),
        Bench::two_ways_sphere(),
        Bench::posted_sphere(),
    ];
    usual().into_iter().chain(peculiar)
}

/// Which fingers hold in one sample or another.
fn holdings(bench: &Bench) -> [FingerSet; 2] {
    [bench.fingers(), bench.fingers().without(FingerIndex(1))]
}

/// A configuration of the bench, by the reference sampler.
fn somewhere(bench: &Bench, key: u64) -> Configuration {
    let found = RejectionSampler.sample(
        &bench.task(),
        PoseRequest::At(Bench::center()),
        bench.fingers(),
        &mut context(key),
    );
    found.expect("nothing interrupts").expect("the kit's hands hold the kit's objects")
}

/// Tries something on samples of every kind.
fn on_samples(
    subject: &Subject<'_>,
    mut check: impl FnMut(&Bench, FingerSet, &PoseRequest<'_>, &Configuration) -> Finding,
) -> Finding {
    for bench in benches() {
        let (sampler, near) = (build(subject, bench)?, somewhere(bench, 1));
        let turned = Pose { rotation: random(71).rotation(), ..Bench::center() };
        // Often enough to draw the object into the post.
        let often = match bench.name {
            "posted_sphere" => 8,
            name if usual().iter().any(|usual| usual.name == name) => 2,
            _ => 1,
        };
        let requests = [
            PoseRequest::Anywhere,
            PoseRequest::At(turned),
            PoseRequest::Near { configuration: &near, radius: 3e-3, angle: 0.2 },
        ];
        for (i, request) in requests.iter().enumerate() {
            for (k, holding) in holdings(bench).into_iter().enumerate() {
                for key in 0..often {
                    let mut context = context(key + 10 * (i + 10 * k) as u64);
                    if let Some(q) = sampler.sample(&bench.task(), *request, holding, &mut context)? {
                        let at = |fault: Fault| fault.at(&format!("`{}`, request {i}", bench.name));
                        check(bench, holding, request, &q).map_err(at)?;
                    }
                }
            }
        }
    }
    Ok(())
}

fn succeeds(subject: &Subject<'_>) -> Finding {
    for bench in benches() {
        let sampler = build(subject, bench)?;
        let mut found = 0;
        for key in 0..10 {
            let request = if key % 2 == 0 { PoseRequest::Anywhere } else { PoseRequest::At(Bench::center()) };
            let q = sampler.sample(&bench.task(), request, bench.fingers(), &mut context(key))?;
            found += usize::from(q.is_some());
        }
        let hand = &bench.world.hand.description().name;
        ensure(found >= 5, || format!("{found} of 10 calls find a configuration with `{hand}`"))?;
    }
    Ok(())
}

fn closed(subject: &Subject<'_>) -> Finding {
    on_samples(subject, |bench, _, _, q| {
        let length = q.X_HO.rotation.coords.norm();
        ensure((length - 1.0).abs() <= 1e-9, || format!("the orientation has length {length:.9}"))?;
        for finger in q.holding().iter() {
            let tip = bench.world.hand.tip_center(finger, &q.joints[finger]);
            let gap = (q.contact_tip_center(finger, bench.radius()).unwrap_or(tip) - tip).norm();
            ensure(gap <= CLOSED, || format!("finger {} is {gap:e} m off its contact", finger.0))?;
            let off = closest_on_mesh(&bench.world.object.mesh, &to_object(&q.X_HO, &tip)).distance
                - bench.radius();
            ensure(off.abs() <= CLOSED, || format!("fingertip {} is {off:e} m off the object", finger.0))?;
        }
        Ok(())
    })
}

fn holding_exact(subject: &Subject<'_>) -> Finding {
    on_samples(subject, |_, holding, _, q| {
        ensure(q.holding() == holding && q.joints.len() == q.contacts.len(), || {
            format!("{holding:?} were to hold, {:?} do", q.holding())
        })
    })
}

fn within_limits(subject: &Subject<'_>) -> Finding {
    on_samples(subject, |bench, _, _, q| {
        let out = q.joints.iter().find(|(finger, joints)| !bench.world.hand.within_limits(*finger, joints));
        ensure(out.is_none(), || format!("beyond the limits: {out:?}"))
    })
}

fn admissible(subject: &Subject<'_>) -> Finding {
    on_samples(subject, |bench, _, _, q| {
        let task = bench.task();
        let refused = task.admissible.admit(&task, q, &mut context(0))?;
        ensure(refused.is_none(), || format!("not admissible ({refused:?}): {q:?}"))
    })
}

fn respects_pose(subject: &Subject<'_>) -> Finding {
    on_samples(subject, |bench, _, request, q| {
        let p = q.X_HO.translation.vector;
        let kept = match request {
            PoseRequest::Anywhere => {
                let (lower, upper) = bench.world.workspace;
                (0..3).all(|i| (lower[i]..=upper[i]).contains(&p[i]))
            }
            PoseRequest::At(X_HO) => q.X_HO == *X_HO,
            PoseRequest::Near { configuration, radius, angle } => {
                let moved = (p - configuration.X_HO.translation.vector).norm();
                let turned = angle_between(&q.X_HO.rotation, &configuration.X_HO.rotation);
                moved <= radius + 1e-9 && turned <= angle + 1e-9
            }
        };
        ensure(kept, || format!("{request:?} was asked for, {:?} given", q.X_HO))
    })
}

fn varies(subject: &Subject<'_>) -> Finding {
    let bench = Bench::free_sphere();
    let sampler = build(subject, bench)?;
    let mut found: Vec<Configuration> = Vec::new();
    for key in 0..8 {
        let request = PoseRequest::At(Bench::center());
        found.extend(sampler.sample(&bench.task(), request, bench.fingers(), &mut context(key))?);
    }
    let alike = found.windows(2).filter(|pair| pair[0] == pair[1]).count();
    ensure(alike == 0, || format!("{alike} of {} samples of different streams are alike", found.len()))?;
    let near = somewhere(bench, 1);
    for key in 0..8 {
        let request = PoseRequest::Near { configuration: &near, radius: 3e-3, angle: 0.2 };
        let found = sampler.sample(&bench.task(), request, bench.fingers(), &mut context(key))?;
        ensure(found.as_ref() != Some(&near), || {
            "what is drawn near a configuration is that one itself".into()
        })?;
    }
    Ok(())
}

fn counts_reasons(subject: &Subject<'_>) -> Finding {
    for bench in usual() {
        let sampler = build(subject, bench)?;
        let (mut context, far) = (context(0), PoseRequest::At(Pose::translation(0.0, 0.0, 1.0)));
        let found = sampler.sample(&bench.task(), far, bench.fingers(), &mut context)?;
        ensure(found.is_none(), || format!("a sample a metre away: {found:?}"))?;
        let counted: u64 = Reason::ALL.iter().map(|&r| context.tally.rejections(Slot::Sampler, r)).sum();
        ensure(counted > 0, || "finds nothing and counts no reason".into())?;
    }
    Ok(())
}

fn counted(subject: &Subject<'_>) -> Finding {
    let bench = Bench::free_sphere();
    let sampler = build(subject, bench)?;
    for request in [PoseRequest::Anywhere, PoseRequest::At(Pose::translation(0.0, 0.0, 1.0))] {
        let mut context = context(0);
        sampler.sample(&bench.task(), request, bench.fingers(), &mut context)?;
        counted_once(&context, Slot::Sampler)?;
    }
    Ok(())
}

fn interrupt(subject: &Subject<'_>) -> Finding {
    let bench = Bench::hand_sphere();
    let sampler = build(subject, bench)?;
    for request in [PoseRequest::Anywhere, PoseRequest::At(Pose::translation(0.0, 0.0, 1.0))] {
        let mut context = Context::new(random(0), &Always);
        let found = sampler.sample(&bench.task(), request, bench.fingers(), &mut context);
        ensure(matches!(found, Err(CallError::Interrupted)), || format!("goes on: {found:?}"))?;
    }
    Ok(())
}

fn sampler_pure(subject: &Subject<'_>) -> Finding {
    for bench in usual() {
        let sampler = build(subject, bench)?;
        pure(4, |i| {
            let mut context = context(i as u64);
            let found =
                sampler.sample(&bench.task(), PoseRequest::Anywhere, holdings(bench)[i % 2], &mut context)?;
            Ok((found, context.tally))
        })?;
    }
    Ok(())
}
