//! `regrasp doctor`: what this program is, and what it finds on this machine.

use crate::args::LibraryArgs;
use crate::plugins::registry;
use crate::table::Table;
use crate::view::open;
use crate::{Failure, say, say_json};
use clap::Args;
use regrasp::api::Role;
use regrasp::run::scenario::{HANDS, SCENARIOS};
use serde_json::{Value, json};
use std::env;
use std::path::Path;
use std::thread;

/// Say version, plugins, folders, browser, cores: what a report of a problem should hold.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  regrasp doctor\n  regrasp doctor --load my-plugin.so")]
pub struct DoctorArgs {
    #[command(flatten)]
    pub libraries: LibraryArgs,
    /// Print one JSON object instead of text.
    #[arg(long)]
    pub json: bool,
}

/// One line: what it is about, a remark, and whether something is missing.
struct Finding {
    about: &'static str,
    what: String,
    fine: bool,
}

pub fn run(args: &DoctorArgs) -> Result<(), Failure> {
    let findings = findings(args)?;
    if args.json {
        let row = |f: &Finding| json!({ "about": f.about, "what": f.what, "ok": f.fine });
        return say_json(&Value::Array(findings.iter().map(row).collect()));
    }
    let mut table = Table::new("<", &["", "", ""]);
    for finding in findings {
        let mark = if finding.fine { "ok" } else { "missing" };
        table.row([finding.about.to_owned(), mark.to_owned(), finding.what]);
    }
    say(table.text().trim_start_matches('\n'))
}

fn findings(args: &DoctorArgs) -> Result<Vec<Finding>, Failure> {
    let registry = registry(&args.libraries)?;
    let by_role = |role: Role| format!("{} {}", registry.of_role(role).count(), role.name());
    let roles: Vec<String> = Role::ALL.into_iter().map(by_role).collect();
    let profile = if cfg!(debug_assertions) { "with checks for development" } else { "for use" };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let ok = |about, what: String| Finding { about, what, fine: true };
    Ok(vec![
        ok("version", format!("regrasp {}, built {profile}", env!("CARGO_PKG_VERSION"))),
        ok("system", format!("{} on {}", env::consts::OS, env::consts::ARCH)),
        ok("cores", cores.to_string()),
        ok("plugins", format!("{} ({})", registry.entries().count(), roles.join(", "))),
        ok("built in", format!("{} scenarios, {} hands", SCENARIOS.len(), HANDS.len())),
        temporary(),
        sources(),
        browser(),
        xacro(),
    ])
}

/// Pages of `view` without `-o` go there.
fn temporary() -> Finding {
    let place = env::temp_dir();
    let tried = open::temporary_folder().and_then(|folder| {
        std::fs::remove_dir(&folder).map_err(|error| format!("`{}`: {error}", folder.display()))
    });
    let what = match &tried {
        Ok(()) => format!("`{}`, writable", place.display()),
        Err(why) => why.clone(),
    };
    Finding { about: "temporary files", what, fine: tried.is_ok() }
}

/// `new-plugin` builds against them.
fn sources() -> Finding {
    let tree = Path::new(env!("CARGO_MANIFEST_DIR"));
    let fine = tree.join("framework/api/Cargo.toml").is_file();
    let what = match fine {
        true => format!("`{}`", tree.display()),
        false => "gone; `new-plugin` needs a checkout (`--framework PATH`)".into(),
    };
    Finding { about: "sources", what, fine }
}

fn browser() -> Finding {
    let opener = open::opener().map(|command| command.get_program().to_string_lossy().into_owned());
    let found = opener.filter(|name| on_path(name));
    let what = match &found {
        Some(name) => format!("`{name}` opens pages"),
        None => "no window to open pages in; `view -o page.html` writes them".into(),
    };
    Finding { about: "browser", what, fine: found.is_some() }
}

fn xacro() -> Finding {
    let fine = on_path("xacro");
    let what =
        if fine { "expands macros of hands" } else { "only for hands in .xacro files: `pip install xacro`" };
    Finding { about: "xacro", what: what.into(), fine }
}

/// Whether a program of this name is in a folder of `PATH`.
fn on_path(name: &str) -> bool {
    let names = [name.to_owned(), format!("{name}{}", env::consts::EXE_SUFFIX)];
    let is_there = |folder: std::path::PathBuf| names.iter().any(|name| folder.join(name).is_file());
    env::var_os("PATH").is_some_and(|path| env::split_paths(&path).any(is_there))
}
