//! What a page of markdown holds, read with the parser and the options that mdBook uses.

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd};
use std::collections::BTreeSet;

/// One page.
#[derive(Debug, Default)]
pub struct Page {
    /// Where links and pictures lead, with the line each stands in.
    pub links: Vec<(usize, String)>,
    /// What a link to this page may name after `#`.
    pub anchors: BTreeSet<String>,
    /// The code blocks with the line they begin in.
    pub blocks: Vec<(usize, String)>,
    /// What `{{#include …}}` names, with the line it stands in.
    pub includes: Vec<(usize, String)>,
}

impl Page {
    pub fn read(text: &str) -> Self {
        let mut page = Self { includes: includes(text), ..Self::default() };
        let line = |at: usize| 1 + text[..at].matches('\n').count();
        let options = Options::ENABLE_TABLES
            | Options::ENABLE_FOOTNOTES
            | Options::ENABLE_STRIKETHROUGH
            | Options::ENABLE_TASKLISTS
            | Options::ENABLE_HEADING_ATTRIBUTES
            | Options::ENABLE_SMART_PUNCTUATION
            | Options::ENABLE_DEFINITION_LIST
            | Options::ENABLE_GFM;
        let (mut heading, mut block): (Option<String>, Option<(usize, String)>) = (None, None);
        for (event, range) in Parser::new_ext(text, options).into_offset_iter() {
            match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push((line(range.start), dest_url.into_string()));
                }
                Event::Start(Tag::Heading { id, .. }) => {
                    heading = Some(String::new());
                    page.anchors.extend(id.map(|id| id.into_string()));
                }
                Event::End(TagEnd::Heading(_)) => page.add_heading(&heading.take().unwrap_or_default()),
                Event::Start(Tag::CodeBlock(kind)) => {
                    let is_shell = match kind {
                        CodeBlockKind::Fenced(language) => {
                            ["", "sh", "console", "text"].contains(&&*language)
                        }
                        CodeBlockKind::Indented => true,
                    };
                    block = is_shell.then(|| (line(range.start), String::new()));
                }
                Event::End(TagEnd::CodeBlock) => page.blocks.extend(block.take()),
                Event::Text(words) => {
                    heading.iter_mut().for_each(|heading| heading.push_str(&words));
                    block.iter_mut().for_each(|(_, block)| block.push_str(&words));
                }
                Event::Code(words) => heading.iter_mut().for_each(|heading| heading.push_str(&words)),
                Event::Html(html) | Event::InlineHtml(html) => {
                    let links = ["href", "src"].iter().flat_map(|name| attributes(&html, name));
                    page.links.extend(links.map(|link| (line(range.start), link)));
                    page.anchors.extend(attributes(&html, "id"));
                }
                _ => {}
            }
        }
        page
    }

    /// mdBook's rule: letters, digits, `_` and `-` are kept, spaces become `-`, and what was there before gets a number.
    fn add_heading(&mut self, heading: &str) {
        let kept = |c: char| match c {
            _ if c.is_alphanumeric() || c == '_' || c == '-' => Some(c),
            _ if c.is_whitespace() => Some('-'),
            _ => None,
        };
        let id: String = heading.trim().to_lowercase().chars().filter_map(kept).collect();
        if !self.anchors.insert(id.clone()) {
            let numbered =
                (1..).map(|k| format!("{id}-{k}")).find(|numbered| !self.anchors.contains(numbered));
            self.anchors.extend(numbered);
        }
    }
}

/// The values of an attribute in a piece of HTML.
fn attributes(html: &str, name: &str) -> Vec<String> {
    let begins = format!(" {name}=\"");
    html.split(&begins).skip(1).filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect()
}

fn includes(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for (k, line) in text.lines().enumerate() {
        // A backslash before the braces shows them as they are.
        for part in line.split("{{#").skip(1).filter(|_| !line.contains("\\{{#")) {
            if let Some((words, _)) = part.split_once("}}")
                && let Some((verb, target)) = words.split_once(' ')
                && ["include", "rustdoc_include", "playground"].contains(&verb)
            {
                found.push((k + 1, target.trim().to_owned()));
            }
        }
    }
    found
}
