//! Where the keys of a JSON text begin: the parser keeps no places, and an error wants its line.

use regrasp_api::KeyPath;
use std::collections::BTreeMap;

/// The byte offset of every key and item of `text`, which must be valid JSON.
pub fn offsets(text: &str) -> BTreeMap<String, usize> {
    let mut scan = Scan { bytes: text.as_bytes(), at: 0, offsets: BTreeMap::new() };
    scan.value(&KeyPath::default());
    scan.offsets
}

struct Scan<'a> {
    bytes: &'a [u8],
    at: usize,
    offsets: BTreeMap<String, usize>,
}

impl Scan<'_> {
    fn value(&mut self, path: &KeyPath) {
        match self.peek() {
            Some(b'{') => self.members(path),
            Some(b'[') => self.items(path),
            Some(b'"') => drop(self.string()),
            _ => self.skip(|byte| !matches!(byte, b',' | b']' | b'}') && !byte.is_ascii_whitespace()),
        }
    }

    fn members(&mut self, path: &KeyPath) {
        self.at += 1;
        while self.peek() == Some(b'"') {
            let start = self.at;
            let path = path.key(&self.string());
            self.offsets.insert(path.to_string(), start);
            self.pass(b':');
            self.value(&path);
            self.pass(b',');
        }
        self.pass(b'}');
    }

    fn items(&mut self, path: &KeyPath) {
        self.at += 1;
        for index in 0.. {
            if matches!(self.peek(), None | Some(b']')) {
                break;
            }
            let path = path.item(index);
            self.offsets.insert(path.to_string(), self.at);
            self.value(&path);
            self.pass(b',');
        }
        self.pass(b']');
    }

    /// The string that begins here, with its escapes as they stand.
    fn string(&mut self) -> String {
        let start = self.at + 1;
        self.at = start;
        while let Some(&byte) = self.bytes.get(self.at).filter(|&&byte| byte != b'"') {
            self.at += if byte == b'\\' { 2 } else { 1 };
        }
        let end = self.at.min(self.bytes.len());
        self.at += 1;
        String::from_utf8_lossy(&self.bytes[start..end]).into_owned()
    }

    /// The next byte that is no white space, and moves there.
    fn peek(&mut self) -> Option<u8> {
        self.skip(|byte| byte.is_ascii_whitespace());
        self.bytes.get(self.at).copied()
    }

    fn pass(&mut self, byte: u8) {
        if self.peek() == Some(byte) {
            self.at += 1;
        }
    }

    fn skip(&mut self, over: impl Fn(u8) -> bool) {
        while self.bytes.get(self.at).is_some_and(|&byte| over(byte)) {
            self.at += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_and_item_has_its_place() {
        let text = r#"{ "a": [1, {"b\"": null}, "x,]"], "c" : -1.5e3 }"#;
        let found = offsets(text);
        let at = |key: &str| &text[found[key]..];
        assert!(at("a").starts_with("\"a\"") && at("c").starts_with("\"c\" : -1.5e3"));
        assert!(at("a[1]").starts_with("{\"b") && at("a[2]").starts_with("\"x,]\""));
        assert_eq!(found.len(), 6);
    }

    #[test]
    fn empty_containers_hold_nothing() {
        assert_eq!(offsets("{\"a\": {}, \"b\": []}").len(), 2);
        assert!(offsets("[]").is_empty() && offsets("").is_empty());
    }
}
