//! What a plugin library exports, and the macro that writes it.

use regrasp_api::{Entry, Faults};

/// What a plugin library hands to the host that loads it.
#[doc(hidden)]
pub struct Library {
    /// What its section holds, for the host to compare with what it read before.
    pub section: &'static [u8],
    /// The plugins, guarded.
    pub entries: &'static [Entry],
}

/// The one function that a plugin library exports.
#[doc(hidden)]
pub type ExportFunction = unsafe extern "C" fn(&Faults) -> &'static Library;

/// The name of the one function that a plugin library exports.
pub const EXPORT_NAME: &str = "regrasp_plugins";

/// Makes a library of type `cdylib` loadable at run time: exports the plugins whose entries are named.
///
/// ```ignore
/// regrasp_abi::export_plugins!(my_plugin::ENTRY);
/// ```
///
/// Each argument is the path of a `const` of type [`Entry`]. The expansion is one exported function, and a
/// section of the file with the [`crate::FINGERPRINT`] and the plugins' ids, which the host reads before it
/// loads anything. Every function of an entry and every object that it builds is put behind a guard that
/// turns panics into errors ([`regrasp_api::CallError::Panicked`]).
///
/// Use it once, in a crate of its own that is a `cdylib` and nothing else: two such crates linked into one
/// program would both define the exported function.
#[macro_export]
macro_rules! export_plugins {
    ($($entry:path),+ $(,)?) => {
        #[allow(unsafe_code, missing_docs, improper_ctypes_definitions)]
        const _: () = {
            const PARTS: &[&str] = &[
                $crate::FINGERPRINT,
                "package: ", env!("CARGO_PKG_NAME"),
                "\nmanifest: ", env!("CARGO_MANIFEST_DIR"),
                $("\nplugin: ", $entry.id,)+
                "\n",
            ];

            // SAFETY (of the attributes): no other section of these names exists, and the host takes the
            // section for text alone.
            #[used]
            #[cfg_attr(target_vendor = "apple", unsafe(link_section = "__DATA,__regrasp"))]
            #[cfg_attr(not(target_vendor = "apple"), unsafe(link_section = ".regrasp"))]
            static SECTION: [u8; $crate::length(PARTS)] = $crate::joined(PARTS);

            static ENTRIES: &[$crate::api::Entry] = &[$({
                struct Plugin;
                impl $crate::Exported for Plugin {
                    const ENTRY: $crate::api::Entry = $entry;
                }
                $crate::GuardedEntry::<Plugin>::ENTRY
            }),+];

            static LIBRARY: $crate::Library = $crate::Library { section: &SECTION, entries: ENTRIES };

            // SAFETY (of the attribute): a `cdylib` of plugins has this one function under this name.
            #[unsafe(no_mangle)]
            extern "C" fn regrasp_plugins(faults: &$crate::api::Faults) -> &'static $crate::Library {
                $crate::api::report_faults_to(*faults);
                &LIBRARY
            }
        };
    };
}
