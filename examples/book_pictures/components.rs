//! Components of GS_n: Algorithm 2 by itself, without start, goal or Algorithm 3.

use regrasp::api::{
    CallError, Configuration, Context, FingerSet, NodeId, Path, PoseRequest, Target, Task, Vec3,
    angle_between,
};
use regrasp::run::Setup;
use regrasp::run::scenario::Scenario;
use std::error::Error;

/// How many nodes a picture has: about as many as the paper's graphs (23 to 65).
pub const NODES: usize = 60;
/// How many seeds the table has.
const SEEDS: u64 = 20;

/// What Algorithm 2 made: nodes, the paths that it found, and for each node the first of its component.
pub struct Explored {
    nodes: Vec<Configuration>,
    paths: Vec<(NodeId, NodeId)>,
    component: Vec<usize>,
    /// For each path, at each of its states, how many fingers can be lifted.
    liftable: Vec<Vec<usize>>,
}

impl Explored {
    /// Algorithm 2, as often as it takes for so many nodes, all of them kept.
    fn new(setup: &Setup<'_>, seed: u64, count: usize) -> Result<Self, CallError> {
        let (task, mut context) = (setup.task(), Context::seeded(seed));
        let holding = FingerSet::first(4);
        let (nodes, paths, component, liftable) = Default::default();
        let (mut all, mut way) = (Self { nodes, paths, component, liftable }, Path::default());
        while all.nodes.len() < count {
            let sampler = &setup.plugins().sampler;
            let Some(q) = sampler.sample(&task, PoseRequest::Anywhere, holding, &mut context)? else {
                continue;
            };
            let near = all.nearest_of_each(&task, &q);
            let new = all.nodes.len();
            all.nodes.push(q);
            all.component.push(new);
            for other in near {
                let [from, to] = [&all.nodes[other], &all.nodes[new]];
                let target = Target::Grasp(to);
                let planner = &setup.plugins().grasp;
                if planner.connect(&task, from, &target, Some(&mut way), &mut context)?.is_complete() {
                    all.liftable.push(liftable_along(&task, &way, &mut context)?);
                    all.join(other, new);
                }
            }
        }
        Ok(all)
    }

    /// The node nearest to a configuration in each component.
    fn nearest_of_each(&self, task: &Task<'_>, q: &Configuration) -> Vec<usize> {
        let mut best: Vec<Option<(f64, usize)>> = vec![None; self.nodes.len()];
        for (node, other) in self.nodes.iter().enumerate() {
            let distance = distance(other, q, task.object.mesh.radius());
            let place = &mut best[self.component[node]];
            if place.is_none_or(|(least, _)| distance < least) {
                *place = Some((distance, node));
            }
        }
        best.into_iter().flatten().map(|(_, node)| node).collect()
    }

    fn join(&mut self, a: usize, b: usize) {
        self.paths.push((NodeId(a as u32), NodeId(b as u32)));
        let (kept, gone) = (self.component[a], self.component[b]);
        let (kept, gone) = (kept.min(gone), kept.max(gone));
        self.component.iter_mut().filter(|component| **component == gone).for_each(|c| *c = kept);
    }

    /// The components with their sizes, the largest first.
    fn sizes(&self) -> Vec<(usize, usize)> {
        let mut sizes: Vec<(usize, usize)> = (0..self.nodes.len())
            .map(|first| (first, self.component.iter().filter(|component| **component == first).count()))
            .filter(|(_, size)| *size > 0)
            .collect();
        sizes.sort_by_key(|&(first, size)| (std::cmp::Reverse(size), first));
        sizes
    }
}

/// How many fingers can be lifted at each state of a path.
fn liftable_along(task: &Task<'_>, way: &Path, context: &mut Context<'_>) -> Result<Vec<usize>, CallError> {
    let count = |q: &Configuration| {
        let grasp = task.grasp(q, q.holding());
        Ok(task.stability.liftable(&grasp, 0, context)?.len())
    };
    way.states.iter().map(count).collect()
}

/// How far two grasps lie apart (m): displacement, turn times radius, contacts in the mean.
fn distance(a: &Configuration, b: &Configuration, radius: f64) -> f64 {
    let moved = (a.X_HO.translation.vector - b.X_HO.translation.vector).norm();
    let turned = angle_between(&a.X_HO.rotation, &b.X_HO.rotation) * radius;
    let pairs = a.contacts.iter().zip(b.contacts.iter());
    let apart = pairs.filter_map(|((_, x), (_, y))| Some((x.as_ref()?.p_OC - y.as_ref()?.p_OC).norm()));
    moved + turned + apart.sum::<f64>() / a.contacts.len() as f64
}

/// The problems of the picture: the paper's three, and the third without its bar.
pub fn problems() -> Result<Vec<(&'static str, Scenario)>, Box<dyn Error>> {
    let paper = regrasp::host::preset("paper")?;
    let named = [
        ("ball", "sphere", true),
        ("cube", "cubic", true),
        ("ellipsoid, no bar", "ellip-obst", false),
        ("ellipsoid and bar", "ellip-obst", true),
    ];
    let load = |(title, name, obstacles): (&'static str, &str, bool)| {
        let mut scenario = regrasp::load(name)?;
        paper.apply(&mut scenario.choices);
        if !obstacles {
            scenario.problem.obstacle.clear();
        }
        Ok((title, scenario))
    };
    named.into_iter().map(load).collect()
}

/// Prints how many components GS_n has and how large the largest is, and how often three fingers or more can
/// be lifted on its paths, over the seeds, as rows in Markdown.
pub fn table(problems: &[(&str, Scenario)]) -> Result<(), Box<dyn Error>> {
    println!("| | components | nodes in the largest | states where three can be lifted | paths, all along |");
    println!("|---|--:|--:|--:|--:|");
    for (title, scenario) in problems {
        let setup = regrasp::setup(scenario)?;
        let (mut counts, mut shares) = (Vec::new(), Vec::new());
        let mut paths: Vec<Vec<usize>> = Vec::new();
        for seed in 0..SEEDS {
            let explored = Explored::new(&setup, seed, NODES)?;
            let sizes = explored.sizes();
            paths.extend(explored.liftable);
            counts.push(sizes.len());
            shares.push((1e2 * sizes[0].1 as f64 / NODES as f64).round() as usize);
        }
        let spread = |mut values: Vec<usize>| {
            values.sort_unstable();
            let (low, high) = (values[values.len() / 2 - 1], values[values.len() / 2]);
            let median = 0.5 * (low + high) as f64;
            (median, values[0], values[values.len() - 1])
        };
        let ((count, few, many), (share, least, most)) = (spread(counts), spread(shares));
        let percent = |part: usize, whole: usize| (1e2 * part as f64 / whole as f64).round();
        let three = |states: &&usize| **states >= 3;
        let states: usize = paths.iter().map(Vec::len).sum();
        let at = percent(paths.iter().flatten().filter(three).count(), states);
        let along = percent(paths.iter().filter(|path| path.iter().all(|n| *n >= 3)).count(), paths.len());
        println!(
            "| {title} | {count} ({few} to {many}) | {share} % ({least} to {most} %) | {at} % | {along} % |"
        );
    }
    Ok(())
}

/// Colours of components, the largest first; what stands alone is white.
const COLOURS: [&str; 6] = ["#2563a8", "#c8402c", "#2f7d4f", "#b8860b", "#7a4fa3", "#3a9aa8"];
/// The side of a panel (px).
const SIDE: f64 = 250.0;

/// The four problems side by side: nodes over SO(3), coloured by component, with the paths that join them.
pub fn picture(problems: &[(&str, Scenario)], seed: u64) -> Result<String, Box<dyn Error>> {
    let height = SIDE + 40.0;
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {:.0} {height:.0}\" \
            font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        SIDE * problems.len() as f64
    );
    for (k, (title, scenario)) in problems.iter().enumerate() {
        let explored = Explored::new(&regrasp::setup(scenario)?, seed, NODES)?;
        let sizes = explored.sizes();
        let said = format!("{title}: {} components, largest {}", sizes.len(), sizes[0].1);
        let left = SIDE * k as f64;
        text += &format!(
            "<g transform=\"translate({:.0} {:.0})\">\n\
             <text y=\"{:.0}\" text-anchor=\"middle\">{said}</text>\n",
            left + 0.5 * SIDE,
            0.5 * SIDE + 5.0,
            0.5 * SIDE + 22.0
        );
        text += &panel(&explored, &sizes);
        text += "</g>\n";
    }
    Ok(text + "</svg>\n")
}

/// One panel about its middle: the ball of rotation vectors, seen a little from above.
fn panel(explored: &Explored, sizes: &[(usize, usize)]) -> String {
    let scale = 0.46 * SIDE / std::f64::consts::PI;
    let (sin, cos) = 0.4_f64.sin_cos();
    let vector = |node: usize| explored.nodes[node].X_HO.rotation.scaled_axis();
    let place = |r: Vec3| (scale * r.x, -scale * (cos * r.z + sin * r.y));
    let colour = |node: usize| {
        let rank = sizes.iter().position(|(first, _)| *first == explored.component[node]).unwrap_or(0);
        if sizes[rank].1 == 1 { "white" } else { COLOURS[rank.min(COLOURS.len() - 1)] }
    };
    let mut text =
        format!("<circle r=\"{:.1}\" fill=\"#f6f8fb\" stroke=\"#c5cad3\"/>\n", scale * std::f64::consts::PI);
    for &(a, b) in &explored.paths {
        let [a, b] = [a.0 as usize, b.0 as usize];
        // A way through the ball's surface comes in again on the other side: no straight line shows it.
        let faint = (vector(a) - vector(b)).norm() > std::f64::consts::PI;
        let ((x1, y1), (x2, y2)) = (place(vector(a)), place(vector(b)));
        text += &format!(
            "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"{}\" stroke-opacity=\"{}\"/>\n",
            colour(a),
            if faint { 0.15 } else { 0.6 }
        );
    }
    for node in 0..explored.nodes.len() {
        let (x, y) = place(vector(node));
        text += &format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{}\" stroke=\"#26374d\"/>\n",
            colour(node)
        );
    }
    text
}
