//! What is told of a roadmap.

use super::RoadmapArgs;
use crate::quantity::{digits, span};
use crate::table::Table;
use crate::{Failure, say, say_json};
use regrasp::planner::roadmap::{Roadmap, RoadmapGraph};
use regrasp::roadmap::Standing;
use regrasp::study::compare::statistics::{Estimate, median, quantile, sorted, wilson};
use serde_json::{Value, json};

/// The fewest nodes that a roadmap is looked at with.
const FEWEST: usize = 60;

/// A roadmap that has grown.
pub struct Report<'a> {
    pub args: &'a RoadmapArgs,
    pub scenario: &'a str,
    pub roadmap: &'a Roadmap,
    pub graph: &'a RoadmapGraph<'a>,
    /// Nodes that were there before.
    pub before: usize,
    /// How long it grew (s).
    pub seconds: f64,
    /// Of the file.
    pub bytes: u64,
    pub standings: &'a [Standing],
}

/// The numbers of nodes at which a roadmap is looked at: halves of halves, the whole last.
pub fn sizes(nodes: usize) -> Vec<usize> {
    let halves = std::iter::successors(Some(nodes), |nodes| Some(nodes.div_ceil(2)));
    let mut sizes: Vec<usize> = halves.take_while(|&half| half == nodes || half >= FEWEST).take(8).collect();
    sizes.dedup();
    sizes.reverse();
    sizes
}

impl Report<'_> {
    /// Tells of it on standard output.
    pub fn tell(&self) -> Result<(), Failure> {
        if self.args.json { say_json(&self.json()) } else { say(&self.text()) }
    }

    fn json(&self) -> Value {
        json!({
            "file": self.args.output,
            "scenario": self.scenario,
            "seed": self.roadmap.seed(),
            "nodes": self.roadmap.node_count(),
            "edges": self.roadmap.edge_count(),
            "learnt": self.roadmap.learnt(),
            "samples": self.roadmap.samples(),
            "components": self.graph.components().len(),
            "largest_component": self.graph.components().first(),
            "grown": self.roadmap.node_count() - self.before,
            "time_s": self.seconds,
            "bytes": self.bytes,
            "report": self.standings.iter().map(standing_json).collect::<Vec<_>>(),
        })
    }

    fn text(&self) -> String {
        let grown = self.roadmap.node_count() - self.before;
        let sizes = self.graph.components();
        let learnt = match self.roadmap.learnt() {
            0 => String::new(),
            learnt => format!(", {learnt} of them from plans"),
        };
        let mut text = format!(
            "{}: {} nodes{learnt}, {} edges, {} of the nodes in the largest of {} components\n",
            self.scenario,
            self.roadmap.node_count(),
            self.roadmap.edge_count(),
            sizes.first().unwrap_or(&0),
            sizes.len(),
        );
        if grown > 0 {
            let rate = digits(grown as f64 / self.seconds.max(1e-9));
            text += &format!("  grown         {grown} nodes in {}, {rate} a second\n", span(self.seconds));
        }
        let size = digits(self.bytes as f64 / 1e6);
        text += &format!("  saved         {} ({size} MB)\n", self.args.output.display());
        if !self.standings.is_empty() {
            text += &self.table();
        }
        text
    }

    fn table(&self) -> String {
        let head = ["nodes", "edges", "largest", "solved", "of", "95 % interval", "regrasps", "ms", "90 %"];
        let mut table = Table::new(">", &head);
        for standing in self.standings {
            let Figures { solved, share, regrasps, time_s } = Figures::of(standing);
            let percent = |x: f64| format!("{:.0}", 100.0 * x);
            let interval = format!("{}-{} %", percent(share.low), percent(share.high));
            let ms =
                |quantile: usize| time_s.map_or("-".into(), |times| format!("{:.1}", times[quantile] * 1e3));
            table.row([
                standing.nodes.to_string(),
                standing.edges.to_string(),
                standing.components.first().unwrap_or(&0).to_string(),
                solved.to_string(),
                standing.attempts.len().to_string(),
                interval,
                regrasps.map_or("-".into(), digits),
                ms(0),
                ms(1),
            ]);
        }
        format!(
            "  random starts and goals through the first nodes alone; medians of the solved:\n{}",
            table.text()
        )
    }
}

/// What the attempts come to.
struct Figures {
    solved: usize,
    share: Estimate,
    /// Median, of the solved.
    regrasps: Option<f64>,
    /// Median and 90 % of the time for planning (s), of the solved.
    time_s: Option<[f64; 2]>,
}

impl Figures {
    fn of(standing: &Standing) -> Self {
        let solved: Vec<_> = standing.attempts.iter().filter(|attempt| attempt.solved).collect();
        let none = Estimate { value: 0.0, low: 0.0, high: 1.0 };
        let share = wilson(solved.len(), standing.attempts.len()).unwrap_or(none);
        let times = sorted(solved.iter().map(|attempt| attempt.planning_s));
        let quantiles = [quantile(&times, 0.5), quantile(&times, 0.9)];
        Self {
            solved: solved.len(),
            share,
            regrasps: median(solved.iter().map(|attempt| attempt.regrasps as f64)),
            time_s: quantiles[0].zip(quantiles[1]).map(|(median, most)| [median, most]),
        }
    }
}

fn standing_json(standing: &Standing) -> Value {
    let Figures { solved, share, regrasps, time_s } = Figures::of(standing);
    json!({
        "nodes": standing.nodes,
        "edges": standing.edges,
        "components": standing.components.len(),
        "largest_component": standing.components.first(),
        "pairs": standing.attempts.len(),
        "solved": solved,
        "share": { "value": share.value, "low": share.low, "high": share.high },
        "regrasps_median": regrasps,
        "time_s_median": time_s.map(|times| times[0]),
        "time_s_90": time_s.map(|times| times[1]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_roadmap_is_looked_at_in_halves() {
        assert_eq!(sizes(1000), [63, 125, 250, 500, 1000]);
        assert_eq!(sizes(40), [40]);
        assert_eq!(sizes(0), [0]);
    }
}
