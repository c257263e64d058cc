//! The laws of graph strategies, tried on made-up graphs.

use crate::fixtures::{Bench, Outcome, SquareGraph, Weather};
use crate::law::{Law, Subject, context, counted_once, pure};
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{Action, Build, GraphStrategy, GraphView, SearchPolicy, Slot, check_schema};

pub(crate) const LAWS: &[Law] = &[
    Law {
        name: "strategy-sensible",
        why: "an action on what is not there ends the run with an error",
        check: sensible,
    },
    Law {
        name: "strategy-queries",
        why: "a path that was found is worth nothing until it is asked for",
        check: queries,
    },
    Law {
        name: "strategy-stops",
        why: "an unreachable goal must end at the budget, with its reasons",
        check: stops,
    },
    Law {
        name: "strategy-goes-on",
        why: "giving up early turns a solvable problem into a failure",
        check: goes_on,
    },
    Law {
        name: "strategy-not-futile",
        why: "the same attempt again has the same result, for ever",
        check: not_futile,
    },
    Law {
        name: "strategy-solves",
        why: "nodes that are never joined are no graph, and a path that is never found no plan",
        check: solves,
    },
    Law {
        name: "strategy-policy",
        why: "how actions are carried out is asked once a run, and must be the same on any machine",
        check: policy,
    },
    Law {
        name: "strategy-counted",
        why: "every call is counted once, by the plugin itself, or the statistics of a run are wrong",
        check: counted,
    },
    Law {
        name: "strategy-pure",
        why: "the graph is the strategy's only memory: the same plan must come out on any number of threads",
        check: strategy_pure,
    },
];

/// Nothing can be joined.
const BARREN: Weather = Weather { joins: 0.0, decomposes: 0.0, most: 40 };
/// Much can be joined, and some paths decompose.
const FAIR: Weather = Weather { joins: 0.3, decomposes: 0.3, most: 300 };
/// Actions after which a run counts as endless: several for each pair of nodes.
const ENDLESS: usize = 8000;
/// How often an action that cannot change anything may be repeated.
const PATIENCE: usize = 3;

fn build(subject: &Subject<'_>) -> Finding<Box<dyn GraphStrategy>> {
    let Build::GraphStrategy(build) = subject.entry.build else { return broken("it builds another role") };
    Ok(build(&subject.demands.settings, &Bench::free_sphere().parts())?)
}

/// Lets the strategy work until it is done; `look` sees each action with the graph before it.
fn run(
    strategy: &dyn GraphStrategy,
    graph: &mut SquareGraph,
    key: u64,
    mut look: impl FnMut(&SquareGraph, Action) -> Finding,
) -> Finding<Outcome> {
    for step in 0..ENDLESS {
        let action = strategy.next(graph, &mut context(1000 * key + step as u64))?;
        look(graph, action)?;
        match graph.act(action) {
            Ok(Outcome::GoesOn) => {}
            Ok(end) => return Ok(end),
            // Senseless actions are the business of one law.
            Err(_) => continue,
        }
    }
    Ok(Outcome::GoesOn)
}

fn sensible(subject: &Subject<'_>) -> Finding {
    let strategy = build(subject)?;
    for (key, weather) in [(1, FAIR), (2, BARREN), (3, FAIR)] {
        let mut graph = SquareGraph::new(weather, key);
        run(&*strategy, &mut graph, key, |graph, action| {
            graph.clone().act(action).map_or_else(|senseless| broken(senseless.to_string()), |_| Ok(()))
        })?;
    }
    Ok(())
}

fn queries(subject: &Subject<'_>) -> Finding {
    let strategy = build(subject)?;
    for key in 0..4 {
        let mut graph = SquareGraph::new(Weather { decomposes: 1.0, ..BARREN }, key);
        // Any goal will do.
        graph.join_with(key as usize % 2);
        let end = run(&*strategy, &mut graph, key, |_, _| Ok(()))?;
        ensure(end == Outcome::Solved, || {
            format!("start and goal are joined, but the run ends with {end:?} and no query")
        })?;
    }
    Ok(())
}

/// Problems that a strategy is to solve.
const PROBLEMS: u64 = 8;

fn solves(subject: &Subject<'_>) -> Finding {
    let (strategy, mut joined) = (build(subject)?, 0);
    for key in 0..PROBLEMS {
        let mut graph = SquareGraph::new(FAIR, 50 + key);
        let end = run(&*strategy, &mut graph, 50 + key, |_, _| Ok(()))?;
        // That a path is asked for is another law.
        joined += u64::from(end == Outcome::Solved || graph.joined());
    }
    ensure(2 * joined >= PROBLEMS, || {
        format!("of {PROBLEMS} problems in which every third pair of nodes can be joined it joins {joined}")
    })
}

/// Ranges of the policy are in its schema, as those of settings are.
fn policy(subject: &Subject<'_>) -> Finding {
    let (strategy, fresh) = (build(subject)?, build(subject)?);
    let policy = strategy.policy();
    ensure(policy == strategy.policy() && policy == fresh.policy(), || {
        format!("it asks for {policy:?} at first, and for {:?} later", strategy.policy())
    })?;
    let schema = schemars::schema_for!(SearchPolicy).to_value();
    let value = serde_json::to_value(policy).map_err(|error| Fault::Broken(error.to_string()))?;
    check_schema(&value, &schema).map_err(|departure| Fault::Broken(format!("it asks for {departure}")))
}

fn stops(subject: &Subject<'_>) -> Finding {
    let strategy = build(subject)?;
    for key in 0..3 {
        let mut graph = SquareGraph::new(BARREN, key);
        let end = run(&*strategy, &mut graph, key, |_, _| Ok(()))?;
        ensure(end == Outcome::Stopped, || {
            let (samples, most) = graph.samples();
            format!("goes on for {ENDLESS} actions, {samples} samples of {most}")
        })?;
    }
    Ok(())
}

fn goes_on(subject: &Subject<'_>) -> Finding {
    let strategy = build(subject)?;
    for key in 0..6 {
        let weather = if key % 2 == 0 { BARREN } else { FAIR };
        let mut graph = SquareGraph::new(weather, key);
        let end = run(&*strategy, &mut graph, key, |_, _| Ok(()))?;
        let (samples, most) = graph.samples();
        ensure(end != Outcome::Stopped || samples >= most, || {
            format!("gives up after {samples} of {most} samples")
        })?;
    }
    Ok(())
}

fn not_futile(subject: &Subject<'_>) -> Finding {
    let strategy = build(subject)?;
    for (key, weather) in [(1, BARREN), (2, FAIR), (3, BARREN)] {
        let (mut graph, mut futile) = (SquareGraph::new(weather, key), 0);
        run(&*strategy, &mut graph, key, |graph, action| {
            futile = if graph.is_futile(action) { futile + 1 } else { 0 };
            ensure(futile <= PATIENCE, || format!("{futile} times in a row to no effect: {action:?}"))
        })?;
    }
    Ok(())
}

fn counted(subject: &Subject<'_>) -> Finding {
    let (strategy, mut joined) = (build(subject)?, SquareGraph::new(FAIR, 8));
    joined.join();
    for graph in [SquareGraph::new(FAIR, 8), joined] {
        let mut context = context(8);
        strategy.next(&graph, &mut context)?;
        counted_once(&context, Slot::GraphStrategy)?;
    }
    Ok(())
}

fn strategy_pure(subject: &Subject<'_>) -> Finding {
    // Graphs as they are met on the way of the plugin's own run.
    let strategy = build(subject)?;
    let (mut graph, mut met) = (SquareGraph::new(FAIR, 9), Vec::new());
    run(&*strategy, &mut graph, 9, |graph, action| {
        if met.len() < 40 {
            met.push((graph.clone(), action));
        }
        Ok(())
    })?;
    let fresh = build(subject)?;
    for (step, (graph, action)) in met.iter().enumerate() {
        let again = fresh.next(graph, &mut context(9000 + step as u64))?;
        ensure(again == *action, || format!("{action:?} in the run, {again:?} by a fresh strategy"))?;
    }
    pure(met.len(), |i| Ok::<_, Fault>(strategy.next(&met[i].0, &mut context(9000 + i as u64))?))
}
