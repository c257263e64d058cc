//! Several pictures as one SVG file, in rows, each with a caption.

use super::{Bounds, Picture, STYLE};
use std::fmt::Write;

/// Room about a picture (mm).
const ROOM: f64 = 10.0;
/// Size of the captions' letters: a part of the sheet's width, which is what it is scaled to ...
const LETTERS: f64 = 0.018;
/// ... and at least this (mm).
const SMALLEST_LETTERS: f64 = 9.0;

/// Pictures with their captions as one SVG file, `columns` in a row; `&`, `<` and `>` in captions are
/// escaped. All are drawn to one scale.
pub fn sheet(frames: &[(Picture, String)], columns: usize) -> String {
    let columns = columns.clamp(1, frames.len().max(1));
    let bounds = frames.iter().fold(Bounds::NOTHING, |all, (picture, _)| all.union(picture.bounds()));
    let width = bounds.size()[0] + 2.0 * ROOM;
    let letters = (LETTERS * columns as f64 * width).max(SMALLEST_LETTERS);
    let above = letters + 0.7 * ROOM;
    let height = bounds.size()[1] + above + ROOM;
    let rows = frames.len().div_ceil(columns);
    let (all_width, all_height) = (columns as f64 * width, rows as f64 * height);
    let mut text = format!(
        "<svg font-family=\"sans-serif\" font-size=\"{letters:.1}\" text-anchor=\"middle\" \
            xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {all_width:.0} \
            {all_height:.0}\">\n<style>{STYLE}</style>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (k, (picture, caption)) in frames.iter().enumerate() {
        let (left, top) = ((k % columns) as f64 * width, (k / columns) as f64 * height);
        let (x, y) = (left + ROOM - bounds.low[0], top + above - bounds.low[1]);
        let (middle, line) = (left + width / 2.0, top + letters + 0.3 * ROOM);
        let caption = caption.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let elements = picture.elements();
        write!(
            text,
            "<g transform=\"translate({x:.1} {y:.1})\">\n{elements}</g>\n<text x=\"{middle:.1}\" \
                y=\"{line:.1}\">{caption}</text>\n"
        )
        .expect("a text takes everything");
    }
    text + "</svg>\n"
}
