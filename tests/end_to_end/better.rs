//! Better plans: relays, which need few regrasps, and `--improve`, by the real binary.

use crate::desk::Desk;
use serde_json::Value;

/// A plan file without the only thing in it that differs from run to run.
fn without_times(plan: &str) -> Value {
    let mut plan: Value = serde_json::from_str(plan).expect("a plan file is JSON");
    plan["statistics"].as_object_mut().expect("statistics").remove("time_s");
    plan
}

/// The costs of the curve, with the searches that found the plans.
fn curve(report: &Value) -> Vec<(u64, f64)> {
    let points = report["improve"]["curve"].as_array().expect("a curve");
    let number = |point: &Value, key: &str| point[key].as_f64().expect("a number");
    points.iter().map(|point| (number(point, "search") as u64, number(point, "cost"))).collect()
}

#[test]
fn relays_need_fewer_regrasps_than_the_graph() {
    let desk = Desk::new();
    let regrasps = |relays: usize| -> u64 {
        let of = |seed: u64| {
            let command = format!("plan cubic --seed {seed} --set graph-strategy.relays={relays} --json");
            let report = desk.run(&command).json();
            assert_eq!((&report["status"], &report["verified"]), (&"solved".into(), &true.into()));
            report["regrasps"].as_u64().expect("a count")
        };
        (0..5).map(of).sum()
    };
    let (with, without) = (regrasps(4), regrasps(0));
    assert!(4 * with < 3 * without, "{with} with relays, {without} without");
}

#[test]
fn relays_are_the_same_on_any_number_of_threads() {
    let desk = Desk::new();
    for seed in 0..3 {
        for threads in [1, 2, 3] {
            let said =
                desk.run(&format!("plan ellip-obst --seed {seed} --threads {threads} -o {threads}.json"));
            assert_eq!(said.code, 0, "{}", said.err);
        }
        let [one, two, three] = ["1.json", "2.json", "3.json"].map(|file| without_times(&desk.read(file)));
        assert!(one == two && one == three, "seed {seed}");
    }
}

#[test]
fn a_number_of_searches_gives_the_same_plan_on_any_number_of_threads() {
    let desk = Desk::new();
    let reports = [1, 2].map(|threads| {
        let command =
            format!("plan ellip-obst --seed 4 --improve 5x --threads {threads} -o {threads}.json --json");
        let said = desk.run(&command);
        assert_eq!(said.code, 0, "{}", said.err);
        said.json()
    });
    assert_eq!(curve(&reports[0]), curve(&reports[1]));
    assert_eq!(reports[0]["improve"]["searches"], 5);
    let [one, two] = ["1.json", "2.json"].map(|file| without_times(&desk.read(file)));
    assert!(one == two);
    assert_eq!(desk.run("verify 1.json").code, 0);
    // The last point is the plan that is written, and its seed finds it again at once.
    let best = reports[0]["improve"]["curve"].as_array().and_then(|all| all.last()).expect("a plan");
    assert_eq!(best["cost"].as_f64(), reports[0]["regrasps"].as_f64());
    assert_eq!(desk.run(&format!("plan ellip-obst --seed {} -o again.json", best["seed"])).code, 0);
    assert!(without_times(&desk.read("again.json"))["segments"] == one["segments"]);
}

#[test]
fn what_is_made_less_becomes_less() {
    let desk = Desk::new();
    for what in ["regrasps", "duration", "travel", "holds"] {
        let said = desk.run(&format!("plan sphere --improve 4x --optimise {what} --json"));
        assert_eq!(said.code, 0, "{what}: {}", said.err);
        let report = said.json();
        assert_eq!(report["improve"]["objective"], what);
        let points = curve(&report);
        assert_eq!(points[0].0, 0, "the first plan begins the curve");
        // Of plans alike in what is made less the shorter one is better.
        assert!(points.windows(2).all(|pair| pair[1].1 <= pair[0].1), "{what}: {points:?}");
    }
    let said = desk.run("plan sphere --improve 6x --optimise duration --json").json();
    let (first, last) = (curve(&said)[0].1, curve(&said)[curve(&said).len() - 1].1);
    assert!(last < first, "six searches and none of a shorter motion: {said}");
    assert_eq!(Some(last), said["duration_s"].as_f64());
}

#[test]
fn seconds_end_and_nonsense_is_refused() {
    let desk = Desk::new();
    let said = desk.run("plan sphere --improve 0.3 -o plan.json");
    assert_eq!(said.code, 0, "{}", said.err);
    assert!(said.out.contains("  improved      "), "{}", said.out);
    assert_eq!(desk.run("verify plan.json").code, 0);
    desk.run("plan sphere --improve soon").assert_fails(2, &["--improve", "`20x`"]);
    desk.run("plan sphere --improve 0x").assert_fails(2, &["--improve", "1..=1000000"]);
    desk.run("plan sphere --improve 2x --optimise speed").assert_fails(2, &["--optimise", "`duration`"]);
    desk.run("plan sphere --optimise duration").assert_fails(2, &["--improve"]);
    desk.run("plan sphere --improve 2x --audit").assert_fails(2, &["--audit"]);
}
