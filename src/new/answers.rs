//! What the answers mean.

use crate::Failure;
use regrasp::api::{did_you_mean, near};
use regrasp::run::scenario::{HANDS, find};
use std::path::Path;

/// The hand: a built-in one, or a file under the key that reads it.
#[derive(Debug, PartialEq)]
pub(super) enum HandGiven {
    BuiltIn(String),
    File { key: &'static str, path: String },
}

impl HandGiven {
    pub(super) fn read(answer: &str) -> Result<Self, Failure> {
        if find(HANDS, answer).is_some() {
            return Ok(Self::BuiltIn(answer.to_owned()));
        }
        let key = match extension(answer).as_deref() {
            Some("toml") => "file",
            Some("urdf") => "urdf",
            Some("xml") => "mjcf",
            _ => {
                let names = || HANDS.iter().map(|hand| hand.name);
                let hint = match did_you_mean(&near(answer, names())) {
                    none if none.is_empty() => {
                        format!("there are {}", names().collect::<Vec<_>>().join(", "))
                    }
                    hint => hint,
                };
                let message = format!(
                    "there is no built-in hand `{answer}`, and files end in .toml, .urdf or .xml; {hint}"
                );
                return Err(Failure::bad_input(message));
            }
        };
        Ok(Self::File { key, path: answer.to_owned() })
    }

    /// The line of the table `[hand]`.
    pub(super) fn line(&self) -> String {
        match self {
            Self::BuiltIn(name) => format!("builtin = {}", quoted(name)),
            Self::File { key, path } => format!("{key} = {}", quoted(path)),
        }
    }
}

/// The object: a shape, with the inline table that says it, or a mesh file.
#[derive(Debug, PartialEq)]
pub(super) enum ObjectChoice {
    Shape { table: String, size: f64 },
    Mesh(String),
}

/// A shape's word, its keys with how many numbers each has, and the size of the ball that stands for it.
type Shape = (&'static str, &'static [(&'static str, usize)], fn(&[f64]) -> f64);

const SHAPES: &[Shape] = &[
    ("sphere", &[("radius", 1)], |x| x[0]),
    ("ellipsoid", &[("semi_axes", 3)], |x| least(x)),
    ("cuboid", &[("size", 3)], |x| least(x) / 2.0),
    ("cylinder", &[("radius", 1), ("height", 1)], |x| x[0]),
    ("capsule", &[("radius", 1), ("height", 1)], |x| x[0]),
    ("torus", &[("ring_radius", 1), ("tube_radius", 1)], |x| x[0] + x[1]),
];

fn least(x: &[f64]) -> f64 {
    x.iter().copied().fold(f64::INFINITY, f64::min)
}

/// A mesh's size is known only when it is read.
const USUAL_SIZE: f64 = 0.03;

impl ObjectChoice {
    pub(super) fn read(answer: &str) -> Result<Self, Failure> {
        let words: Vec<&str> = answer.split_whitespace().collect();
        let Some((kind, keys, size)) = SHAPES.iter().find(|(kind, ..)| words.first() == Some(kind)) else {
            // What follows the point of a number is no kind of file.
            if extension(answer).is_some_and(|kind| kind.parse::<u32>().is_err()) {
                return Ok(Self::Mesh(answer.to_owned()));
            }
            let kinds = SHAPES.iter().map(|(kind, ..)| *kind);
            let first = words.first().copied().unwrap_or_default();
            let hint = match did_you_mean(&near(first, kinds.clone())) {
                none if none.is_empty() => format!("shapes are {}", kinds.collect::<Vec<_>>().join(", ")),
                hint => hint,
            };
            return Err(Failure::bad_input(format!("`{answer}` is neither a shape nor a mesh file; {hint}")));
        };
        let wanted: usize = keys.iter().map(|(_, count)| count).sum();
        let x = finite(&words[1..]).filter(|x| x.len() == wanted);
        let x = x.ok_or_else(|| {
            Failure::bad_input(format!("`{answer}`: after `{kind}` come {}, in m", keys_text(keys)))
        })?;
        let mut rest = x.as_slice();
        let mut table = format!("{{ kind = {}", quoted(kind));
        for (key, count) in *keys {
            let (own, others) = rest.split_at(*count);
            rest = others;
            table += &match own {
                [one] => format!(", {key} = {one:?}"),
                all => format!(", {key} = {all:?}"),
            };
        }
        Ok(Self::Shape { table: table + " }", size: size(&x) })
    }

    /// The radius (m) of a ball of its size.
    pub(super) fn size(&self) -> f64 {
        match self {
            Self::Shape { size, .. } => *size,
            Self::Mesh(_) => USUAL_SIZE,
        }
    }
}

fn keys_text(keys: &[(&str, usize)]) -> String {
    let one = |(key, count): &(&str, usize)| match count {
        1 => (*key).to_owned(),
        count => format!("{key} ({count} numbers)"),
    };
    keys.iter().map(one).collect::<Vec<_>>().join(" and ")
}

/// The goal, seen from the start.
#[derive(Debug, PartialEq)]
pub(super) enum GoalChoice {
    /// About an axis of the hand's frame, by an angle (degrees).
    Turn { axis: [f64; 3], degrees: f64 },
    /// By a displacement in the hand's frame (m).
    Move([f64; 3]),
}

impl GoalChoice {
    pub(super) fn read(answer: &str) -> Result<Self, Failure> {
        let words: Vec<&str> = answer.split_whitespace().collect();
        match words.as_slice() {
            ["turn", axis, rest @ ..] => {
                let axes = [("x", [1.0, 0.0, 0.0]), ("y", [0.0, 1.0, 0.0]), ("z", [0.0, 0.0, 1.0])];
                let Some((_, axis)) = axes.into_iter().find(|(name, _)| name == axis) else {
                    return Err(Failure::bad_input(format!("`{axis}` is no axis; `x`, `y` or `z` is")));
                };
                let [degrees] = numbers(rest, "`turn`, an axis and one number (degrees)")?;
                Ok(Self::Turn { axis, degrees })
            }
            ["move", rest @ ..] => Ok(Self::Move(numbers(rest, "`move`, three numbers (m)")?)),
            _ => Err(Failure::bad_input(format!(
                "`{answer}` is no goal; write `turn z 45` (degrees) or `move 0 0 0.01` (m)"
            ))),
        }
    }
}

fn numbers<const N: usize>(words: &[&str], what: &str) -> Result<[f64; N], Failure> {
    let read = finite(words).and_then(|x| <[f64; N]>::try_from(x).ok());
    read.ok_or_else(|| Failure::bad_input(format!("`{}`: wanted are {what}", words.join(" "))))
}

fn finite(words: &[&str]) -> Option<Vec<f64>> {
    words.iter().map(|word| word.parse::<f64>().ok().filter(|x| x.is_finite())).collect()
}

fn extension(name: &str) -> Option<String> {
    Some(Path::new(name).extension()?.to_str()?.to_lowercase())
}

/// A TOML string.
pub(super) fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}
