//! The registry's plugins for a plugin that wraps them.

use crate::{Choices, Registry, Source};
use regrasp_abi::{Guardable, guarded};
use regrasp_api::{
    Build, BuildError, Built, ClosedChainSampler, ContactModel, GraphStrategy, LocalPlanner, Parts, Shelf,
    Slot, StabilityTest, SurfaceParam,
};

/// Builds any plugin of the registry.
pub(crate) struct RegistryShelf<'a> {
    pub registry: &'a Registry,
}

impl RegistryShelf<'_> {
    fn take<T: Guardable + ?Sized>(
        &self,
        slot: Slot,
        id: Option<&str>,
        make: impl Fn(Build) -> Built<T>,
    ) -> Built<T> {
        let choices = Choices::default();
        let id = id.unwrap_or(&choices.choice(slot).id);
        let entry = self.registry.lookup(slot, id);
        let entry = entry.map_err(|error| BuildError::Unsupported(error.to_string()))?;
        match self.registry.source(entry) {
            Source::BuiltIn => guarded(entry.id, || make(entry.build)),
            // A library brings its own guard.
            Source::Library(_) => make(entry.build),
        }
    }
}

/// Builds by the role's builder; the entry's role is that of the slot, as the look-up makes sure.
macro_rules! take {
    ($shelf:expr, $slot:expr, $id:expr, $settings:expr, $parts:expr, $role:ident) => {
        $shelf.take($slot, $id, |build| match build {
            Build::$role(make) => make($settings, $parts),
            _ => Err(BuildError::Unsupported("the entry builds a plugin of another role".into())),
        })
    };
}

impl Shelf for RegistryShelf<'_> {
    fn contact_model(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>) -> Built<dyn ContactModel> {
        take!(self, Slot::ContactModel, id, settings, parts, ContactModel)
    }

    fn stability_test(
        &self,
        id: Option<&str>,
        settings: &str,
        parts: &Parts<'_>,
    ) -> Built<dyn StabilityTest> {
        take!(self, Slot::StabilityTest, id, settings, parts, StabilityTest)
    }

    fn surface(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam> {
        take!(self, Slot::Surface, id, settings, parts, Surface)
    }

    fn sampler(&self, id: Option<&str>, settings: &str, parts: &Parts<'_>) -> Built<dyn ClosedChainSampler> {
        take!(self, Slot::Sampler, id, settings, parts, Sampler)
    }

    fn local_planner(
        &self,
        slot: Slot,
        id: Option<&str>,
        settings: &str,
        parts: &Parts<'_>,
    ) -> Built<dyn LocalPlanner> {
        take!(self, slot, id, settings, parts, LocalPlanner)
    }

    fn graph_strategy(
        &self,
        id: Option<&str>,
        settings: &str,
        parts: &Parts<'_>,
    ) -> Built<dyn GraphStrategy> {
        take!(self, Slot::GraphStrategy, id, settings, parts, GraphStrategy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_plugins::{Fingers, entries, tetrahedron};
    use regrasp_api::{Contact, EmptyShelf, FingerIndex, Vec3};

    #[test]
    fn a_plugin_is_found_by_name_and_refused_with_what_there_is() {
        let registry = Registry::new(entries()).unwrap();
        let shelf = RegistryShelf { registry: &registry };
        let (object, hand) = (tetrahedron(), Fingers(4));
        let parts = Parts { plugins: &shelf, ..Parts::new(&object, &hand) };
        let model = parts.plugins.contact_model(Some("point"), "", &parts).unwrap();
        let contact = Contact { facet: 0, p_OC: Vec3::zeros(), n_O: Vec3::z() };
        assert!(!model.cone(FingerIndex(0), &contact, 0.5).carries_torsion());
        let error = parts.plugins.contact_model(Some("pont"), "", &parts).err().unwrap().to_string();
        assert!(error.contains("point"), "{error}");
        assert!(EmptyShelf.surface(None, "", &parts).is_err());
    }
}
