//! What names from files may do to a terminal: nothing. Colours that the program itself gives. And what is
//! told beside a command's output.

use crate::output;
use std::borrow::Cow;
use std::collections::hash_map::RandomState;
use std::ffi::OsString;
use std::hash::{BuildHasher, Hasher};
use std::io::{self, IsTerminal, Write};
use std::sync::{LazyLock, OnceLock};

/// When there are colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum When {
    /// On a terminal, unless the environment says otherwise.
    #[default]
    Auto,
    /// Wherever it goes.
    Always,
    /// Nowhere.
    Never,
}

/// When there are colours, by its name.
pub fn when(text: &str) -> Result<When, String> {
    match text {
        "auto" => Ok(When::Auto),
        "always" => Ok(When::Always),
        "never" => Ok(When::Never),
        _ => Err("it must be `auto`, `always` or `never`".into()),
    }
}

/// What a colour means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// Something is as it should be.
    Good,
    /// Something is not.
    Bad,
    /// Something to look at.
    Look,
    /// A heading.
    Head,
}

/// The codes of select graphic rendition (ECMA-48) in the order of [`Paint`], and at the end that for none.
const CODES: [&str; 5] = ["\u{1b}[32m", "\u{1b}[31m", "\u{1b}[33m", "\u{1b}[1m", "\u{1b}[0m"];

/// The first of five letters for private use that stand for colours until the text is written. Which ones
/// they are no file can know, so that no name in a file can colour anything.
static MARK: LazyLock<u32> = LazyLock::new(|| {
    let number = RandomState::new().build_hasher().finish() % 65_000;
    0x10_0000 + number as u32
});

fn mark(code: u32) -> char {
    char::from_u32(*MARK + code).expect("plane 16 holds letters for private use")
}

/// Which code a letter stands for.
fn code(letter: char) -> Option<&'static str> {
    let offset = u32::from(letter).checked_sub(*MARK)?;
    CODES.get(offset as usize).copied()
}

/// The text in a colour, where it is written to something that has colours.
pub fn paint(paint: Paint, text: &str) -> String {
    format!("{}{text}{}", mark(paint as u32), mark(4))
}

/// How many places a text takes up, the marks of colours not counted.
pub fn width(text: &str) -> usize {
    text.chars().filter(|letter| code(*letter).is_none()).count()
}

static CHOSEN: OnceLock<When> = OnceLock::new();

/// Takes the user's choice.
pub fn choose(when: When) {
    // The first choice stands; there is one.
    let _ = CHOSEN.set(when);
}

/// Whether a stream gets colours: the choice, then the environment (`NO_COLOR`, `CLICOLOR_FORCE`, `CLICOLOR`,
/// a terminal that is `dumb`), then whether it is a terminal.
fn is_coloured(when: When, set: &dyn Fn(&str) -> Option<OsString>, is_terminal: bool) -> bool {
    let says = |name: &str| set(name).filter(|value| !value.is_empty());
    match when {
        When::Always => true,
        When::Never => false,
        When::Auto if says("NO_COLOR").is_some() => false,
        When::Auto if says("CLICOLOR_FORCE").is_some_and(|value| value != "0") => true,
        When::Auto if says("CLICOLOR").is_some_and(|value| value == "0") => false,
        When::Auto => is_terminal && says("TERM").is_none_or(|value| value != "dumb"),
    }
}

fn has_colours(is_terminal: bool) -> bool {
    is_coloured(CHOSEN.get().copied().unwrap_or_default(), &|name| std::env::var_os(name), is_terminal)
}

/// Tells something on standard error, a line each.
pub fn remark(remarks: &[String]) {
    for remark in remarks {
        tell("note:", Paint::Look, remark);
    }
}

/// A line on standard error, its label in a colour.
pub fn tell(label: &str, colour: Paint, text: &str) {
    let line = match label {
        "" => text.to_owned(),
        label => format!("{} {text}", paint(colour, label)),
    };
    // A reader of standard error that has gone away is no failure.
    let _ = writeln!(io::stderr(), "{}", rendered(&line, has_colours(io::stderr().is_terminal())));
}

/// The text as standard output gets it.
pub fn for_standard_output(text: &str) -> Cow<'_, str> {
    rendered(text, has_colours(output::is_terminal()))
}

/// The text with control characters made visible, but for the ends of lines and tabs, and without colours.
///
/// A link or a finger may be called anything; an escape sequence in its name must not move the cursor,
/// recolour the screen or answer for the user.
pub fn printable(text: &str) -> Cow<'_, str> {
    rendered(text, false)
}

fn rendered(text: &str, colours: bool) -> Cow<'_, str> {
    let is_harmful = |c: char| c.is_control() && c != '\n' && c != '\t';
    if !text.contains(|c: char| is_harmful(c) || code(c).is_some()) {
        return Cow::Borrowed(text);
    }
    let visible = |c: char| match code(c) {
        Some(code) if colours => code.to_owned(),
        Some(_) => String::new(),
        None if is_harmful(c) => c.escape_default().to_string(),
        None => c.to_string(),
    };
    Cow::Owned(text.chars().map(visible).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escape_sequences_are_shown_not_obeyed() {
        assert_eq!(printable("a\n\tb"), "a\n\tb");
        assert_eq!(printable("\u{1b}[2Jgone\r\u{9b}31m"), "\\u{1b}[2Jgone\\r\\u{9b}31m");
        assert_eq!(printable("40 µm, ≤ 30°"), "40 µm, ≤ 30°");
        assert_eq!(rendered("\u{1b}[2J", true), "\\u{1b}[2J", "with colours, too");
    }

    #[test]
    fn colours_take_no_room_and_vanish_where_there_are_none() {
        let text = paint(Paint::Good, "ok");
        assert_eq!((width(&text), printable(&text).as_ref()), (2, "ok"));
        assert_eq!(rendered(&text, true), "\u{1b}[32mok\u{1b}[0m");
    }

    #[test]
    fn the_choice_comes_before_the_environment_and_that_before_the_terminal() {
        let of = |when: When, set: &[(&str, &str)], is_terminal: bool| {
            let find = |name: &str| set.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into());
            is_coloured(when, &find, is_terminal)
        };
        assert!(of(When::Auto, &[], true) && !of(When::Auto, &[], false));
        assert!(of(When::Always, &[("NO_COLOR", "1")], false));
        assert!(!of(When::Never, &[("CLICOLOR_FORCE", "1")], true));
        assert!(!of(When::Auto, &[("NO_COLOR", "1")], true) && of(When::Auto, &[("NO_COLOR", "")], true));
        assert!(of(When::Auto, &[("CLICOLOR_FORCE", "1")], false));
        assert!(!of(When::Auto, &[("CLICOLOR_FORCE", "0")], false));
        assert!(!of(When::Auto, &[("CLICOLOR", "0")], true) && !of(When::Auto, &[("TERM", "dumb")], true));
        assert!(!of(When::Auto, &[("NO_COLOR", "1"), ("CLICOLOR_FORCE", "1")], true));
    }
}
