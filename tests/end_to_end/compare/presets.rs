//! The paper as a whole and part by part: presets and settings that are varied, and the strict suite.

use super::rows::rows;
use crate::desk::Desk;

#[test]
fn presets_are_varied_and_the_papers_row_stands_beside_ours() {
    let desk = Desk::new();
    let pairs = "sphere-given-1 sphere-given-2";
    let vary = "--vary preset=paper,default --vary sampler=rlg,projection";
    let said = desk.run(&format!("compare {pairs} {vary} --seeds 1 -o pairs"));
    assert_eq!(said.code, 0, "{}", said.err);
    let found = rows(&desk, "pairs");
    let variants: Vec<&str> = found[..4].iter().map(|row| row["variant"].as_str()).collect();
    let names = ["paper + rlg", "paper + projection", "default + rlg", "default + projection"];
    assert_eq!((found.len(), variants), (8, names.to_vec()));
    let chosen = |k: usize| (found[k]["surface"].as_str(), found[k]["sampler"].as_str());
    assert_eq!(chosen(1), ("surface/steiner", "sampler/projection"), "what is varied besides wins");
    assert_eq!(chosen(2), ("surface/geodesic", "sampler/rlg"));
    // Both pairs are one problem; the paper's figures come first.
    for text in [said.out, desk.read("pairs/search.md")] {
        for part in ["the paper, means", "17.5 (mean)", "196", "2 of 2", "paths in GS"] {
            assert!(text.contains(part), "`{part}` is not in:\n{text}");
        }
    }
    let head = "scenarios = [\"sphere-given-1\"]\nseeds = 1\n";
    let levels = "[[vary]]\nslot = \"preset\"\nlevels = [{ use = \"default\" }, { use = \"paper\" }]\n";
    desk.write("presets.toml", format!("{head}{levels}"));
    assert_eq!(desk.run("compare --study presets.toml -o file").code, 0);
    let found = rows(&desk, "file");
    let told: Vec<_> = found.iter().map(|row| (row["variant"].as_str(), row["surface"].as_str())).collect();
    assert_eq!(told, [("default", "surface/geodesic"), ("paper", "surface/steiner")]);
}

#[test]
fn presets_that_do_not_exist_or_come_twice_are_refused() {
    let desk = Desk::new();
    let refused =
        |words: &str, parts: &[&str]| desk.run(&format!("compare {words} -o bad")).assert_fails(2, parts);
    refused("sphere --vary preset=papre", &["no preset `papre`", "did you mean `paper`"]);
    refused("sphere --vary preset=paper --vary preset=default", &["`preset` twice"]);
    let head = "scenarios = [\"sphere\"]\n[[vary]]\nslot = \"preset\"\n";
    desk.write("bad.toml", format!("{head}levels = [{{ use = \"papre\" }}]\n"));
    refused("--study bad.toml", &["vary[0].levels[0].use", "did you mean `paper`"]);
    desk.write("bad.toml", format!("{head}levels = [{{ poses = 3 }}]\n"));
    refused("--study bad.toml", &["`vary[0].levels[0]` names a preset by `use`"]);
}

/// Every departure from the paper is a setting or a plugin, so that one `--vary` makes its ablation.
#[test]
fn every_ablation_is_one_vary() {
    let desk = Desk::new();
    let strategy = [
        "first_try=false,true",
        "relays=0,4",
        "join_ends=false,true",
        "grasp_paths=true,false",
        "drop_unconnected=true,false",
        "all_components=true,false",
        "start=0.1,1.0",
        "policy.start_grasps=1,12",
        "policy.goal_grasps=1,6",
        "policy.samples_per_goal=0,10",
        "policy.restart_samples=0,60",
        "policy.spare_fingers=1,0",
        "policy.more_fingers=false,true",
        "policy.admission=leavable,stable",
        "policy.connection=one-end,both-ends",
        "policy.decomposition=halving,greedy",
    ];
    let others = [
        "preset=paper,default",
        "surface=steiner,geodesic",
        "sampler.anywhere=1.0,0.1",
        "local-planner.regrasp.direct=false,true",
    ];
    let all =
        strategy.map(|text| format!("graph-strategy.{text}")).into_iter().chain(others.map(str::to_owned));
    for (k, vary) in all.enumerate() {
        let said = desk.run(&format!("compare sphere-free --preset paper --vary {vary} --seeds 1 -o {k}"));
        assert_eq!(said.code, 0, "{vary}: {}", said.err);
        let found = rows(&desk, &k.to_string());
        let chosen = |k: usize| {
            let columns =
                ["surface", "sampler.settings", "graph-strategy.settings", "local-planner.regrasp.settings"];
            columns.map(|column| found[k][column].clone())
        };
        assert!(found.len() == 2 && chosen(0) != chosen(1), "{vary}");
        assert!(found.iter().all(|row| row["status"] == "solved"), "{vary}: {found:?}");
    }
}

#[test]
fn the_strict_suite_is_solved_as_the_paper_plans() {
    let desk = Desk::new();
    let said = desk.run("compare --suite strict --preset paper --seeds 1 --threads 2 -o strict");
    assert_eq!(said.code, 0, "{}", said.err);
    let found = rows(&desk, "strict");
    assert_eq!(found.len(), 15);
    for row in &found {
        assert!(row["status"] == "solved" && row["verified"] == "true", "{row:?}");
    }
    let through = found.iter().filter(|row| row["used_grasp_edges"] != "0").count();
    assert!(through >= 12, "{through} of 15 plans have a path in GS_n");
    assert_eq!(said.out.matches("the paper, means").count(), 3, "{}", said.out);
}

#[test]
fn the_ball_is_turned_through_paths_in_gs_n_as_the_paper_shows_it() {
    let desk = Desk::new();
    assert_eq!(desk.run("compare sphere --preset paper --seeds 20 -o sphere").code, 0);
    let through = rows(&desk, "sphere").iter().filter(|row| row["used_grasp_edges"] != "0").count();
    assert!(through >= 18, "{through} of 20");
}
