//! What the file lacks: asked for at once, with the flags of a whole command.

use crate::options::HandOptions;
use regrasp_formats::RobotFault as Fault;
use std::path::Path;

/// What the file lacks.
#[derive(Debug, Default)]
pub(crate) struct Needs {
    /// What is missing, with the line of the first of its joints.
    missing: Vec<(What, String, Option<usize>)>,
    /// Why no radius was found for the fingertips, with one that may do.
    radius: Option<(String, f64)>,
}

/// What a joint can lack.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    Limits,
    Lower,
    Upper,
    Velocity,
    Effort,
    NoVelocity,
    NoEffort,
}

impl What {
    const ALL: [Self; 7] = [
        Self::Limits,
        Self::Lower,
        Self::Upper,
        Self::Velocity,
        Self::Effort,
        Self::NoVelocity,
        Self::NoEffort,
    ];

    fn sentence(self) -> &'static str {
        match self {
            Self::Limits => {
                "no limits; write <limit lower=\"…\" upper=\"…\" velocity=\"…\" effort=\"…\"/> (rad, rad/s, \
                 N·m), or give `limits`"
            }
            Self::Lower => "its <limit> lacks `lower`",
            Self::Upper => "its <limit> lacks `upper`",
            Self::Velocity => {
                "its <limit> lacks `velocity`; write it, or give `velocity` for all joints that lack it"
            }
            Self::Effort => {
                "its <limit> lacks `effort` (in an MJCF: its actuator lacks `forcerange`); write it, or give \
                 `effort` for all joints that lack it"
            }
            Self::NoVelocity => {
                "`velocity` = 0 must be positive, or the joint could not move; correct it, or give \
                 `velocity` for all joints that lack it"
            }
            Self::NoEffort => {
                "`effort` = 0 must be positive, or the joint could not move; correct it, or give `effort` \
                 for all joints that lack it"
            }
        }
    }

    /// The flag that gives it, with a value to start from.
    fn flag(self) -> (&'static str, &'static str) {
        match self {
            Self::Limits | Self::Lower | Self::Upper => ("--limits", "NAME=LOWER..UPPER"),
            Self::Velocity | Self::NoVelocity => ("--velocity", "3"),
            Self::Effort | Self::NoEffort => ("--effort", "1"),
        }
    }
}

impl Needs {
    /// Notes that a joint lacks something.
    pub fn joint(&mut self, what: What, joint: &str, line: usize) {
        self.missing.push((what, joint.to_owned(), Some(line)));
    }

    /// Notes that the fingertips' radius is not known.
    pub fn radius(&mut self, why: String, suggestion: f64) {
        self.radius = Some((why, suggestion));
    }

    /// The refusal, if anything is missing.
    pub fn check(&self, file: &Path, options: &HandOptions) -> Result<(), Fault> {
        let mut sentences: Vec<String> = self.radius.iter().map(|(why, _)| why.clone()).collect();
        let mut flags: Vec<String> =
            self.radius.iter().map(|(_, radius)| format!("--fingertip-radius {radius:.4}")).collect();
        for what in What::ALL {
            let names: Vec<&str> = self.named(what);
            if names.is_empty() {
                continue;
            }
            sentences.push(format!("{}: {}", listed(&names), what.sentence()));
            flags.extend(flag(what, &names).filter(|flag| !flags.contains(flag)));
        }
        if sentences.is_empty() {
            return Ok(());
        }
        let message = format!(
            "{}\nwith everything that is missing (the values are yours to choose): `{} {}`",
            sentences.join("\n"),
            command(file, options),
            flags.join(" ")
        );
        let key = match (&self.radius, self.missing.is_empty()) {
            (Some(_), true) => Some("fingertip_radius"),
            _ => None,
        };
        Err(Fault { line: self.missing.iter().find_map(|(.., line)| *line), key, message })
    }

    fn named(&self, what: What) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for (other, name, _) in &self.missing {
            if *other == what && !names.contains(&name.as_str()) {
                names.push(name);
            }
        }
        names
    }
}

fn flag(what: What, names: &[&str]) -> Option<String> {
    let (flag, value) = what.flag();
    if flag != "--limits" {
        return Some(format!("{flag} {value}"));
    }
    // One range for all is enough to see the hand.
    (!names.is_empty()).then(|| format!("{flag} -1.57..1.57"))
}

fn listed(names: &[&str]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{name}`")).collect();
    match names.len() {
        1 => format!("joint {}", shown[0]),
        count if count <= SHOWN => format!("joints {}", shown.join(", ")),
        count => format!("joints {}, … ({count} in all)", shown.join(", ")),
    }
}

/// The command as it was given, as far as it says what a file lacks.
fn command(file: &Path, options: &HandOptions) -> String {
    let mut words = vec![format!("regrasp hand {}", file.display())];
    let given = [
        ("--fingertip-radius", options.fingertip_radius),
        ("--scale", options.scale),
        ("--mesh-scale", options.mesh_scale),
        ("--velocity", options.velocity),
        ("--effort", options.effort),
        ("--acceleration", options.acceleration),
    ];
    words.extend(given.iter().filter_map(|(flag, value)| Some(format!("{flag} {}", (*value)?))));
    if !options.tips.is_empty() {
        words.push(format!("--tips {}", options.tips.join(",")));
    }
    words.extend(options.palm.iter().map(|palm| format!("--palm {palm}")));
    words.extend(options.packages.iter().map(|folder| format!("--packages {}", folder.display())));
    words.join(" ")
}
