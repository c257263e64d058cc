//! `regrasp new-plugin`

mod python;

use crate::args::{LibraryArgs, NewPluginArgs};
use crate::{Failure, plugins, say};
use regrasp::api::{Role, Slot, did_you_mean, near};
use regrasp::host::Choices;
use regrasp_template::text;
use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};

/// The tree that this program was built from.
const OWN_TREE: &str = env!("CARGO_MANIFEST_DIR");
/// This program's own lock file: with it a plugin is built of the very crates that this program was built of,
/// without a network.
const LOCK: &str = include_str!("../Cargo.lock");

/// What the name of the template's plugins is replaced with.
const TEMPLATE_NAME: &str = "/template\"";

pub fn run(args: &NewPluginArgs) -> Result<(), Failure> {
    let role = role(&args.role)?;
    check_name(role, &args.name)?;
    let package = PathBuf::from(format!("{}-{}", args.name, role.name()));
    let folder = args.output.clone().unwrap_or(package);
    if args.python {
        return python::write(role, &args.name, &folder);
    }
    let framework = framework(args.framework.as_deref())?;
    let new_crate = NewCrate::new(role, &args.name, &framework)?;
    write_all(&folder, new_crate.files())?;
    say(&new_crate.next_steps(&folder))
}

/// Writes files into a folder that is not there, or empty.
fn write_all<N: AsRef<Path>>(
    folder: &Path,
    files: impl IntoIterator<Item = (N, String)>,
) -> Result<(), Failure> {
    if fs::read_dir(folder).map_or(folder.exists(), |mut inside| inside.next().is_some()) {
        return Err(Failure::bad_input(format!(
            "`{}` exists; give another folder with `-o`",
            folder.display()
        )));
    }
    files.into_iter().try_for_each(|(name, text)| write(&folder.join(name), &text))
}

fn role(name: &str) -> Result<Role, Failure> {
    Role::ALL.into_iter().find(|role| role.name() == name).ok_or_else(|| {
        let names = || Role::ALL.iter().map(|role| role.name());
        let hint = match did_you_mean(&near(name, names())) {
            none if none.is_empty() => format!("there are `{}`", names().collect::<Vec<_>>().join("`, `")),
            hint => hint,
        };
        Failure::bad_input(format!("there is no role `{name}`; {hint}"))
    })
}

/// Names are in kebab case, and free.
fn check_name(role: Role, name: &str) -> Result<(), Failure> {
    let word =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit());
    if !name.split('-').all(word) || !name.starts_with(|c: char| c.is_ascii_lowercase()) {
        let reason =
            "is not in kebab case (lower-case letters and digits, words joined by `-`, a letter first)";
        return Err(Failure::bad_input(format!("the name `{name}` {reason}")));
    }
    let id = format!("{}/{name}", role.name());
    if plugins::registry(&LibraryArgs { load: Vec::new() })?.entries().any(|entry| entry.id == id) {
        return Err(Failure::bad_input(format!("there is a built-in plugin `{id}`; choose another name")));
    }
    Ok(())
}

/// The framework's sources, as an absolute path.
fn framework(given: Option<&Path>) -> Result<PathBuf, Failure> {
    let tree = given.unwrap_or(Path::new(OWN_TREE));
    let has = |name: &str| tree.join("framework").join(name).join("Cargo.toml").is_file();
    if !(has("api") && has("conformance")) {
        let message = match given {
            Some(_) => format!("`{}` is no checkout of Regrasp: it has no `framework/api`", tree.display()),
            None => format!(
                "the sources that this program was built from are gone (`{OWN_TREE}`); give a checkout of \
                    the same version: `--framework PATH`"
            ),
        };
        return Err(Failure::bad_input(message));
    }
    tree.canonicalize().map_err(|error| Failure::bad_input(format!("`{}`: {error}", tree.display())))
}

fn write(path: &Path, text: &str) -> Result<(), Failure> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let written = fs::create_dir_all(folder).and_then(|()| fs::write(path, text));
    written.map_err(|error| Failure::bad_input(format!("cannot write `{}`: {error}", path.display())))
}

/// A crate to be written.
struct NewCrate {
    source: &'static str,
    /// What stands for each `{{key}}` of the texts.
    words: Vec<(&'static str, String)>,
    is_surface: bool,
}

impl NewCrate {
    fn new(role: Role, name: &str, framework: &Path) -> Result<Self, Failure> {
        let (source, slot) = text::module(role);
        let package = format!("{name}-{}", role.name());
        let library = format!("{DLL_PREFIX}{}_dynamic{DLL_SUFFIX}", package.replace('-', "_"));
        let quoted = |name: &str| {
            let path = framework.join(name);
            let text = path.to_str().ok_or_else(|| {
                Failure::bad_input(format!(
                    "`{}` is not UTF-8 and cannot stand in a Cargo.toml",
                    path.display()
                ))
            })?;
            Ok::<_, Failure>(toml::Value::from(text).to_string())
        };
        let words = vec![
            ("id", format!("{}/{name}", role.name())),
            ("role", role.name().to_owned()),
            ("name", name.to_owned()),
            ("slot", slot.name().to_owned()),
            ("default", default_name(slot)),
            ("summary", summary(source).to_owned()),
            ("crate", package.replace('-', "_")),
            ("package", package.clone()),
            ("library", Path::new("target").join("release").join(library).display().to_string()),
            ("test", format!("{:<28}", test_command())),
            ("framework", framework.display().to_string()),
            ("build", quoted("target")?),
            ("abi", quoted("framework/abi")?),
            ("api", quoted("framework/api")?),
            ("conformance", quoted("framework/conformance")?),
        ];
        Ok(Self { source, words, is_surface: role == Role::Surface })
    }

    /// The files by their paths in the crate.
    fn files(&self) -> [(&'static str, String); 9] {
        let conformance = match self.is_surface {
            true => text::CONFORMANCE_OF_SURFACE,
            false => text::CONFORMANCE,
        };
        [
            ("Cargo.toml", self.fill(text::MANIFEST)),
            ("Cargo.lock", LOCK.to_owned()),
            (".gitignore", "/target\n".to_owned()),
            (".cargo/config.toml", self.fill(text::CONFIG)),
            ("README.md", self.fill(text::README)),
            (
                "src/lib.rs",
                self.source.replace(TEMPLATE_NAME, &self.fill("/{{name}}\""))
                    + text::REGISTRATION
                    + text::TESTS,
            ),
            ("tests/conformance.rs", self.fill(conformance)),
            ("dynamic/Cargo.toml", self.fill(text::DYNAMIC_MANIFEST)),
            ("dynamic/src/lib.rs", self.fill(text::DYNAMIC)),
        ]
    }

    fn fill(&self, text: &str) -> String {
        let fill = |text: String, (key, word): &(&str, String)| text.replace(&format!("{{{{{key}}}}}"), word);
        self.words.iter().fold(text.to_owned(), fill)
    }

    fn next_steps(&self, folder: &Path) -> String {
        let steps = "\
`{{folder}}` has the plugin `{{id}}`; it works as it is:
    cd {{folder}}
    {{test}}# the laws of its role
    cargo build --release --workspace    # {{library}}
    regrasp plan sphere --load {{library}} --use {{slot}}={{name}}
    regrasp compare sphere --load {{library}} --vary {{slot}}={{default}},{{name}} -o study
The plugin is in `src/lib.rs`: make it yours, and do the same again.
";
        self.fill(&steps.replace("{{folder}}", &folder.display().to_string()))
    }
}

/// How the tests are run so that they use what was compiled for this program: in its own profile.
fn test_command() -> &'static str {
    if cfg!(debug_assertions) { "cargo test" } else { "cargo test --release" }
}

/// The name, without its role, of the plugin that fills a slot by default.
fn default_name(slot: Slot) -> String {
    let choices = Choices::default();
    let id = &choices.choice(slot).id;
    id.rsplit_once('/').map_or(id.as_str(), |(_, name)| name).to_owned()
}

/// What a source says of itself in its first line.
fn summary(source: &str) -> &str {
    source.lines().next().unwrap_or_default().trim_start_matches("//! ").trim_end_matches('.')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn new_crate(role: Role) -> NewCrate {
        NewCrate::new(role, "mine", Path::new("/some/\"odd\" tree")).unwrap()
    }

    #[test]
    fn no_word_is_left_open_and_the_id_is_the_new_one() {
        for role in Role::ALL {
            let files = new_crate(role).files();
            let text = |name: &str| &files.iter().find(|(file, _)| *file == name).unwrap().1;
            let open = |(name, text): &&(&str, String)| !name.ends_with(".lock") && text.contains("{{");
            assert_eq!(files.iter().find(open), None);
            assert!(text("src/lib.rs").contains(&format!("id: \"{}/mine\"", role.name())), "{role:?}");
            assert!(!text("src/lib.rs").contains("template"), "{role:?}");
            let steps = new_crate(role).next_steps(Path::new("mine"));
            assert!(!steps.contains("{{") && steps.contains("cd mine\n"), "{steps}");
            for name in ["Cargo.toml", "dynamic/Cargo.toml"] {
                let manifest: toml::Table = text(name).parse().unwrap();
                let (package, room) = match name {
                    "Cargo.toml" => ("regrasp-api", "api"),
                    _ => ("regrasp-abi", "abi"),
                };
                let path = manifest["dependencies"][package]["path"].as_str().unwrap();
                assert!(Path::new(path).ends_with(format!("\"odd\" tree/framework/{room}")), "{path}");
            }
        }
    }

    #[test]
    fn names_are_kebab_case_and_free() {
        for bad in ["", "Mine", "my_own", "-a", "a-", "1st", "rlg"] {
            assert!(check_name(Role::Sampler, bad).is_err(), "{bad}");
        }
        assert!(check_name(Role::Sampler, "my-own2").is_ok());
        assert!(role("sampler").is_ok() && role("samplr").is_err());
    }

    #[test]
    fn a_folder_without_the_framework_is_refused() {
        assert!(framework(Some(Path::new("no-such-tree"))).is_err());
        assert!(framework(None).is_ok());
    }
}
