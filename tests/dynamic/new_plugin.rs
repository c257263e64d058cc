//! What `new-plugin` writes works as it is.

use crate::workshop::{ROLES, cargo, regrasp, written};
use serde_json::Value;

/// For one role: compiles against the workspace, passes the kit, is listed with its source, plans.
fn works(role: &str) {
    let library = written(role);
    let library = library.to_str().expect("the target folder is UTF-8");
    let kit = cargo(role, &["test", "--workspace"]);
    assert_eq!(kit.code, Some(0), "{role}: {}\n{}", kit.out, kit.err);

    let id = format!("{role}/mine");
    let listed = regrasp(&["plugins", &id, "--load", library, "--json"]);
    let listed: Value = serde_json::from_str(&listed.out).expect("JSON");
    assert_eq!(listed[0]["id"], id.as_str());
    assert!(
        listed[0]["source"]
            .as_str()
            .is_some_and(|source| source.ends_with("dynamic.so") || cfg!(not(target_os = "linux")))
    );
    let page = regrasp(&["plugins", &id, "--load", library]);
    assert!(page.out.contains("use = \"mine\"") && page.out.contains("default"), "{}", page.out);

    let slot = ROLES.iter().find(|(name, _)| *name == role).expect("a role").1;
    let choice = format!("{slot}=mine");
    let planned = regrasp(&["plan", "sphere", "--load", library, "--use", &choice, "--json"]);
    assert_eq!(planned.code, Some(0), "{role}: {}", planned.err);
    let planned: Value = serde_json::from_str(&planned.out).expect("JSON");
    assert_eq!((&planned["status"], &planned["verified"]), (&"solved".into(), &true.into()));
    assert!(planned["plugins"].to_string().contains(&id), "{}", planned["plugins"]);
}

#[test]
fn every_role_compiles_passes_the_kit_loads_and_plans() {
    ROLES.iter().for_each(|(role, _)| works(role));
}

/// A dependency is added as in any other crate: cargo need not be told to which package of the workspace.
#[test]
fn a_dependency_is_added_without_naming_the_package() {
    written("sampler");
    let here = concat!(env!("CARGO_MANIFEST_DIR"), "/framework/world");
    let said = cargo("sampler", &["add", "--dry-run", "--path", here]);
    assert!(said.code == Some(0) && said.err.contains("regrasp-world"), "{said:?}");
}

#[test]
fn what_the_verifier_takes_on_trust_is_said_with_the_plan() {
    let library = written("contact-model");
    let library = library.to_str().expect("the target folder is UTF-8");
    let said = regrasp(&["plan", "sphere", "--load", library, "--use", "contact-model=mine"]);
    assert!(said.out.contains("not independently checked: `contact-model/mine`"), "{said:?}");
    let said = regrasp(&["plan", "sphere"]);
    let words = ["claims", "stability", "start", "goals"];
    assert!(said.code == Some(0) && words.iter().all(|word| !said.out.contains(word)), "{said:?}");
}

#[test]
fn settings_of_a_loaded_plugin_are_checked_like_any_others() {
    let library = written("contact-model");
    let library = library.to_str().expect("the target folder is UTF-8");
    let plan = |set: &str| {
        regrasp(&["plan", "sphere", "--load", library, "--use", "contact-model=mine", "--set", set])
    };
    let said = plan("contact-model.factor=3");
    assert_eq!(said.code, Some(2), "{said:?}");
    assert!(said.err.contains("contact-model/mine") && said.err.contains("outside 0.1..=1"), "{said:?}");
    let said = plan("contact-model.factr=0.5");
    assert!(said.code == Some(2) && said.err.contains("did you mean `factor`?"), "{said:?}");
}

#[test]
fn a_plugin_is_written_only_where_nothing_is_lost() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let inside = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(inside("kept.txt"), "mine").expect("a temporary folder");
    let here = folder.path().display().to_string();
    let cases: [(&[&str], &str); 5] = [
        (&["new-plugin", "sampler", "own", "-o", &here], "exists"),
        (&["new-plugin", "samplr", "own", "-o", &inside("a")], "did you mean `sampler`?"),
        (&["new-plugin", "sampler", "rlg", "-o", &inside("b")], "built-in plugin `sampler/rlg`"),
        (&["new-plugin", "sampler", "My_Own", "-o", &inside("c")], "kebab case"),
        (
            &["new-plugin", "sampler", "own", "--framework", &here, "-o", &inside("d")],
            "no checkout of Regrasp",
        ),
    ];
    for (arguments, why) in cases {
        let said = regrasp(arguments);
        assert!(said.code == Some(2) && said.err.contains(why), "{arguments:?}: {said:?}");
    }
    assert_eq!(
        std::fs::read_dir(folder.path()).expect("a temporary folder").count(),
        1,
        "nothing was written"
    );
    assert_eq!(std::fs::read_to_string(inside("kept.txt")).expect("it was kept"), "mine");
}

#[test]
fn a_package_in_python_is_written_for_every_role_and_python_reads_it() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (role, slot) in ROLES {
        let place = folder.path().join(role);
        let said = regrasp(&["new-plugin", "--python", role, "my-own", "-o", &place.display().to_string()]);
        assert!(said.code == Some(0) && said.out.contains(&format!("--use {slot}=my-own")), "{said:?}");
        let module = format!("my_own_{}.py", role.replace('-', "_"));
        for name in [module.as_str(), "tests/test_conformance.py"] {
            let path = place.join(name);
            // Parsed alone: the package that it imports need not be there.
            let parse = "import ast, sys; ast.parse(open(sys.argv[1], encoding='utf-8').read())";
            let read = std::process::Command::new("python3").args(["-c", parse]).arg(&path).output();
            match read {
                Ok(read) => assert!(read.status.success(), "{}", String::from_utf8_lossy(&read.stderr)),
                Err(_) => assert!(path.is_file(), "without Python the file is all that can be looked for"),
            }
        }
        let manifest = std::fs::read_to_string(place.join("pyproject.toml")).expect("it is written");
        assert!(manifest.contains(&format!("name = \"my-own-{role}\"")), "{manifest}");
    }
    let said = regrasp(&["new-plugin", "--python", "sampler", "own", "--framework", "."]);
    assert_eq!(said.code, Some(2), "{said:?}");
}
