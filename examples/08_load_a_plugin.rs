//! Loads plugins from a library at run time, and plans with one of them.
//!
//! `cargo run --example 08_load_a_plugin [LIBRARY]`
//!
//! Without a library it builds one: the plugins that `regrasp new-plugin` starts from. A library is read
//! before it is loaded: what was built by another compiler or from other sources of the framework is refused
//! before any of its code runs.

use regrasp::Stopwatch;
use regrasp::api::Slot;
use regrasp::host::{Registry, Source};
use regrasp::run::{Setup, scenario};
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() -> Result<(), Box<dyn Error>> {
    let given = std::env::args().nth(1).map(PathBuf::from);
    let library = given.map_or_else(build, Ok)?;

    // All plugins of the program, and those of the library. Only explicit paths are loaded.
    let registry = Registry::linked()?.with_libraries(&[&library])?;
    let loaded = |entry: &&_| registry.source(entry) != Source::BuiltIn;
    let plugins: Vec<_> = registry.entries().filter(loaded).collect();
    println!("{} has {} plugins:", library.file_name().unwrap_or_default().display(), plugins.len());
    for entry in &plugins {
        println!("  {:<24} {}", entry.id, entry.summary);
    }
    assert!(!plugins.is_empty());

    // From here on a loaded plugin is like any other. A panic in it ends the run with an error that names it,
    // not the program.
    let mut scenario = scenario::load("sphere", &registry)?;
    if let Some(sampler) = plugins.iter().find(|entry| entry.slots.contains(&Slot::Sampler)) {
        scenario.choices.use_plugin(Slot::Sampler, sampler.id);
    }
    let setup = Setup::new(&scenario, &scenario.choices, &registry)?;
    let run = setup.run(&Stopwatch::start().options(0))?;
    println!("sphere with `{}`: verified {}", setup.choices().choice(Slot::Sampler).id, run.is_verified());
    assert!(run.is_verified());

    // What is no plugin library is refused, with the reason; nothing is used in its place.
    let this_program = std::env::current_exe()?;
    let refused = Registry::linked()?.with_libraries(&[this_program]).err().ok_or("it is no library")?;
    println!("refused: {refused}");
    Ok(())
}

/// Builds the template's library beside this program, with cargo, and says where it is.
fn build() -> Result<PathBuf, Box<dyn Error>> {
    let program = std::env::current_exe()?; // TARGET/PROFILE/examples/this
    let profile = program.ancestors().nth(2).ok_or("examples lie in a folder of the profile")?;
    let target = profile.parent().ok_or("profiles lie in the target folder")?;
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--quiet", "--package", "regrasp-template-dynamic", "--target-dir"]).arg(target);
    if profile.ends_with("release") {
        cargo.arg("--release");
    }
    let built = cargo.current_dir(Path::new(env!("CARGO_MANIFEST_DIR"))).status()?;
    if !built.success() {
        return Err("cargo could not build the plugins".into());
    }
    Ok(profile.join(format!("{DLL_PREFIX}regrasp_template_dynamic{DLL_SUFFIX}")))
}
