//! `summary.md`.

use super::number::{count_text, milliseconds, p_text, percent, three_digits};
use super::{Finding, family_text, finding, signed, subject};
use crate::compare::{Cell, Comparison, Family, Figure, LeftOut, RunStatus, Study, StudyScenario, Verdict};

/// How the figures were made.
const NOTES: &str = include_str!("notes.md");

/// The text of `summary.md`: for each scenario what may be said, and a table.
pub fn markdown(study: &Study, rows: &[Vec<Cell<'_>>], family: &Family) -> String {
    let head = format!(
        "# {} on {}, {}\n",
        counted(study.variants.len(), "variant"),
        counted(study.scenarios.len(), "scenario"),
        counted(study.seeds.count as usize, "seed")
    );
    let stated = family_text(study, family, &code);
    let stated = if stated.is_empty() { stated } else { format!("\n{stated}\n") };
    let sections = rows.iter().enumerate();
    let sections: String = sections.map(|(k, row)| section(study, k, row, family)).collect();
    format!("{head}{}{stated}{sections}\n{NOTES}", command(study))
}

fn counted(number: usize, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

fn command(study: &Study) -> String {
    let fence = "```";
    format!("\n{fence}\n{}\n{fence}\n", study.command.join(" ").replace(fence, "'''"))
}

fn section(study: &Study, k: usize, row: &[Cell<'_>], family: &Family) -> String {
    let scenario = &study.scenarios[k];
    let left_out = study.left_out.iter().filter(|pair| pair.scenario == scenario.name);
    let Finding { lead, lines } = finding(study, k, row, family, &code);
    let lines: String = lines.iter().map(|line| format!("- {line}\n")).collect();
    let lines = if lines.is_empty() { lines } else { format!("{lines}\n") };
    format!(
        "\n## {}\n\n{}\n\n{lead}\n\n{lines}{}{}{}",
        plain(&scenario.name),
        plain(&scenario.summary),
        table(scenario, row),
        differences(study, k, family),
        left_out.map(left_out_line).collect::<String>()
    )
}

/// The matrix: for every question and measure the difference with its interval, and what may be said.
fn differences(study: &Study, k: usize, family: &Family) -> String {
    let head = ["", "measure", "seeds", "difference (interval)", "verdict", "p"];
    let mut lines = vec![head.map(str::to_owned).to_vec()];
    lines.extend(family.on(k).iter().map(|found| {
        vec![
            subject(study, &found.question, &code),
            plain(&found.measure.noun()),
            found.pairs.to_string(),
            signed(found),
            verdict(found),
            p_text(found.p_holm),
        ]
    }));
    if lines.len() == 1 { String::new() } else { format!("\n{}", aligned(&lines)) }
}

fn verdict(found: &Comparison) -> String {
    let [more, less] = found.measure.words();
    match found.verdict {
        Verdict::More => more.into(),
        Verdict::Less => less.into(),
        Verdict::Same => "the same".into(),
        Verdict::NotShown => "not shown".into(),
        Verdict::TooFew => "too few seeds".into(),
    }
}

fn left_out_line(pair: &LeftOut) -> String {
    format!("\nNot planned by {}: {}\n", code(&pair.variant), plain(&pair.reason))
}

const HEAD: [&str; 8] =
    ["variant", "solved", "% (95 %)", "ms (95 %)", "MB", "generated", "graph", "regrasps"];

fn table(scenario: &StudyScenario, row: &[Cell<'_>]) -> String {
    let mut lines: Vec<Vec<String>> = vec![HEAD.map(str::to_owned).to_vec()];
    lines.extend(row.iter().map(cells));
    if let Some(paper) = &scenario.paper {
        let name = format!("*published: {}, averages*", plain(&paper.example));
        let none = String::new;
        let time = format!("{}", paper.time_s * 1e3);
        let [generated, graph] = [paper.generated_nodes, paper.graph_nodes].map(|count| count.to_string());
        lines.push(vec![name, none(), none(), time, none(), generated, graph, none()]);
    }
    aligned(&lines)
}

fn cells(cell: &Cell<'_>) -> Vec<String> {
    let median =
        |figure: Figure| cell.median(figure).map(|found| count_text(found.value)).unwrap_or_default();
    let failed = [RunStatus::Error, RunStatus::Panic, RunStatus::Crash]
        .map(|status| cell.count(status))
        .iter()
        .sum::<usize>();
    let failed = if failed > 0 { format!(", {}", counted(failed, "error")) } else { String::new() };
    vec![
        code(&cell.variant.name),
        format!("{}/{}{failed}", cell.successes().count(), cell.runs.len()),
        cell.success().map(percent).unwrap_or_default(),
        cell.median(Figure::Planning).map(milliseconds).unwrap_or_default(),
        cell.median(Figure::Memory).map(|found| three_digits(1e-6 * found.value)).unwrap_or_default(),
        median(Figure::GeneratedNodes),
        median(Figure::GraphNodes),
        median(Figure::Regrasps),
    ]
}

/// The table with its columns lined up, the first flush left, the others flush right.
pub(in crate::compare) fn aligned(lines: &[Vec<String>]) -> String {
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
    let text = |line: &Vec<String>| {
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
pub(in crate::compare) fn code(name: &str) -> String {
    format!("`{}`", name.replace(['`', '|', '\n', '\r'], "'"))
}

/// Text of a user: what Markdown or HTML would take for a mark is only shown.
pub(in crate::compare) fn plain(text: &str) -> String {
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
