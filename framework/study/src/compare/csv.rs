//! Tables as comma-separated values, quoted as RFC 4180 has it; lines end with a line feed.

/// One row.
pub(super) fn line(cells: Vec<String>) -> String {
    cells.into_iter().map(quoted).collect::<Vec<_>>().join(",") + "\n"
}

/// A cell in quotes where it holds a quote, a comma or the end of a line.
fn quoted(cell: String) -> String {
    if cell.contains(['"', ',', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let cells = ["plain", "a, b", "say \"no\"", "two\nlines", ""].map(str::to_owned).to_vec();
        assert_eq!(line(cells), "plain,\"a, b\",\"say \"\"no\"\"\",\"two\nlines\",\n");
    }
}
