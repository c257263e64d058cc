//! Charts: a plan over time, the offset surface, the manipulation graph.

use crate::motions::turn_deg;
use crate::problem::Example;
use regrasp::api::{Configuration, Contact, Context, EdgeKind, FingerIndex, Hand, NodeId, SurfacePath, Vec3};
use regrasp::planner::{End, Fate};
use std::error::Error;
use std::fmt::Write;

/// Begins a drawing of this size (px).
fn paper(width: f64, height: f64) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" \
            font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    )
}

fn word(text: &mut String, (x, y): (f64, f64), anchor: &str, what: &str) {
    *text += &format!("<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{what}</text>\n");
}

fn line(text: &mut String, points: &[(f64, f64)], style: &str) {
    let path: String = points.iter().map(|(x, y)| format!("{x:.1},{y:.1} ")).collect();
    *text += &format!("<polyline points=\"{}\" fill=\"none\" {style}/>\n", path.trim_end());
}

/// Which finger holds when, how far the object has turned, and the certified margin, over time.
pub fn timeline(example: &Example<'_>) -> Result<String, Box<dyn Error>> {
    let states = example.states();
    let hand = example.hand();
    let (count, (start, _), (_, end)) = (hand.finger_count(), states[0], states[states.len() - 1]);
    let plan = example.run.plan.as_ref().ok_or("no plan")?;
    let margins = regrasp::verify::series(plan)?.into_iter().flatten().map(|state| state.margin);
    let margins: Vec<f64> = margins.map(Option::unwrap_or_default).collect();
    let x = |time: f64| 90.0 + 600.0 * time / end;
    let mut text = paper(710.0, 290.0);
    for (finger, row) in (0..count).map(|i| (FingerIndex(i as u8), 20.0 + 20.0 * i as f64)) {
        word(&mut text, (82.0, row + 11.0), "end", &hand.finger(finger).name);
        // Runs of states in which the finger holds, or does not.
        let holds = |pair: &[(&Configuration, f64)]| pair.iter().all(|(q, _)| q.contacts[finger].is_some());
        let moments: Vec<_> = states.windows(2).filter(|pair| pair[1].1 > pair[0].1).collect();
        for run in moments.chunk_by(|a, b| holds(a) == holds(b)) {
            let (from, to) = (x(run[0][0].1), x(run[run.len() - 1][1].1));
            let fill = if holds(run[0]) { "#26374d" } else { "#c8402c" };
            let width = to - from;
            writeln!(
                text,
                "<rect x=\"{from:.1}\" y=\"{row}\" width=\"{width:.1}\" height=\"14\" fill=\"{fill}\"/>"
            )?;
        }
    }
    let below = 20.0 + 20.0 * count as f64 + 20.0;
    let most = margins.iter().copied().fold(0.0, f64::max);
    let turned: Vec<f64> = states.iter().map(|(q, _)| turn_deg(&start.X_HO, &q.X_HO)).collect();
    let largest = turned.iter().copied().fold(0.0, f64::max);
    for (name, unit, values, most, top) in
        [("turned", "°", &turned, largest, below), ("margin", "", &margins, most, below + 75.0)]
    {
        let y = |value: f64| top + 50.0 * (1.0 - value / most);
        word(&mut text, (82.0, top + 28.0), "end", name);
        word(
            &mut text,
            (82.0, y(most) + 4.0),
            "end",
            &if unit.is_empty() { format!("{most:.2}") } else { format!("{most:.0}{unit}") },
        );
        word(&mut text, (82.0, y(0.0) + 4.0), "end", "0");
        line(&mut text, &[(x(0.0), y(0.0)), (x(end), y(0.0))], "stroke=\"#c5cad3\"");
        let points: Vec<_> =
            states.iter().zip(values).map(|((_, time), value)| (x(*time), y(*value))).collect();
        line(&mut text, &points, "stroke=\"#2563a8\" stroke-width=\"1.6\"");
    }
    for second in 0..=end as u32 {
        word(&mut text, (x(f64::from(second)), below + 150.0), "middle", &format!("{second} s"));
    }
    Ok(text + "</svg>\n")
}

/// The cube from above: a contact's way from one face to the next, and the way of the fingertip's centre over
/// it.
pub fn offset(example: &Example<'_>) -> Result<String, Box<dyn Error>> {
    let radius = example.hand().fingertip_radius();
    let half = 0.5 * 0.045;
    let touch = |p: Vec3, n: Vec3| -> Contact {
        example.setup.plugins().surface.project(&(p + n * radius), None).contact
    };
    let from = touch(Vec3::new(half, -0.008, 0.004), Vec3::x());
    let to = touch(Vec3::new(-0.006, half, 0.004), Vec3::y());
    let mut way = SurfacePath::default();
    if !example.setup.plugins().surface.geodesic(&from, &to, &mut way, &mut Context::seeded(0))? {
        return Err("the faces are not joined".into());
    }
    let px = |p: &Vec3| (260.0 + 5e3 * p.x, 215.0 - 5e3 * p.y);
    let mut text = paper(640.0, 345.0);
    let corners =
        [(-half, -half), (half, -half), (half, half), (-half, half)].map(|(x, y)| px(&Vec3::new(x, y, 0.0)));
    writeln!(
        text,
        "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.1}\" height=\"{:.1}\" fill=\"#f4e8c8\" \
         stroke=\"#c9b37a\"/>",
        corners[3].0,
        corners[3].1,
        corners[2].0 - corners[3].0,
        corners[0].1 - corners[3].1
    )?;
    let moments: Vec<Contact> = (0..=60).map(|k| way.at(f64::from(k) / 60.0)).collect();
    let centers: Vec<_> = moments.iter().map(|contact| px(&contact.tip_center(radius))).collect();
    for contact in moments.iter().step_by(6) {
        let (foot, tip) = (px(&contact.p_OC), px(&contact.tip_center(radius)));
        line(&mut text, &[foot, tip], "stroke=\"#9aa5b4\" stroke-width=\"1\"");
    }
    for contact in [&moments[0], &moments[moments.len() - 1]] {
        let (x, y) = px(&contact.tip_center(radius));
        writeln!(
            text,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{:.1}\" fill=\"#26374d\" fill-opacity=\"0.25\" \
             stroke=\"#26374d\"/>",
            5e3 * radius
        )?;
    }
    line(&mut text, &centers, "stroke=\"#2563a8\" stroke-width=\"2\"");
    line(
        &mut text,
        &moments.iter().map(|contact| px(&contact.p_OC)).collect::<Vec<_>>(),
        "stroke=\"#b3261e\" stroke-width=\"2.5\"",
    );
    word(&mut text, (260.0, 220.0), "middle", "cube");
    word(&mut text, (400.0, 55.0), "start", "fingertip's centre");
    word(&mut text, (260.0, 120.0), "middle", "contact");
    Ok(text + "</svg>\n")
}

/// How an edge is drawn.
fn look(kind: EdgeKind, fate: Fate) -> &'static str {
    match (fate, kind) {
        (Fate::Used, _) => "stroke=\"#c8402c\" stroke-width=\"3\"",
        (Fate::Executable, _) => "stroke=\"#2f7d4f\" stroke-width=\"1.5\"",
        (Fate::Failed, EdgeKind::TransferRegrasp) => {
            "stroke=\"#9aa5b4\" stroke-width=\"0.6\" stroke-dasharray=\"1 3\""
        }
        (Fate::Failed, EdgeKind::Grasp) => "stroke=\"#c9b37a\" stroke-width=\"0.5\" stroke-dasharray=\"1 4\"",
        (Fate::Valid | Fate::Unchecked, _) => "stroke=\"#2563a8\" stroke-width=\"1.5\"",
    }
}

/// The manipulation graph, each node at its angle from the start and from the goal.
pub fn graph(example: &Example<'_>) -> String {
    let (graph, mut text) = (example.graph(), paper(520.0, 520.0));
    let nodes = graph.nodes();
    let X_HO = |node: NodeId| &nodes[node.0 as usize].X_HO;
    let end_of = |node| graph.ends().iter().find(|(_, other)| *other == node).map(|(end, _)| *end);
    let pose_of = |wanted| graph.ends().iter().find(|(end, _)| *end == wanted).map(|(_, node)| X_HO(*node));
    let (Some(start), Some(goal)) = (pose_of(End::Start), pose_of(End::Goal(0))) else { return text };
    let axes = |from_start: f64, from_goal: f64| (70.0 + 3.0 * from_start, 460.0 - 3.0 * from_goal);
    let place = |node: NodeId| {
        let X_HO = X_HO(node);
        // Grasps at one pose stand side by side.
        let same = nodes[..node.0 as usize].iter().filter(|other| other.X_HO == *X_HO).count() as f64;
        let (x, y) = axes(turn_deg(start, X_HO), turn_deg(goal, X_HO));
        (x + 15.0 * same, y - 9.0 * same)
    };
    line(&mut text, &[axes(0.0, 145.0), axes(0.0, 0.0), axes(145.0, 0.0)], "stroke=\"#c5cad3\"");
    for angle in [0.0, 45.0, 90.0, 135.0] {
        let ((x, bottom), (left, y)) = (axes(angle, 0.0), axes(0.0, angle));
        word(&mut text, (x, bottom + 20.0), "middle", &format!("{angle}°"));
        word(&mut text, (left - 10.0, y + 4.0), "end", &format!("{angle}°"));
    }
    for edge in graph.edges() {
        line(&mut text, &[place(edge.from), place(edge.to)], look(edge.kind, edge.fate));
    }
    for node in (0..nodes.len() as u32).map(NodeId) {
        let (x, y) = place(node);
        let fill = match end_of(node) {
            Some(End::Start) => "#26374d",
            Some(End::Goal(_)) => "#c8402c",
            None => "white",
        };
        text +=
            &format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"5\" fill=\"{fill}\" stroke=\"#26374d\"/>\n");
    }
    word(&mut text, (290.0, 505.0), "middle", "turned away from the start");
    text +=
        "<text transform=\"translate(22 240) rotate(-90)\" text-anchor=\"middle\">left to the goal</text>\n";
    text + "</svg>\n"
}
