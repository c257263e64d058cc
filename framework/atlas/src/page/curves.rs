//! Curves: shares and regrasps over size, shares over friction; a line for each hand.

use super::axis::Frame;
use super::in_words;
use crate::text::escape;
use crate::{AtlasHand, Attempt, Cell, Shape, Share, Summary, Wish};
use std::fmt::Write;

/// A mark: where, how high, between what, and in words.
struct Point {
    x: f64,
    y: f64,
    ends: Option<[f64; 2]>,
    words: String,
}

/// Hands, cells and what they come to.
pub(super) struct Curves<'a> {
    pub hands: &'a [AtlasHand],
    pub cells: &'a [Cell],
    pub summary: &'a Summary,
}

impl Curves<'_> {
    /// Two charts for each shape, friction and mass: shares and regrasps over size.
    pub fn over_size(&self, wish: &Wish) -> String {
        let mut text = String::from("<section>\n<h2>Over size</h2>\n");
        text += &self.key();
        for &shape in &wish.shapes {
            for &friction in &wish.frictions {
                for mass in masses(wish) {
                    let is_in = |cell: &&Cell| {
                        let member = &cell.member;
                        (member.shape, member.friction, member.mass) == (shape, friction, mass)
                    };
                    let weight = mass.map_or(String::new(), |mass| format!(", {mass} kg"));
                    let title = format!("{}, friction {friction}{weight}", shape.name());
                    text += &self.pair(&title, &is_in);
                }
            }
        }
        text + "</section>\n"
    }

    /// Shares and regrasps of the cells for which `is_in` holds.
    fn pair(&self, title: &str, is_in: &dyn Fn(&&Cell) -> bool) -> String {
        let cells: Vec<(&Cell, &crate::CellSummary)> =
            self.cells.iter().zip(&self.summary.cells).filter(|(cell, _)| is_in(cell)).collect();
        let of_hand = |hand: &AtlasHand, point: &dyn Fn(&Cell, &crate::CellSummary) -> Option<Point>| {
            let own = cells.iter().filter(|(cell, _)| cell.member.hand == hand.name);
            own.filter_map(|(cell, of)| point(cell, of)).collect::<Vec<Point>>()
        };
        let shares: Vec<_> = self.hands.iter().map(|hand| of_hand(hand, &share_point)).collect();
        let counts: Vec<_> = self.hands.iter().map(|hand| of_hand(hand, &regrasp_point)).collect();
        let ticks = distinct(cells.iter().map(|(cell, _)| cell.member.size_mm()));
        let size = "size (mm)";
        format!(
            "<h3>{0}</h3>\n<div class=\"charts\">\n{1}{2}</div>\n",
            escape(title),
            self.chart(&ticks, size, "orientations reached (%)", Some(100.0), &shares),
            self.chart(&ticks, size, "regrasps of a plan, median", None, &counts),
        )
    }

    /// Shares over friction, of all sizes and masses together: one chart for each shape; nothing where there
    /// is one friction alone.
    pub fn over_friction(&self, wish: &Wish) -> String {
        if wish.frictions.len() < 2 {
            return String::new();
        }
        let mut text = String::from(
            "<section>\n<h2>Over friction</h2>\n<p>All sizes and masses together; a hand that cannot hold an \
             object reaches nothing with it.</p>\n",
        );
        text += &self.key();
        text += "<div class=\"charts\">\n";
        for &shape in &wish.shapes {
            let lines: Vec<_> = self.hands.iter().map(|hand| self.by_friction(hand, shape, wish)).collect();
            let share = format!("orientations reached (%), {}", shape.name());
            text += &self.chart(&wish.frictions, "coefficient of friction", &share, Some(100.0), &lines);
        }
        text + "</div>\n</section>\n"
    }

    fn by_friction(&self, hand: &AtlasHand, shape: Shape, wish: &Wish) -> Vec<Point> {
        let point = |&friction: &f64| {
            let is_in = |cell: &&Cell| {
                let member = &cell.member;
                member.hand == hand.name && member.shape == shape && member.friction == friction
            };
            let cells: Vec<&Cell> = self.cells.iter().filter(is_in).collect();
            // What cannot be held counts as so many goals that were not reached.
            let lost = cells.iter().filter(|cell| cell.attempts.is_empty()).count() * wish.goals;
            let attempts = cells.iter().flat_map(|cell| &cell.attempts);
            let share = with_lost(attempts, lost);
            share_mark(friction, &share, format!("{}, friction {friction}", hand.name))
        };
        wish.frictions.iter().filter_map(point).collect()
    }

    /// One chart, a line for each hand.
    fn chart(&self, ticks: &[f64], x: &str, y: &str, top: Option<f64>, lines: &[Vec<Point>]) -> String {
        let highest = lines.iter().flatten().map(|point| point.y).fold(1.0, f64::max);
        let ends = [ticks.first(), ticks.last()].map(|end| end.copied().unwrap_or_default());
        let frame = Frame { x: ends, top: top.unwrap_or(highest * 1.1), names: [x.to_owned(), y.to_owned()] };
        let drawn = lines.iter().enumerate().map(|(k, points)| line(&frame, k, points)).collect::<String>();
        frame.picture(
            ticks,
            &format!("{y} over {x}, a line for each hand; the table below has the numbers"),
            &drawn,
        )
    }

    /// Which line is whose.
    fn key(&self) -> String {
        let entry = |(k, hand): (usize, &AtlasHand)| {
            format!(
                "<span><svg viewBox=\"-12 -8 24 16\" aria-hidden=\"true\">\
                 <line class=\"curve c{0}\" x1=\"-12\" y1=\"0\" x2=\"12\" y2=\"0\"/>{1}</svg>{2}</span>",
                k % COLOURS,
                mark(k, 0.0, 0.0, ""),
                escape(&hand.name)
            )
        };
        let entries: String = self.hands.iter().enumerate().map(entry).collect();
        format!("<p class=\"key\">{entries}</p>\n")
    }
}

/// Colours of lines; then they come again, with other marks.
const COLOURS: usize = 7;

fn masses(wish: &Wish) -> Vec<Option<f64>> {
    match wish.masses.is_empty() {
        true => vec![None],
        false => wish.masses.iter().copied().map(Some).collect(),
    }
}

fn distinct(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

/// The share of these attempts and of so many that were lost before they began.
fn with_lost<'a>(attempts: impl Iterator<Item = &'a Attempt>, lost: usize) -> Share {
    let share = Share::of(attempts);
    Share::counted(share.reached, share.of + lost)
}

fn share_point(cell: &Cell, of: &crate::CellSummary) -> Option<Point> {
    let (size, hand) = (cell.member.size_mm(), &cell.member.hand);
    match &cell.cause {
        // Not held: nothing is reached.
        Some(_) => {
            Some(Point { x: size, y: 0.0, ends: None, words: format!("{hand}, {size} mm: cannot hold it") })
        }
        None => share_mark(size, &of.share, format!("{hand}, {size} mm")),
    }
}

fn share_mark(x: f64, share: &Share, name: String) -> Option<Point> {
    let estimate = share.estimate?.map(|share| 100.0 * share);
    let words = format!("{name}: {}", in_words(share));
    Some(Point { x, y: estimate.value, ends: Some([estimate.low, estimate.high]), words })
}

fn regrasp_point(cell: &Cell, of: &crate::CellSummary) -> Option<Point> {
    let y = of.regrasps_median?;
    let (hand, size) = (&cell.member.hand, cell.member.size_mm());
    let plans = of.share.reached;
    let words = format!("{hand}, {size} mm: {y} regrasps, median of {plans} plans");
    Some(Point { x: size, y, ends: None, words })
}

/// A line with its marks; marks of different hands stand a little apart.
fn line(frame: &Frame, k: usize, points: &[Point]) -> String {
    let aside = (k as f64 % 9.0 - 4.0) * 1.6;
    let place = |point: &Point| (frame.x_at(point.x) + aside, frame.y_at(point.y));
    let path: Vec<String> = points.iter().map(place).map(|(x, y)| format!("{x:.1},{y:.1}")).collect();
    let mut text = format!("<polyline class=\"curve c{}\" points=\"{}\"/>\n", k % COLOURS, path.join(" "));
    for point in points {
        let (x, y) = place(point);
        if let Some([low, high]) = point.ends {
            let [low, high] = [low, high].map(|end| frame.y_at(end));
            let _ = write!(
                text,
                "<line class=\"bar c{}\" x1=\"{x:.1}\" y1=\"{low:.1}\" x2=\"{x:.1}\" y2=\"{high:.1}\"/>",
                k % COLOURS
            );
        }
        text += &mark(k, x, y, &point.words);
        text.push('\n');
    }
    text
}

/// A hand's mark: its form tells hands apart where colours do not.
fn mark(k: usize, x: f64, y: f64, words: &str) -> String {
    let form = match k % 4 {
        0 => "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z",
        1 => "M-3.600 -3.600h7.200v7.200h-7.200z",
        2 => "M0 -4.800L4.600 3.400H-4.600z",
        _ => "M0 -5L5 0L0 5L-5 0z",
    };
    let title = if words.is_empty() { String::new() } else { format!("<title>{}</title>", escape(words)) };
    let hollow = if k / 4 % 2 == 1 { " hollow" } else { "" };
    format!(
        "<path class=\"mark c{}{hollow}\" transform=\"translate({x:.1} {y:.1})\" d=\"{form}\">{title}</path>",
        k % COLOURS
    )
}
