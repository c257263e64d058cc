//! `regrasp scenarios`

use crate::args::ScenariosArgs;
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::api::{did_you_mean, near};
use regrasp::host::Registry;
use regrasp::run::scenario::{self, HANDS, SCENARIOS, Scenario};
use serde_json::{Value, json};

pub fn run(args: &ScenariosArgs) -> Result<(), Failure> {
    if let Some(name) = &args.name {
        return print_file(name);
    }
    let registry = Registry::linked().map_err(Failure::refused)?;
    let load = |name| scenario::load(name, &registry).map_err(Failure::refused);
    let scenarios = SCENARIOS.iter().map(|file| load(file.name)).collect::<Result<Vec<_>, _>>()?;
    if args.json {
        return say_json(&Value::Array(scenarios.iter().map(described).collect()));
    }
    let mut table = Table::new("<", &["scenario", "what it shows"]);
    scenarios.iter().for_each(|scenario| table.row([scenario.name.clone(), scenario.summary.clone()]));
    let hands: Vec<&str> = HANDS.iter().map(|hand| hand.name).collect();
    say(&format!("{}\n  hands: {}\n", table.text(), hands.join(", ")))
}

fn described(scenario: &Scenario) -> Value {
    json!({
        "name": scenario.name,
        "summary": scenario.summary,
        "source": scenario.source,
        "paper": scenario.paper,
        "goals": scenario.problem.goal.len(),
    })
}

fn print_file(name: &str) -> Result<(), Failure> {
    if let Some(file) = scenario::find(SCENARIOS, name).or_else(|| scenario::find(HANDS, name)) {
        return say(file.text);
    }
    let names = SCENARIOS.iter().chain(HANDS).map(|file| file.name);
    let hint = match did_you_mean(&near(name, names)) {
        none if none.is_empty() => "`regrasp scenarios` lists them".to_owned(),
        hint => hint,
    };
    Err(Failure::bad_input(format!("there is no built-in scenario or hand `{name}`; {hint}")))
}
