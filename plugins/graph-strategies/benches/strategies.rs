//! One decision of each strategy, in the made-up graph of 200 nodes that it grew itself, start and goal still
//! apart.
//!
//! The made-up graph answers `attempted` by a search, the planner's by hashing: figures are upper bounds.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_api::{Action, Context, GraphStrategy, GraphView, Random, Uninterrupted};
use regrasp_conformance::fixtures::{SquareGraph, Weather};
use regrasp_graph_strategies::*;
use std::hint::black_box;

/// What the strategy makes of a world in which nothing can be joined.
fn grown(strategy: &dyn GraphStrategy) -> SquareGraph {
    let mut graph = SquareGraph::new(Weather { joins: 0.0, decomposes: 0.0, most: 1000 }, 1);
    for step in 0.. {
        let mut context = Context::new(Random::from_key(step, 0, 0, 0), &Uninterrupted);
        let action = strategy.next(&graph, &mut context).expect("nothing interrupts");
        let grows = matches!(action, Action::Explore(_) | Action::Extend(..));
        if graph.node_count() >= 200 && grows {
            break;
        }
        graph.act(action).expect("strategies act sensibly");
    }
    graph
}

fn decisions(criterion: &mut Criterion) {
    let strategies: [(&str, Box<dyn GraphStrategy>); 5] = [
        ("interleaved", Box::new(Interleaved::new(Default::default()).expect("defaults are in range"))),
        ("explore-first", Box::new(ExploreFirst::new(Default::default()).expect("defaults are in range"))),
        ("connect-first", Box::new(ConnectFirst::new(Default::default()).expect("defaults are in range"))),
        ("lazy", Box::new(Lazy::new(Default::default()).expect("defaults are in range"))),
        ("bidirectional", Box::new(Bidirectional::new(Default::default()).expect("defaults are in range"))),
    ];
    for (name, strategy) in strategies {
        let graph = grown(&*strategy);
        criterion.bench_function(name, |bencher| {
            let mut context = Context::new(Random::from_key(1, 0, 0, 0), &Uninterrupted);
            bencher.iter(|| strategy.next(black_box(&graph), &mut context));
        });
    }
}

criterion_group!(benches, decisions);
criterion_main!(benches);
