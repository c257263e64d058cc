//! A chart's frame: two axes with ticks, numbers and units.

use std::fmt::Write;

/// Where a chart lies in its picture, and what its ends are.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    /// Ends of the horizontal axis, in its unit.
    pub x: [f64; 2],
    /// Top of the vertical axis, which begins at 0.
    pub top: f64,
    /// What the axes show, with units.
    pub names: [String; 2],
}

/// The picture (user units).
const SIZE: [f64; 2] = [460.0, 270.0];
/// Room left, right, above and below of the axes.
const ROOM: [f64; 4] = [48.0, 14.0, 12.0, 42.0];
/// The most ticks of an axis.
const MOST_TICKS: usize = 9;

impl Frame {
    /// Where a value lies.
    pub fn x_at(&self, value: f64) -> f64 {
        let [low, high] = self.x;
        let share = if high > low { (value - low) / (high - low) } else { 0.5 };
        ROOM[0] + 14.0 + share * (SIZE[0] - ROOM[0] - ROOM[1] - 28.0)
    }

    /// Where a value lies.
    pub fn y_at(&self, value: f64) -> f64 {
        let share = (value / self.top).clamp(0.0, 1.0);
        SIZE[1] - ROOM[3] - share * (SIZE[1] - ROOM[2] - ROOM[3])
    }

    /// The picture: frame and what is inside; `ticks` are the values on the horizontal axis, `label` says
    /// what it is to who does not see it.
    pub fn picture(&self, ticks: &[f64], label: &str, inside: &str) -> String {
        let [width, height] = SIZE;
        let mut text =
            format!("<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{label}\">\n");
        let (left, right, bottom) = (ROOM[0], width - ROOM[1], height - ROOM[3]);
        for value in steps(self.top) {
            let y = self.y_at(value);
            let _ = writeln!(
                text,
                "<line class=\"rule\" x1=\"{left}\" y1=\"{y:.1}\" x2=\"{right}\" y2=\"{y:.1}\"/>\
                 <text class=\"tick\" x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{value}</text>",
                left - 6.0,
                y + 4.0
            );
        }
        let every = ticks.len().div_ceil(MOST_TICKS);
        for value in ticks.iter().step_by(every.max(1)) {
            let x = self.x_at(*value);
            let _ = writeln!(
                text,
                "<line class=\"axis\" x1=\"{x:.1}\" y1=\"{bottom}\" x2=\"{x:.1}\" y2=\"{:.1}\"/>\
                 <text class=\"tick\" x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                bottom + 5.0,
                bottom + 18.0,
                (value * 1e3).round() / 1e3
            );
        }
        let middle = (ROOM[2] + bottom) / 2.0;
        let _ = writeln!(
            text,
            "<line class=\"axis\" x1=\"{left}\" y1=\"{bottom}\" x2=\"{right}\" y2=\"{bottom}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>\
             <text transform=\"translate(13 {middle:.1}) rotate(-90)\" \
             text-anchor=\"middle\">{}</text>\n{inside}</svg>\n",
            (left + right) / 2.0,
            height - 6.0,
            self.names[0],
            self.names[1]
        );
        text
    }
}

/// Round values from 0 to at most `top`, about five of them.
fn steps(top: f64) -> Vec<f64> {
    let rough = top / 5.0;
    let size = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 2.5, 5.0, 10.0].into_iter().map(|k| k * size).find(|step| *step >= rough);
    let step = step.unwrap_or(rough);
    let round = |value: f64| (value * 1e6).round() / 1e6;
    (0..).map(|k| round(k as f64 * step)).take_while(|value| *value <= top * 1.000_001).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round() {
        assert_eq!(steps(100.0), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        assert_eq!(steps(7.0), [0.0, 2.0, 4.0, 6.0]);
        assert_eq!(steps(1.0).len(), 6);
    }
}
