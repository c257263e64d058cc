//! The fingerprint: everything that must be equal for two separately built binaries to share Rust objects.

macro_rules! contract_version {
    () => {
        "1"
    };
}

#[cfg(panic = "unwind")]
macro_rules! panic_strategy {
    () => {
        "unwind"
    };
}
#[cfg(not(panic = "unwind"))]
macro_rules! panic_strategy {
    () => {
        "abort"
    };
}

/// Version of the plugin contract; raised by every change that a plugin's author must react to.
pub const CONTRACT_VERSION: &str = contract_version!();

/// The key of the line that holds [`CONTRACT_VERSION`].
pub const CONTRACT_KEY: &str = "contract";

/// The fingerprint of this build: lines `key: value`, the contract's version first.
///
/// Rust promises no layout of types, vtables or calls between compilers, and a changed field in `regrasp-api`
/// changes layouts under the same compiler; so all of it is compared: contract version, hashes of the sources
/// of `regrasp-api` and of this crate, features, nalgebra's version, compiler and commit, target, CPU
/// features, panic strategy. Optimisation and debug assertions change no layout and are left out: a plugin
/// built for release works in a host built for debugging.
pub const FINGERPRINT: &str = concat!(
    "contract: ",
    contract_version!(),
    "\n",
    include_str!(concat!(env!("OUT_DIR"), "/fingerprint.txt")),
    "panic strategy: ",
    panic_strategy!(),
    "\n"
);

/// The section of a plugin library that holds the fingerprint, as the `object` crate names it on every
/// platform.
pub const SECTION: &str = ".regrasp";

/// How many bytes `parts` have together.
#[doc(hidden)]
pub const fn length(parts: &[&str]) -> usize {
    let (mut sum, mut i) = (0, 0);
    while i < parts.len() {
        sum += parts[i].len();
        i += 1;
    }
    sum
}

/// The bytes of `parts` one after the other; `N` is their [`length`].
#[doc(hidden)]
pub const fn joined<const N: usize>(parts: &[&str]) -> [u8; N] {
    let mut bytes = [0; N];
    let (mut at, mut i) = (0, 0);
    while i < parts.len() {
        let part = parts[i].as_bytes();
        let mut k = 0;
        while k < part.len() {
            bytes[at] = part[k];
            (at, k) = (at + 1, k + 1);
        }
        i += 1;
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_has_a_key_and_a_value_of_its_own() {
        let lines: Vec<(&str, &str)> =
            FINGERPRINT.lines().map(|line| line.split_once(": ").unwrap()).collect();
        assert_eq!(lines[0], (CONTRACT_KEY, CONTRACT_VERSION));
        let keys: Vec<&str> = lines.iter().map(|(key, _)| *key).collect();
        let expected = [
            "contract",
            "api sources",
            "abi sources",
            "api features",
            "nalgebra",
            "compiler",
            "compiler commit",
            "target",
            "cpu features",
            "panic strategy",
        ];
        assert_eq!(keys, expected);
        assert!(lines.iter().all(|(_, value)| !value.is_empty()));
        assert_eq!(lines[1].1.len(), 32);
        assert_eq!(lines[4].1.split('.').count(), 3, "a whole version: {}", lines[4].1);
    }

    #[test]
    fn parts_are_joined_in_order() {
        const PARTS: &[&str] = &["ab", "", "c"];
        const JOINED: [u8; length(PARTS)] = joined(PARTS);
        assert_eq!(&JOINED, b"abc");
    }
}
