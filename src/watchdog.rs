//! Ends a process in which a plugin from a library does not come back.
//!
//! A call is stopped where it asks [`proceed`](regrasp::api::Context::proceed), and nothing makes a library's
//! code ask. A thread cannot be ended from outside either, so that the process has to end: with a sentence
//! that says why.

use crate::terminal::printable;
use regrasp::api::Slot;
use regrasp::host::{Registry, Source};
use regrasp::run::Setup;
use std::io::{self, Write};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;
use std::time::Duration;

/// How long a call may go on after the time limit before it counts as one that never ends.
const GRACE: Duration = Duration::from_secs(2);

/// Whether somebody has asked for the time since the limit, and been told that it is up.
pub type Heard = Arc<AtomicBool>;

/// Watches over a run with a time limit; without plugins from libraries, whose authors we are not, there is
/// nothing to watch.
pub fn watch(limit_s: Option<f64>, heard: &Heard, setup: &Setup<'_>, registry: &Registry) {
    let loaded = loaded(setup, registry);
    let Some(limit) = limit_s.filter(|_| !loaded.is_empty()) else { return };
    let heard = Arc::clone(heard);
    thread::spawn(move || {
        thread::sleep(Duration::from_secs_f64(limit) + GRACE);
        if !heard.load(Ordering::Relaxed) {
            let _ = writeln!(io::stderr(), "{}", printable(&sentence(limit, &loaded)));
            std::process::exit(3);
        }
    });
}

/// The plugins in use that are from libraries.
fn loaded(setup: &Setup<'_>, registry: &Registry) -> Vec<String> {
    let chosen = |slot: Slot| registry.lookup(slot, setup.choices().choice(slot).id.as_str()).ok();
    let mut ids: Vec<String> = Slot::ALL
        .into_iter()
        .filter_map(chosen)
        .filter(|entry| !matches!(registry.source(entry), Source::BuiltIn))
        .map(|entry| format!("`{}`", entry.id))
        .collect();
    ids.dedup();
    ids
}

fn sentence(limit_s: f64, loaded: &[String]) -> String {
    let names = loaded.join(", ");
    format!(
        "no plan: the time limit of {limit_s} s has passed, and for {} s a call of a plugin has not come \
         back; \
            from libraries are {names}. A plugin whose calls may be long asks `context.proceed()` in its \
            loops",
        GRACE.as_secs()
    )
}
