//! A strategy: looks where the way from start to goal is torn, and tries to mend it there.

// ANCHOR: uses
use regrasp_api::{
    Action, Build, CallError, Context, EdgeKind, Entry, GraphStrategy, GraphView, Link, NodeId, Settings,
    SettingsError, Slot, check_settings,
};
use serde::{Deserialize, Serialize};
// ANCHOR_END: uses

// ANCHOR: settings
/// Settings of [`Mend`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MendSettings {
    /// The part of the steps that samples a node although there is something to mend.
    #[schemars(range(min = 0.0, max = 0.9), extend("x-unit" = "1"))]
    pub explore: f64,
    /// How much better several small gaps are than a large one: the power of a gap's length that is added up
    /// along the way.
    #[schemars(range(min = 1.0, max = 4.0), extend("x-unit" = "1"))]
    pub power: f64,
}

impl Default for MendSettings {
    fn default() -> Self {
        Self { explore: 0.0, power: 2.0 }
    }
}

impl Settings for MendSettings {}

/// Mends the way from start to goal, and explores where it cannot be mended.
#[derive(Clone, Copy, Debug)]
pub struct Mend {
    settings: MendSettings,
}

impl Mend {
    /// A strategy with checked settings.
    pub fn new(settings: MendSettings) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self { settings })
    }
}
// ANCHOR_END: settings

// ANCHOR: gaps
/// The shortest untried bridge between two components.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Gap {
    /// Length in the planner's metric (m).
    length: f64,
    ends: (NodeId, NodeId),
}

/// All gaps between components: a square table, by the components' places in ascending order.
struct Gaps {
    count: usize,
    table: Vec<Option<Gap>>,
    /// The place of each node's component.
    place: Vec<usize>,
}

impl Gaps {
    /// Measures every pair of nodes: the square of the graph's size, which the few nodes of a usual graph can
    /// bear.
    fn new(graph: &dyn GraphView) -> Self {
        let components = graph.components();
        let place_of = |node| components.partition_point(|&other| other < graph.component(node));
        let place: Vec<usize> = nodes(graph).map(place_of).collect();
        let count = components.len();
        let mut gaps = Self { count, table: vec![None; count * count], place };
        for b in nodes(graph) {
            for a in nodes(graph).take_while(|&a| a < b) {
                gaps.offer(graph, a, b);
            }
        }
        gaps
    }

    fn offer(&mut self, graph: &dyn GraphView, a: NodeId, b: NodeId) {
        let (i, j) = (self.place_of(a), self.place_of(b));
        if i == j || graph.attempted(a, b, EdgeKind::TransferRegrasp) {
            return;
        }
        let gap = Gap { length: graph.distance(a, b), ends: (a, b) };
        let here = &mut self.table[i * self.count + j];
        if here.is_none_or(|best| gap.length < best.length) {
            *here = Some(gap);
            self.table[j * self.count + i] = Some(gap);
        }
    }

    fn place_of(&self, node: NodeId) -> usize {
        self.place[node.0 as usize]
    }
}

fn nodes(graph: &dyn GraphView) -> impl Iterator<Item = NodeId> {
    (0..graph.node_count() as u32).map(NodeId)
}
// ANCHOR_END: gaps

// ANCHOR: way
impl Gaps {
    /// The gaps on the cheapest way between components, from one of `from` to one of `to`; empty where there
    /// is no untried way.
    fn way(&self, from: usize, to: &[usize], power: f64) -> Vec<Gap> {
        let mut cost = vec![f64::INFINITY; self.count];
        let mut last: Vec<Option<(usize, Gap)>> = vec![None; self.count];
        let mut open: Vec<usize> = (0..self.count).collect();
        cost[from] = 0.0;
        // Dijkstra's algorithm; a queue would not pay for so few components.
        while let Some(next) = cheapest(&open, &cost) {
            let here = open.swap_remove(next);
            if to.contains(&here) {
                return steps(&last, here);
            }
            for there in 0..self.count {
                let Some(gap) = self.table[here * self.count + there] else { continue };
                let through = cost[here] + gap.length.powf(power);
                if through < cost[there] {
                    (cost[there], last[there]) = (through, Some((here, gap)));
                }
            }
        }
        Vec::new()
    }
}

/// Where the cheapest component that can be reached stands in `open`.
fn cheapest(open: &[usize], cost: &[f64]) -> Option<usize> {
    let reached = (0..open.len()).filter(|&i| cost[open[i]].is_finite());
    reached.min_by(|&i, &j| cost[open[i]].total_cmp(&cost[open[j]]).then(open[i].cmp(&open[j])))
}

fn steps(last: &[Option<(usize, Gap)>], mut here: usize) -> Vec<Gap> {
    let mut gaps = Vec::new();
    while let Some((before, gap)) = last[here] {
        gaps.push(gap);
        here = before;
    }
    gaps
}
// ANCHOR_END: way

// ANCHOR: role
impl GraphStrategy for Mend {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        context.count_call(Slot::GraphStrategy);
        if graph.joined() {
            return Ok(Action::Query);
        }
        let (samples, most) = graph.samples();
        if samples >= most {
            return Ok(Action::Stop);
        }
        if context.random.unit() < self.settings.explore {
            return Ok(Action::Explore(Link::Components));
        }
        let gaps = Gaps::new(graph);
        let goals: Vec<usize> = graph.goals().iter().map(|&goal| gaps.place_of(goal)).collect();
        let way = gaps.way(gaps.place_of(graph.start()), &goals, self.settings.power);
        // The longest first: if it cannot be bridged, the others need not be.
        let longest = way.into_iter().max_by(|a, b| a.length.total_cmp(&b.length));
        Ok(match longest {
            Some(Gap { ends: (a, b), .. }) => Action::Connect(a, b, EdgeKind::TransferRegrasp),
            None => Action::Explore(Link::Components),
        })
    }
}
// ANCHOR_END: role

// ANCHOR: entry
/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "graph-strategy/mend",
    slots: &[Slot::GraphStrategy],
    summary: "tries the longest gap on the cheapest way from start to goal",
    references: &[
        "Bohlin, Kavraki, Path planning using lazy PRM, ICRA 2000",
        "Dijkstra, A note on two problems in connexion with graphs, Numerische Mathematik 1959",
    ],
    schema: MendSettings::schema,
    check: check_settings::<MendSettings>,
    build: Build::GraphStrategy(|json, _parts| Ok(Box::new(Mend::new(MendSettings::from_json(json)?)?))),
};
regrasp_api::inventory::submit! { ENTRY }
// ANCHOR_END: entry

// ANCHOR: tests
#[cfg(test)]
mod tests {
    use super::*;

    /// Components on a line, each of one node, with a gap wherever `may` says so.
    fn on_a_line(places: &[f64], may: impl Fn(usize, usize) -> bool) -> Gaps {
        let count = places.len();
        let gap = |i: usize, j: usize| Gap {
            length: (places[i] - places[j]).abs(),
            ends: (NodeId(i as u32), NodeId(j as u32)),
        };
        let table = (0..count * count).map(|k| (k / count, k % count));
        let table = table.map(|(i, j)| (i != j && may(i.min(j), i.max(j))).then(|| gap(i, j))).collect();
        Gaps { count, table, place: (0..count).collect() }
    }

    fn lengths(gaps: &Gaps, power: f64) -> Vec<f64> {
        let mut lengths: Vec<f64> = gaps.way(0, &[1], power).iter().map(|gap| gap.length).collect();
        lengths.sort_by(f64::total_cmp);
        lengths
    }

    #[test]
    fn several_small_gaps_are_better_than_a_large_one() {
        // Start, goal, and two components between them.
        let gaps = on_a_line(&[0.0, 4.0, 1.0, 3.0], |_, _| true);
        assert_eq!(lengths(&gaps, 2.0), [1.0, 1.0, 2.0]);
    }

    #[test]
    fn what_was_tried_is_gone_round_and_where_nothing_is_left_there_is_no_way() {
        let gaps = on_a_line(&[0.0, 4.0, 1.0, 3.0], |i, j| (i, j) != (2, 3));
        assert_eq!(lengths(&gaps, 2.0), [1.0, 3.0]);
        assert_eq!(lengths(&on_a_line(&[0.0, 4.0], |_, _| false), 2.0), [] as [f64; 0]);
    }
}
// ANCHOR_END: tests
