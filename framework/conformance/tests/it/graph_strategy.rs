//! For each law of strategies one liar that breaks it and no other.
use crate::support;

use regrasp_api::*;
use regrasp_conformance::reference::Interleaving;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What a liar does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Nothing,
    ExtendsNobody,
    NeverAsks,
    KnowsNoBudget,
    GivesUp,
    TriesAgain,
    CountsTwice,
    JoinsNothing,
    WantsMoreEachTime,
    OnlyAtHome,
}

struct Liar {
    lie: Lie,
    home: std::thread::ThreadId,
    asked: AtomicUsize,
}

impl GraphStrategy for Liar {
    fn next(&self, graph: &dyn GraphView, context: &mut Context<'_>) -> Result<Action, CallError> {
        let nodes = graph.node_count();
        let (samples, most) = graph.samples();
        if self.lie != Lie::Nothing {
            context.count_call(Slot::GraphStrategy);
        }
        match self.lie {
            Lie::ExtendsNobody if nodes % 17 == 16 && samples < most && context.random.unit() < 0.5 => {
                Ok(Action::Extend(NodeId(nodes as u32), Vicinity::default(), Link::None))
            }
            Lie::NeverAsks if graph.joined() => {
                Ok(if samples < most { Action::Explore(Link::None) } else { Action::Stop })
            }
            Lie::KnowsNoBudget if samples >= most => Ok(Action::Explore(Link::Components)),
            Lie::GivesUp if !graph.joined() && samples > most / 2 => Ok(Action::Stop),
            Lie::TriesAgain if !graph.joined() && samples < most && context.random.unit() < 0.8 => {
                Ok(Action::Connect(graph.start(), graph.goals()[0], EdgeKind::Grasp))
            }
            Lie::JoinsNothing if !graph.joined() => {
                Ok(if samples < most { Action::Explore(Link::None) } else { Action::Stop })
            }
            Lie::OnlyAtHome if std::thread::current().id() != self.home => Ok(Action::Stop),
            Lie::Nothing | Lie::CountsTwice => Interleaving.next(graph, context),
            _ => {
                let mut own = Context::new(context.random.clone(), &Uninterrupted);
                Interleaving.next(graph, &mut own)
            }
        }
    }

    fn policy(&self) -> SearchPolicy {
        let more = match self.lie {
            Lie::WantsMoreEachTime => self.asked.fetch_add(1, Ordering::Relaxed),
            _ => 0,
        };
        let policy = SearchPolicy::default();
        SearchPolicy { goal_grasps: policy.goal_grasps + more, ..policy }
    }
}

macro_rules! liar {
    ($lie:expr) => {
        Entry {
            id: "graph-strategy/liar",
            slots: &[Slot::GraphStrategy],
            summary: "says what it likes",
            references: &["nobody"],
            schema: NoSettings::schema,
            check: check_settings::<NoSettings>,
            build: Build::GraphStrategy(|json, _| {
                NoSettings::from_json(json)?;
                Ok(Box::new(Liar {
                    lie: $lie,
                    home: std::thread::current().id(),
                    asked: AtomicUsize::new(0),
                }))
            }),
        }
    };
}

#[test]
fn each_liar_fails_its_check_and_no_other() {
    let liars = [
        (liar!(Lie::ExtendsNobody), "strategy-sensible"),
        (liar!(Lie::NeverAsks), "strategy-queries"),
        (liar!(Lie::KnowsNoBudget), "strategy-stops"),
        (liar!(Lie::GivesUp), "strategy-goes-on"),
        (liar!(Lie::TriesAgain), "strategy-not-futile"),
        (liar!(Lie::CountsTwice), "strategy-counted"),
        (liar!(Lie::JoinsNothing), "strategy-solves"),
        (liar!(Lie::WantsMoreEachTime), "strategy-policy"),
        (liar!(Lie::OnlyAtHome), "strategy-pure"),
    ];
    support::judge(Slot::GraphStrategy, &liar!(Lie::Nothing), &liars, &[]);
}
