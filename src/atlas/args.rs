//! What `regrasp atlas` takes.

use super::sizes::sizes;
use crate::numbers::whole;
use crate::work::WorkArgs;
use regrasp::atlas::{Shape, Wish};
use std::path::PathBuf;

/// Map what hands can do with a family of objects: the share of orientations that they reach.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
For each hand, shape, size, friction and mass, start grasps are drawn about the middle of where the hand can \
hold the object. From each start the object is to be turned into an orientation drawn uniformly from all; it \
may end within `--reach` of where it was. An orientation counts as reached if a plan leads there and passes \
the verifier. Shares are lower bounds: a larger `--nodes` finds more. Hands with fewer than four fingers get \
soft fingertips, since hard ones cannot regrasp with three.\n\n\
The folder gets `atlas.html` (the page), `atlas.json`, `cells.csv` (a row for each hand and object), \
`attempts.csv` (a row for each orientation) and `atlas.part` (what is done, member by member): after Ctrl-C \
or a crash the same command goes on from there. The result is the same on any number of threads.\n\n\
Examples:\n  regrasp atlas --hands allegro-like,four-finger --size 20..80mm -o atlas\n  \
regrasp atlas --hands four-finger,my-hand.urdf --shapes cube --size 50mm --friction 0.4,0.6,0.8 -o atlas\n  \
regrasp atlas --hands allegro-like --size 30,50mm --mass 0.05,0.2 --goals 200 --threads 2 -o atlas")]
pub struct AtlasArgs {
    /// Hands, with commas between: names of built-in ones, hand files, URDF or MJCF files.
    #[arg(long, value_name = "HAND,…", value_delimiter = ',', required = true)]
    pub hands: Vec<String>,
    /// Sizes of the objects along their longest axis: `20..80mm` (with `--steps`), `30,50mm`, or `0.05m`.
    #[arg(long, value_name = "A..BMM", default_value = "20..80mm", allow_negative_numbers = true)]
    pub size: String,
    /// How many sizes a range means, 2 to 100.
    #[arg(long, value_name = "N", default_value_t = 7, allow_negative_numbers = true,
          value_parser = whole::<usize, 2, 100>)]
    pub steps: usize,
    /// Shapes: `sphere`, `cube`, `cylinder`, `ellipsoid`, `bar`.
    #[arg(long, value_name = "SHAPE,…", value_delimiter = ',', default_value = "sphere,cube",
          value_parser = shape)]
    pub shapes: Vec<Shape>,
    /// Coefficients of friction, each in 0.01 to 10.
    #[arg(
        long,
        value_name = "MU,…",
        value_delimiter = ',',
        default_value = "0.8",
        allow_negative_numbers = true
    )]
    pub friction: Vec<f64>,
    /// Masses (kg) whose weight all grasps must hold within the joints' efforts, each in 0.0001 to 100; by
    /// default grasps must close, whatever the force.
    #[arg(long, value_name = "KG,…", value_delimiter = ',', allow_negative_numbers = true)]
    pub mass: Vec<f64>,
    /// Orientations for each hand and object, 1 to 100000. By default 40: a share of a half is then known to
    /// 15 % either way.
    #[arg(long, value_name = "N", default_value_t = 40, allow_negative_numbers = true,
          value_parser = whole::<usize, 1, 100_000>)]
    pub goals: usize,
    /// How far (m) the object may be from where it was when it has turned, 0 to 1.
    #[arg(long, value_name = "M", default_value_t = 0.01, allow_negative_numbers = true)]
    pub reach: f64,
    /// Positions that are tried for each orientation, 1 to 100: first where the object was, then others
    /// within the reach.
    #[arg(long, value_name = "N", default_value_t = 3, allow_negative_numbers = true,
          value_parser = whole::<usize, 1, 100>)]
    pub tries: usize,
    /// Nodes that the search for one position may generate, 1 to 10000000.
    #[arg(long, value_name = "N", default_value_t = 10, allow_negative_numbers = true,
          value_parser = whole::<usize, 1, 10_000_000>)]
    pub nodes: usize,
    /// Write the atlas to this folder, or go on with the one that is in it.
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    /// Seed of all random choices.
    #[arg(long, default_value_t = 0, value_name = "N", allow_negative_numbers = true,
          value_parser = whole::<u64, 0, { u64::MAX }>)]
    pub seed: u64,
    #[command(flatten)]
    pub work: WorkArgs,
}

impl AtlasArgs {
    /// What is asked for.
    pub fn wish(&self) -> Result<Wish, String> {
        let mut shapes = self.shapes.clone();
        shapes.sort_unstable();
        shapes.dedup();
        Ok(Wish {
            shapes,
            sizes: sizes(&self.size, self.steps)?,
            frictions: ascending(&self.friction),
            masses: ascending(&self.mass),
            goals: self.goals,
            reach: self.reach,
            tries: self.tries,
            nodes: self.nodes,
            seed: self.seed,
        })
    }
}

/// The numbers in order, each once.
fn ascending(numbers: &[f64]) -> Vec<f64> {
    let mut numbers = numbers.to_vec();
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
    numbers
}

fn shape(text: &str) -> Result<Shape, String> {
    let names = || Shape::ALL.map(Shape::name);
    let found = Shape::ALL.into_iter().find(|shape| shape.name() == text.trim());
    found.ok_or_else(|| {
        let meant = regrasp::api::did_you_mean(&regrasp::api::near(text, names()));
        format!("it must be one of {}; {meant}", names().join(", ")).trim_end_matches("; ").to_owned()
    })
}
