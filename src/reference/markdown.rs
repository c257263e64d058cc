//! Markdown: what the pages are written in.

/// A table; `|` in cells is escaped.
pub fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    let line =
        |cells: &mut dyn Iterator<Item = String>| format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "));
    let mut text = line(&mut head.iter().map(ToString::to_string));
    text += &line(&mut head.iter().map(|_| "---".to_owned()));
    for row in rows {
        text += &line(&mut row.iter().map(|cell| cell.replace('|', "\\|")));
    }
    text + "\n"
}

/// Text as code; nothing where it is empty.
pub fn code(text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("`{text}`") }
}

/// The parts of a cell, one below the other; empty ones are left out. Six narrow columns would leave no room
/// for the words.
pub fn lines(parts: &[String]) -> String {
    let parts: Vec<&str> = parts.iter().map(String::as_str).filter(|part| !part.is_empty()).collect();
    parts.join("<br>")
}

/// A block of code.
pub fn block(language: &str, text: &str) -> String {
    format!("```{language}\n{}\n```\n\n", text.trim_end())
}

/// A heading whose address stays what it is, whatever becomes of its words.
pub fn heading(level: usize, title: &str, anchor: &str) -> String {
    format!("{} {title} {{#{anchor}}}\n\n", "#".repeat(level))
}

/// Plain text in which nothing is taken for markup: `<` would begin an HTML tag outside of code, `*` and `_`
/// emphasis, `[` a link.
pub fn prose(text: &str) -> String {
    let escaped = |(i, part): (usize, &str)| match i % 2 {
        1 => part.to_owned(),
        _ => part.replace('<', "&lt;").replace('*', "\\*").replace('[', "\\["),
    };
    text.split('`').enumerate().map(escaped).collect::<Vec<_>>().join("`")
}
