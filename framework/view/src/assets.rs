//! The page's own files and three.js, as they are in the tree.

/// The page, with `{{NAME}}` where something is put in.
pub(crate) const PAGE: &str = include_str!("../assets/page.html");
/// Its style.
pub(crate) const STYLE: &str = include_str!("../assets/style.css");
/// The script that starts the modules.
pub(crate) const LOADER: &str = include_str!("../assets/loader.js");
/// The licence of three.js, which goes with every copy.
pub(crate) const THREE_LICENSE: &str = include_str!("../third_party/three/LICENSE");

macro_rules! own {
    ($($name:literal),+) => { [$(($name, include_str!(concat!("../assets/", $name)))),+] };
}

/// The modules of three.js, by the names under which others import them; who is imported comes first.
pub(crate) const THREE: [(&str, &str); 3] = [
    ("./three.core.min.js", include_str!("../third_party/three/three.core.min.js")),
    ("three", include_str!("../third_party/three/three.module.min.js")),
    ("three/orbit", include_str!("../third_party/three/OrbitControls.js")),
];

/// The page's own modules, in the same order; they import each other by file name.
pub(crate) const OWN: [(&str, &str); 12] = own![
    "pose.js",
    "motion.js",
    "bodies.js",
    "marks.js",
    "stage.js",
    "player.js",
    "curves.js",
    "segments.js",
    "facts.js",
    "graph.js",
    "keys.js",
    "main.js"
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scripts_do_not_end_the_element_they_stand_in() {
        for (name, text) in THREE.into_iter().chain(OWN).chain([("loader.js", LOADER), ("style.css", STYLE)])
        {
            let text = text.to_lowercase();
            for bad in ["</script", "<!--", "</style"] {
                assert!(!text.contains(bad), "{name} contains {bad}");
            }
        }
    }

    #[test]
    fn nothing_is_loaded_from_the_network() {
        for (name, text) in
            OWN.into_iter().chain([("page.html", PAGE), ("style.css", STYLE), ("loader.js", LOADER)])
        {
            // The name space of SVG is no address that anything is loaded from.
            let text = text.replace("http://www.w3.org/2000/svg", "");
            for bad in ["http:", "https:", "fetch(", "XMLHttpRequest", "url("] {
                assert!(!text.contains(bad), "{name} contains {bad}");
            }
        }
    }

    #[test]
    fn modules_import_only_what_comes_before_them() {
        let mut known: Vec<String> = THREE.iter().map(|(name, _)| name.to_string()).collect();
        for (name, text) in OWN {
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
