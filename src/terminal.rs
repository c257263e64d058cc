//! What names from files may do to a terminal: nothing. And what is told beside a command's output.

use std::borrow::Cow;
use std::io::{self, Write};

/// Tells something on standard error, a line each.
pub fn remark(remarks: &[String]) {
    for remark in remarks {
        // A reader of standard error that has gone away is no failure.
        let _ = writeln!(io::stderr(), "note: {}", printable(remark));
    }
}

/// The text with control characters made visible, but for the ends of lines and tabs.
///
/// A link or a finger may be called anything; an escape sequence in its name must not move the cursor,
/// recolour the screen or answer for the user.
pub fn printable(text: &str) -> Cow<'_, str> {
    let is_harmful = |c: char| c.is_control() && c != '\n' && c != '\t';
    if !text.contains(is_harmful) {
        return Cow::Borrowed(text);
    }
    let visible = |c: char| if is_harmful(c) { c.escape_default().to_string() } else { c.to_string() };
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
    }
}
