//! Draws a plan as a film strip: hand and object at the ends of its segments, as an SVG picture.
//!
//! `cargo run --release --example film_strip [SCENARIO [FILE.svg]]`
//!
//! A finger that holds the object has a dark tip, a lifted one a red tip. The cross painted on the object shows how it turns.

use regrasp::api::{Configuration, Hand, Vec3};
use regrasp::host::Registry;
use regrasp::planner::{Clock, Silent};
use regrasp::study::scenario::{self, Scenario};
use regrasp::study::{NeverStops, RunOptions, Setup};
use regrasp::world::LinkFrame;
use std::error::Error;
use std::fmt::Write;

struct NoClock;
impl Clock for NoClock {
    fn seconds(&self) -> f64 {
        0.0
    }
}

/// Width and height of a frame, in units of the picture.
const FRAME: (f64, f64) = (200.0, 200.0);
/// Units of the picture for one metre.
const SCALE: f64 = 900.0;

/// Orthographic view from the front, 35° from above: the point on the paper and its depth (larger is nearer).
fn view(p_HP: &Vec3) -> (f64, f64, f64) {
    let (sin, cos) = 35_f64.to_radians().sin_cos();
    let (right, up, near) = (p_HP.x, p_HP.y * sin + p_HP.z * cos, -p_HP.y * cos + p_HP.z * sin);
    (FRAME.0 / 2.0 + SCALE * right, 0.8 * FRAME.1 - SCALE * up, near)
}

/// A thing to draw with its depth.
type Stroke = (f64, String);

fn line(points: &[Vec3], style: &str) -> Stroke {
    let seen: Vec<_> = points.iter().map(view).collect();
    let path: String = seen.iter().map(|(x, y, _)| format!("{x:.1},{y:.1} ")).collect();
    let depth = seen.iter().map(|seen| seen.2).sum::<f64>() / seen.len() as f64;
    (depth, format!("<polyline points=\"{}\" {style}/>", path.trim_end()))
}

fn ball(center: &Vec3, radius: f64, fill: &str) -> Stroke {
    let (x, y, depth) = view(center);
    (depth, format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.1}\" fill=\"{fill}\"/>", SCALE * radius))
}

/// The object's outline, which is that of its convex hull, and on it the facets about two of its own planes, painted.
fn object(scenario: &Scenario, q: &Configuration, strokes: &mut Vec<Stroke>) {
    let mesh = &scenario.object.mesh;
    let in_hand = |p: Vec3| (q.X_HO * nalgebra::Point3::from(p)).coords;
    let depth = view(&q.X_HO.translation.vector).2;
    let mut outline = hull(mesh.vertices().iter().map(|&p| in_hand(p)).collect());
    outline.extend(outline.first().copied());
    strokes.push((depth, line(&outline, "fill=\"#ecdcb4\" stroke=\"#b09a62\"").1));
    for facet in 0..mesh.facets().len() as u32 {
        let corners = mesh.corners(facet);
        let middle = corners.iter().sum::<Vec3>() / 3.0;
        let painted = middle.x.abs() < 0.003 || middle.y.abs() < 0.003 && middle.x > 0.0;
        let corners = corners.map(in_hand);
        if painted && side(&corners[0], &corners[1], &corners[2]) < 0.0 {
            strokes.push((depth + 1e-9, line(&corners, "fill=\"#c0763a\"").1));
        }
    }
}

/// Which side of the line from `a` to `b` the point `c` is seen on.
fn side(a: &Vec3, b: &Vec3, c: &Vec3) -> f64 {
    let [a, b, c] = [a, b, c].map(view);
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// The convex hull of points as they are seen (A. M. Andrew's monotone chain, IPL 1979).
fn hull(mut points: Vec<Vec3>) -> Vec<Vec3> {
    points.sort_by(|a, b| view(a).0.total_cmp(&view(b).0).then(view(a).1.total_cmp(&view(b).1)));
    let mut around = Vec::new();
    for _ in 0..2 {
        let mut chain: Vec<Vec3> = Vec::new();
        for point in &points {
            while chain.len() > 1 && side(&chain[chain.len() - 2], &chain[chain.len() - 1], point) <= 0.0 {
                chain.pop();
            }
            chain.push(*point);
        }
        chain.pop();
        around.extend(chain);
        points.reverse();
    }
    around
}

fn fingers(scenario: &Scenario, q: &Configuration, strokes: &mut Vec<Stroke>) {
    let hand = &scenario.hand;
    for (finger, joints) in q.joints.iter() {
        let mut room = LinkFrame::room();
        let frames = hand.link_frames(finger, joints, &mut room);
        let tip = hand.tip_center(finger, joints);
        let points: Vec<Vec3> = frames.iter().map(|frame| frame.p_HL).chain([tip]).collect();
        let style = "fill=\"none\" stroke=\"#7a8ea6\" stroke-width=\"11\" stroke-linecap=\"round\" stroke-opacity=\"0.85\"";
        strokes.extend(points.windows(2).map(|ends| line(ends, style)));
        let fill = if q.contacts[finger].is_some() { "#26374d" } else { "#c8402c" };
        // A tip is seen in front of its own link, which ends in it.
        let (depth, tip) = ball(&tip, hand.fingertip_radius(), fill);
        let link = strokes.last().map_or(depth, |link| link.0);
        strokes.push((depth.max(link + 1e-9), tip));
    }
}

fn frame(scenario: &Scenario, q: &Configuration, caption: &str) -> Result<String, std::fmt::Error> {
    let mut strokes = Vec::new();
    object(scenario, q, &mut strokes);
    fingers(scenario, q, &mut strokes);
    strokes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut text = String::new();
    strokes.iter().try_for_each(|(_, stroke)| writeln!(text, "{stroke}"))?;
    let (x, y) = (FRAME.0 / 2.0, 18.0);
    writeln!(
        text,
        "<text x=\"{x}\" y=\"{y}\" font-family=\"sans-serif\" font-size=\"12\" text-anchor=\"middle\">{caption}</text>"
    )?;
    Ok(text)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let name = words.next().unwrap_or("sphere".into());
    let file = words.next().unwrap_or(format!("{name}.svg"));
    let registry = Registry::linked()?;
    let scenario = scenario::load(&name, &registry)?;
    let setup = Setup::new(&scenario, &scenario.choices, &registry)?;
    let options = RunOptions { seed: 0, threads: 1, stop: &NeverStops, clock: &NoClock, progress: &Silent };
    let run = setup.run(&options)?;
    let states: Vec<_> = run
        .outcome
        .motion
        .segments
        .iter()
        .flat_map(|segment| segment.states.iter().zip(&segment.times))
        .collect();
    let (columns, rows) = (4, 2);
    let mut body = String::new();
    for k in 0..columns * rows {
        let (q, time) = states[k * (states.len() - 1) / (columns * rows - 1)];
        let (x, y) = ((k % columns) as f64 * FRAME.0, (k / columns) as f64 * FRAME.1);
        let drawn = frame(&scenario, q, &format!("{time:.1} s"))?;
        write!(body, "<g transform=\"translate({x} {y})\">\n{drawn}</g>\n")?;
    }
    let (width, height) = (columns as f64 * FRAME.0, rows as f64 * FRAME.1);
    let head = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\">");
    std::fs::write(
        &file,
        format!("{head}\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n{body}</svg>\n"),
    )?;
    println!(
        "{file}: {} frames of a motion of {:.1} s",
        columns * rows,
        states.last().map_or(0.0, |(_, time)| **time)
    );
    Ok(())
}
