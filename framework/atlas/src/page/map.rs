//! Maps of turns: by the axis, seen from both ends of z, and by the angle.
//!
//! Each half of the sphere of axes is drawn by Lambert's equal-area projection (J. H. Lambert, 1772), so that
//! parts of one area look alike. A part is as dark as the share is high, and has it as a number.

use super::in_words;
use crate::bins::{AROUND, CAP};
use crate::text::escape;
use crate::{ANGLES_DEG, AtlasHand, Bin, Sector, Shape, Summary};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Radius of a disc (user units).
const RADIUS: f64 = 70.0;

/// The maps of all hands, a row for each hand and shape.
pub(super) fn maps(hands: &[AtlasHand], summary: &Summary) -> String {
    let mut text = String::from(
        "<section>\n<h2>Which turns are easy</h2>\n<p>Each disc is half of the sphere of axes, in the hand's \
         frame: on the left the axes on the side of +z, on the right those on the side of -z, x to the right \
         and y upwards in both; the cap in the middle holds the axes about z. A turn by the right hand about \
         the axis; all sizes, frictions and masses together. The number is the share of goals that were \
         reached, in percent; the darker, the more.</p>\n",
    );
    for hand in hands {
        for shape in Shape::ALL {
            let is_in = |bin: &&Bin| bin.hand == hand.name && bin.shape == shape;
            let bins: Vec<&Bin> = summary.bins.iter().filter(is_in).collect();
            if bins.iter().any(|bin| bin.share.of > 0) {
                text += &row(&hand.name, shape, &bins);
            }
        }
    }
    text + "</section>\n"
}

/// A disc pair for each band of angles.
fn row(hand: &str, shape: Shape, bins: &[&Bin]) -> String {
    let mut text = format!("<h3>{}, {}</h3>\n<div class=\"maps\">\n", escape(hand), shape.name());
    for (k, ends) in ANGLES_DEG.windows(2).enumerate() {
        let of_band: Vec<&&Bin> = bins.iter().filter(|bin| bin.band == k).collect();
        let label = format!(
            "{} with {}: shares by axis, turns of {} to {}°",
            escape(hand),
            shape.name(),
            ends[0],
            ends[1]
        );
        let _ = write!(
            text,
            "<figure><svg viewBox=\"-82 -84 316 168\" role=\"img\" aria-label=\"{label}\">\n{}{}</svg>\
             <figcaption>turns of {} to {}°</figcaption></figure>\n",
            disc(&of_band, true, 0.0),
            disc(&of_band, false, 2.0 * RADIUS + 12.0),
            ends[0],
            ends[1]
        );
    }
    text + "</div>\n"
}

fn disc(bins: &[&&Bin], is_up: bool, x: f64) -> String {
    let mut text = format!("<g transform=\"translate({x} 0)\">\n");
    for bin in bins.iter().filter(|bin| bin.at.is_up == is_up) {
        text += &part(bin);
    }
    let side = if is_up { "+z" } else { "-z" };
    let _ = writeln!(
        text,
        "<circle class=\"rim\" r=\"{RADIUS}\"/><text class=\"tick\" x=\"-66\" y=\"-62\">{side}</text></g>"
    );
    text
}

/// One part with its number.
fn part(bin: &Bin) -> String {
    let shape = match bin.at.around {
        None => format!("<circle r=\"{:.2}\"", inner()),
        Some(k) => format!("<path d=\"{}\"", ring(k)),
    };
    let (x, y) = middle(bin.at);
    let (dark, number) = match bin.share.estimate {
        None => ("none".to_owned(), "–".to_owned()),
        Some(share) => (format!("s{:.0}", 10.0 * share.value), format!("{:.0}", 100.0 * share.value)),
    };
    let light =
        if bin.share.estimate.is_some_and(|share| share.value > 0.55) { " class=\"light\"" } else { "" };
    format!(
        "{shape} class=\"part {dark}\"><title>{}: {}</title></{}>\
         <text{light} x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\" aria-hidden=\"true\">{number}</text>\n",
        escape(&bin.sector),
        in_words(&bin.share),
        if bin.at.around.is_none() { "circle" } else { "path" },
        y + 4.0
    )
}

/// The radius of a cap: on an equal-area disc the square of the radius grows as 1 - z.
fn inner() -> f64 {
    RADIUS * (1.0 - CAP).sqrt()
}

/// A sector round the cap, y upwards.
fn ring(k: usize) -> String {
    let [a, b] = [k, k + 1].map(|k| TAU * k as f64 / AROUND as f64);
    let at = |radius: f64, angle: f64| format!("{:.2} {:.2}", radius * angle.cos(), -radius * angle.sin());
    let r = inner();
    format!(
        "M{}L{}A{RADIUS} {RADIUS} 0 0 0 {}L{}A{r:.2} {r:.2} 0 0 1 {}z",
        at(r, a),
        at(RADIUS, a),
        at(RADIUS, b),
        at(r, b),
        at(r, a)
    )
}

fn middle(at: Sector) -> (f64, f64) {
    let Some(k) = at.around else { return (0.0, 0.0) };
    let (radius, angle) = (0.5 * (inner() + RADIUS) + 2.0, TAU * (k as f64 + 0.5) / AROUND as f64);
    (radius * angle.cos(), -radius * angle.sin())
}
