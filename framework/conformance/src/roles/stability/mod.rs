//! The laws of stability tests that decide force closure.

mod call;
mod proof;
mod symmetry;

use crate::law::Law;

pub(crate) const LAWS: &[Law] = &[
    Law {
        name: "no-false-stable",
        why: "a grasp that is wrongly called stable drops the object",
        check: call::no_false_stable,
    },
    Law {
        name: "accepts-good-grasps",
        why: "a test that refuses clear grasps leaves the planner without configurations",
        check: call::accepts_good_grasps,
    },
    Law {
        name: "rigid-motion",
        why: "where the object's frame lies is a modeller's whim",
        check: symmetry::rigid_motion,
    },
    Law {
        name: "permutation",
        why: "the order of the fingers is that of the hand file",
        check: symmetry::permutation,
    },
    Law { name: "scale", why: "force closure knows no unit of length", check: symmetry::scale },
    Law {
        name: "monotone-in-friction",
        why: "plans are made with less friction than the object has",
        check: symmetry::monotone_in_friction,
    },
    Law {
        name: "monotone-in-contacts",
        why: "the planner takes a grasp for stable as soon as a part of it is",
        check: symmetry::monotone_in_contacts,
    },
    Law {
        name: "hint-never-decides",
        why: "a verdict that depends on what was asked before is different on another number of threads",
        check: call::hint_never_decides,
    },
    Law {
        name: "test-equals-assess",
        why: "the report must speak of the grasps that the search accepted",
        check: call::test_equals_assess,
    },
    Law {
        name: "certificate",
        why: "a proof that does not prove its verdict is worse than none",
        check: proof::certificate,
    },
    Law { name: "margins", why: "plans are compared by their margins", check: proof::margins },
    Law {
        name: "liftable",
        why: "lifting a finger that is needed drops the object; the fast way must not differ from the plain \
            one",
        check: call::liftable,
    },
    Law {
        name: "unsupported-cones",
        why: "a combination that cannot work is refused with a sentence, not a crash in mid-search",
        check: call::unsupported_cones,
    },
    Law {
        name: "stability-counted",
        why: "every call is counted once, by the plugin itself, or the statistics of a run are wrong",
        check: call::counted,
    },
    Law {
        name: "stability-pure",
        why: "threads share the test, and the same plan must come out on any number of them",
        check: call::stability_pure,
    },
];
