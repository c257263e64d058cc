//! The template as text: the module of each role, and the files of the crate round it, with `{{words}}` to be
//! filled in.

use regrasp_api::{Role, Slot};

/// The module of a role, and the slot that its plugin fills.
pub fn module(role: Role) -> (&'static str, Slot) {
    match role {
        Role::ContactModel => (include_str!("contact_model.rs"), Slot::ContactModel),
        Role::StabilityTest => (include_str!("stability_test.rs"), Slot::StabilityTest),
        Role::Surface => (include_str!("surface.rs"), Slot::Surface),
        Role::Sampler => (include_str!("sampler.rs"), Slot::Sampler),
        Role::LocalPlanner => (include_str!("local_planner.rs"), Slot::RegraspPlanner),
        Role::GraphStrategy => (include_str!("graph_strategy.rs"), Slot::GraphStrategy),
    }
}

/// The last line of a crate with one of these modules: it registers the plugin with whatever links the crate.
///
/// The template itself registers nothing: the program links it for its texts.
pub const REGISTRATION: &str = "regrasp_api::inventory::submit! { ENTRY }\n";

/// The first test of such a crate, beside its code.
pub const TESTS: &str = include_str!("../crate/tests.rs.in");

/// The crate's `Cargo.toml`.
pub const MANIFEST: &str = include_str!("../crate/Cargo.toml.in");
/// Its `.cargo/config.toml`.
pub const CONFIG: &str = include_str!("../crate/config.toml.in");
/// Its `README.md`.
pub const README: &str = include_str!("../crate/README.md.in");
/// Its `tests/conformance.rs`.
pub const CONFORMANCE: &str = include_str!("../crate/conformance.rs.in");
/// The same for a surface.
pub const CONFORMANCE_OF_SURFACE: &str = include_str!("../crate/conformance_surface.rs.in");
/// `Cargo.toml` of the library that is loaded at run time.
pub const DYNAMIC_MANIFEST: &str = include_str!("../crate/dynamic.toml.in");
/// Its `src/lib.rs`.
pub const DYNAMIC: &str = include_str!("../crate/dynamic.rs.in");
