//! Tables that line up.

use crate::terminal::width;

/// Rows of cells; the first row is the head.
#[derive(Clone, Debug, Default)]
pub struct Table {
    rows: Vec<Vec<String>>,
    /// For each column `<` for flush left or `>` for flush right; the last letter stands for all that follow.
    sides: &'static str,
}

impl Table {
    /// A table with columns flush left or right as `sides` says, such as `<>>`.
    pub fn new(sides: &'static str, head: &[&str]) -> Self {
        Self { rows: vec![head.iter().map(ToString::to_string).collect()], sides }
    }

    /// Adds a row.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        self.rows.push(cells.into_iter().collect());
    }

    fn is_left(&self, column: usize) -> bool {
        self.sides.chars().nth(column).or(self.sides.chars().last()) == Some('<')
    }

    /// The text, each line indented by two spaces.
    pub fn text(&self) -> String {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let widest = |column: usize| {
            let cells = self.rows.iter().filter_map(|row| row.get(column));
            cells.map(|cell| width(cell)).max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..columns).map(widest).collect();
        let line = |row: &Vec<String>| {
            let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &all))| {
                let room = " ".repeat(all - width(cell));
                if self.is_left(column) { format!("{cell}{room}") } else { format!("{room}{cell}") }
            });
            format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned() + "\n"
        };
        self.rows.iter().map(line).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_line_up() {
        let mut table = Table::new("<>", &["name", "n"]);
        table.row(["a".into(), "10".into()]);
        table.row(["µ long".into(), "5".into()]);
        assert_eq!(table.text(), "  name     n\n  a       10\n  µ long   5\n");
    }
}
