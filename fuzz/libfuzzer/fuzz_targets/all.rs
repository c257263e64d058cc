//! All targets behind one binary: the first byte says which one reads the rest.
#![no_main]

use libfuzzer_sys::fuzz_target;
use regrasp_fuzz::TARGETS;

fuzz_target!(|input: &[u8]| {
    let Some((&first, bytes)) = input.split_first() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    (TARGETS[usize::from(first) % TARGETS.len()].read)(bytes, folder.path());
});
