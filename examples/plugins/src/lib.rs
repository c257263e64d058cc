//! Seven plugins, each in one file of less than 150 lines, as somebody outside of the project would write
//! them.
//!
//! | plugin | shows |
//! |---|---|
//! | `contact-model/grained` | a cone that depends on the contact, made for each |
//! | `surface/remembering` | a plugin that wraps another, and remembers what it answered |
//! | `surface/superquadric` | a closed form that guides, where points and normals are the mesh's |
//! | `local-planner/guarded` | a planner that wraps the default, with a cause and a figure of its own |
//! | `local-planner/roadmap` | a planner of its own for regrasps, with a figure of its own |
//! | `graph-strategy/bandit` | a strategy that learns from what was done |
//! | `graph-strategy/best-first` | a strategy that looks at poses |

mod bandit;
mod best_first;
mod grained;
mod guarded;
mod remembering;
mod roadmap;
mod superquadric;

pub use bandit::ENTRY as BANDIT;
pub use best_first::ENTRY as BEST_FIRST;
pub use grained::ENTRY as GRAINED;
pub use guarded::ENTRY as GUARDED;
pub use remembering::ENTRY as REMEMBERING;
pub use roadmap::ENTRY as ROADMAP;
pub use superquadric::ENTRY as SUPERQUADRIC;
