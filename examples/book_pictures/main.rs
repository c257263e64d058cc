//! Draws the book's pictures, all from real plans, into `book/src/pictures`.
//!
//! `cargo run --release --example book_pictures [FOLDER]`

mod charts;
mod components;
mod motions;
mod problem;

use problem::Example;
use std::error::Error;
use std::path::PathBuf;

/// Scenarios whose first grasp is shown in the picture of the suite.
const SUITE: [&str; 12] = [
    "sphere",
    "cubic",
    "ellip-obst",
    "sphere-free",
    "sphere-soft",
    "sphere-five",
    "ring",
    "bracket",
    "baton",
    "allegro-ball",
    "allegro-cube",
    "rgmc-a1-60",
];

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).map_or(PathBuf::from("book/src/pictures"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    let write = |name: &str, text: String| {
        let file = folder.join(name).with_extension("svg");
        println!("{} ({:.0} kB)", file.display(), text.len() as f64 / 1e3);
        std::fs::write(file, text)
    };
    let [ball, cube, egg] = ["sphere", "cubic", "ellip-obst"].map(regrasp::load);
    let (ball, cube, egg) = (ball?, cube?, egg?);
    let sphere = Example::solve(&ball, 0)?;
    write("sphere-strip", motions::strip(&sphere, 8, 4))?;
    write("timeline", charts::timeline(&sphere)?)?;
    write("transfer", motions::transfer(&sphere)?)?;
    let cubic = Example::solve(&cube, 1)?;
    write("regrasp", motions::regrasp(&cubic)?)?;
    write("offset", charts::offset(&cubic)?)?;
    let ellipsoid = Example::solve(&egg, 5)?;
    write("lift", motions::liftable(&ellipsoid)?)?;
    write("slide", motions::slide_and_roll(&ellipsoid)?)?;
    write("graph", charts::graph(&ellipsoid))?;
    let explored = components::problems()?;
    components::table(&explored)?;
    write("components", components::picture(&explored, 0)?)?;
    // The hand with the TriFinger's kinematics, three times as large, is left out.
    let suite = SUITE.iter().map(|name| regrasp::load(name)).collect::<Result<Vec<_>, _>>()?;
    let suite = suite.iter().map(|scenario| Example::solve(scenario, 0)).collect::<Result<Vec<_>, _>>()?;
    write("suite", motions::first_grasps(&suite))?;
    Ok(())
}
