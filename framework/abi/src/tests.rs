//! Guards round plugins that panic.

use crate::*;
use regrasp_api::*;

struct Panics;

impl ContactModel for Panics {
    fn cone(&self, _: FingerIndex, _: &Contact, _: f64) -> Cone<'_> {
        panic!("no cone")
    }

    fn fewest_contacts(&self) -> usize {
        3
    }
}

impl GraphStrategy for Panics {
    fn next(&self, _: &dyn GraphView, _: &mut Context<'_>) -> Result<Action, CallError> {
        panic!("no {}", "step")
    }
}

impl Drop for Panics {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            panic!("no end");
        }
    }
}

struct Broken;
impl Exported for Broken {
    const ENTRY: Entry = Entry {
        id: "contact-model/broken",
        slots: &[Slot::ContactModel],
        summary: "panics wherever it can",
        references: &["none"],
        schema: || panic!("no schema"),
        check: |_| panic!("no check"),
        build: Build::ContactModel(
            |json, _| if json.is_empty() { Ok(Box::new(Panics)) } else { panic!("no build") },
        ),
    };
}

const CONTACT: Contact = Contact { facet: 0, p_OC: Vec3::new(0.0, 0.0, 1.0), n_O: Vec3::new(0.0, 0.0, 1.0) };

fn panicked(message: &str) -> CallError {
    CallError::Panicked { plugin: "contact-model/broken".into(), message: message.into() }
}

#[test]
fn a_value_after_a_panic_is_harmless_and_the_fault_ends_the_call() {
    let model = guarded::<dyn ContactModel>("contact-model/broken", || Ok(Box::new(Panics))).unwrap();
    assert_eq!(model.fewest_contacts(), 3);
    assert_eq!(take_fault(), None);
    assert_eq!(model.cone(FingerIndex(0), &CONTACT, 0.5), Cone::Elliptic { mu: 0.0, gamma: 0.0 });
    let context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    assert_eq!(context.proceed(), Err(panicked("no cone")));
    assert_eq!(unless_fault(Ok(())), Err(panicked("no cone")));
    assert_eq!(context.proceed(), Ok(()));
    drop(model);
    assert_eq!(take_fault(), None, "the end of an object spoils no call");
}

#[test]
fn a_call_that_can_fail_fails_with_the_panics_message() {
    struct Nothing;
    impl GraphView for Nothing {
        fn node_count(&self) -> usize {
            0
        }
        fn samples(&self) -> (usize, usize) {
            (0, 0)
        }
        fn start(&self) -> NodeId {
            NodeId(0)
        }
        fn configuration(&self, _: NodeId) -> &Configuration {
            unreachable!("the strategy panics before it asks")
        }
        fn origin(&self, _: NodeId) -> Origin {
            Origin::Start
        }
        fn history(&self) -> &[PastAction] {
            &[]
        }
        fn goals(&self) -> &[NodeId] {
            &[]
        }
        fn component(&self, _: NodeId) -> ComponentId {
            ComponentId(0)
        }
        fn components(&self) -> &[ComponentId] {
            &[]
        }
        fn joined(&self) -> bool {
            false
        }
        fn distance(&self, _: NodeId, _: NodeId) -> f64 {
            0.0
        }
        fn attempted(&self, _: NodeId, _: NodeId, _: EdgeKind) -> bool {
            false
        }
        fn edges(&self) -> &[EdgeView] {
            &[]
        }
        fn shortest_path(&self) -> Vec<EdgeId> {
            Vec::new()
        }
    }
    let strategy = guarded::<dyn GraphStrategy>("contact-model/broken", || Ok(Box::new(Panics))).unwrap();
    let mut context = Context::new(Random::from_key(0, 0, 0, 0), &Uninterrupted);
    assert_eq!(strategy.next(&Nothing, &mut context), Err(panicked("no step")));
    assert_eq!(take_fault(), None, "the error was returned and needs no memory");
}

#[test]
fn every_function_of_an_entry_is_guarded() {
    const ENTRY: Entry = GuardedEntry::<Broken>::ENTRY;
    assert_eq!((ENTRY.id, ENTRY.slots), (Broken::ENTRY.id, Broken::ENTRY.slots));
    assert_eq!((ENTRY.schema)(), "{}");
    assert_eq!(take_fault(), Some(panicked("no schema")));
    assert!((ENTRY.check)("").unwrap_err().to_string().contains("panicked: no check"));
    let Build::ContactModel(build) = ENTRY.build else { panic!("another role") };
    let object = ObjectModel::new(
        Mesh::new(
            vec![Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z()],
            vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
        )
        .unwrap(),
        None,
        0.1,
        0.8,
    );
    let parts = Parts::new(&object, &NoHand);
    let error = build("{}", &parts).err().unwrap();
    assert!(error.to_string().contains("`contact-model/broken` panicked: no build"), "{error}");
    let model = build("", &parts).unwrap();
    model.cone(FingerIndex(0), &CONTACT, 0.5);
    assert_eq!(take_fault(), Some(panicked("no cone")));
}

/// A method that a trait provides and a guard does not pass on would run the provided code in place of the
/// plugin's own, silently.
#[test]
fn guards_pass_on_every_method_of_every_trait() {
    let methods = |text: &'static str, from: &str, end: &str| -> Vec<&'static str> {
        let body = text.split_once(from).unwrap_or_else(|| panic!("there is no `{from}`")).1;
        let body = body.split_once(end).expect("a block ends").0;
        let names =
            body.split("    fn ").skip(1).map(|rest| rest.split(['(', '<']).next().unwrap_or_default());
        let mut names: Vec<_> = names.collect();
        names.sort_unstable();
        names
    };
    let roles = include_str!("roles.rs");
    let services = include_str!("services.rs");
    let traits = [
        ("ContactModel", include_str!("../../api/src/roles/contact_model.rs"), roles),
        ("StabilityTest", include_str!("../../api/src/roles/stability_test.rs"), roles),
        ("SurfaceParam", include_str!("../../api/src/roles/surface_param.rs"), roles),
        ("ClosedChainSampler", include_str!("../../api/src/roles/closed_chain_sampler.rs"), roles),
        ("LocalPlanner", include_str!("../../api/src/roles/local_planner.rs"), roles),
        ("GraphStrategy", include_str!("../../api/src/roles/graph_strategy.rs"), roles),
        ("GraphView", include_str!("../../api/src/roles/graph_strategy.rs"), services),
        ("Hand", include_str!("../../api/src/services/hand.rs"), services),
        ("Clearance", include_str!("../../api/src/services/clearance.rs"), services),
        ("Admissible", include_str!("../../api/src/task.rs"), services),
    ];
    for (name, declared, guards) in traits {
        let wanted = methods(declared, &format!("pub trait {name}"), "\n}");
        let passed = methods(guards, &format!("passed_on!({name}: "), "\n});");
        assert_eq!(wanted, passed, "{name}");
    }
}

/// A clearance whose lone fingers panic, at the call and at their end.
struct Lonely;

impl Clearance for Lonely {
    fn object_free(&self, _: &Pose) -> Result<(), BodyPair> {
        Ok(())
    }
    fn finger_free(&self, _: FingerIndex, _: &FingerJoints, _: &Pose, _: TipRule) -> Result<(), BodyPair> {
        Ok(())
    }
    fn fingers_free(
        &self,
        _: (FingerIndex, &FingerJoints),
        _: (FingerIndex, &FingerJoints),
    ) -> Result<(), BodyPair> {
        Ok(())
    }
    fn configuration_free(&self, _: &Configuration, _: FingerSet, _: bool) -> Result<(), BodyPair> {
        Ok(())
    }
    fn lone_finger<'a>(
        &'a self,
        _: FingerIndex,
        _: &'a Configuration,
        _: FingerSet,
    ) -> Box<dyn LoneFinger + 'a> {
        Box::new(Panics)
    }
    fn distances(&self, _: &Configuration, _: f64) -> Vec<PairDistance> {
        Vec::new()
    }
}

impl LoneFinger for Panics {
    fn free(&self, _: &FingerJoints, _: TipRule) -> Result<(), BodyPair> {
        panic!("no finger")
    }
}

/// A plugin drops a lone finger inside its own library, which a panic of the framework must not enter.
#[test]
fn a_lone_finger_is_guarded_to_its_end() {
    let joints = FingerJoints::zeros(1);
    let resting = Configuration {
        X_HO: Pose::identity(),
        joints: PerFinger::filled(1, joints),
        contacts: PerFinger::filled(1, None),
    };
    let clearance = GuardedService::<dyn Clearance>::guarding("service/clearance", &Lonely);
    let finger = clearance.lone_finger(FingerIndex(0), &resting, FingerSet::EMPTY);
    assert!(finger.free(&joints, TipRule::Touches).is_err(), "not known to be free");
    let fault = CallError::Panicked { plugin: "service/clearance".into(), message: "no finger".into() };
    assert_eq!(take_fault(), Some(fault));
    drop(finger);
    assert_eq!(take_fault(), None, "the end of an object spoils no call");
}

/// A payload whose own end panics.
struct Trap;

impl Drop for Trap {
    fn drop(&mut self) {
        panic!("a payload's end");
    }
}

#[test]
fn a_panics_payload_may_panic_too() {
    let built = guarded::<dyn ContactModel>("contact-model/trap", || std::panic::panic_any(Trap));
    assert!(built.err().is_some_and(|error| error.to_string().contains("(no message)")));
}

struct NoHand;
impl Hand for NoHand {
    fn finger_count(&self) -> usize {
        0
    }
    fn finger(&self, _: FingerIndex) -> &FingerModel {
        unreachable!("the hand has no finger")
    }
    fn fingertip_radius(&self) -> f64 {
        0.01
    }
    fn tip_center(&self, _: FingerIndex, _: &FingerJoints) -> Vec3 {
        Vec3::zeros()
    }
    fn tip_kinematics(&self, _: FingerIndex, _: &FingerJoints) -> TipKinematics {
        unreachable!("the hand has no finger")
    }
    fn inverse(&self, _: FingerIndex, _: &Vec3, _: &FingerJoints) -> Option<FingerJoints> {
        None
    }
}
