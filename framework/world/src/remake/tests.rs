use super::*;
use crate::primitive_mesh;
use regrasp_api::Primitive;

const RADIUS: f64 = 0.03;

/// A ball's vertices and facets.
fn ball() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mesh = primitive_mesh(&Primitive::Sphere { radius: RADIUS }, 5120).unwrap();
    (mesh.vertices().to_vec(), mesh.facets().to_vec())
}

/// How far the vertices of a mesh are from the ball at most.
fn off_ball(mesh: &Mesh) -> f64 {
    mesh.vertices().iter().map(|v| (v.norm() - RADIUS).abs()).fold(0.0, f64::max)
}

#[test]
fn the_winding_number_tells_inside_from_outside() {
    let (vertices, facets) = ball();
    let winding = Winding::new(&vertices, &facets).unwrap();
    for (p, wanted) in [(0.0, 1.0), (0.029, 1.0), (0.031, 0.0), (0.1, 0.0)] {
        let found = winding.at(&Vec3::new(0.6 * p, -0.8 * p, 0.0));
        assert!((found - wanted).abs() < 0.02, "{p}: {found}");
    }
    // Without one half: half around the middle.
    let half: Vec<[u32; 3]> = facets.into_iter().filter(|f| vertices[f[0] as usize].z > 0.0).collect();
    assert!((Winding::new(&vertices, &half).unwrap().at(&Vec3::zeros()) - 0.5).abs() < 0.03);
    assert!(Winding::new(&vertices, &[]).is_none());
}

#[test]
fn a_ball_with_a_hole_a_doubled_facet_and_a_spike_through_it_becomes_a_ball() {
    let (mut vertices, mut facets) = ball();
    facets.push(facets[7]);
    facets.truncate(facets.len() - 40);
    facets.push([3, 3, 9]);
    let inward = facets[100][0] as usize;
    vertices[inward] = -vertices[inward] * 1.02;
    assert!(Mesh::new(vertices.clone(), facets.clone()).is_err());
    let remade = remake(&vertices, &facets).unwrap();
    let volume = remade.mesh.mass_properties().volume / (4.0 / 3.0 * std::f64::consts::PI * RADIUS.powi(3));
    assert!((volume - 1.0).abs() < 0.02, "{volume}");
    assert!(remade.off.0 < 0.1 * remade.step, "{:?}", remade.off);
    assert!(remade.remark().contains("made anew"));
}

#[test]
fn a_good_surface_stays_where_it_is() {
    let (vertices, facets) = ball();
    let remade = remake(&vertices, &facets).unwrap();
    assert!(off_ball(&remade.mesh) < 0.3 * remade.step, "{}", off_ball(&remade.mesh) / remade.step);
    assert_eq!(remake(&vertices, &facets).unwrap(), remade);
}

#[test]
fn what_encloses_nothing_or_several_bodies_is_none() {
    let (vertices, facets) = ball();
    assert!(remake(&vertices, &facets[..1]).is_none());
    assert!(remake(&vertices, &[]).is_none() && remake(&[], &[]).is_none());
    let turned: Vec<[u32; 3]> = facets.iter().map(|f| [f[0], f[2], f[1]]).collect();
    assert!(remake(&vertices, &turned).is_none());
    let (mut both, mut all) = (vertices.clone(), facets.clone());
    both.extend(vertices.iter().map(|v| v + Vec3::x() * 0.1));
    all.extend(facets.iter().map(|f| f.map(|v| v + vertices.len() as u32)));
    assert!(remake(&both, &all).is_none());
}
