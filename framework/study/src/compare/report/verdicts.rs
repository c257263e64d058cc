//! The family's verdicts as the page draws them.

use crate::compare::statistics::{BoxPlot, box_plot};
use crate::compare::summary::{cell, clause, signed, subject};
use crate::compare::{
    Cell, Comparison, Family, Figure, Measure, MeasureName, Question, Study, row_horizon_s,
};
use serde::Serialize;

/// Every question of a scenario in every measure.
#[derive(Serialize)]
pub struct Matrix {
    /// The names of the measures: the columns.
    measures: Vec<String>,
    rows: Vec<Row>,
}

#[derive(Serialize)]
struct Row {
    subject: String,
    /// The variants that it is about, by index; empty for effects of factors.
    variants: Vec<usize>,
    answers: Vec<Answer>,
}

#[derive(Serialize)]
struct Answer {
    text: String,
    title: String,
    shown: bool,
    /// 1 where better, -1 where worse, 0 where neither.
    better: i8,
}

/// The matrix of a scenario; `name` marks names.
pub fn matrix(study: &Study, scenario: usize, family: &Family, name: &dyn Fn(&str) -> String) -> Matrix {
    let questions = family.questions(scenario);
    let first = questions.first().map_or(&[][..], |(_, answers)| answers);
    let measures = first.iter().map(|found| found.measure.noun()).collect();
    let row = |(question, answers): &(&Question, &[Comparison])| Row {
        subject: subject(study, question, name),
        variants: match question {
            Question::Pair { a, b } => vec![*a, *b],
            _ => Vec::new(),
        },
        answers: answers.iter().map(answer).collect(),
    };
    Matrix { measures, rows: questions.iter().map(row).collect() }
}

fn answer(found: &Comparison) -> Answer {
    let title = clause(found).unwrap_or_else(|| {
        let [up, down] = found.sides;
        let [more, less] = found.measure.words();
        let sides = format!("{more} on {up} of {} seeds, {less} on {down}", found.pairs);
        format!("{} {}: {sides}", found.measure.noun(), signed(found))
    });
    Answer { text: cell(found), title, shown: found.is_shown(), better: found.is_better() }
}

/// The variants that may be called best: the one with the smallest median over all runs, and those that were
/// compared with it and not shown to differ in planning time or in what they solve. Indices of variants in
/// their order, the best one first.
pub fn best(row: &[Cell<'_>], scenario: usize, family: &Family) -> Vec<usize> {
    let solvers = row.iter().filter(|cell| cell.median_of_all_s().is_finite());
    let Some(first) = solvers.clone().min_by(|a, b| a.median_of_all_s().total_cmp(&b.median_of_all_s()))
    else {
        return Vec::new();
    };
    let is_tie = |other: usize| {
        let between = |found: &&Comparison| match found.question {
            Question::Pair { a, b } => [(a, b), (b, a)].contains(&(first.index, other)),
            _ => false,
        };
        let is_time = |found: &&Comparison| {
            matches!(found.measure, Measure::Solved | Measure::Figure(Figure::Planning))
        };
        let mut all = family.on(scenario).iter().filter(between).filter(is_time).peekable();
        all.peek().is_some() && all.all(|found| !found.is_shown())
    };
    let equals = solvers.map(|cell| cell.index).filter(|&other| other != first.index && is_tie(other));
    std::iter::once(first.index).chain(equals).collect()
}

/// Box plots of a measure, a box a variant.
#[derive(Serialize)]
pub struct Boxes {
    measure: String,
    /// Of the numbers: `s`, `m`, `kg`, `N`, `share`, or nothing.
    unit: &'static str,
    boxes: Vec<(usize, BoxPlot)>,
}

/// Box plots of every measure but solved runs and planning time, which have charts of their own; what plugins
/// noted is among them.
pub fn boxes(row: &[Cell<'_>], chosen: &[MeasureName]) -> Vec<Boxes> {
    let horizon_s = row_horizon_s(row);
    let runs = row.iter().flat_map(|cell| cell.runs.iter().copied());
    let mut measures = Measure::of_runs(runs, chosen);
    measures.retain(|measure| !matches!(measure, Measure::Solved | Measure::Figure(Figure::Planning)));
    let of = |measure: &Measure| {
        let values =
            |cell: &Cell<'_>| box_plot(cell.successes().filter_map(|run| measure.of(run, horizon_s)));
        let boxes = row.iter().filter_map(|cell| Some((cell.index, values(cell)?)));
        Boxes { measure: measure.noun(), unit: measure.unit().name(), boxes: boxes.collect() }
    };
    measures.iter().map(of).collect()
}
