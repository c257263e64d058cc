//! Cones with a grain, and cones of edges, against a conic program that is written out here: the grain's two
//! coefficients as its definition has them.
use crate::support;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettingsBuilder, DefaultSolver, IPSolver, SolverStatus, SupportedConeT};
use nalgebra::{DMatrix, Vector6};
use regrasp_api::{
    Cone, ConeEdge, FingerIndex, Grasp, GraspContact, Mesh, ObjectModel, Random, StabilityTest, Vec3,
    tangents,
};
use regrasp_stability_tests::{Equilibrium, EquilibriumSettings, Holding, HoldingSettings};
use support::{Family, random_touches, verdict_of};

/// The largest normal force (N), the mass (kg), and what torques are divided by (m).
const MOST: f64 = 5.0;
const MASS: f64 = 0.2;
const LENGTH: f64 = 0.04;
/// Slack of the program's optimum within which neither side is asked for a verdict.
const UNCLEAR: f64 = 1e-5;

/// What a contact's cone is in the program: four wrenches whose last three make a round cone of the first, or
/// wrenches with weights.
enum Part {
    Round([Vector6<f64>; 4]),
    Edges(Vec<Vector6<f64>>),
}

fn wrench(p: &Vec3, f: Vec3, m: Vec3) -> Vector6<f64> {
    let m = (p.cross(&f) + m) / LENGTH;
    Vector6::new(f.x, f.y, f.z, m.x, m.y, m.z)
}

fn part(contact: &GraspContact<'_>) -> Part {
    let (p, n) = (&contact.p_OC, -contact.n_O);
    let round = |[u, v]: [Vec3; 2], gamma: f64| {
        let pure = |f: Vec3| wrench(p, f, Vec3::zeros());
        Part::Round([pure(n), pure(u), pure(v), wrench(p, Vec3::zeros(), n * gamma)])
    };
    match &contact.cone {
        Cone::Elliptic { mu, gamma } => round(tangents(&n).map(|t| t * *mu), *gamma),
        Cone::Grained(grain) => {
            let along = (grain.axis_O - n * n.dot(&grain.axis_O)).normalize();
            round([along * grain.mu[0], n.cross(&along) * grain.mu[1]], grain.gamma)
        }
        Cone::Polyhedral(edges) => {
            let [t1, t2] = tangents(&n);
            let edge = |edge: &ConeEdge| {
                wrench(p, n + t1 * edge.tangential[0] + t2 * edge.tangential[1], n * edge.torsion)
            };
            Part::Edges(edges.iter().map(edge).collect())
        }
    }
}

/// min -t subject to A x + s = b, s in the cones, row by row.
#[derive(Default)]
struct Program {
    rows: Vec<(Vec<(usize, f64)>, f64)>,
    cones: Vec<SupportedConeT<f64>>,
}

impl Program {
    fn row(&mut self, entries: Vec<(usize, f64)>, b: f64) {
        self.rows.push((entries, b));
    }

    fn solve(self, columns: usize) -> Option<f64> {
        let mut A = DMatrix::<f64>::zeros(self.rows.len(), columns);
        for (i, (entries, _)) in self.rows.iter().enumerate() {
            entries.iter().for_each(|&(j, x)| A[(i, j)] += x);
        }
        let rows: Vec<Vec<f64>> = A.row_iter().map(|row| row.iter().copied().collect()).collect();
        let b: Vec<f64> = self.rows.iter().map(|(_, b)| *b).collect();
        let mut cost = vec![0.0; columns];
        cost[columns - 1] = -1.0;
        let settings = DefaultSettingsBuilder::default().verbose(false).build().unwrap();
        let (P, A) = (CscMatrix::zeros((columns, columns)), CscMatrix::from(&rows));
        let mut solver = DefaultSolver::new(&P, &cost, &A, &b, &self.cones, settings).unwrap();
        solver.solve();
        match solver.solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => Some(solver.solution.x[columns - 1]),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => Some(f64::NEG_INFINITY),
            _ => None,
        }
    }
}

/// How far inside the cones some forces can be that give `wanted` (N, N·m over the length) with normal forces
/// up to [`MOST`], as a part of it; without `wanted`, that balance each other with normal forces that sum to
/// 1.
fn reference(grasp: &Grasp<'_>, wanted: Option<Vector6<f64>>) -> Option<f64> {
    let parts: Vec<Part> = grasp.contacts().iter().map(part).collect();
    let sizes: Vec<usize> = parts
        .iter()
        .map(|part| match part {
            Part::Round(_) => 4,
            Part::Edges(edges) => edges.len(),
        })
        .collect();
    let t: usize = sizes.iter().sum();
    let first = |i: usize| sizes[..i].iter().sum::<usize>();
    let wrenches = |part: &Part| match part {
        Part::Round(each) => each.to_vec(),
        Part::Edges(each) => each.clone(),
    };
    let normals = |i: usize, part: &Part| -> Vec<usize> {
        match part {
            Part::Round(_) => vec![first(i)],
            Part::Edges(edges) => (first(i)..first(i) + edges.len()).collect(),
        }
    };
    let mut program = Program::default();
    for k in 0..6 {
        let each = parts.iter().enumerate().flat_map(|(i, part)| {
            wrenches(part).into_iter().enumerate().map(move |(j, w)| (i, j, w[k])).collect::<Vec<_>>()
        });
        let entries = each.map(|(i, j, x)| (first(i) + j, x)).collect();
        program.row(entries, wanted.map_or(0.0, |wanted| wanted[k] / MOST));
    }
    program.cones.push(SupportedConeT::ZeroConeT(6));
    let all = parts.iter().enumerate();
    match wanted {
        None => {
            let entries = all.flat_map(|(i, part)| normals(i, part)).map(|j| (j, 1.0)).collect();
            program.row(entries, 1.0);
            program.cones.push(SupportedConeT::ZeroConeT(1));
        }
        Some(_) => {
            for (i, part) in all {
                let sum = normals(i, part).into_iter().map(|j| (j, 1.0));
                program.row(sum.chain([(t, 1.0)]).collect(), 1.0);
            }
            program.cones.push(SupportedConeT::NonnegativeConeT(parts.len()));
        }
    }
    for (i, part) in parts.iter().enumerate() {
        let size = sizes[i];
        for j in 0..size {
            let slack = matches!(part, Part::Edges(_)) || j == 0;
            let mut entries = vec![(first(i) + j, -1.0)];
            entries.extend(slack.then_some((t, 1.0)));
            program.row(entries, 0.0);
        }
        program.cones.push(match part {
            Part::Round(_) => SupportedConeT::SecondOrderConeT(size),
            Part::Edges(_) => SupportedConeT::NonnegativeConeT(size),
        });
    }
    program.solve(t + 1)
}

/// A random grasp of a few centimetres whose cones have grains, each its own; some round or of edges.
fn random_grasp(random: &mut Random, with_edges: bool) -> Grasp<'static> {
    let count = 3 + random.index(3);
    let touches = random_touches(random, count, Family::Pcwf);
    let reach = touches.iter().map(|touch| touch.p.norm()).fold(1e-9, f64::max);
    let mut grasp = Grasp::new(random.direction() * 9.81);
    for (i, touch) in touches.iter().enumerate() {
        let mu = [random.range(0.2, 1.2), random.range(0.2, 1.2)];
        let gamma = if random.index(2) == 0 { 0.0 } else { random.range(1e-4, 4e-3) };
        let cone = match random.index(4) {
            0 if with_edges => edges_of(&touch.n, &random.direction(), mu),
            1 => Cone::Elliptic { mu: mu[0], gamma },
            _ => Cone::grained(&(random.direction() * random.range(0.1, 3.0)), mu, gamma),
        };
        let p_OC = touch.p * (LENGTH / reach);
        grasp.push(GraspContact { finger: FingerIndex(i as u8), p_OC, n_O: touch.n, cone });
    }
    grasp
}

/// Seven edges on an elliptic cone, unevenly.
fn edges_of(n_O: &Vec3, axis_O: &Vec3, mu: [f64; 2]) -> Cone<'static> {
    let ([t1, t2], n) = (tangents(&-n_O), -n_O);
    let along = (axis_O - n * n.dot(axis_O)).normalize();
    let across = n.cross(&along);
    let edge = |k: usize| {
        let (sin, cos) = (0.9 * k as f64 + 0.01 * (k * k) as f64).sin_cos();
        let f = along * (mu[0] * cos) + across * (mu[1] * sin);
        ConeEdge { tangential: [f.dot(&t1), f.dot(&t2)], torsion: 0.0 }
    };
    Cone::Polyhedral((0..7).map(edge).collect())
}

/// Every verdict against the program's optimum; asks for both kinds.
fn compare(what: &str, verdicts: impl Iterator<Item = (bool, Option<f64>)>) {
    let (mut yes, mut no, mut unclear) = (0, 0, 0);
    for (stable, slack) in verdicts {
        match slack {
            Some(slack) if slack > UNCLEAR => {
                assert!(stable, "{what}: refused, with a slack of {slack:e}");
                yes += 1;
            }
            Some(slack) if slack < -UNCLEAR => {
                assert!(!stable, "{what}: called stable, with a slack of {slack:e}");
                no += 1;
            }
            _ => unclear += 1,
        }
    }
    assert!(yes > 20 && no > 20 && 10 * unclear < yes + no, "{what}: {yes} yes, {no} no, {unclear} unclear");
}

#[test]
fn closure_is_that_of_the_conic_program() {
    for test in [&support::force_closure() as &dyn StabilityTest, &support::socp()] {
        let mut random = Random::from_key(71, 0, 0, 0);
        compare(
            "closure",
            (0..600).map(|_| {
                let grasp = random_grasp(&mut random, false);
                (verdict_of(test, &grasp).is_stable(), reference(&grasp, None))
            }),
        );
    }
    // Where some cones are of edges, and where the fingers are fewer by one.
    let (mut random, test) = (Random::from_key(72, 0, 0, 0), support::force_closure());
    compare(
        "closure with edges",
        (0..400).map(|_| {
            let grasp = random_grasp(&mut random, true);
            (verdict_of(&test, &grasp).is_stable(), reference(&grasp, None))
        }),
    );
}

/// The weight, and the weight with each vertex of the disturbances.
fn loads(settings: &EquilibriumSettings, g_O: &Vec3) -> Vec<Vector6<f64>> {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let pure = |f: Vec3, m: Vec3| wrench(&Vec3::zeros(), f, m);
    let weight = pure(g_O * -MASS, Vec3::zeros());
    let mut all = vec![weight];
    for (short, long) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
        for v in [Vec3::new(0.0, short, long), Vec3::new(short, long, 0.0), Vec3::new(long, 0.0, short)] {
            let v = v / (golden * golden / 3.0_f64.sqrt());
            all.push(weight + pure(v * settings.disturbance_force, Vec3::zeros()));
            all.push(weight + pure(Vec3::zeros(), v * settings.disturbance_torque));
        }
    }
    all
}

#[test]
fn equilibrium_is_that_of_the_conic_program() {
    let disturbances = EquilibriumSettings::default();
    let settings = EquilibriumSettings { max_normal_force: MOST, ..disturbances };
    let test = Equilibrium::new(settings, MASS, Vec3::zeros()).unwrap();
    for with_edges in [false, true] {
        let mut random = Random::from_key(73, 0, 0, 0);
        compare(
            "equilibrium",
            (0..160).map(|_| {
                let grasp = random_grasp(&mut random, with_edges);
                let slacks =
                    loads(&settings, &grasp.g_O).into_iter().map(|load| reference(&grasp, Some(load)));
                let least = slacks.collect::<Option<Vec<_>>>().map(|all| all.into_iter().fold(1.0, f64::min));
                (verdict_of(&test, &grasp).is_stable(), least)
            }),
        );
    }
}

#[test]
fn holding_is_that_of_the_conic_program() {
    let corners = [[0.1, 0.1, 0.1], [0.1, -0.1, -0.1], [-0.1, 0.1, -0.1], [-0.1, -0.1, 0.1]].map(Vec3::from);
    let facets = vec![[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]];
    let object = ObjectModel::new(Mesh::new(corners.to_vec(), facets).unwrap(), None, MASS, 1.2);
    let settings = HoldingSettings {
        reserve: 0.0,
        friction_factor: 1.0,
        max_normal_force: Some(MOST),
        ..Default::default()
    };
    let test = Holding::new(settings, &object).unwrap();
    let mut random = Random::from_key(74, 0, 0, 0);
    compare(
        "holding",
        (0..400).map(|_| {
            let grasp = random_grasp(&mut random, false);
            // As the whole of the friction at the object's own centre.
            let load = wrench(&object.p_OCm, grasp.g_O * -MASS, Vec3::zeros());
            (verdict_of(&test, &grasp).is_stable(), reference(&grasp, Some(load)))
        }),
    );
}

#[test]
fn a_grain_of_equal_coefficients_is_none() {
    let mut random = Random::from_key(76, 0, 0, 0);
    for _ in 0..300 {
        let mut grasp = Grasp::new(Vec3::zeros());
        let mut plain = Grasp::new(Vec3::zeros());
        for contact in random_grasp(&mut random, false).contacts() {
            let (mu, gamma) = (random.range(0.2, 1.2), 0.0);
            let cone = Cone::grained(&random.direction(), [mu, mu], gamma);
            grasp.push(GraspContact { cone, ..contact.clone() });
            plain.push(GraspContact { cone: Cone::Elliptic { mu, gamma }, ..contact.clone() });
        }
        let test = support::force_closure();
        assert_eq!(verdict_of(&test, &grasp), verdict_of(&test, &plain));
        let [a, b] = [&grasp, &plain].map(|g| support::with_context(|c| test.assess(g, None, None, c)));
        assert!((a.margin_lower - b.margin_lower).abs() < 1e-6, "{a:?} {b:?}");
    }
}
