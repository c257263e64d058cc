//! Damages an input as files are damaged, and as somebody would who means harm.

use regrasp::api::Random;

/// Words that readers trip over: numbers at the edges of their types, signs, tokens of the formats.
const WORDS: [&[u8]; 24] = [
    b"0",
    b"-0",
    b"-1",
    b"1e160",
    b"-1e308",
    b"1e999",
    b"nan",
    b"inf",
    b"4294967295",
    b"18446744073709551616",
    b"0.1e-320",
    b"[",
    b"]",
    b"{",
    b"}",
    b"\"",
    b"<",
    b"/>",
    b"\0",
    b"\xff\xfe",
    b"\xef\xbb\xbf",
    b"\n",
    b" ",
    b"\x1b[2J",
];

/// A damaged copy of `input`: one to four changes, some of them taken from `other`.
pub fn mutate(input: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = input.to_vec();
    for _ in 0..1 + random.index(4) {
        change(&mut bytes, other, random);
    }
    bytes
}

fn change(bytes: &mut Vec<u8>, other: &[u8], random: &mut Random) {
    let at = random.index(bytes.len() + 1);
    let end = (at + 1 + random.index(1 + bytes.len() / 8)).min(bytes.len());
    let word = WORDS[random.index(WORDS.len())];
    match random.index(8) {
        0 if at < bytes.len() => bytes[at] ^= 1 << random.index(8),
        1 => drop(bytes.splice(at..at, word.iter().copied())),
        2 => drop(bytes.drain(at..end)),
        3 => {
            let copy = bytes[at..end].to_vec();
            drop(bytes.splice(at..at, copy));
        }
        4 => bytes.truncate(at),
        5 => {
            let from = random.index(other.len() + 1);
            let to = (from + random.index(200)).min(other.len());
            drop(bytes.splice(at..at, other[from..to].iter().copied()));
        }
        _ => replace_number(bytes, at, word),
    }
}

/// Puts `word` in the place of the next number.
fn replace_number(bytes: &mut Vec<u8>, from: usize, word: &[u8]) {
    let is_part = |byte: &u8| byte.is_ascii_digit() || matches!(byte, b'.' | b'-' | b'+');
    let Some(start) = bytes[from..].iter().position(|byte| byte.is_ascii_digit()) else { return };
    let start = from + start;
    let length = bytes[start..].iter().take_while(|byte| is_part(byte)).count();
    drop(bytes.splice(start..start + length, word.iter().copied()));
}
