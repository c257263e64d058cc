//! `summary.md`.

use super::finding;
use super::number::{count_text, milliseconds, p_text, percent, ratio_text};
use crate::compare::{Cell, Figure, LeftOut, RunStatus, Study, StudyScenario};

/// How the figures were made.
const NOTES: &str = include_str!("notes.md");

/// The text of `summary.md`: for each scenario a sentence of result and a table.
pub fn markdown(study: &Study, rows: &[Vec<Cell<'_>>]) -> String {
    let head = format!(
        "# {} on {}, {}\n",
        counted(study.variants.len(), "variant"),
        counted(study.scenarios.len(), "scenario"),
        counted(study.seeds.count as usize, "seed")
    );
    let sections = study.scenarios.iter().zip(rows);
    let sections: String = sections.map(|(scenario, row)| section(study, scenario, row)).collect();
    format!("{head}{}{sections}\n{NOTES}", command(study))
}

fn counted(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

fn command(study: &Study) -> String {
    let fence = "```";
    format!("\n{fence}\n{}\n{fence}\n", study.command.join(" ").replace(fence, "'''"))
}

fn section(study: &Study, scenario: &StudyScenario, row: &[Cell<'_>]) -> String {
    let left_out = study.left_out.iter().filter(|pair| pair.scenario == scenario.name);
    format!(
        "\n## {}\n\n{}\n\n{}\n\n{}{}",
        plain(&scenario.name),
        plain(&scenario.summary),
        finding(row, &code),
        table(scenario, row),
        left_out.map(left_out_line).collect::<String>()
    )
}

fn left_out_line(pair: &LeftOut) -> String {
    format!("\nNot planned by {}: {}\n", code(&pair.variant), plain(&pair.reason))
}

const HEAD: [&str; 10] = [
    "variant",
    "solved",
    "% (95 %)",
    "ms (95 %)",
    "times as long (95 %)",
    "effect",
    "p",
    "generated",
    "graph",
    "regrasps",
];

fn table(scenario: &StudyScenario, row: &[Cell<'_>]) -> String {
    let mut lines: Vec<[String; 10]> = vec![HEAD.map(str::to_owned)];
    lines.extend(row.iter().map(cells));
    if let Some(paper) = &scenario.paper {
        let name = format!("*published: {}, averages*", plain(&paper.example));
        let none = String::new;
        let time = format!("{}", paper.time_s * 1e3);
        let counts = [paper.generated_nodes, paper.graph_nodes].map(|count| count.to_string());
        let [generated, graph] = counts;
        lines.push([name, none(), none(), time, none(), none(), none(), generated, graph, none()]);
    }
    aligned(&lines)
}

fn cells(cell: &Cell<'_>) -> [String; 10] {
    let median =
        |figure: Figure| cell.median(figure).map(|found| count_text(found.value)).unwrap_or_default();
    let paired = cell.compared.as_ref();
    let failed = [RunStatus::Error, RunStatus::Panic, RunStatus::Crash]
        .map(|status| cell.count(status))
        .iter()
        .sum::<usize>();
    let failed = if failed > 0 { format!(", {}", counted(failed, "error")) } else { String::new() };
    [
        code(&cell.variant.name),
        format!("{}/{}{failed}", cell.successes().count(), cell.runs.len()),
        cell.success().map(percent).unwrap_or_default(),
        cell.median(Figure::Planning).map(milliseconds).unwrap_or_default(),
        paired.and_then(|compared| compared.paired.ratio).map(ratio_text).unwrap_or_default(),
        paired.map(|compared| format!("{:+.2}", compared.paired.effect)).unwrap_or_default(),
        paired.map(|compared| p_text(compared.time_p)).unwrap_or_default(),
        median(Figure::GeneratedNodes),
        median(Figure::GraphNodes),
        median(Figure::Regrasps),
    ]
}

/// The table with its columns lined up, the first flush left, the others flush right.
fn aligned(lines: &[[String; 10]]) -> String {
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..HEAD.len()).map(width).collect();
    let text = |line: &[String; 10]| {
        let cells = line.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| match column {
            0 => format!(" {cell:<width$} "),
            _ => format!(" {cell:>width$} "),
        });
        format!("|{}|\n", cells.collect::<Vec<_>>().join("|"))
    };
    let rule = widths.iter().enumerate().map(|(column, &width)| match column {
        0 => format!(":{}", "-".repeat(width + 1)),
        _ => format!("{}:", "-".repeat(width + 1)),
    });
    let rule = format!("|{}|\n", rule.collect::<Vec<_>>().join("|"));
    let mut texts = lines.iter().map(text);
    texts.next().unwrap_or_default() + &rule + &texts.collect::<String>()
}

/// A name as code: nothing in it can end the code or the cell of a table.
fn code(name: &str) -> String {
    format!("`{}`", name.replace(['`', '|', '\n', '\r'], "'"))
}

/// Text of a user: what Markdown or HTML would take for a mark is only shown.
fn plain(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '\n' | '\r' => escaped.push(' '),
            '\\' | '`' | '*' | '_' | '[' | ']' | '<' | '>' | '|' | '#' => escaped.extend(['\\', letter]),
            _ => escaped.push(letter),
        }
    }
    escaped
}
