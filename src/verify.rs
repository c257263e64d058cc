//! `regrasp verify`

use crate::args::VerifyArgs;
use crate::holds::holds_lines;
use crate::quantity::quantity;
use crate::table::Table;
use crate::terminal::{Paint, paint};
use crate::{Failure, say, say_json};
use regrasp::api::Problem;
use regrasp::page::place_text;
use regrasp::plan::Extreme;
use regrasp::verify::Check;
use serde_json::json;
use std::thread;

pub fn run(args: &VerifyArgs) -> Result<(), Failure> {
    let plan = regrasp::plan::read(&args.plan).map_err(Failure::refused)?;
    let cores = || thread::available_parallelism().map_or(1, usize::from);
    let verdict = regrasp::verify::verify_on(&plan, args.threads.map_or_else(cores, usize::from));
    if args.json {
        say_json(&json!(verdict))?;
    } else {
        let word = match verdict.valid {
            true => paint(Paint::Good, "valid"),
            false => paint(Paint::Bad, "not valid"),
        };
        let (certificate, problem) = (verdict.certificate.as_ref(), &plan.scenario.problem);
        let margin = certificate.and_then(|certificate| certificate.closure_margin.as_ref());
        say(&format!(
            "{}: {word}\n{}{}",
            args.plan.display(),
            check_table(verdict.checks.iter(), margin, problem),
            holds_lines(certificate.and_then(|certificate| certificate.holds.as_ref()), problem)
        ))?;
    }
    if verdict.valid {
        return Ok(());
    }
    let failed: Vec<&str> = verdict.failures().map(|check| check.name).collect();
    Err(Failure::not_verified(format!("the plan does not verify: {}", failed.join(", "))))
}

/// Checks as a table, one a line; `margin` is the certificate's, where the grasps are stable.
pub fn check_table<'a>(
    checks: impl Iterator<Item = &'a Check>,
    margin: Option<&Extreme>,
    problem: &Problem,
) -> String {
    let mut table = Table::new("<<>><<", &["check", "", "worst", "", "limit", "where"]);
    for check in checks {
        let verdict = match check.ok {
            true => paint(Paint::Good, "ok"),
            false => paint(Paint::Bad, "FAILED"),
        };
        // One figure for one thing: a stable grasp's margin, as `plan` tells it, not the slack of its proof.
        if let Some(margin) = margin.filter(|_| check.ok && check.name == "stability") {
            let place = place_text(&margin.place, problem);
            let text = format!("margin {:.3}", margin.value);
            table.row([check.name.to_owned(), verdict, text, ">".to_owned(), "0".to_owned(), place]);
            continue;
        }
        let worst = check.worst.map_or("-".to_owned(), |worst| quantity(worst, check.unit));
        let limit = quantity(check.limit, check.unit);
        let place = place_text(&check.place, problem);
        table.row([check.name, &verdict, &worst, check.side.sign(), &limit, &place].map(str::to_owned));
    }
    table.text()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp::plan::Place;

    #[test]
    fn places_name_only_what_applies() {
        let registry = regrasp::host::Registry::linked().expect("the built-in plugins differ");
        let scenario = regrasp::run::scenario::load("sphere", &registry).expect("it is built in");
        let place = Place { segment: Some(2), finger: Some(1), ..Place::default() };
        assert_eq!(place_text(&place, &scenario.problem), "segment 3, finger `north`");
        assert_eq!(place_text(&Place::default(), &scenario.problem), "");
    }
}
