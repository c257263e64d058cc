//! The laws of local planners, for each of their three slots.

mod answer;
mod case;
mod inspect;
mod journey;
mod links;
mod places;
mod special;
mod way;

use crate::law::{Law, Subject, context};
use crate::report::{Finding, broken};
use case::{Case, cases};
pub(crate) use journey::Journey;
use regrasp_api::{Build, BuildError, CallError, LocalPlanner, Path, Slot};
use std::rc::Rc;

/// A slot as a type, so that one check serves all three.
pub(crate) trait Kind {
    const SLOT: Slot;
}

pub(crate) struct Grasp;
pub(crate) struct Transfer;
pub(crate) struct Regrasp;

impl Kind for Grasp {
    const SLOT: Slot = Slot::GraspPlanner;
}
impl Kind for Transfer {
    const SLOT: Slot = Slot::TransferPlanner;
}
impl Kind for Regrasp {
    const SLOT: Slot = Slot::RegraspPlanner;
}

/// The laws of all slots, then those of one.
macro_rules! laws {
    ($kind:ty, $prefix:literal, $($own:expr),*) => {
        &[
            Law {
                name: concat!($prefix, "-ends"),
                why: "consecutive pieces of a plan share their end states exactly",
                check: answer::ends::<$kind>,
            },
            Law {
                name: concat!($prefix, "-reached"),
                why: "the planner goes on from where it is told that a motion ended, and why",
                check: answer::reached::<$kind>,
            },
            Law {
                name: concat!($prefix, "-fraction"),
                why: "the search takes the fraction for how far it came, and pays by it",
                check: answer::fraction::<$kind>,
            },
            Law {
                name: concat!($prefix, "-target"),
                why: "a motion that stops beside its target leaves a gap in the plan",
                check: answer::target::<$kind>,
            },
            Law {
                name: concat!($prefix, "-path-optional"),
                why: "edges are checked without a path first, and stored later",
                check: answer::path_optional::<$kind>,
            },
            Law {
                name: concat!($prefix, "-succeeds"),
                why: "a planner that refuses the simplest motions leaves the graph without edges",
                check: answer::succeeds::<$kind>,
            },
            Law {
                name: concat!($prefix, "-reasons"),
                why: "a search that fails is explained by its counted refusals",
                check: answer::reasons::<$kind>,
            },
            Law {
                name: concat!($prefix, "-counted"),
                why: "every call is counted once, by the plugin itself, or the statistics of a run are wrong",
                check: answer::counted::<$kind>,
            },
            Law {
                name: concat!($prefix, "-wrong-target"),
                why: "a plugin in the wrong slot is refused with a sentence",
                check: answer::wrong_target::<$kind>,
            },
            Law {
                name: concat!($prefix, "-interrupt"),
                why: "Ctrl-C and deadlines end a run soon",
                check: answer::interrupt::<$kind>,
            },
            Law {
                name: concat!($prefix, "-pure"),
                why: "motions are computed ahead on other threads, and the same plan must come out",
                check: answer::planner_pure::<$kind>,
            },
            Law {
                name: concat!($prefix, "-steps"),
                why: "what lies between two states is looked at no closer than the resolution says",
                check: way::steps::<$kind>,
            },
            Law {
                name: concat!($prefix, "-limits"),
                why: "no joint can leave its limits",
                check: way::limits::<$kind>,
            },
            Law {
                name: concat!($prefix, "-collision-free"),
                why: "the verifier compares all bodies, also between the stored states",
                check: way::collision_free::<$kind>,
            },
            Law {
                name: concat!($prefix, "-stable"),
                why: "the grasp must hold at every instant",
                check: way::stays_stable::<$kind>,
            },
            $($own),*
        ]
    };
}

pub(crate) const GRASP: &[Law] = laws!(
    Grasp,
    "grasp",
    Law {
        name: "grasp-contacts",
        why: "decomposition takes the contacts of the path's states for its targets",
        check: way::contacts_true::<Grasp>,
    },
    Law {
        name: "grasp-closed",
        why: "between the stored states the fingertips must touch too",
        check: way::stays_closed::<Grasp>,
    },
    Law {
        name: "grasp-same-fingers",
        why: "inside GS_n the same n fingers hold",
        check: special::same_fingers::<Grasp>,
    }
);

pub(crate) const TRANSFER: &[Law] = laws!(
    Transfer,
    "transfer",
    Law {
        name: "transfer-contacts",
        why: "the next regrasp starts from the contacts that the transfer says it drifted to",
        check: way::contacts_true::<Transfer>,
    },
    Law {
        name: "transfer-closed",
        why: "between the stored states the fingertips must touch too",
        check: way::stays_closed::<Transfer>,
    },
    Law {
        name: "transfer-same-fingers",
        why: "a finger that lets go or joins in makes a regrasp, which is another kind of path",
        check: special::same_fingers::<Transfer>,
    },
    Law {
        name: "transfer-no-slip",
        why: "fingertips that slip lose the grasp that was planned",
        check: special::no_slip,
    }
);

pub(crate) const REGRASP: &[Law] = laws!(
    Regrasp,
    "regrasp",
    Law {
        name: "regrasp-others-rest",
        why: "while one finger moves nothing else may",
        check: special::others_rest,
    },
    Law {
        name: "regrasp-touches-at-ends",
        why: "a fingertip that scrapes along the object moves it",
        check: special::touches_at_ends,
    },
    Law {
        name: "regrasp-lifts",
        why: "a fingertip that comes down again beside its contact, or does not rise, slides",
        check: special::lifts,
    }
);

/// The plugin for a problem; an error where it is built for another role.
fn build(subject: &Subject<'_>, case: &Case) -> Finding<Box<dyn LocalPlanner>> {
    let Build::LocalPlanner(build) = subject.entry.build else { return broken("it builds another role") };
    Ok(build(&subject.demands.settings, &case.bench.parts())?)
}

/// Tries something on all that the plugin made; a failure names hand, object and case.
fn on_journeys<K: Kind>(subject: &Subject<'_>, check: impl Fn(&Journey) -> Finding) -> Finding {
    for journey in journeys::<K>(subject)?.iter() {
        let number = cases(K::SLOT).iter().position(|case| std::ptr::eq(case, journey.case)).unwrap_or(0);
        check(journey).map_err(|fault| fault.at(&format!("`{}`, case {number}", journey.case.bench.name)))?;
    }
    Ok(())
}

/// What the plugin makes of every problem of the slot whose hand and object it takes.
fn journeys<K: Kind>(subject: &Subject<'_>) -> Finding<Rc<Vec<Journey>>> {
    if let Some((_, known)) = subject.journeys.borrow().iter().find(|(slot, _)| *slot == K::SLOT) {
        return Ok(known.clone());
    }
    let Build::LocalPlanner(build) = subject.entry.build else { return broken("it builds another role") };
    let mut made = Vec::new();
    for (key, case) in cases(K::SLOT).iter().enumerate() {
        let planner = match build(&subject.demands.settings, &case.bench.parts()) {
            Err(BuildError::Unsupported(_)) => continue,
            built => built?,
        };
        let mut path = Path::default();
        let (task, target) = (case.bench.task(), case.goal.target());
        let mut context = context(key as u64);
        let reached = match planner.connect(&task, &case.from, &target, Some(&mut path), &mut context) {
            // The plugin's law is for other hands or contact models: it says so, and is tried on the rest.
            Err(CallError::Unsupported { .. }) => continue,
            reached => reached?,
        };
        made.push(Journey { case, reached, path, tally: context.tally });
    }
    if made.is_empty() {
        return Err(crate::report::Fault::Skip(
            "the plugin takes none of the kit's hands and objects".into(),
        ));
    }
    let made = Rc::new(made);
    subject.journeys.borrow_mut().push((K::SLOT, made.clone()));
    Ok(made)
}
