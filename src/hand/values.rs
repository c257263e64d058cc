//! What the options of `regrasp hand` may be.

use regrasp::api::Vec3;
use regrasp::hands::JointChoice;

/// Three numbers with commas between them.
pub(super) fn point(text: &str) -> Result<Vec3, String> {
    let read: Option<Vec<f64>> = text.split(',').map(|x| x.trim().parse::<f64>().ok()).collect();
    let numbers: Option<[f64; 3]> = read.and_then(|numbers| numbers.try_into().ok());
    numbers.map(Vec3::from).ok_or_else(|| "it must be three numbers such as 0,0,0.01".into())
}

/// `name=value`, or a value alone.
pub(super) fn rate(text: &str) -> Result<(Option<String>, f64), String> {
    let (name, value) = match text.rsplit_once('=') {
        Some((name, value)) => (Some(name.to_owned()), value),
        None => (None, text),
    };
    let value =
        value.trim().parse().map_err(|_| "it must be a number, or a joint's name, `=` and a number")?;
    Ok((name, value))
}

/// `name=position`.
pub(super) fn position(text: &str) -> Result<JointChoice, String> {
    match rate(text)? {
        (Some(name), q) => Ok(JointChoice { name, position: Some(q), ..Default::default() }),
        (None, _) => Err("it must be a joint's name, `=` and a number".into()),
    }
}

/// `name=low..high`, or a range alone.
pub(super) fn range(text: &str) -> Result<JointChoice, String> {
    let (name, range) = text.rsplit_once('=').unwrap_or(("", text));
    let ends = range.split_once("..").map(|(low, high)| (low.trim().parse(), high.trim().parse()));
    match ends {
        Some((Ok(lower), Ok(upper))) => Ok(JointChoice {
            name: name.into(),
            lower: Some(lower),
            upper: Some(upper),
            ..Default::default()
        }),
        _ => {
            Err("it must be two numbers such as -0.3..1.6, with or without a joint's name and `=` before"
                .into())
        }
    }
}

/// The radius (m) of a ball.
pub(super) fn radius(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(radius) if (1e-3..=1.0).contains(&radius) => Ok(radius),
        _ => Err("it must be a number of metres in 0.001..=1".into()),
    }
}
