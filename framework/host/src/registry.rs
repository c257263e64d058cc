//! The plugins that this program has.

use crate::{HostError, LoadError, inspect, open};
use regrasp_api::{Entry, Role, Slot, inventory, near};
use std::collections::BTreeMap;
use std::fmt;
use std::path::{Path, PathBuf};

/// Where a plugin comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source<'a> {
    /// It is linked into the program.
    BuiltIn,
    /// It was loaded from this library.
    Library(&'a Path),
}

impl fmt::Display for Source<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BuiltIn => f.write_str("built-in"),
            Self::Library(path) => write!(f, "{}", path.display()),
        }
    }
}

/// Every plugin of the program, sorted by id.
pub struct Registry {
    entries: Vec<&'static Entry>,
    /// The libraries of those plugins that were loaded, by id.
    libraries: BTreeMap<String, PathBuf>,
}

impl Registry {
    /// The plugins that are linked into the program.
    pub fn linked() -> Result<Self, HostError> {
        Self::new(inventory::iter::<Entry>)
    }

    /// A registry of the given entries; refuses an id that occurs twice or does not begin with the entry's
    /// role.
    pub fn new(entries: impl IntoIterator<Item = &'static Entry>) -> Result<Self, HostError> {
        let mut entries: Vec<&'static Entry> = entries.into_iter().collect();
        entries.sort_by_key(|entry| entry.id);
        if let Some(twice) = entries.windows(2).find(|pair| pair[0].id == pair[1].id) {
            return Err(HostError::Duplicate(twice[0].id.to_owned()));
        }
        let misnamed = entries.iter().find(|entry| bare_name(entry).is_none());
        match misnamed {
            Some(entry) => Err(HostError::WrongRole { id: entry.id.to_owned(), role: entry.role().name() }),
            None => Ok(Self { entries, libraries: BTreeMap::new() }),
        }
    }

    /// The same registry with the plugins of libraries added.
    ///
    /// All libraries are read first: if one of them does not fit this program, or has a plugin whose id is
    /// taken, none is loaded.
    pub fn with_libraries<P: AsRef<Path>>(mut self, paths: &[P]) -> Result<Self, HostError> {
        let inspected = paths.iter().map(|path| inspect(path.as_ref())).collect::<Result<Vec<_>, _>>()?;
        for library in &inspected {
            library.ids.iter().try_for_each(|id| self.reserve(id, &library.path))?;
        }
        let mut entries = self.entries;
        for library in &inspected {
            entries.extend(open(library)?);
        }
        Ok(Self { libraries: self.libraries, ..Self::new(entries)? })
    }

    /// Notes that the plugin `id` is to come from the library at `path`.
    fn reserve(&mut self, id: &str, path: &Path) -> Result<(), LoadError> {
        let first = match self.libraries.get(id) {
            Some(library) => Source::Library(library),
            None if self.entries.iter().any(|entry| entry.id == id) => Source::BuiltIn,
            None => {
                self.libraries.insert(id.to_owned(), path.to_owned());
                return Ok(());
            }
        };
        let source = |source: Source<'_>| match source {
            Source::BuiltIn => "this program".to_owned(),
            Source::Library(path) => format!("`{}`", path.display()),
        };
        let second = source(Source::Library(path));
        Err(LoadError::Duplicate { id: id.to_owned(), first: source(first), second })
    }

    /// Where a plugin comes from.
    pub fn source(&self, entry: &Entry) -> Source<'_> {
        self.libraries.get(entry.id).map_or(Source::BuiltIn, |path| Source::Library(path))
    }

    /// The entries in ascending order of ids.
    pub fn entries(&self) -> impl Iterator<Item = &'static Entry> {
        self.entries.iter().copied()
    }

    /// The plugins of one role, in ascending order of ids.
    pub fn of_role(&self, role: Role) -> impl Iterator<Item = &'static Entry> {
        self.entries().filter(move |entry| entry.role() == role)
    }

    /// The plugin with this full id, or with this bare name where only one role has it.
    pub fn find(&self, name: &str) -> Option<&'static Entry> {
        let full = self.entries().find(|entry| entry.id == name);
        full.or_else(|| {
            let mut bare = self.entries().filter(|entry| bare_name(entry) == Some(name));
            bare.next().filter(|_| bare.next().is_none())
        })
    }

    /// The plugin for `slot` with this full id or bare name.
    pub fn lookup(&self, slot: Slot, name: &str) -> Result<&'static Entry, HostError> {
        let of_role = || self.of_role(slot.role());
        let found = of_role().find(|entry| entry.id == name || bare_name(entry) == Some(name));
        match found {
            Some(entry) if entry.slots.contains(&slot) => Ok(entry),
            Some(entry) => Err(HostError::WrongSlot {
                slot,
                id: entry.id.to_owned(),
                fits: entry.slots.iter().map(|slot| slot.name().to_owned()).collect(),
            }),
            None => Err(self.unknown(slot, name)),
        }
    }

    fn unknown(&self, slot: Slot, name: &str) -> HostError {
        let fitting = || self.entries().filter(|entry| entry.slots.contains(&slot));
        let bare = name.rsplit_once('/').map_or(name, |(_, bare)| bare);
        let names = near(bare, fitting().filter_map(bare_name));
        let near = names.iter().map(|name| format!("{}/{name}", slot.role().name())).collect();
        let known = fitting().map(|entry| entry.id.to_owned()).collect();
        HostError::UnknownPlugin { slot, id: name.to_owned(), near, known }
    }
}

/// The id without its role; `None` where the id does not begin with it.
fn bare_name(entry: &'static Entry) -> Option<&'static str> {
    entry.id.strip_prefix(entry.role().name())?.strip_prefix('/')
}

/// The slot with this name.
pub fn slot_by_name(name: &str) -> Result<Slot, HostError> {
    let found = Slot::ALL.into_iter().find(|slot| slot.name() == name);
    found.ok_or_else(|| HostError::UnknownSlot {
        name: name.to_owned(),
        near: near(name, Slot::ALL.iter().map(|slot| slot.name())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_plugins::{ALWAYS, ALWAYS_AGAIN, LINEAR, MISNAMED, POINT, entries};

    fn registry() -> Registry {
        Registry::new(entries()).unwrap()
    }

    #[test]
    fn entries_are_sorted_and_doubles_are_refused() {
        let ids: Vec<&str> = registry().entries().map(|entry| entry.id).collect();
        let mut sorted = ids.clone();
        sorted.sort_unstable();
        assert_eq!(ids, sorted);
        let twice = Registry::new([&ALWAYS, &ALWAYS_AGAIN]).err();
        assert_eq!(twice, Some(HostError::Duplicate("stability-test/always".into())));
        let misnamed = Registry::new([&MISNAMED]).err().unwrap().to_string();
        assert!(misnamed.contains("`stability-test/…`"), "{misnamed}");
    }

    #[test]
    fn plugins_are_found_by_full_and_bare_name() {
        let registry = registry();
        for name in ["stability-test/always", "always"] {
            assert_eq!(registry.lookup(Slot::StabilityTest, name).unwrap().id, ALWAYS.id);
            assert_eq!(registry.find(name).unwrap().id, ALWAYS.id);
        }
        assert_eq!(registry.lookup(Slot::GraspPlanner, "linear").unwrap().id, LINEAR.id);
        assert_eq!(registry.find("contact-model/point").unwrap().id, POINT.id);
        assert!(registry.find("nothing").is_none());
    }

    #[test]
    fn unknown_names_show_the_near_ones() {
        let registry = registry();
        let text = registry.lookup(Slot::StabilityTest, "alwys").err().unwrap().to_string();
        assert!(text.contains("did you mean `stability-test/always`?"), "{text}");
        let text = registry.lookup(Slot::StabilityTest, "xyz").err().unwrap().to_string();
        assert!(text.contains("there are `stability-test/always`") && text.contains("`--load`"), "{text}");
        let text = registry.lookup(Slot::TransferPlanner, "linear").err().unwrap().to_string();
        assert!(text.contains("it fits `local-planner.grasp`"), "{text}");
        let text = slot_by_name("samler").unwrap_err().to_string();
        assert!(text.contains("did you mean `sampler`"), "{text}");
    }
}
