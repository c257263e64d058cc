//! A plugin that panics ends the run with an error that names it; the process is not aborted.

use crate::workshop::{Said, faulty, regrasp};

fn plan(options: &[&str]) -> Said {
    let library = faulty();
    let library = library.to_str().expect("the target folder is UTF-8").to_owned();
    // A problem whose plan needs every role: on easy ones no path in GS_n is asked for.
    regrasp(&[&["plan", "ellip-obst", "--load", &library], options].concat())
}

#[test]
fn a_panic_in_any_role_ends_the_run_with_the_plugins_name() {
    let cases = [
        ("contact-model=faulty", "`contact-model/faulty` panicked: the cone broke"),
        ("stability-test=faulty", "`stability-test/faulty` panicked: the test broke"),
        ("surface=faulty", "`surface/faulty` panicked: the surface broke"),
        ("sampler=faulty", "`sampler/faulty` panicked: (no message)"),
        ("local-planner.grasp=faulty", "`local-planner/faulty` panicked: index out of bounds"),
        ("local-planner.transfer=faulty", "`local-planner/faulty` panicked: index out of bounds"),
        ("local-planner.regrasp=faulty", "`local-planner/faulty` panicked: index out of bounds"),
        ("graph-strategy=faulty", "`graph-strategy/faulty` panicked: the strategy broke"),
        ("sampler=not-built", "`sampler/not-built` panicked: the building broke"),
        ("sampler=not-checked", "`sampler/not-checked` panicked: the check broke"),
        ("sampler=no-schema", "`sampler/faulty` panicked: the schema broke"),
    ];
    for (choice, message) in cases {
        let said = plan(&["--use", choice]);
        let message = message
            .replace("`sampler/faulty` panicked: the schema", "`sampler/no-schema` panicked: the schema");
        assert!(said.code == Some(2) && said.err.contains(&message), "{choice}: {said:?}");
        assert!(said.out.is_empty(), "{choice}: {said:?}");
    }
}

#[test]
fn a_panic_in_the_middle_of_a_search_on_two_threads_ends_the_run() {
    let said = plan(&["--use", "contact-model=faulty", "--threads", "2", "--seed", "3"]);
    assert!(
        said.code == Some(2) && said.err.contains("`contact-model/faulty` panicked: the cone broke"),
        "{said:?}"
    );
}

#[test]
fn a_panic_that_a_plugin_provokes_in_the_framework_ends_the_run() {
    let cases = [
        ("graph-strategy=asks-for-no-node", "`service/graph` panicked: index out of bounds"),
        ("graph-strategy=names-no-node", "broke the contract of its role"),
        ("sampler=asks-for-no-finger", "`service/hand` panicked: index out of bounds"),
    ];
    for (choice, message) in cases {
        let said = plan(&["--use", choice]);
        assert!(said.code == Some(2) && said.err.contains(message), "{choice}: {said:?}");
    }
}

#[test]
fn a_call_that_never_ends_is_named_soon_after_the_time_limit() {
    let said = plan(&["--use", "sampler=loops", "--time-limit", "0.2"]);
    assert!(said.code == Some(3) && said.err.contains("`sampler/loops`"), "{said:?}");
}

#[test]
fn a_panic_at_the_end_of_a_plugins_life_spoils_no_result() {
    let said = plan(&["--use", "contact-model=not-dropped"]);
    assert_eq!(said.code, Some(0), "{said:?}");
    assert!(said.out.contains("solved, verified"), "{said:?}");
}

#[cfg(unix)]
#[test]
fn what_a_plugin_prints_spoils_no_json() {
    let library = faulty();
    let library = library.to_str().expect("the target folder is UTF-8");
    let said = regrasp(&["plan", "sphere", "--load", library, "--use", "contact-model=chatters", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&said.out).expect("one JSON object");
    assert_eq!((said.code, &json["status"]), (Some(0), &"solved".into()));
    assert!(said.err.contains("chatter"), "it is not lost: {said:?}");
}
