//! A hash of Rust sources that tells apart what two separately built binaries must have in common.
//!
//! It covers every token: signatures, layouts, bodies. Comments, documentation, layout of the text and tests
//! do not count, so that a plugin built before a typo was mended still loads. Build scripts of `regrasp-api`
//! and `regrasp-abi` use it.

mod fnv;

use fnv::Fnv;
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::fs;
use std::iter::Peekable;
use std::path::{Path, PathBuf};

/// The hash (128 bits, in hexadecimal) of all Rust files in a folder and below, in the order of their paths.
///
/// Panics where a file cannot be read or is no Rust: in a build script that ends the build with the reason.
pub fn of_sources(folder: &Path) -> String {
    let mut files = Vec::new();
    walk(folder, &mut files);
    files.sort();
    assert!(!files.is_empty(), "`{}` holds no sources", folder.display());
    let mut hash = Fnv::default();
    for file in &files {
        let name =
            file.strip_prefix(folder).expect("it was found there").to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("`{}`: {error}", file.display()));
        hash.word(&name);
        hash.word(&of_text(&text).unwrap_or_else(|error| panic!("`{}`: {error}", file.display())));
    }
    hash.text()
}

/// The hash of one file's text.
pub fn of_text(text: &str) -> Result<String, proc_macro2::LexError> {
    let mut hash = Fnv::default();
    add(text.parse()?, &mut hash);
    Ok(hash.text())
}

/// Files of tests alone are left out: they are part of no build that plugins are loaded into.
fn walk(folder: &Path, files: &mut Vec<PathBuf>) {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("`{}`: {error}", folder.display()));
    for entry in entries {
        let path = entry.unwrap_or_else(|error| panic!("`{}`: {error}", folder.display())).path();
        if path.is_dir() {
            walk(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "rs") && !path.ends_with("tests.rs") {
            files.push(path);
        }
    }
}

fn add(stream: TokenStream, hash: &mut Fnv) {
    let mut tokens = stream.into_iter().peekable();
    while let Some(token) = tokens.next() {
        match token {
            TokenTree::Punct(punct) if punct.as_char() == '#' => attribute(&mut tokens, hash),
            TokenTree::Group(group) => {
                let (open, close) = match group.delimiter() {
                    Delimiter::Brace => ("{", "}"),
                    Delimiter::Bracket => ("[", "]"),
                    Delimiter::Parenthesis => ("(", ")"),
                    Delimiter::None => ("", ""),
                };
                hash.word(open);
                add(group.stream(), hash);
                hash.word(close);
            }
            other => hash.word(&other.to_string()),
        }
    }
}

/// What follows a `#`: an attribute is passed over if it documents, with the whole item if that is a test.
fn attribute(tokens: &mut Peekable<impl Iterator<Item = TokenTree>>, hash: &mut Fnv) {
    let inner = tokens.next_if(|token| matches!(token, TokenTree::Punct(punct) if punct.as_char() == '!'));
    let group = tokens.next_if(|token| matches!(token, TokenTree::Group(_)));
    let Some(TokenTree::Group(group)) = group else {
        hash.word("#");
        return;
    };
    let words: Vec<String> = group.stream().into_iter().map(|token| token.to_string()).collect();
    let first = words.first().map(String::as_str);
    if inner.is_none() && first == Some("cfg") && words.get(1).is_some_and(|condition| condition == "(test)")
    {
        skip_item(tokens);
    } else if first != Some("doc") {
        hash.word(if inner.is_some() { "#!" } else { "#" });
        add(group.stream(), hash);
    }
}

/// Passes over an item: to its `;`, or to its braces.
fn skip_item(tokens: &mut Peekable<impl Iterator<Item = TokenTree>>) {
    for token in tokens {
        match token {
            TokenTree::Punct(punct) if punct.as_char() == ';' => return,
            TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => return,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BASE: &str = "pub struct A { pub x: f64 }\npub fn f(a: &A) -> f64 { a.x }\n";

    fn hash(text: &str) -> String {
        of_text(text).unwrap()
    }

    #[test]
    fn comments_docs_layout_and_tests_change_nothing() {
        let same = [
            "//! A crate.\n/// A point.\npub struct A { /** m */ pub x: f64 }\npub fn f(a: &A) -> f64 { a.x \
             } // x",
            "pub struct A {\n    pub x: f64\n}\n\npub fn f(a: &A) -> f64 {\n    a.x\n}",
            "pub struct A { pub x: f64 }\npub fn f(a: &A) -> f64 { a.x }\n#[cfg(test)]\nmod tests { fn g() \
             {} }",
            "#[cfg(test)]\n#[allow(unused)]\nmod tests;\npub struct A { pub x: f64 }\npub fn f(a: &A) -> \
             f64 { a.x }",
        ];
        same.iter().for_each(|text| assert_eq!(hash(text), hash(BASE), "{text}"));
    }

    #[test]
    fn fields_types_bodies_order_and_attributes_change_it() {
        let others = [
            "pub struct A { pub x: f32 }\npub fn f(a: &A) -> f64 { a.x }",
            "pub struct A { pub x: f64, y: f64 }\npub fn f(a: &A) -> f64 { a.x }",
            "pub struct A { pub x: f64 }\npub fn f(a: &A) -> f64 { -a.x }",
            "pub fn f(a: &A) -> f64 { a.x }\npub struct A { pub x: f64 }",
            "#[repr(C)] pub struct A { pub x: f64 }\npub fn f(a: &A) -> f64 { a.x }",
        ];
        others.iter().for_each(|text| assert_ne!(hash(text), hash(BASE), "{text}"));
    }
}
