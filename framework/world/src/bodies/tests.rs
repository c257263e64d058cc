use super::*;
use crate::primitive_mesh;
use regrasp_api::Primitive;

/// Boxes given by centre and half size, those with `false` inside out, as one mesh.
fn boxes(all: &[(Vec3, f64, bool)]) -> Mesh {
    let (mut vertices, mut facets) = (Vec::new(), Vec::new());
    for (center, half, outward) in all {
        let cube = primitive_mesh(&Primitive::Cuboid { half_size: Vec3::repeat(*half) }, 12).unwrap();
        let first = vertices.len() as u32;
        vertices.extend(cube.vertices().iter().map(|v| v + center));
        let turned = |f: &[u32; 3]| if *outward { *f } else { [f[0], f[2], f[1]] }.map(|v| v + first);
        facets.extend(cube.facets().iter().map(turned));
    }
    Mesh::new(vertices, facets).unwrap()
}

fn at(x: f64) -> Vec3 {
    Vec3::new(x, 0.1 * x, 0.07 * x)
}

fn rigid(mesh: Mesh, assembly: bool) -> Result<Mesh, BodyFault> {
    rigid_body(mesh, assembly).map(|body| body.mesh)
}

#[test]
fn what_overlapping_bodies_share_counts_once() {
    let both = boxes(&[(at(0.0), 0.02, true), (at(0.015), 0.015, true)]);
    let union = rigid(both.clone(), false).unwrap();
    // The first reaches to 0.02 along each axis, the second from its centre - 0.015 on.
    let shared: f64 = at(0.015).iter().map(|c| 0.02f64.min(c + 0.015) - (c - 0.015).max(-0.02)).product();
    let wanted = 0.04f64.powi(3) + 0.03f64.powi(3) - shared;
    assert!((union.mass_properties().volume - wanted).abs() < 1e-12, "{}", union.mass_properties().volume);
    assert_eq!(body_count(&union), 1);
    assert_eq!(rigid(both, false).unwrap(), union);
}

#[test]
fn a_body_inside_out_that_overlaps_another_is_named() {
    let fault = rigid(boxes(&[(at(0.0), 0.02, true), (at(0.015), 0.015, false)]), false).unwrap_err();
    assert!(matches!(fault, BodyFault::InsideOut { body: 2, .. }), "{fault}");
}

#[test]
fn a_body_within_another_is_part_of_it_and_a_turned_one_a_hollow() {
    let nested = rigid(boxes(&[(at(0.0), 0.02, true), (at(0.001), 0.01, true)]), false).unwrap();
    assert!((nested.mass_properties().volume - 0.04f64.powi(3)).abs() < 1e-15);
    let hollow = rigid(boxes(&[(at(0.0), 0.02, true), (at(0.001), 0.01, false)]), false).unwrap();
    assert!((hollow.mass_properties().volume - (0.04f64.powi(3) - 0.02f64.powi(3))).abs() < 1e-15);
    assert_eq!(body_count(&hollow), 2);
}

#[test]
fn a_small_body_inside_out_is_named() {
    let fault = rigid(boxes(&[(at(0.0), 0.02, true), (at(0.06), 0.01, false)]), true).unwrap_err();
    assert!(matches!(fault, BodyFault::InsideOut { body: 2, count: 2, facets: 12, .. }), "{fault}");
}

#[test]
fn a_body_inside_out_is_turned_and_a_hollow_is_not() {
    let mesh =
        outward_bodies(boxes(&[(at(0.0), 0.02, true), (at(0.06), 0.01, false), (at(0.0), 0.01, false)]));
    let wanted = 0.04f64.powi(3) + 0.02f64.powi(3) - 0.02f64.powi(3);
    assert!((mesh.mass_properties().volume - wanted).abs() < 1e-15);
}

#[test]
fn bodies_apart_are_an_assembly_or_refused() {
    let mesh = || boxes(&[(at(0.0), 0.02, true), (at(0.06), 0.01, true)]);
    assert!(matches!(rigid(mesh(), false), Err(BodyFault::Apart { count: 2, .. })));
    assert_eq!(rigid(mesh(), true).unwrap(), mesh());
    // Also one that lies in another's hollow.
    let caged = boxes(&[(at(0.0), 0.03, true), (at(0.0), 0.02, false), (at(0.0), 0.01, true)]);
    assert!(matches!(rigid(caged, false), Err(BodyFault::Apart { count: 2, .. })));
}

#[test]
fn a_surface_through_itself_is_named_with_the_place() {
    let ball = primitive_mesh(&Primitive::Sphere { radius: 0.02 }, 320).unwrap();
    let top = (0..ball.vertices().len())
        .max_by(|&a, &b| ball.vertices()[a].z.total_cmp(&ball.vertices()[b].z))
        .unwrap();
    let [x, y, z] = ball.vertices()[top].into();
    // Straight through the opposite vertex, edge upon edge, and beside it.
    for apex in [Vec3::new(-1.5 * x, -1.5 * y, -1.5 * z), Vec3::new(x + 1.1e-3, y + 0.7e-3, -0.03)] {
        let mut vertices = ball.vertices().to_vec();
        vertices[top] = apex;
        let fault = rigid(Mesh::new(vertices, ball.facets().to_vec()).unwrap(), false).unwrap_err();
        assert!(matches!(fault, BodyFault::Crossing { .. }), "{apex}: {fault}");
    }
    assert!(rigid(ball, false).is_ok());
}

#[test]
fn bodies_that_cross_edge_upon_edge_or_touch_are_told_apart() {
    // Mirrored about the planes of symmetry: the edges of each go through the diagonals of the other.
    let plus = boxes(&[(Vec3::zeros(), 0.02, true), (Vec3::new(0.02, 0.0, 0.0), 0.01, true)]);
    let union = rigid(plus, false).unwrap();
    let wanted = 0.04f64.powi(3) + 0.5 * 0.02f64.powi(3);
    assert!((union.mass_properties().volume - wanted).abs() < 1e-12, "{}", union.mass_properties().volume);
    // Face upon face: nothing reaches through anything.
    let upon = boxes(&[(Vec3::zeros(), 0.02, true), (Vec3::new(0.0, 0.0, 0.03), 0.01, true)]);
    assert!(!matches!(rigid(upon, true), Err(BodyFault::Crossing { .. } | BodyFault::Overlap { .. })));
}

#[test]
fn bodies_that_touch_by_faces_become_one() {
    let sizes = 0.04f64.powi(3) + 0.02f64.powi(3);
    for place in [Vec3::new(0.0, 0.0, 0.03), Vec3::new(0.03, 0.004, -0.003), Vec3::new(0.0, 0.03, 0.01)] {
        let upon = rigid_body(boxes(&[(Vec3::zeros(), 0.02, true), (place, 0.01, true)]), false).unwrap();
        assert!((upon.mesh.mass_properties().volume - sizes).abs() < 1e-11, "{place}");
        assert_eq!((body_count(&upon.mesh), upon.united), (1, 2));
    }
    // A gap, and an edge in common, do not make one piece.
    for place in [Vec3::new(0.0, 0.0, 0.030_001), Vec3::new(0.03, 0.0, 0.03)] {
        let apart = rigid_body(boxes(&[(Vec3::zeros(), 0.02, true), (place, 0.01, true)]), false);
        assert!(matches!(apart, Err(BodyFault::Apart { count: 2, .. })), "{place}");
    }
}

#[test]
fn what_was_done_is_counted() {
    let both = rigid_body(boxes(&[(at(0.0), 0.02, true), (at(0.015), 0.015, true)]), false).unwrap();
    assert!(both.remarks()[0].starts_with("2 bodies that overlap or touch were united"));
    let nested = rigid_body(boxes(&[(at(0.0), 0.02, true), (at(0.001), 0.01, true)]), false).unwrap();
    assert_eq!((nested.united, nested.within), (0, 1));
    assert!(rigid_body(boxes(&[(at(0.0), 0.02, true)]), false).unwrap().remarks().is_empty());
}

/// A ball of radius 30 mm with a small one of 9 mm in its side, whose middle is `x` (m) away, and the volume
/// that both have together.
fn ball_with_knob(x: f64) -> (Mesh, f64) {
    let ball = primitive_mesh(&Primitive::Sphere { radius: 0.03 }, 320).unwrap();
    let knob = primitive_mesh(&Primitive::Sphere { radius: 0.009 }, 320).unwrap();
    let moved = knob.vertices().iter().map(|v| v + Vec3::x() * x);
    let vertices: Vec<Vec3> = ball.vertices().iter().copied().chain(moved).collect();
    let first = ball.vertices().len() as u32;
    let facets = knob.facets().iter().map(|f| f.map(|v| v + first));
    let facets = ball.facets().iter().copied().chain(facets).collect();
    let volume = ball.mass_properties().volume + knob.mass_properties().volume;
    (Mesh::new(vertices, facets).unwrap(), volume)
}

#[test]
fn bodies_whose_vertices_lie_in_common_planes_are_united() {
    for x in [0.02, 0.025, 0.026, 0.027, 0.028, 0.03, 0.033, 0.036, 0.038] {
        let (both, volume) = ball_with_knob(x);
        let union = rigid(both, false).unwrap_or_else(|fault| panic!("{x}: {fault}"));
        assert!(union.mass_properties().volume < volume && union.mass_properties().volume > 1.05e-4, "{x}");
        assert_eq!(body_count(&union), 1);
    }
}
