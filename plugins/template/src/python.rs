//! The template in Python: a package with the plugin of one role, its test and its README.

use regrasp_api::{Role, Slot};

/// What the name of the template's plugins is replaced with.
const TEMPLATE_NAME: &str = "/template\"";

/// The module of a role, the class that it defines, and the slot that this fills.
pub fn module(role: Role) -> (&'static str, &'static str, Slot) {
    macro_rules! text {
        ($file:literal) => {
            include_str!(concat!("../python/", $file))
        };
    }
    match role {
        Role::ContactModel => (text!("contact_model.py"), "ScaledFriction", Slot::ContactModel),
        Role::StabilityTest => (text!("stability_test.py"), "PressedPair", Slot::StabilityTest),
        Role::Surface => (text!("surface.py"), "Facets", Slot::Surface),
        Role::Sampler => (text!("sampler.py"), "Rejection", Slot::Sampler),
        Role::LocalPlanner => (text!("local_planner.py"), "UpOverDown", Slot::RegraspPlanner),
        Role::GraphStrategy => (text!("graph_strategy.py"), "Alternate", Slot::GraphStrategy),
    }
}

/// The name of the module, as Python imports it.
pub fn module_name(role: Role, name: &str) -> String {
    package(role, name).replace('-', "_")
}

/// The files of a package with the plugin `ROLE/name`, by their paths in it.
///
/// `name` is in kebab case, `default` the name of the plugin that fills the slot by default.
pub fn files(role: Role, name: &str, default: &str) -> Vec<(String, String)> {
    let (source, class, slot) = module(role);
    let module = module_name(role, name);
    // Paths over points on the edges are some percent longer than the shortest.
    let allowance = if role == Role::Surface { ", geodesic_tolerance=0.05" } else { "" };
    let words = [
        ("id", format!("{}/{name}", role.name())),
        ("role", role.name().to_owned()),
        ("name", name.to_owned()),
        ("slot", slot.name().to_owned()),
        ("default", default.to_owned()),
        ("package", package(role, name)),
        ("module", module.clone()),
        ("class", class.to_owned()),
        ("allowance", allowance.to_owned()),
    ];
    let fill = |text: &str| {
        let fill = |text: String, (key, word): &(&str, String)| text.replace(&format!("{{{{{key}}}}}"), word);
        words.iter().fold(text.to_owned(), fill)
    };
    vec![
        ("pyproject.toml".into(), fill(include_str!("../python/pyproject.toml.in"))),
        ("README.md".into(), fill(include_str!("../python/README.md.in"))),
        (".gitignore".into(), "__pycache__/\n*.egg-info/\n/build/\n/dist/\n/study/\n".into()),
        (format!("{module}.py"), source.replace(TEMPLATE_NAME, &format!("/{name}\""))),
        ("tests/test_conformance.py".into(), fill(include_str!("../python/test_conformance.py.in"))),
    ]
}

/// The name of the package.
fn package(role: Role, name: &str) -> String {
    format!("{name}-{}", role.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_word_is_left_open_and_the_id_is_the_new_one() {
        for role in Role::ALL {
            let files = files(role, "my-own", "rlg");
            assert!(
                files.iter().all(|(_, text)| !text.contains("{{") && !text.contains("template")),
                "{role:?}"
            );
            let module = format!("{}.py", module_name(role, "my-own"));
            let (_, source) = files.iter().find(|(name, _)| *name == module).expect("the module is written");
            assert!(source.contains(&format!("id = \"{}/my-own\"", role.name())), "{role:?}");
            let (_, class, slot) = super::module(role);
            assert!(source.contains(&format!("class {class}(rg.")) && slot.role() == role, "{role:?}");
        }
    }
}
