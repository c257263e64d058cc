//! Names that resemble a misspelt one.

/// The candidates that resemble `name`, best first, at most three.
///
/// On lower-case text: a Jaro-Winkler similarity of at least 0.8, one slip of the keys (a letter too many,
/// too few, wrong, or two in the wrong order), or one name inside the other.
pub fn near<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let name = name.to_lowercase();
    let mut scored: Vec<(f64, &str)> = candidates
        .into_iter()
        .map(|candidate| (similarity(&name, &candidate.to_lowercase()), candidate))
        .filter(|(score, _)| *score >= 0.8)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    scored.into_iter().take(3).map(|(_, candidate)| candidate.to_owned()).collect()
}

fn similarity(name: &str, candidate: &str) -> f64 {
    let contained =
        name.len() >= 3 && candidate.contains(name) || candidate.len() >= 3 && name.contains(candidate);
    let slip = name.len() >= 3 && strsim::damerau_levenshtein(name, candidate) == 1;
    let alike = strsim::jaro_winkler(name, candidate);
    if contained || slip { alike.max(0.9) } else { alike }
}

/// "did you mean …?" for the given names, or the empty text.
pub fn did_you_mean(near: &[String]) -> String {
    match near {
        [] => String::new(),
        [one] => format!("did you mean `{one}`?"),
        [rest @ .., last] => format!("did you mean `{}` or `{last}`?", rest.join("`, `")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn misspelt_names_find_their_neighbours_and_strangers_find_none() {
        let names = ["sphere", "sphere-tilt", "cubic", "ellip-obst"];
        assert_eq!(near("spere", names)[0], "sphere");
        assert_eq!(near("Cube", names), ["cubic"]);
        assert_eq!(near("ellipse", names), ["ellip-obst"]);
        assert!(near("zzz", names).is_empty());
        assert_eq!(near("rgl", ["rlg", "projection"]), ["rlg"]);
    }

    #[test]
    fn suggestions_read_as_a_question() {
        assert_eq!(did_you_mean(&[]), "");
        assert_eq!(did_you_mean(&["a".into()]), "did you mean `a`?");
        assert_eq!(did_you_mean(&["a".into(), "b".into(), "c".into()]), "did you mean `a`, `b` or `c`?");
    }
}
