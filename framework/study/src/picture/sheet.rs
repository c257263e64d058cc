//! Several pictures as one SVG file, in rows, each with a caption.

use super::{Bounds, Picture, STYLE};
use std::fmt::Write;

/// Room about a picture, and above it for its caption (mm).
const ROOM: (f64, f64) = (10.0, 16.0);

/// Pictures with their captions as one SVG file, `columns` in a row; `&`, `<` and `>` in captions are escaped. All are drawn to one scale.
pub fn sheet(frames: &[(Picture, String)], columns: usize) -> String {
    let columns = columns.clamp(1, frames.len().max(1));
    let bounds = frames.iter().fold(Bounds::NOTHING, |all, (picture, _)| all.union(picture.bounds()));
    let (width, height) = (bounds.size()[0] + 2.0 * ROOM.0, bounds.size()[1] + ROOM.0 + ROOM.1);
    let rows = frames.len().div_ceil(columns);
    let (all_width, all_height) = (columns as f64 * width, rows as f64 * height);
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {all_width:.0} {all_height:.0}\">\n<style>{STYLE}</style>\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (k, (picture, caption)) in frames.iter().enumerate() {
        let (left, top) = ((k % columns) as f64 * width, (k / columns) as f64 * height);
        let (x, y) = (left + ROOM.0 - bounds.low[0], top + ROOM.1 - bounds.low[1]);
        let (middle, line) = (left + width / 2.0, top + 12.0);
        let caption = caption.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let (elements, font) =
            (picture.elements(), "font-family=\"sans-serif\" font-size=\"9\" text-anchor=\"middle\"");
        write!(
            text,
            "<g transform=\"translate({x:.1} {y:.1})\">\n{elements}</g>\n<text x=\"{middle:.1}\" y=\"{line:.1}\" {font}>{caption}</text>\n"
        )
        .expect("a text takes everything");
    }
    text + "</svg>\n"
}
