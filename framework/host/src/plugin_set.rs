//! The plugin objects of one run.

use crate::choice::settings_text;
use crate::shelf::RegistryShelf;
use crate::{Choice, Choices, HostError, Registry, Source};
use regrasp_abi::{Guardable, guarded};
use regrasp_api::{
    Build, BuildError, Built, ClosedChainSampler, ContactModel, GraphStrategy, LocalPlanner, Parts, Plugins,
    Slot, StabilityTest, SurfaceParam, unless_fault, with_slots,
};

macro_rules! plugin_set {
    ($([$slot:ident $field:ident $trait:ident] ($role:ident, $id:tt, $default:tt, $doc:tt))+) => {
        /// A plugin object for each slot.
        pub struct PluginSet {
            $(#[doc = $doc] pub $field: Box<dyn $trait>,)+
        }

        impl PluginSet {
            /// Builds the chosen plugins for a hand and an object, and refuses a hand with too few fingers
            /// for the contact model.
            pub fn build(registry: &Registry, choices: &Choices, parts: &Parts<'_>) -> Result<Self, HostError> {
                let shelf = RegistryShelf { registry };
                let parts = &Parts { plugins: &shelf, ..*parts };
                let builder = Builder { registry, choices, parts };
                builder.check_fingers(builder.contact_model()?.as_ref())?;
                Ok(Self { $($field: builder.$field()?,)+ })
            }

            /// The plugins, lent.
            pub fn plugins(&self) -> Plugins<'_> {
                Plugins { $($field: self.$field.as_ref(),)+ }
            }
        }

        impl Builder<'_> {
            // The entry's role is that of the slot, as `Registry::lookup` makes sure.
            $(fn $field(&self) -> Result<Box<dyn $trait>, HostError> {
                self.build(Slot::$slot, |build, text, parts| match build {
                    Build::$role(make) => make(text, parts),
                    _ => Err(BuildError::Unsupported("the entry builds a plugin of another role".into())),
                })
            })+
        }
    };
}
with_slots!(plugin_set);

struct Builder<'a> {
    registry: &'a Registry,
    choices: &'a Choices,
    parts: &'a Parts<'a>,
}

impl Builder<'_> {
    fn build<T: Guardable + ?Sized>(
        &self,
        slot: Slot,
        make: impl Fn(Build, &str, &Parts<'_>) -> Built<T>,
    ) -> Result<Box<T>, HostError> {
        let Choice { id, settings } = self.choices.choice(slot);
        let entry = self.registry.lookup(slot, id)?;
        let make = || make(entry.build, &settings_text(settings), self.parts);
        let built = match self.registry.source(entry) {
            Source::BuiltIn => guarded(entry.id, make),
            // A library brings its own guard.
            Source::Library(_) => make(),
        };
        built.map_err(|error| HostError::Build { id: entry.id.to_owned(), error })
    }

    fn check_fingers(&self, contact_model: &dyn ContactModel) -> Result<(), HostError> {
        let (fingers, fewest) = (self.parts.hand.finger_count(), contact_model.fewest_contacts());
        unless_fault(Ok(()))?;
        if fingers > fewest {
            return Ok(());
        }
        let contact_model = self.choices.choice(Slot::ContactModel).id.clone();
        Err(HostError::TooFewFingers { fingers, contact_model, fewest })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_plugins::{Fingers, all_choices, entries, tetrahedron};

    fn build(fingers: usize) -> HostError {
        let registry = Registry::new(entries()).unwrap();
        let choices = all_choices().resolve(&registry).unwrap();
        let object = tetrahedron();
        let hand = Fingers(fingers);
        let parts = Parts::new(&object, &hand);
        PluginSet::build(&registry, &choices, &parts).err().unwrap()
    }

    #[test]
    fn three_fingers_are_too_few_for_point_contacts() {
        let text = build(3).to_string();
        assert!(text.contains("the hand has 3 fingers"), "{text}");
        assert!(text.contains("`contact-model/point`") && text.contains("4 fingers are needed"), "{text}");
    }

    #[test]
    fn a_plugin_that_cannot_be_built_is_named() {
        let text = build(4).to_string();
        assert_eq!(text, "`stability-test/always`: for tests of the registry only");
    }
}
