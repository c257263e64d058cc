//! Entries whose functions and objects are guarded.

use crate::guard::{caught, guarded, guarded_check};
use regrasp_api::{
    Build, BuildError, Built, ClosedChainSampler, ContactModel, Entry, GraphStrategy, LocalPlanner, Parts,
    SettingsError, StabilityTest, SurfaceParam, with_roles,
};
use std::marker::PhantomData;

/// Something that has an entry; the export macro makes one for each plugin.
#[doc(hidden)]
pub trait Exported {
    /// The plugin's own entry.
    const ENTRY: Entry;
}

/// The same entry with every function behind the guard.
#[doc(hidden)]
pub struct GuardedEntry<E>(PhantomData<E>);

macro_rules! builders {
    ($([$variant:ident $name:ident $role:ident] $row:tt)+) => {
        impl<E: Exported> GuardedEntry<E> {
            $(fn $name(json: &str, parts: &Parts<'_>) -> Built<dyn $role> {
                guarded(E::ENTRY.id, || match E::ENTRY.build {
                    Build::$variant(build) => build(json, parts),
                    _ => Err(BuildError::Unsupported("the entry builds a plugin of another role".into())),
                })
            })+

            const BUILD: Build = match E::ENTRY.build {
                $(Build::$variant(_) => Build::$variant(Self::$name)),+
            };
        }
    };
}
with_roles!(builders);

impl<E: Exported> GuardedEntry<E> {
    /// The guarded entry.
    pub const ENTRY: Entry =
        Entry { schema: Self::schema, check: Self::check, build: Self::BUILD, ..E::ENTRY };

    fn schema() -> String {
        caught(E::ENTRY.id, || (E::ENTRY.schema)()).unwrap_or_else(|fault| {
            regrasp_api::report_fault(fault);
            "{}".into()
        })
    }

    fn check(json: &str) -> Result<(), SettingsError> {
        guarded_check(E::ENTRY.id, || (E::ENTRY.check)(json))
    }
}
