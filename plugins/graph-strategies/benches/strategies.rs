//! One decision of each strategy, in a made-up graph of 200 nodes whose components have not met.
//!
//! The made-up graph answers `attempted` by a search, the planner's by hashing: figures are upper bounds.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use regrasp_api::{Action, Context, GraphStrategy, Link, Random, Uninterrupted};
use regrasp_conformance::fixtures::{SquareGraph, Weather};
use regrasp_graph_strategies::*;
use std::hint::black_box;

fn graph() -> SquareGraph {
    let mut graph = SquareGraph::new(Weather { joins: 0.0, decomposes: 0.0, most: 1000 }, 1);
    for _ in 0..197 {
        graph.act(Action::Explore(Link::None)).expect("exploring makes sense");
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
    let graph = graph();
    for (name, strategy) in strategies {
        criterion.bench_function(name, |bencher| {
            let mut context = Context::new(Random::from_key(1, 0, 0, 0), &Uninterrupted);
            bencher.iter(|| strategy.next(black_box(&graph), &mut context));
        });
    }
}

criterion_group!(benches, decisions);
criterion_main!(benches);
