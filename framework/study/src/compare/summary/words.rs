//! A comparison in words: the same wherever it is told.

use super::number::{p_text, three_digits};
use crate::compare::statistics::Estimate;
use crate::compare::{Comparison, Family, Measure, Pairs, Question, Study, Unit, Verdict};

/// A scale on which numbers are told: their factor, and the unit with a blank before it.
struct Scale {
    factor: f64,
    unit: &'static str,
}

/// The scale for numbers of this size.
fn scale(measure: &Measure, size: f64) -> Scale {
    let (factor, unit) = match measure.unit() {
        Unit::Seconds if size < 1e-3 => (1e6, " µs"),
        Unit::Seconds if size < 1.0 => (1e3, " ms"),
        Unit::Seconds => (1.0, " s"),
        Unit::Metres => (1e3, " mm"),
        Unit::Bytes if size < 1e6 => (1e-3, " kB"),
        Unit::Bytes => (1e-6, " MB"),
        Unit::Share => (1e2, " points"),
        Unit::Plain("kg") => (1.0, " kg"),
        Unit::Plain("N") => (1.0, " N"),
        Unit::Plain(_) => (1.0, ""),
    };
    Scale { factor, unit }
}

/// The largest size of the finite numbers of an estimate.
fn size(found: Estimate) -> f64 {
    [found.value, found.low, found.high]
        .into_iter()
        .filter(|x| x.is_finite())
        .fold(0.0, |a, x| x.abs().max(a))
}

/// A number without a fraction of zeros.
fn plain(value: f64) -> String {
    let text = three_digits(value);
    match text.split_once('.') {
        Some((whole, fraction)) if fraction.bytes().all(|digit| digit == b'0') => whole.to_owned(),
        _ => text,
    }
}

/// A shown difference: `planning 3.10 ms slower (1.40 to 5.00), p = 0.002`.
pub fn clause(found: &Comparison) -> Option<String> {
    let estimate = found.difference.filter(|_| found.is_shown())?;
    let [more, less] = found.measure.words();
    let (word, other) = if found.verdict == Verdict::More { (more, less) } else { (less, more) };
    let noun = found.measure.noun();
    let p = p_text(found.p_holm);
    let within = match found.is_within_band() {
        true => ", yet within the band of equivalence",
        false => "",
    };
    if estimate.value == 0.0 {
        let [up, down] = found.sides;
        let (with, against) = if found.verdict == Verdict::More { (up, down) } else { (down, up) };
        let of = found.pairs;
        return Some(format!("{noun} {word} on {with} of {of} seeds, {other} on {against}, {p}{within}"));
    }
    let Scale { factor, unit } = scale(&found.measure, size(estimate));
    let ends = [estimate.low, estimate.high].map(|end| factor * end.abs());
    let [low, high] = if found.verdict == Verdict::More { ends } else { [ends[1], ends[0]] };
    let value = plain(factor * estimate.value.abs());
    Some(format!("{noun} {value}{unit} {word} ({} to {}), {p}{within}", plain(low), plain(high)))
}

/// The difference with its sign and interval, for a table: `+3.10 ms (1.40 to 5.00)`; empty where there is
/// none or its interval is unknown.
pub fn signed(found: &Comparison) -> String {
    let estimate = found.difference.filter(|estimate| estimate.low.is_finite() && estimate.high.is_finite());
    let Some(estimate) = estimate else { return String::new() };
    let Scale { factor, unit } = scale(&found.measure, size(estimate));
    let [value, low, high] = [estimate.value, estimate.low, estimate.high].map(|x| plain(factor * x));
    let sign = if estimate.value > 0.0 { "+" } else { "" };
    format!("{sign}{value}{unit} ({low} to {high})")
}

/// The verdict for a cell of a table: the difference where one is shown, else why none is.
pub fn cell(found: &Comparison) -> String {
    match found.verdict {
        Verdict::More | Verdict::Less => match found.difference {
            Some(estimate) if estimate.value != 0.0 => {
                let Scale { factor, unit } = scale(&found.measure, size(estimate));
                let sign = if estimate.value > 0.0 { "+" } else { "" };
                format!("{sign}{}{unit}", plain(factor * estimate.value))
            }
            _ => found.measure.words()[usize::from(found.verdict == Verdict::Less)].to_owned(),
        },
        Verdict::Same => "same".into(),
        Verdict::NotShown => "not shown".into(),
        Verdict::TooFew => "too few".into(),
    }
}

/// What a question is about; `name` marks the names of variants and levels.
pub fn subject(study: &Study, question: &Question, name: &dyn Fn(&str) -> String) -> String {
    let variant = |k: usize| name(&study.variants[k].name);
    match question {
        Question::Pair { a, b } if study.hypotheses.pairs == Pairs::All => {
            format!("{} against {}", variant(*a), variant(*b))
        }
        Question::Pair { a, .. } => variant(*a),
        Question::Effect { slot, level, base } => {
            format!("factor {}, {} rather than {}", slot.name(), name(level), name(base))
        }
        Question::Interaction { slots: [a, b], levels: [x, y] } => {
            format!("{} {} together with {} {}, beyond both effects", a.name(), name(x), b.name(), name(y))
        }
        Question::Older { variant: k } => variant(*k),
    }
}

/// All answers to one question in one line: what is shown, what is practically the same, what is not shown,
/// what could not be.
pub fn line(answers: &[Comparison], band: f64) -> String {
    let mut parts: Vec<String> = answers.iter().filter_map(clause).collect();
    let nouns = |verdict: Verdict| {
        let wanted = answers.iter().filter(|found| found.verdict == verdict);
        wanted.map(|found| found.measure.noun()).collect::<Vec<_>>().join(", ")
    };
    let too_few = answers.iter().filter(|found| found.verdict == Verdict::TooFew);
    let needed = too_few.map(Comparison::fewest).max().unwrap_or_default();
    let heads = [
        (Verdict::Same, format!("the same within {}", percent(band))),
        (Verdict::NotShown, "no difference shown".to_owned()),
        (Verdict::TooFew, format!("too few seeds in common, of {needed} needed")),
    ];
    for (verdict, head) in heads {
        let nouns = nouns(verdict);
        if !nouns.is_empty() {
            parts.push(format!("{head}: {nouns}"));
        }
    }
    parts.join("; ")
}

/// A share in percent without a fraction of zeros.
pub fn percent(share: f64) -> String {
    format!("{} %", (1e4 * share).round() / 1e2)
}

/// The family of hypotheses in a sentence or two.
pub fn family_text(study: &Study, family: &Family, name: &dyn Fn(&str) -> String) -> String {
    let all = family.comparisons.len();
    if all == 0 {
        return String::new();
    }
    let pairs = match study.hypotheses.pairs {
        Pairs::Baseline => format!("each variant against {}", name(&study.variants[0].name)),
        Pairs::All => "each variant against each".to_owned(),
    };
    let is_effect = |found: &Comparison| matches!(found.question, Question::Effect { .. });
    let effects = match family.comparisons.iter().any(is_effect) {
        true => ", and the factors' effects and interactions",
        false => "",
    };
    format!(
        "One family of hypotheses: {pairs}{effects}, in every measure, on every scenario: {all}, of which {} \
         could be told apart by a test and are corrected together (Holm; three quarters of the level go to \
         solved runs and planning time). A difference counts as shown below p = \
         0.05; as practically none within {} of the first variant's median.",
        family.tested,
        percent(study.hypotheses.band)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::Figure;

    fn comparison(measure: Measure, verdict: Verdict, [value, low, high]: [f64; 3]) -> Comparison {
        Comparison {
            scenario: 0,
            question: Question::Pair { a: 1, b: 0 },
            measure,
            pairs: 20,
            sides: [15, 2],
            p: 0.001,
            p_holm: 0.002,
            level: 0.01,
            difference: Some(Estimate { value, low, high }),
            band: None,
            verdict,
        }
    }

    #[test]
    fn differences_are_told_in_the_unit_of_the_thing() {
        let planning = Measure::Figure(Figure::Planning);
        let slower = comparison(planning.clone(), Verdict::More, [3.1e-3, 1.4e-3, 5e-3]);
        assert_eq!(clause(&slower).unwrap(), "planning 3.10 ms slower (1.40 to 5), p = 0.002");
        assert_eq!((signed(&slower), cell(&slower)), ("+3.10 ms (1.40 to 5)".into(), "+3.10 ms".into()));
        let faster = comparison(planning.clone(), Verdict::Less, [-2.0, -3.0, -1.5]);
        assert_eq!(clause(&faster).unwrap(), "planning 2 s faster (1.50 to 3), p = 0.002");
        let solved = comparison(Measure::Solved, Verdict::Less, [-0.25, -0.4, -0.1]);
        assert_eq!(clause(&solved).unwrap(), "solved 25 points fewer (10 to 40), p = 0.002");
        let count = comparison(Measure::Figure(Figure::Regrasps), Verdict::More, [0.0, 0.0, 1.0]);
        assert_eq!(clause(&count).unwrap(), "regrasps more on 15 of 20 seeds, fewer on 2, p = 0.002");
        let open = comparison(planning, Verdict::NotShown, [0.1, -0.1, 0.3]);
        assert_eq!((clause(&open), signed(&open)), (None, "+100 ms (-100 to 300)".into()));
    }
}
