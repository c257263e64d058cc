//! Plugins that panic, for tests; and an initialiser that leaves a mark where the library was loaded.

use regrasp_api::*;
use std::sync::atomic::{AtomicUsize, Ordering};

regrasp_abi::export_plugins!(
    CONE,
    STABILITY,
    SURFACE,
    SAMPLER,
    PLANNER,
    STRATEGY,
    ASKS_FOR_NO_NODE,
    NAMES_NO_NODE,
    ASKS_FOR_NO_FINGER,
    NOT_BUILT,
    NOT_CHECKED,
    LOOPS,
    NO_SCHEMA,
    NOT_DROPPED,
    ABORTS,
    CHATTERS,
);

/// Runs while the library is loaded, before anything of it is called.
#[cfg(target_os = "linux")]
#[used]
#[unsafe(link_section = ".init_array")]
static MARK: extern "C" fn() = {
    extern "C" fn mark() {
        if let Some(file) = std::env::var_os("REGRASP_TEST_MARK") {
            let _ = std::fs::write(file, "loaded");
        }
    }
    mark
};

const fn entry(id: &'static str, slots: &'static [Slot], build: Build) -> Entry {
    let (schema, check) = (NoSettings::schema as fn() -> String, check_settings::<NoSettings>);
    Entry { id, slots, summary: "panics, for tests", references: &["none"], schema, check, build }
}

/// Works for a while, so that the panic comes in the middle of a search.
#[derive(Default)]
struct LateCone(AtomicUsize);
impl ContactModel for LateCone {
    fn cone(&self, _: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
        assert!(self.0.fetch_add(1, Ordering::Relaxed) < 500, "the cone broke");
        Cone::Elliptic { mu, gamma: 0.0 }
    }
    fn fewest_contacts(&self) -> usize {
        3
    }
}
const CONE: Entry = entry(
    "contact-model/faulty",
    &[Slot::ContactModel],
    Build::ContactModel(|_, _| Ok(Box::<LateCone>::default())),
);

/// Prints, which no plugin should.
struct Chatters;
impl ContactModel for Chatters {
    fn cone(&self, _: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
        print!("chatter");
        Cone::Elliptic { mu, gamma: 0.0 }
    }
    fn fewest_contacts(&self) -> usize {
        println!("chatter");
        3
    }
}
const CHATTERS: Entry = entry(
    "contact-model/chatters",
    &[Slot::ContactModel],
    Build::ContactModel(|_, _| Ok(Box::new(Chatters))),
);

struct Panics;
impl StabilityTest for Panics {
    fn test(&self, _: &Grasp<'_>, _: &mut Hint, _: &mut Context<'_>) -> Result<Stability, CallError> {
        panic!("the test broke")
    }
    fn assess(
        &self,
        _: &Grasp<'_>,
        _: Option<f64>,
        _: Option<Vec3>,
        _: &mut Context<'_>,
    ) -> Result<Assessment, CallError> {
        panic!("the test broke")
    }
}
const STABILITY: Entry =
    entry("stability-test/faulty", &[Slot::StabilityTest], Build::StabilityTest(|_, _| Ok(Box::new(Panics))));

impl SurfaceParam for Panics {
    fn sample(&self, _: &mut Random) -> Contact {
        panic!("the surface broke")
    }
    fn geodesic(
        &self,
        _: &Contact,
        _: &Contact,
        _: &mut SurfacePath,
        _: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        panic!("the surface broke")
    }
    fn project(&self, _: &Vec3, _: Option<u32>) -> Projection {
        panic!("the surface broke")
    }
    fn walk(&self, _: &Contact, _: &Vec3, _: f64) -> Contact {
        panic!("the surface broke")
    }
    fn edge_distance(&self, _: &Contact) -> f64 {
        panic!("the surface broke")
    }
}
const SURFACE: Entry = entry("surface/faulty", &[Slot::Surface], Build::Surface(|_, _| Ok(Box::new(Panics))));

impl ClosedChainSampler for Panics {
    fn sample(
        &self,
        _: &Task<'_>,
        _: PoseRequest<'_>,
        _: FingerSet,
        _: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        // A number that is no text: the payload has no message.
        std::panic::panic_any(7_u32)
    }
    fn close(
        &self,
        _: &Task<'_>,
        _: &Pose,
        _: &PerFinger<Option<Contact>>,
        _: &Configuration,
        _: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        panic!("the sampler broke")
    }
}
const SAMPLER: Entry = entry("sampler/faulty", &[Slot::Sampler], Build::Sampler(|_, _| Ok(Box::new(Panics))));

impl LocalPlanner for Panics {
    fn connect(
        &self,
        _: &Task<'_>,
        from: &Configuration,
        _: &Target<'_>,
        _: Option<&mut Path>,
        _: &mut Context<'_>,
    ) -> Result<Reached, CallError> {
        // An index out of range, as a plugin's own mistakes are.
        let finger = FingerIndex(from.joints.len() as u8);
        unreachable!("{:?}", from.joints[finger])
    }
}
const PLANNER: Entry = entry(
    "local-planner/faulty",
    &[Slot::GraspPlanner, Slot::TransferPlanner, Slot::RegraspPlanner],
    Build::LocalPlanner(|_, _| Ok(Box::new(Panics))),
);

impl GraphStrategy for Panics {
    fn next(&self, _: &dyn GraphView, _: &mut Context<'_>) -> Result<Action, CallError> {
        panic!("the strategy broke")
    }
}
const STRATEGY: Entry =
    entry("graph-strategy/faulty", &[Slot::GraphStrategy], Build::GraphStrategy(|_, _| Ok(Box::new(Panics))));

/// Makes the framework panic inside the plugin's call.
struct AsksForNoNode;
impl GraphStrategy for AsksForNoNode {
    fn next(&self, graph: &dyn GraphView, _: &mut Context<'_>) -> Result<Action, CallError> {
        graph.component(NodeId(1_000_000));
        Ok(Action::Explore(Link::Components))
    }
}
const ASKS_FOR_NO_NODE: Entry = entry(
    "graph-strategy/asks-for-no-node",
    &[Slot::GraphStrategy],
    Build::GraphStrategy(|_, _| Ok(Box::new(AsksForNoNode))),
);

struct NamesNoNode;
impl GraphStrategy for NamesNoNode {
    fn next(&self, _: &dyn GraphView, _: &mut Context<'_>) -> Result<Action, CallError> {
        Ok(Action::Connect(NodeId(0), NodeId(1_000_000), EdgeKind::Grasp))
    }
}
const NAMES_NO_NODE: Entry = entry(
    "graph-strategy/names-no-node",
    &[Slot::GraphStrategy],
    Build::GraphStrategy(|_, _| Ok(Box::new(NamesNoNode))),
);

struct AsksForNoFinger;
impl ClosedChainSampler for AsksForNoFinger {
    fn sample(
        &self,
        task: &Task<'_>,
        _: PoseRequest<'_>,
        _: FingerSet,
        context: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        // Without an end but for `proceed`: the fault ends it.
        loop {
            task.hand.finger(FingerIndex(200));
            context.proceed()?;
        }
    }
    fn close(
        &self,
        _: &Task<'_>,
        _: &Pose,
        _: &PerFinger<Option<Contact>>,
        _: &Configuration,
        _: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        Ok(None)
    }
}
const ASKS_FOR_NO_FINGER: Entry = entry(
    "sampler/asks-for-no-finger",
    &[Slot::Sampler],
    Build::Sampler(|_, _| Ok(Box::new(AsksForNoFinger))),
);

const NOT_BUILT: Entry =
    entry("sampler/not-built", &[Slot::Sampler], Build::Sampler(|_, _| panic!("the building broke")));
const NOT_CHECKED: Entry =
    Entry { id: "sampler/not-checked", check: |_| panic!("the check broke"), ..SAMPLER };
const NO_SCHEMA: Entry = Entry { id: "sampler/no-schema", schema: || panic!("the schema broke"), ..SAMPLER };

/// Calls never come back.
struct Loops;
impl ClosedChainSampler for Loops {
    fn sample(
        &self,
        _: &Task<'_>,
        _: PoseRequest<'_>,
        _: FingerSet,
        _: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        loop {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
    }
    fn close(
        &self,
        _: &Task<'_>,
        _: &Pose,
        _: &PerFinger<Option<Contact>>,
        _: &Configuration,
        _: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        Ok(None)
    }
}
const LOOPS: Entry = entry("sampler/loops", &[Slot::Sampler], Build::Sampler(|_, _| Ok(Box::new(Loops))));

/// A working contact model that panics when it is dropped.
struct NotDropped;
impl ContactModel for NotDropped {
    fn cone(&self, _: FingerIndex, _: &Contact, mu: f64) -> Cone<'_> {
        Cone::Elliptic { mu, gamma: 0.0 }
    }
    fn fewest_contacts(&self) -> usize {
        3
    }
}
impl Drop for NotDropped {
    fn drop(&mut self) {
        panic!("the end broke")
    }
}
const NOT_DROPPED: Entry = entry(
    "contact-model/not-dropped",
    &[Slot::ContactModel],
    Build::ContactModel(|_, _| Ok(Box::new(NotDropped))),
);

/// Takes the whole process down with it.
struct Aborts;
impl ClosedChainSampler for Aborts {
    fn sample(
        &self,
        _: &Task<'_>,
        _: PoseRequest<'_>,
        _: FingerSet,
        _: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        std::process::abort()
    }
    fn close(
        &self,
        _: &Task<'_>,
        _: &Pose,
        _: &PerFinger<Option<Contact>>,
        _: &Configuration,
        _: &mut Context<'_>,
    ) -> Result<Option<Configuration>, CallError> {
        std::process::abort()
    }
}
const ABORTS: Entry =
    entry("sampler/aborts", &[Slot::Sampler], Build::Sampler(|_, _| Ok(Box::new(Aborts))));
