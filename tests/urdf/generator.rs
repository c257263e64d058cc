//! URDF hands of any number of fingers and joints, written by the tests themselves.

use std::fmt::Write;

/// What a generated hand looks like.
#[derive(Clone, Copy, Debug)]
pub struct Pattern {
    pub fingers: usize,
    /// Joints of each finger, 3 to 5: abduction, then flexions.
    pub joints: usize,
    /// The shape of the links: `box`, `cylinder`, `capsule`, `mesh`, or none.
    pub link: &'static str,
    /// Whether the last joint is driven by the one before.
    pub driven: bool,
}

/// Lengths of the links behind the flexions (m), so that every finger is 0.115 m long.
fn lengths(flexions: usize) -> &'static [f64] {
    match flexions {
        2 => &[0.065, 0.050],
        3 => &[0.045, 0.035, 0.035],
        _ => &[0.035, 0.030, 0.025, 0.025],
    }
}

/// The URDF of a hand whose fingers stand evenly on a circle of 60 mm radius.
pub fn hand(pattern: Pattern) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<robot name=\"generated\">\n<link name=\"palm\"><collision>\
         <origin xyz=\"0 0 -0.02\"/><geometry><box size=\"0.14 0.14 0.02\"/></geometry></collision></link>\n",
    );
    for finger in 0..pattern.fingers {
        self::finger(&mut text, pattern, finger);
    }
    text + "</robot>\n"
}

fn finger(text: &mut String, pattern: Pattern, finger: usize) {
    let angle = std::f64::consts::TAU * finger as f64 / pattern.fingers as f64;
    let (sin, cos) = angle.sin_cos();
    let base =
        format!("xyz=\"{} {} 0\" rpy=\"0 0 {}\"", 0.06 * cos, 0.06 * sin, angle + std::f64::consts::PI);
    joint(
        text,
        (&format!("f{finger}_abduction"), None),
        "palm",
        &format!("f{finger}_knuckle"),
        &base,
        "1 0 0",
        (-0.9, 0.9),
    );
    link(text, &format!("f{finger}_knuckle"), "");
    let mut before = format!("f{finger}_knuckle");
    let mut height = 0.0;
    for (k, length) in lengths(pattern.joints - 1).iter().enumerate() {
        let name = format!("f{finger}_link{k}");
        let limits = if k == 0 { (-1.2, 1.4) } else { (0.05, 1.9) };
        let driver =
            (pattern.driven && k + 2 == pattern.joints).then(|| format!("f{finger}_flexion{}", k - 1));
        joint(
            text,
            (&format!("f{finger}_flexion{k}"), driver.as_deref()),
            &before,
            &name,
            &format!("xyz=\"0 0 {height}\""),
            "0 1 0",
            limits,
        );
        link(text, &name, &shape(pattern.link, *length));
        (before, height) = (name, *length);
    }
    writeln!(
        text,
        "<link name=\"f{finger}_tip\"/><joint name=\"f{finger}_end\" type=\"fixed\"><parent \
            link=\"{before}\"/>\
         <child link=\"f{finger}_tip\"/><origin xyz=\"0 0 {height}\"/></joint>"
    )
    .unwrap();
}

/// A shape along z from the link's origin.
fn shape(kind: &str, length: f64) -> String {
    let geometry = match kind {
        "box" => format!("<box size=\"0.014 0.014 {length}\"/>"),
        "cylinder" => format!("<cylinder radius=\"0.007\" length=\"{length}\"/>"),
        "mesh" => format!(
            "<mesh filename=\"package://generated/meshes/wedge.obj\" scale=\"0.007 0.007 {length}\"/>"
        ),
        _ => format!("<capsule radius=\"0.007\" length=\"{length}\"/>"),
    };
    let height = if kind == "mesh" { 0.0 } else { length / 2.0 };
    format!("<collision><origin xyz=\"0 0 {height}\"/><geometry>{geometry}</geometry></collision>")
}

/// A three-sided prism from z = 0 to 1, with one corner too many and no lid: its convex hull is what counts.
pub const WEDGE: &str = "v 1 0 0\nv -0.5 0.8 0\nv -0.5 -0.8 0\nv 1 0 1\nv -0.5 0.8 1\nv -0.5 -0.8 1\nv 0 0 \
    0.5\n\
    f 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\nf 3 1 4\nf 3 4 6\nf 1 3 7\n";

fn link(text: &mut String, name: &str, collision: &str) {
    writeln!(text, "<link name=\"{name}\">{collision}</link>").unwrap();
}

fn joint(
    text: &mut String,
    (name, driver): (&str, Option<&str>),
    parent: &str,
    child: &str,
    origin: &str,
    axis: &str,
    (lower, upper): (f64, f64),
) {
    let mimic =
        driver.map(|driver| format!("<mimic joint=\"{driver}\" multiplier=\"0.8\" offset=\"0.02\"/>"));
    writeln!(
        text,
        "<joint name=\"{name}\" type=\"revolute\"><parent link=\"{parent}\"/><child \
            link=\"{child}\"/><origin {origin}/>\
         <axis xyz=\"{axis}\"/><limit lower=\"{lower}\" upper=\"{upper}\" velocity=\"4\" \
         effort=\"1\"/>{}</joint>",
        mimic.unwrap_or_default()
    )
    .unwrap();
}
