//! On random studies no sentence contradicts the matrix, and no verdict its own numbers.

use super::super::{comparisons_csv, markdown};
use crate::compare::fixture::{factorial, runs, solved, study, unsolved};
use crate::compare::{Pairs, RunKey, RunRecord, RunStatus, Study, analyse, judge_all};
use proptest::prelude::*;
use regrasp_api::Random;

/// A study as random as studies come: two to five variants or two factors, few or many seeds, differences or
/// none, failures or none.
fn random_study(seed: u64) -> (Study, Vec<RunRecord>) {
    let mut random = Random::from_key(0x57d7, seed, 0, 0);
    let mut study = match random.index(3) {
        0 => factorial(&["rlg", "new"], &["interleaved", "lazy", "eager"][..2 + random.index(2)]),
        _ => study(&["rlg", "b", "c", "d", "e"][..2 + random.index(4)]),
    };
    study.seeds.count = 4 + random.index(40) as u64;
    study.hypotheses.pairs = Pairs::ALL[random.index(2)];
    study.hypotheses.band = [0.0, 0.02, 0.1, 0.5][random.index(4)];
    if random.index(2) == 0 {
        study.scenarios.iter_mut().for_each(|one| one.problem.limits.budget.time_limit = Some(1.5));
    }
    let spread = [0.01, 0.3, 1.0][random.index(3)];
    let mut records = Vec::new();
    let effects: Vec<f64> = study.variants.iter().map(|_| 0.3 * random.normal()).collect();
    let failing: Vec<f64> = study.variants.iter().map(|_| random.range(-0.5, 0.6)).collect();
    for key in study.keys() {
        let hard = (0.3 * Random::from_key(7, key.seed, 0, 0).normal()).exp();
        let time = hard * (effects[key.variant] + spread * random.normal()).exp();
        records.push(run(&study, key, time, failing[key.variant], &mut random));
    }
    (study, records)
}

fn run(study: &Study, key: RunKey, time: f64, failing: f64, random: &mut Random) -> RunRecord {
    let mut run = solved(study, key, time);
    if let Some(motion) = &mut run.motion {
        motion.regrasps = random.index(3 + key.variant);
        motion.duration_s = 2.0 + random.index(2) as f64;
    }
    run.times.memory_bytes = Some((2e6 * (0.1 * random.normal()).exp()) as u64);
    if let Some(certified) = &mut run.certified {
        certified.margin = Some(0.1 + 0.01 * random.normal());
    }
    match random.range(0.0, 1.0) < failing {
        true => unsolved(run, RunStatus::NoPlan),
        false => run,
    }
}

/// What a sentence says of a measure.
#[derive(Clone, Debug, PartialEq)]
enum Said {
    Word(String),
    Same,
    NotShown,
    TooFew,
}

/// What a line says of each measure: the reader's way to take it apart, not the writer's.
fn claims(line: &str) -> Vec<(String, Said)> {
    let (_, said) = line.split_once(": ").expect("a subject and what is said of it");
    let lists = [
        ("the same within", Said::Same),
        ("no difference shown", Said::NotShown),
        ("too few seeds", Said::TooFew),
    ];
    let mut claims = Vec::new();
    for part in said.trim_end_matches('.').split("; ") {
        match lists.iter().find(|(head, _)| part.starts_with(head)) {
            Some((_, said)) => {
                let (_, nouns) = part.split_once(": ").expect("a list");
                claims.extend(nouns.split(", ").map(|noun| (noun.to_owned(), said.clone())));
            }
            None => claims.push(shown(part)),
        }
    }
    claims
}

/// Of `planning 3.1 ms slower (1.4 to 5.0), p = 0.002` the noun and the word.
fn shown(part: &str) -> (String, Said) {
    let words = ["slower", "faster", "more", "fewer", "longer", "shorter", "larger", "smaller", "less"];
    let tokens: Vec<&str> = part.split_whitespace().collect();
    let at = tokens.iter().position(|token| words.contains(token));
    let at = at.unwrap_or_else(|| panic!("no word of difference in {part:?}"));
    let end = tokens.iter().position(|token| token.parse::<f64>().is_ok()).unwrap_or(at).min(at);
    (tokens[..end].join(" "), Said::Word(tokens[at].to_owned()))
}

/// The cells of the rows of the matrix: subject, measure, seeds, difference, verdict, p.
fn matrix(section: &str) -> Vec<Vec<String>> {
    let rows = section.lines().filter(|line| line.starts_with('|'));
    let rows =
        rows.map(|line| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect());
    let rows: Vec<Vec<String>> = rows.collect();
    let begin = rows.iter().position(|row| row.get(1).is_some_and(|cell| cell == "measure"));
    begin.map_or(Vec::new(), |begin| rows[begin + 2..].to_vec())
}

fn said(verdict: &str) -> Said {
    match verdict {
        "the same" => Said::Same,
        "not shown" => Said::NotShown,
        "too few seeds" => Said::TooFew,
        word => Said::Word(word.to_owned()),
    }
}

/// Holds every sentence of a scenario against its matrix.
fn check_section(section: &str) {
    let matrix = matrix(section);
    let lines: Vec<&str> = section.lines().filter_map(|line| line.strip_prefix("- ")).collect();
    for line in &lines {
        if line.contains(" comparisons: ") {
            check_counts(line, &matrix);
            continue;
        }
        let subject = line.split_once(": ").expect("a subject").0;
        let mut claims = claims(line);
        let rows: Vec<_> = matrix.iter().filter(|row| row[0] == subject).collect();
        assert_eq!(claims.len(), rows.len(), "each measure once: {line}");
        for row in rows {
            let place = claims.iter().position(|(noun, _)| *noun == row[1]);
            let (noun, claim) = claims.remove(place.unwrap_or_else(|| panic!("{} in {line}", row[1])));
            assert_eq!(claim, said(&row[4]), "{subject}, {noun}: {line}");
        }
    }
    assert!(!lines.is_empty() || matrix.is_empty(), "{section}");
}

/// `planning, of 7 comparisons: 4 slower, 2 faster, 1 the same.`
fn check_counts(line: &str, matrix: &[Vec<String>]) {
    let (noun, rest) = line.split_once(", of ").expect("a measure");
    let (_, counts) = rest.trim_end_matches('.').split_once(": ").expect("counts");
    for part in counts.split(", ") {
        let (count, word) = part.split_once(' ').expect("a number and a word");
        let word = match word {
            "not shown to differ" => "not shown",
            "on too few seeds to tell" => "too few seeds",
            word => word,
        };
        let is_pair =
            |row: &&Vec<String>| !row[0].starts_with("factor ") && !row[0].contains(" together with ");
        let found = matrix.iter().filter(is_pair).filter(|row| row[1] == noun && row[4] == word).count();
        assert_eq!(count.parse(), Ok(found), "{line}");
    }
}

/// Rows of `comparisons.csv`; no cell of these studies holds a quote or a comma but the last one.
fn check_numbers(text: &str) {
    for line in text.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let at =
            cells.iter().position(|cell| ["more", "less", "same", "not-shown", "too-few"].contains(cell));
        let at = at.expect("a verdict");
        let number = |back: usize| cells[at - back].parse::<f64>().ok();
        let (p_holm, p, band) = (number(1).unwrap(), number(2).unwrap(), number(3));
        let (value, low, high) = (number(7), number(6), number(5));
        assert!(p <= p_holm, "{line}");
        assert_eq!(p_holm < 0.05, ["more", "less"].contains(&cells[at]), "{line}");
        match cells[at] {
            "more" => assert!(low.unwrap() >= 0.0 && value.unwrap() >= 0.0, "{line}"),
            "less" => assert!(high.unwrap() <= 0.0 && value.unwrap() <= 0.0, "{line}"),
            "same" => {
                let band = band.unwrap();
                assert!(low.unwrap() >= -band && high.unwrap() <= band && low.unwrap() <= 0.0, "{line}");
            }
            "not-shown" => {
                assert!(low.is_none_or(|low| low <= 0.0) && high.is_none_or(|high| high >= 0.0), "{line}")
            }
            _ => {}
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    #[test]
    fn no_sentence_contradicts_the_matrix(seed in any::<u64>()) {
        let (study, records) = random_study(seed);
        let rows = analyse(&study, &records);
        let family = judge_all(&study, &rows);
        let page = markdown(&study, &rows, &family);
        let (page, _) = page.split_once("## How to read this").unwrap();
        page.split("\n## ").skip(1).for_each(check_section);
        check_numbers(&comparisons_csv(&study, &family));
    }
}

#[test]
fn a_sentence_that_lies_is_found_out() {
    let study = study(&["rlg", "slow", "same"]);
    let records = runs(&study, |key| Some([1.0, 2.0, 1.0][key.variant] + 0.1 * key.seed as f64));
    let rows = analyse(&study, &records);
    let page = markdown(&study, &rows, &judge_all(&study, &rows));
    let (page, _) = page.split_once("## How to read this").unwrap();
    let section = page.split("\n## ").nth(1).unwrap();
    check_section(section);
    for (truth, lie) in [
        ("s slower (", "s faster ("),
        ("no difference shown: ", "the same within 10 %: "),
        ("the same within 10 %: planning, ", "the same within 10 %: "),
    ] {
        let told = section.replacen(truth, lie, 1);
        assert_ne!(told, section, "{truth}");
        assert!(std::panic::catch_unwind(|| check_section(&told)).is_err(), "{lie}");
    }
}
