//! The plugins that the book's tutorials build: each plans, and whoever follows a chapter gets what it
//! promises.

mod chapters;
mod follow;
mod plans;
#[path = "../dynamic/workshop.rs"]
#[allow(dead_code)]
mod workshop;

/// The tutorials: role, name of the plugin, slot.
const TUTORIALS: [(&str, &str, &str); 6] = [
    ("contact-model", "greasy", "contact-model"),
    ("stability-test", "concurrent", "stability-test"),
    ("surface", "taut", "surface"),
    ("sampler", "fingers-first", "sampler"),
    ("local-planner", "hop", "local-planner.regrasp"),
    ("graph-strategy", "mend", "graph-strategy"),
];
