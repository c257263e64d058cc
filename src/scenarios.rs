//! `regrasp scenarios`: what is built in, read but not built.

use crate::args::ScenariosArgs;
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::api::{did_you_mean, near};
use regrasp::run::scenario::{self, BuiltIn, HANDS, SCENARIOS, ScenarioFile};
use serde_json::{Value, json};

pub fn run(args: &ScenariosArgs) -> Result<(), Failure> {
    if let Some(name) = &args.name {
        return print_file(name);
    }
    let read = |file: &BuiltIn| file.read().map(|scenario| (file.name, scenario)).map_err(Failure::refused);
    let scenarios = SCENARIOS.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    if args.json {
        return say_json(&Value::Array(scenarios.iter().map(described).collect()));
    }
    let mut table = Table::new("<", &["scenario", "what it shows"]);
    scenarios.iter().for_each(|(name, scenario)| table.row([(*name).to_owned(), scenario.summary.clone()]));
    let hands: Vec<&str> = HANDS.iter().map(|hand| hand.name).collect();
    say(&format!("{}\n  hands: {}\n", table.text(), hands.join(", ")))
}

fn described((name, scenario): &(&str, ScenarioFile)) -> Value {
    json!({
        "name": name,
        "summary": scenario.summary,
        "source": scenario.source,
        "paper": scenario.paper,
        "goals": scenario.goal.len(),
    })
}

fn print_file(name: &str) -> Result<(), Failure> {
    if let Some(file) = scenario::find_scenario(name).or_else(|| scenario::find(HANDS, name)) {
        return say(file.text);
    }
    let names = SCENARIOS.iter().chain(HANDS).map(|file| file.name);
    let hint = match did_you_mean(&near(name, names)) {
        none if none.is_empty() => "`regrasp scenarios` lists them".to_owned(),
        hint => hint,
    };
    Err(Failure::bad_input(format!("there is no built-in scenario or hand `{name}`; {hint}")))
}
