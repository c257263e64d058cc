//! `comparisons.csv`: a row for each hypothesis.

use crate::compare::{Comparison, Family, Question, Study, csv};

const HEAD: [&str; 19] = [
    "scenario",
    "question",
    "what",
    "against",
    "measure",
    "seeds",
    "more",
    "less",
    "difference",
    "low",
    "high",
    "confidence",
    "band",
    "p",
    "p_holm",
    "verdict",
    "within_band",
    "better",
    "says",
];

/// The text of `comparisons.csv`: every hypothesis with its verdict, in SI units and with all digits; what
/// does not exist is empty.
pub fn comparisons_csv(study: &Study, family: &Family) -> String {
    let rows = family.comparisons.iter().map(|found| csv::line(row(study, found)));
    csv::line(HEAD.map(str::to_owned).to_vec()) + &rows.collect::<String>()
}

/// The kind of a question, what it asks about, and against what.
fn question(study: &Study, question: &Question) -> [String; 3] {
    let variant = |k: usize| study.variants[k].name.clone();
    match question {
        Question::Pair { a, b } => ["pair".into(), variant(*a), variant(*b)],
        Question::Effect { slot, level, base } => {
            ["effect".into(), format!("{}: {level}", slot.name()), format!("{}: {base}", slot.name())]
        }
        Question::Interaction { slots: [a, b], levels: [x, y] } => {
            let what = format!("{}: {x} × {}: {y}", a.name(), b.name());
            ["interaction".into(), what, "both effects alone".into()]
        }
        Question::Older { variant: k } => ["older".into(), variant(*k), variant(*k)],
    }
}

fn row(study: &Study, found: &Comparison) -> Vec<String> {
    let finite =
        |value: Option<f64>| value.filter(|x| x.is_finite()).map_or(String::new(), |x| x.to_string());
    let difference = found.difference;
    let mut cells = vec![study.scenarios[found.scenario].name.clone()];
    cells.extend(question(study, &found.question));
    cells.push(found.measure.column());
    cells.extend([found.pairs, found.sides[0], found.sides[1]].map(|count| count.to_string()));
    cells.extend([
        finite(difference.map(|found| found.value)),
        finite(difference.map(|found| found.low)),
        finite(difference.map(|found| found.high)),
        (1.0 - found.level).to_string(),
        finite(found.band),
        found.p.to_string(),
        found.p_holm.to_string(),
        found.verdict.name().to_owned(),
        found.is_within_band().to_string(),
        found.is_better().to_string(),
        super::clause(found).unwrap_or_default(),
    ]);
    cells
}
