//! A small study with made-up runs, for tests.

use super::*;
use regrasp_api::{Reason, Slot};
use regrasp_host::Registry;
use regrasp_plan::{PluginChoice, PluginStatistics};
use std::collections::BTreeMap;
use std::path::Path;

const SCENARIO: &str = include_str!("../../../../scenarios/sphere.toml");

/// Two scenarios, the second with a hostile name, and these variants; 12 seeds.
pub fn study(variants: &[&str]) -> Study {
    let registry = Registry::linked().unwrap();
    let scenario = regrasp_run::scenario::from_text("sphere", SCENARIO, Path::new(""), &registry).unwrap();
    let choice = |name: &&str| {
        let settings = serde_json::json!({ "note": "a, \"b\" <i>" });
        BTreeMap::from([(Slot::Sampler, PluginChoice { id: format!("sampler/{name}"), settings })])
    };
    let one = |name: &str, paper| StudyScenario {
        name: name.into(),
        summary: "a ball | turned".into(),
        source: "made up".into(),
        paper,
        plugins: variants.iter().map(choice).collect(),
        problem: scenario.problem.clone(),
    };
    let variant = |name: &&str| Variant {
        name: (*name).into(),
        levels: BTreeMap::from([(Slot::Sampler, (*name).to_owned())]),
    };
    Study {
        format: StudyFormat::RegraspStudy,
        version: STUDY_VERSION,
        command: ["regrasp", "compare", "sphere"].map(str::to_owned).to_vec(),
        versions: BTreeMap::from([("regrasp".to_owned(), "0.1.0".to_owned())]),
        machines: vec![Machine { host: "a host".into(), cores: 2, threads: 2, ..Machine::default() }],
        started_s: 1_795_316_400,
        shard: None,
        scenarios: vec![one("sphere", scenario.paper.clone()), one("</script><b>&\"", None)],
        varied: vec![Slot::Sampler],
        variants: variants.iter().map(variant).collect(),
        left_out: Vec::new(),
        hypotheses: Hypotheses::default(),
        seeds: Seeds { first: 0, count: 12 },
        time_limit_s: None,
    }
}

/// The same scenarios with all combinations of two factors, samplers and strategies.
pub fn factorial(samplers: &[&str], strategies: &[&str]) -> Study {
    let names: Vec<String> =
        samplers.iter().flat_map(|a| strategies.iter().map(move |b| format!("{a} + {b}"))).collect();
    let mut study = study(&names.iter().map(String::as_str).collect::<Vec<_>>());
    study.varied = vec![Slot::Sampler, Slot::GraphStrategy];
    for variant in &mut study.variants {
        let (sampler, strategy) = variant.name.split_once(" + ").unwrap();
        let levels = [(Slot::Sampler, sampler.to_owned()), (Slot::GraphStrategy, strategy.to_owned())];
        variant.levels = levels.into();
    }
    study
}

/// The run of a key, solved and verified after this time.
pub fn solved(study: &Study, key: RunKey, planning_s: f64) -> RunRecord {
    let plugin = PluginStatistics { calls: 10, rejections: BTreeMap::from([(Reason::Reach, 4)]) };
    let share = |name: &str, share: f64| (name.to_owned(), share * planning_s);
    RunRecord {
        scenario: study.scenarios[key.scenario].name.clone(),
        variant: study.variants[key.variant].name.clone(),
        seed: key.seed,
        status: RunStatus::Solved,
        verified: true,
        message: None,
        times: Times {
            planning_s,
            verification_s: 0.01,
            phases_s: BTreeMap::from([share("search", 1.0)]),
            roles_s: BTreeMap::from([
                share("sampler", 0.25),
                share("clearance", 0.5),
                share("framework", 0.25),
            ]),
            memory_bytes: Some(2_500_000),
        },
        counts: Counts {
            generated_nodes: 40,
            graph_nodes: 9,
            components: 1,
            roadmap: Default::default(),
            collision_tests: 500,
            goals_reached: 1,
            notes: BTreeMap::new(),
            plugins: BTreeMap::from([(Slot::Sampler, plugin)]),
        },
        motion: Some(MotionFigures { transfers: 4, regrasps: 3, ..MotionFigures::default() }),
        certified: Some(Certified { margin: Some(0.1), ..Certified::default() }),
    }
}

/// The same run without a plan.
pub fn unsolved(mut run: RunRecord, status: RunStatus) -> RunRecord {
    run.status = status;
    run.verified = false;
    run.message = Some("it is <no> good".into());
    (run.motion, run.certified) = (None, None);
    run
}

/// Runs of every key of the study; `time` gives the time of each, or `None` where there is no plan.
pub fn runs(study: &Study, time: impl Fn(RunKey) -> Option<f64>) -> Vec<RunRecord> {
    let mut runs = Vec::new();
    for scenario in 0..study.scenarios.len() {
        for variant in 0..study.variants.len() {
            for seed in study.seeds.iter() {
                let key = RunKey { scenario, variant, seed };
                let run = solved(study, key, time(key).unwrap_or(0.5));
                runs.push(if time(key).is_some() { run } else { unsolved(run, RunStatus::NoPlan) });
            }
        }
    }
    runs
}
