//! A hand and an object of one's own: writes a hand file, a mesh and a scenario, and turns a nut in the hand.
//!
//! `cargo run --example 10_own_hand_and_object [FOLDER]`
//!
//! With a folder the three files stay there, to be changed and planned by `regrasp plan FOLDER/nut.toml`. A
//! hand may as well be a URDF: `[hand] urdf = "my-hand.urdf"`.

use std::error::Error;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// One finger: a joint for spreading, two for bending. Metres, radians; fingers differ in name and place.
const FINGER: &str = r#"
[[finger]]
name = "NAME"
base = { position = [X, Y, 0.0], axis = [0.0, 0.0, 1.0], angle_deg = TURN }
tip = [0.0, 0.0, 0.055]    # the fingertip's centre in the last link's frame
rest = [0.0, -0.9, 0.6]
joint = [
  { name = "NAME-spread", axis = [1.0, 0.0, 0.0], lower = -0.9, upper = 0.9 },
  { name = "NAME-bend", axis = [0.0, 1.0, 0.0], lower = -1.2, upper = 1.4, link = [
    { shape = { kind = "capsule", from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.070], radius = 0.009 } } ] },
  { name = "NAME-curl", axis = [0.0, 1.0, 0.0], lower = 0.05, upper = 2.4, origin = { position = [0.0, 0.0, 0.070] }, link = [
    { shape = { kind = "capsule", from = [0.0, 0.0, 0.0], to = [0.0, 0.0, 0.055], radius = 0.009 } } ] },
]
"#;

/// Four fingers round a palm, each looking inward.
fn hand() -> String {
    let mut text = "name = \"my-hand\"\nfingertip_radius = 0.011\n".to_owned();
    text += "palm = [{ shape = { kind = \"box\", size = [0.15, 0.15, 0.02] }, pose = { position = [0.0, \
        0.0, -0.02] } }]\n";
    for (name, x, y, turn) in [
        ("thumb", 0.065, 0.0, 180),
        ("index", 0.0, 0.065, 270),
        ("middle", -0.065, 0.0, 0),
        ("ring", 0.0, -0.065, 90),
    ] {
        let place = |text: &str, word, number: f64| text.replace(word, &format!("{number:?}"));
        text += &place(&place(&place(FINGER, "X", x), "Y", y), "TURN", f64::from(turn)).replace("NAME", name);
    }
    text
}

/// A hexagonal prism as an OBJ file in millimetres: corners, then faces that are counter-clockwise seen from
/// outside.
fn nut() -> Result<String, std::fmt::Error> {
    let mut text = String::new();
    for z in [-25.0, 25.0] {
        for k in 0..6 {
            let (sin, cos) = (TAU * f64::from(k) / 6.0).sin_cos();
            writeln!(text, "v {:.4} {:.4} {z}", 30.0 * cos, 30.0 * sin)?;
        }
    }
    writeln!(text, "f 6 5 4 3 2 1\nf 7 8 9 10 11 12")?;
    for k in 0..6 {
        let next = (k + 1) % 6;
        writeln!(text, "f {} {} {} {}", k + 1, next + 1, next + 7, k + 7)?;
    }
    Ok(text)
}

/// The problem: half a turn.
const SCENARIO: &str = r#"
[hand]
file = "my-hand.toml"

[object]
name = "nut"
mass = 0.15         # kg
friction = 0.8
shape = { kind = "mesh", file = "nut.obj", scale = 0.001 }

[start]
pose = { position = [0.0, 0.0, 0.09] }

[[goal]]
pose = { position = [0.0, 0.0, 0.09], axis = [0.0, 0.0, 1.0], angle_deg = 180.0 }
"#;

fn write_files(folder: &Path) -> Result<String, Box<dyn Error>> {
    fs::create_dir_all(folder)?;
    fs::write(folder.join("my-hand.toml"), hand())?;
    fs::write(folder.join("nut.obj"), nut()?)?;
    let scenario = folder.join("nut.toml");
    fs::write(&scenario, SCENARIO)?;
    Ok(scenario.to_str().ok_or("the folder's name is UTF-8")?.to_owned())
}

fn main() -> Result<(), Box<dyn Error>> {
    let temporary = tempfile::tempdir()?;
    let given = std::env::args().nth(1);
    let file = write_files(given.as_deref().map_or(temporary.path(), Path::new))?;
    let scenario = regrasp::load(&file)?;
    let (fingers, object) = (scenario.problem.hand.finger.len(), &scenario.object);
    let volume = object.mesh.mass_properties().volume;
    println!(
        "a hand of {fingers} fingers, a nut of {} facets and {:.1} cm³",
        object.mesh.facets().len(),
        volume * 1e6
    );
    // Six triangles of sides 30 mm, 50 mm high.
    assert!((volume - 6.0 * 0.03f64.powi(2) * 0.75f64.sqrt() / 2.0 * 0.05).abs() < 1e-9);

    let run = regrasp::solve(&scenario, 0)?;
    if let Some(why) = run.why_not_solved() {
        return Err(why.into());
    }
    let counts = &run.outcome.statistics;
    println!(
        "half a turn: {} transfers, {} regrasps, verified {}",
        counts.transfers,
        counts.regrasps,
        run.is_verified()
    );
    assert!(run.is_verified());
    Ok(())
}
