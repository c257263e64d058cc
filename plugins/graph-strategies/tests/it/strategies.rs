//! What tells the strategies apart, on made-up graphs.
use proptest::prelude::*;
use regrasp_api::*;
use regrasp_conformance::fixtures::{Outcome, SquareGraph, Weather};
use regrasp_graph_strategies::*;

fn context(key: u64) -> Context<'static> {
    Context::new(Random::from_key(key, 0, 0, 0), &Uninterrupted)
}

/// Lets the strategy work; `look` sees the graph before each action.
fn run(
    strategy: &dyn GraphStrategy,
    weather: Weather,
    key: u64,
    mut look: impl FnMut(&SquareGraph, Action),
) -> Outcome {
    let mut graph = SquareGraph::new(weather, key);
    for step in 0..5000 {
        let action = strategy.next(&graph, &mut context(key << 16 | step)).unwrap();
        look(&graph, action);
        match graph.act(action).expect("only sensible actions") {
            Outcome::GoesOn => {}
            end => return end,
        }
    }
    Outcome::GoesOn
}

fn by_transfer(action: Action) -> bool {
    matches!(action, Action::Connect(_, _, EdgeKind::TransferRegrasp))
}

fn grows(action: Action) -> bool {
    matches!(action, Action::Explore(_) | Action::Extend(..))
}

const BARREN: Weather = Weather { joins: 0.0, decomposes: 0.0, most: 60 };
const FAIR: Weather = Weather { joins: 0.2, decomposes: 0.5, most: 200 };

fn all_by_default() -> Vec<(&'static str, Box<dyn GraphStrategy>)> {
    vec![
        ("interleaved", Box::new(Interleaved::new(Default::default()).unwrap())),
        ("explore-first", Box::new(ExploreFirst::new(Default::default()).unwrap())),
        ("connect-first", Box::new(ConnectFirst::new(Default::default()).unwrap())),
        ("lazy", Box::new(Lazy::new(Default::default()).unwrap())),
        ("bidirectional", Box::new(Bidirectional::new(Default::default()).unwrap())),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..Default::default() })]

    #[test]
    fn every_strategy_solves_what_often_joins_and_decomposes(
        seed in 0..1_000_000_u64, joins in 0.3..1.0, decomposes in 0.3..1.0,
    ) {
        for (name, strategy) in all_by_default() {
            let end = run(&*strategy, Weather { joins, decomposes, most: 300 }, seed, |_, _| ());
            prop_assert_eq!(end, Outcome::Solved, "{} with seed {}", name, seed);
        }
    }

    #[test]
    fn every_strategy_spends_its_whole_budget_before_it_stops(seed in 0..1_000_000_u64) {
        for (name, strategy) in all_by_default() {
            let mut grown = 0;
            let end = run(&*strategy, BARREN, seed, |_, action| grown += usize::from(grows(action)));
            prop_assert_eq!((end, grown), (Outcome::Stopped, BARREN.most), "{} with seed {}", name, seed);
        }
    }
}

#[test]
fn interleaved_connects_as_often_as_its_law_says() {
    // Where nothing joins there is always a pair to try, so that α decides alone.
    let settings = InterleavedSettings { start: 0.1, end: 0.6, growth: 30.0, ..Default::default() };
    let strategy = Interleaved::new(settings).unwrap();
    let (mut drawn, mut connected, mut expected, mut variance) = (0, 0, 0.0, 0.0);
    for key in 0..40 {
        run(&strategy, Weather { most: 30, ..BARREN }, key, |graph, action| {
            let alpha_is_1 = by_transfer(action);
            // Pairs run out in small graphs; those steps explore whatever α is.
            if graph.node_count() < 12 || !(alpha_is_1 || grows(action)) {
                return;
            }
            let p = 0.1 + 0.5 * (1.0 - (-(graph.node_count() as f64) / 30.0).exp());
            drawn += 1;
            connected += u32::from(alpha_is_1);
            expected += p;
            variance += p * (1.0 - p);
        });
    }
    let off = (f64::from(connected) - expected).abs() / variance.sqrt();
    assert!(drawn > 500 && off < 4.0, "{connected} of {drawn}, {expected:.0} expected: {off:.1} sigma");
}

#[test]
fn interleaved_tries_to_reach_the_goals_before_it_joins_the_ends_inside_the_manifold() {
    let strategy = Interleaved::new(Default::default()).unwrap();
    let (mut first, mut goals) = (Vec::new(), Vec::new());
    run(&strategy, BARREN, 1, |graph, action| {
        goals = graph.goals().to_vec();
        first.push(action);
    });
    let (reach, join) = first.split_at(goals.len());
    let start_to = |goal: &NodeId| Action::Connect(NodeId(0), *goal, EdgeKind::TransferRegrasp);
    assert_eq!(reach, goals.iter().map(start_to).collect::<Vec<_>>());
    let ends = |a: NodeId, b: NodeId| a.0 < 3 && b.0 < 3;
    assert!(matches!(join[0], Action::Connect(a, b, EdgeKind::Grasp) if ends(a, b)), "{:?}", join[0]);
    let never =
        Interleaved::new(InterleavedSettings { start: 0.0, end: 0.0, growth: 1.0, ..Default::default() })
            .unwrap();
    run(&never, FAIR, 2, |_, action| assert!(!by_transfer(action) || reach.contains(&action)));
}

#[test]
fn explore_first_connects_only_a_graph_of_its_size() {
    let settings = ExploreFirstSettings { nodes: 20, fraction: 0.5, neighbours: 4, ..Default::default() };
    let strategy = ExploreFirst::new(settings).unwrap();
    let mut connected = 0;
    for key in 0..5 {
        run(&strategy, FAIR, key, |graph, action| {
            assert!(!by_transfer(action) || graph.node_count() >= 20);
            connected += usize::from(by_transfer(action));
        });
    }
    // The share of the budget ends exploring too: 6 of 60 nodes, long before 1000.
    let strategy = ExploreFirst::new(ExploreFirstSettings {
        nodes: 1000,
        fraction: 0.1,
        neighbours: 4,
        ..Default::default()
    })
    .unwrap();
    run(&strategy, BARREN, 1, |graph, action| {
        assert!(!by_transfer(action) || graph.samples().0 >= 6);
        connected += usize::from(by_transfer(action));
    });
    assert!(connected > 20, "{connected}");
}

#[test]
fn connect_first_grows_only_when_the_newest_node_and_the_ends_have_nothing_left() {
    let strategy = ConnectFirst::new(ConnectFirstSettings { neighbours: 3, ..Default::default() }).unwrap();
    let mut grown = 0;
    run(&strategy, Weather { joins: 0.02, ..BARREN }, 3, |graph, action| {
        if !grows(action) {
            return;
        }
        grown += 1;
        let newest = NodeId(graph.node_count() as u32 - 1);
        for node in [newest, graph.start(), graph.goals()[0], graph.goals()[1]] {
            let mut apart: Vec<NodeId> = (0..graph.node_count() as u32).map(NodeId).collect();
            apart.retain(|&other| graph.component(other) != graph.component(node));
            apart.sort_by(|&a, &b| graph.distance(node, a).total_cmp(&graph.distance(node, b)));
            let tried = |&&other: &&NodeId| graph.attempted(node, other, EdgeKind::TransferRegrasp);
            assert_eq!(apart.iter().take(3).filter(tried).count(), apart.len().min(3));
        }
    });
    assert!(grown > 10, "{grown}");
}

#[test]
fn lazy_checks_the_edges_of_its_path_and_nothing_else() {
    let strategy = Lazy::new(LazySettings { neighbours: 4, connect: 0.1, ..Default::default() }).unwrap();
    let (mut checked, mut queried) = (0, 0);
    for key in 0..10 {
        run(&strategy, Weather { joins: 0.5, ..FAIR }, key, |graph, action| {
            let path = graph.shortest_path();
            let verdict = |id: &EdgeId| graph.edges().iter().find(|edge| edge.id == *id).unwrap().verdict;
            match action {
                Action::Check(edge) => {
                    checked += 1;
                    assert!(graph.joined() && path.contains(&edge));
                    assert_eq!(verdict(&edge), EdgeVerdict::Unchecked);
                    // Nothing unchecked lies nearer to either end of the path.
                    let place = path.iter().position(|id| *id == edge).unwrap();
                    let inward = place.min(path.len() - 1 - place);
                    let outer = path[..inward].iter().chain(&path[path.len() - inward..]);
                    assert!(outer.into_iter().all(|id| verdict(id) != EdgeVerdict::Unchecked));
                }
                Action::Query => {
                    queried += 1;
                    assert!(path.iter().all(|id| verdict(id) != EdgeVerdict::Unchecked));
                }
                Action::Explore(link) => assert_eq!(link, Link::Unchecked(4)),
                Action::Connect(a, b, EdgeKind::Grasp) => {
                    assert!(a == graph.start() && graph.goals().contains(&b));
                }
                Action::Connect(..) => assert!(!graph.joined()),
                other => assert_eq!(other, Action::Stop),
            }
        });
    }
    assert!(checked > 20 && queried > 5, "{checked} checks, {queried} queries");
}

#[test]
fn bidirectional_extends_its_trees_in_turn() {
    let settings = BidirectionalSettings { greed: 0.5, anywhere: 0.0, ..Default::default() };
    let strategy = Bidirectional::new(settings).unwrap();
    let (mut of_start, mut of_goals) = (0, 0);
    for key in 0..10 {
        run(&strategy, Weather { joins: 0.05, ..FAIR }, key, |graph, action| {
            assert!(!matches!(action, Action::Explore(_)));
            let Action::Extend(node, _, link) = action else { return };
            assert_eq!(link, Link::Components);
            let in_start = |node: NodeId| graph.component(node) == graph.component(graph.start());
            let in_goals = |node: NodeId| {
                graph.goals().iter().any(|&goal| graph.component(goal) == graph.component(node))
            };
            if graph.samples().0.is_multiple_of(2) {
                of_start += 1;
                assert!(in_start(node));
            } else {
                of_goals += 1;
                assert!(in_goals(node));
            }
        });
    }
    assert!(of_start > 20 && of_goals > 20, "{of_start} and {of_goals}");
}

#[test]
fn bidirectional_draws_anywhere_as_often_as_it_is_told() {
    let strategy =
        Bidirectional::new(BidirectionalSettings { greed: 1.0, anywhere: 0.3, ..Default::default() })
            .unwrap();
    let (mut anywhere, mut near) = (0, 0);
    for key in 0..20 {
        run(&strategy, BARREN, key, |_, action| match action {
            Action::Explore(_) => anywhere += 1,
            Action::Extend(..) => near += 1,
            _ => {}
        });
    }
    let share = f64::from(anywhere) / f64::from(anywhere + near);
    assert!((share - 0.3).abs() < 0.06, "{share}");
}

#[test]
fn settings_are_refused_beyond_their_ranges() {
    let range = |key: &str, error: SettingsError| {
        let SettingsError::Departs(departure) = error else { panic!("{error}") };
        assert_eq!(departure.path.to_string(), key);
        // What is not a number is none as JSON either: a fault of type.
        assert!(matches!(departure.fault, Fault::Range { .. } | Fault::Type { .. }), "{departure}");
    };
    range("start", InterleavedSettings { start: -0.1, ..Default::default() }.validate().unwrap_err());
    range("growth", InterleavedSettings { growth: 0.0, ..Default::default() }.validate().unwrap_err());
    range("nodes", ExploreFirstSettings { nodes: 100_001, ..Default::default() }.validate().unwrap_err());
    range(
        "fraction",
        ExploreFirstSettings { fraction: f64::NAN, ..Default::default() }.validate().unwrap_err(),
    );
    range("neighbours", ConnectFirstSettings { neighbours: 0, ..Default::default() }.validate().unwrap_err());
    range("connect", LazySettings { connect: 1.5, ..Default::default() }.validate().unwrap_err());
    range("greed", BidirectionalSettings { greed: 1.1, ..Default::default() }.validate().unwrap_err());
    assert!(Lazy::new(LazySettings { neighbours: 0, connect: 0.5, ..Default::default() }).is_err());
}
