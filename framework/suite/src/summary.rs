//! Results beside the published ones: rows for a terminal, Markdown, JSON.

use crate::outcome::Spread;
use crate::{Outcome, Problem, Protocol, Published, Trial, problems};
use regrasp_study::compare::statistics::Estimate;
use serde::Serialize;

/// The heads of [`rows`].
const HEADS: [&str; 6] =
    ["series", "published", "of", "theirs works in", "ours in the model", "ours in simulation (rapier)"];

/// A row for each published figure: what was published and where it holds, and ours beside it, planned and
/// verified in the model, and replayed in simulation.
pub fn rows(protocol: &Protocol, outcomes: &[Outcome]) -> Vec<[String; 6]> {
    let mut rows = Vec::new();
    for (series, outcome) in protocol.series.iter().zip(outcomes) {
        for published in &series.published {
            rows.push(row(published, outcome));
        }
    }
    rows.insert(0, HEADS.map(str::to_owned));
    rows
}

fn row(published: &Published, outcome: &Outcome) -> [String; 6] {
    [
        outcome.series.clone(),
        format!("{}: {}", published.what, published.figure),
        published.method.clone(),
        published.world.words().to_owned(),
        in_model(outcome),
        in_simulation(outcome),
    ]
}

/// What was planned and verified.
fn in_model(outcome: &Outcome) -> String {
    let mut parts = Vec::new();
    if let Some(turns) = outcome.revolutions {
        parts.push(format!("{} revolutions", spread(turns)));
    }
    if let Some(chain) = outcome.chain {
        parts.push(format!("{} goals in turn of {} trials", spread(chain), outcome.trials));
    }
    if let (None, Some(share)) = (outcome.chain, outcome.share) {
        parts.push(format!("{} solved, {} of {}", percent(share), outcome.solved, outcome.plans));
    }
    if let Some([median, most, slowest]) = outcome.planning_s {
        let ms = |s: f64| format!("{:.1}", 1e3 * s);
        parts.push(format!("{} ms median, {} 90 %, {} slowest", ms(median), ms(most), ms(slowest)));
    }
    if let Some(regrasps) = outcome.regrasps {
        parts.push(format!("{regrasps} regrasp{}", if regrasps == 1.0 { "" } else { "s" }));
    }
    parts.join("; ")
}

/// What arrived in the replays.
fn in_simulation(outcome: &Outcome) -> String {
    let why = outcome.unreplayable.as_ref().map(|why| why.0.as_str());
    let Some(arrived) = outcome.arrived else {
        return why.map_or("not replayed".into(), |why| format!("cannot be replayed: {why}"));
    };
    let mut parts = Vec::new();
    match (outcome.arrived_chain, outcome.arrived_share) {
        (Some(chain), _) => {
            parts.push(format!("{} goals in turn arrive, each replayed by itself", spread(chain)))
        }
        (None, Some(share)) => {
            parts.push(format!("{} arrive, {arrived} of {}", percent(share), outcome.plans))
        }
        (None, None) => {}
    }
    if let (Some([distance, far]), Some([angle, most])) = (outcome.distance, outcome.angle) {
        parts.push(format!(
            "end off by {:.1} mm and {:.1}° median, {:.1} mm and {:.1}° at most",
            1e3 * distance,
            angle.to_degrees(),
            1e3 * far,
            most.to_degrees()
        ));
    }
    parts.extend(why.map(|why| format!("some cannot be replayed: {why}")));
    parts.join("; ")
}

fn spread(spread: Spread) -> String {
    format!("{:.1} ± {:.1}", spread.mean, spread.deviation)
}

fn percent(share: Estimate) -> String {
    let percent = |x: f64| format!("{:.0}", 100.0 * x);
    format!("{} % ({}-{} %)", percent(share.value), percent(share.low), percent(share.high))
}

/// The results as a page of Markdown.
pub fn markdown(name: &str, protocol: &Protocol, outcomes: &[Outcome]) -> String {
    let mut text = format!("# {name}: {}\n\n{}\n\n", protocol.title, protocol.paper);
    for (number, row) in rows(protocol, outcomes).iter().enumerate() {
        text += &format!("| {} |\n", row.each_ref().map(|cell| cell.replace('|', "\\|")).join(" | "));
        if number == 0 {
            text += "|---|---|---|---|---|---|\n";
        }
    }
    text += "\nShares with 95 % intervals (Wilson). Ours is a plan in a model that an independent verifier \
             accepts; it is carried out in a simulation at most, never by a real hand.\n";
    text + &format!("\n## Like for like\n\n{}\n\n## Chosen here\n\n{}\n", protocol.like, protocol.chosen)
}

/// The file of results; its format comes first, so that it is known by its beginning.
#[derive(Serialize)]
struct Document<'a> {
    format: &'static str,
    version: u32,
    regrasp: &'static str,
    protocol: &'a Protocol,
    outcomes: &'a [Outcome],
    problems: Vec<Vec<Problem>>,
    trials: &'a [Trial],
}

/// Protocol, outcomes, problems and trials as JSON text; SI units.
pub fn json(protocol: &Protocol, outcomes: &[Outcome], trials: &[Trial]) -> String {
    let document = Document {
        format: "regrasp-suite",
        version: 1,
        regrasp: env!("CARGO_PKG_VERSION"),
        protocol,
        outcomes,
        problems: protocol.series.iter().map(problems).collect(),
        trials,
    };
    serde_json::to_string_pretty(&document).expect("plain data is written without fault") + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Trial;
    use crate::outcome::tests::{attempt, series};
    use crate::protocol::consecutive;

    #[test]
    fn each_row_says_where_either_method_works() {
        let series = series(consecutive(1, 2));
        let trial = Trial { attempts: vec![attempt(true, Some(true)); 2], ..Trial::default() };
        let outcomes = [Outcome::of(&series, &[&trial])];
        let protocol = Protocol {
            title: "t".into(),
            paper: "p".into(),
            like: "l".into(),
            chosen: "c".into(),
            series: vec![series],
        };
        let rows = rows(&protocol, &outcomes);
        assert_eq!(rows.len(), 2);
        assert!(rows[1][3] == "real hand" && rows[1][4].starts_with("2.0 ± 0.0 goals in turn"), "{rows:?}");
        assert!(rows[1][5].contains("arrive"), "{rows:?}");
        let text = markdown("x", &protocol, &outcomes);
        assert!(text.contains("sampling-based control \\| real LEAP hand"), "cells keep their columns");
        assert!(json(&protocol, &outcomes, &[trial]).starts_with("{\n  \"format\": \"regrasp-suite\""));
    }
}
