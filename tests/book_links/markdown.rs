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
    /// The code blocks of a terminal, with the line they begin in.
    pub blocks: Vec<(usize, String)>,
    /// The code blocks in TOML, likewise.
    pub tables: Vec<(usize, String)>,
    /// The blocks that a comment says to be printed by a command.
    pub outputs: Vec<Output>,
    /// What `{{#include …}}` names, with the line it stands in: mdBook alone shows it: no page has any.
    pub includes: Vec<(usize, String)>,
    /// The blocks that a comment says to be a piece of a file.
    pub listings: Vec<Listing>,
}

/// A block with the piece of a file that it shows: `file`, `file:anchor` or `file:from:to`.
#[derive(Debug)]
pub struct Listing {
    pub line: usize,
    pub target: String,
    pub text: String,
}

/// A block with the command that printed it.
#[derive(Debug)]
pub struct Output {
    pub line: usize,
    pub command: String,
    pub text: String,
}

impl Page {
    pub fn read(text: &str) -> Self {
        let mut reader = Reader { page: Self::of_lines(text), ..Reader::default() };
        let options = Options::ENABLE_TABLES
            | Options::ENABLE_FOOTNOTES
            | Options::ENABLE_STRIKETHROUGH
            | Options::ENABLE_TASKLISTS
            | Options::ENABLE_HEADING_ATTRIBUTES
            | Options::ENABLE_SMART_PUNCTUATION
            | Options::ENABLE_DEFINITION_LIST
            | Options::ENABLE_GFM;
        for (event, range) in Parser::new_ext(text, options).into_offset_iter() {
            reader.line = 1 + text[..range.start].matches('\n').count();
            reader.take(event);
        }
        reader.page
    }

    /// What is found line by line.
    fn of_lines(text: &str) -> Self {
        Self { includes: includes(text), listings: listings(text), ..Self::default() }
    }

    /// mdBook's rule: letters, digits, `_` and `-` are kept, spaces become `-`, and what was there before
    /// gets a number.
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

/// A page while it is read.
#[derive(Default)]
struct Reader {
    page: Page,
    line: usize,
    /// The heading that is being read, without an id of its own.
    heading: Option<String>,
    /// The command that printed the next code block.
    printed_by: Option<String>,
    /// The code block that is being read, its line and whether it is TOML.
    block: Option<(usize, String, bool)>,
}

impl Reader {
    fn take(&mut self, event: Event<'_>) {
        match event {
            Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                self.page.links.push((self.line, dest_url.into_string()));
            }
            Event::Start(Tag::Heading { id: Some(id), .. }) => {
                self.page.anchors.insert(id.into_string());
            }
            Event::Start(Tag::Heading { id: None, .. }) => self.heading = Some(String::new()),
            Event::End(TagEnd::Heading(_)) => {
                self.heading.take().iter().for_each(|heading| self.page.add_heading(heading));
            }
            Event::Start(Tag::CodeBlock(kind)) => self.begin_block(&kind),
            Event::End(TagEnd::CodeBlock) => {
                if let Some((line, text, is_toml)) = self.block.take() {
                    let command = self.printed_by.take();
                    self.page.outputs.extend(command.map(|command| Output {
                        line,
                        command,
                        text: text.clone(),
                    }));
                    let blocks = if is_toml { &mut self.page.tables } else { &mut self.page.blocks };
                    blocks.push((line, text));
                }
            }
            Event::Text(words) | Event::Code(words) => {
                self.heading.iter_mut().for_each(|heading| heading.push_str(&words));
                self.block.iter_mut().for_each(|(_, block, _)| block.push_str(&words));
            }
            Event::Html(html) | Event::InlineHtml(html) => {
                let command = html.trim().strip_prefix("<!-- output of: ");
                self.printed_by = command.and_then(|rest| Some(rest.strip_suffix("-->")?.trim().to_owned()));
                let links = ["href", "src"].iter().flat_map(|name| attributes(&html, name));
                self.page.links.extend(links.map(|link| (self.line, link)));
                self.page.anchors.extend(attributes(&html, "id"));
            }
            _ => {}
        }
    }

    fn begin_block(&mut self, kind: &CodeBlockKind<'_>) {
        let language = match kind {
            CodeBlockKind::Fenced(language) => language.as_ref(),
            CodeBlockKind::Indented => "",
        };
        let is_wanted = ["", "sh", "console", "text", "toml"].contains(&language);
        self.block = is_wanted.then(|| (self.line, String::new(), language == "toml"));
    }
}

/// The values of an attribute in a piece of HTML.
fn attributes(html: &str, name: &str) -> Vec<String> {
    let begins = format!(" {name}=\"");
    html.split(&begins).skip(1).filter_map(|rest| Some(rest.split_once('"')?.0.to_owned())).collect()
}

fn listings(text: &str) -> Vec<Listing> {
    let mut lines = text.lines().enumerate();
    let mut found = Vec::new();
    while let Some((k, line)) = lines.next() {
        let mark = line.strip_prefix("<!-- listing: ").and_then(|rest| rest.strip_suffix(" -->"));
        let Some(target) = mark else { continue };
        let opens = lines.next().is_some_and(|(_, line)| line.starts_with("```"));
        let body = lines.by_ref().take_while(|(_, line)| opens && *line != "```");
        let text = body.map(|(_, line)| format!("{line}\n")).collect();
        found.push(Listing { line: k + 1, target: target.to_owned(), text });
    }
    found
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
