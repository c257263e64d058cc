//! Tables as comma-separated values, quoted as RFC 4180 has it; lines end with a line feed.

/// One row.
pub(super) fn line(cells: Vec<String>) -> String {
    cells.into_iter().map(quoted).collect::<Vec<_>>().join(",") + "\n"
}

/// A cell in quotes where it holds a quote, a comma or the end of a line; a text that a spreadsheet would
/// take for a formula begins with an apostrophe, as those programs mark texts.
fn quoted(cell: String) -> String {
    let is_formula = cell.starts_with(['=', '+', '-', '@', '\t']) && cell.parse::<f64>().is_err();
    let cell = if is_formula { format!("'{cell}") } else { cell };
    if cell.contains(['"', ',', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let cells = ["plain", "a, b", "say \"no\"", "two\nlines", ""].map(str::to_owned).to_vec();
        assert_eq!(line(["=1+1", "-3.5", "@x"].map(str::to_owned).to_vec()), "'=1+1,-3.5,'@x\n");
        assert_eq!(line(cells), "plain,\"a, b\",\"say \"\"no\"\"\",\"two\nlines\",\n");
    }
}
