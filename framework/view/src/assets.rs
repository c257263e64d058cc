//! The page's own files and three.js, as they are in the tree.

/// The page, with `{{NAME}}` where something is put in.
pub(crate) const PAGE: &str = include_str!("../assets/page.html");
/// What a plan's page has beside and below the scene.
pub(crate) const PLAN: &str = include_str!("../assets/plan.html");
/// What the pages of hands and objects have there.
pub(crate) const MODEL: &str = include_str!("../assets/model.html");
/// The style of all pages, of plans', and of the others'.
pub(crate) const STYLE: &str = include_str!("../assets/style.css");
pub(crate) const PLAN_STYLE: &str = include_str!("../assets/plan.css");
pub(crate) const MODEL_STYLE: &str = include_str!("../assets/model.css");
/// The script that starts the modules.
pub(crate) const LOADER: &str = include_str!("../assets/loader.js");
/// The licence of three.js, which goes with every copy.
pub(crate) const THREE_LICENSE: &str = include_str!("../third_party/three/LICENSE");

/// Modules: their names and texts.
pub(crate) type Modules = &'static [(&'static str, &'static str)];

macro_rules! own {
    ($($name:literal),+) => { &[$(($name, include_str!(concat!("../assets/", $name)))),+] };
}

/// The modules of three.js, by the names under which others import them; who is imported comes first.
pub(crate) const THREE: Modules = &[
    ("./three.core.min.js", include_str!("../third_party/three/three.core.min.js")),
    ("three", include_str!("../third_party/three/three.module.min.js")),
    ("three/orbit", include_str!("../third_party/three/OrbitControls.js")),
];

/// The modules of all pages, in the same order; they import each other by file name.
pub(crate) const SHARED: Modules = own![
    "pose.js",
    "dom.js",
    "hand.js",
    "bodies.js",
    "handbody.js",
    "light.js",
    "stage.js",
    "shell.js",
    "section.js"
];

/// Those of a plan's page.
pub(crate) const PLAN_PARTS: Modules = own![
    "motion.js",
    "marks.js",
    "actor.js",
    "player.js",
    "chart.js",
    "curves.js",
    "plotbar.js",
    "segments.js",
    "table.js",
    "facts.js",
    "graph.js",
    "compare.js",
    "zip.js",
    "record.js",
    "keys.js",
    "main.js"
];

/// Those of a hand's page.
pub(crate) const HAND_PARTS: Modules = own!["reach.js", "joints.js", "label.js", "handpage.js"];

/// Those of an object's page.
pub(crate) const OBJECT_PARTS: Modules = own!["objectpage.js"];

#[cfg(test)]
mod tests {
    use super::*;

    /// All texts of our own.
    fn own() -> impl Iterator<Item = (&'static str, &'static str)> {
        let rest = [
            ("page.html", PAGE),
            ("plan.html", PLAN),
            ("model.html", MODEL),
            ("style.css", STYLE),
            ("plan.css", PLAN_STYLE),
            ("model.css", MODEL_STYLE),
            ("loader.js", LOADER),
        ];
        modules().chain(rest)
    }

    fn modules() -> impl Iterator<Item = (&'static str, &'static str)> {
        [SHARED, PLAN_PARTS, HAND_PARTS, OBJECT_PARTS].into_iter().flatten().copied()
    }

    #[test]
    fn scripts_do_not_end_the_element_they_stand_in() {
        let scripts = own().filter(|(name, _)| !name.ends_with("html"));
        for (name, text) in THREE.iter().copied().chain(scripts) {
            let text = text.to_lowercase();
            for bad in ["</script", "<!--", "</style"] {
                assert!(!text.contains(bad), "{name} contains {bad}");
            }
        }
    }

    #[test]
    fn nothing_is_loaded_from_the_network() {
        for (name, text) in own() {
            // The name space of SVG is no address that anything is loaded from.
            let text = text.replace("http://www.w3.org/2000/svg", "");
            for bad in ["http:", "https:", "fetch(", "XMLHttpRequest", "url("] {
                assert!(!text.contains(bad), "{name} contains {bad}");
            }
        }
    }

    #[test]
    fn modules_import_only_what_comes_before_them() {
        for parts in [PLAN_PARTS, HAND_PARTS, OBJECT_PARTS] {
            let mut known: Vec<String> = THREE.iter().map(|(name, _)| name.to_string()).collect();
            for (name, text) in SHARED.iter().chain(parts) {
                for line in text.lines().filter(|line| line.starts_with("import ")) {
                    let from = line.rsplit('"').nth(1).expect("imports stand on one line, in double quotes");
                    assert!(
                        known.iter().any(|name| name == from),
                        "{name} imports {from}, which is not loaded by then"
                    );
                }
                known.push(format!("./{name}"));
            }
        }
    }
}
