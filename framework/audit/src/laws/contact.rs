//! Laws of contacts on the object's surface, and of what surfaces answer.

use super::{Kept, broken, ensure, length};
use crate::geometry::{closest_on_facet, closest_on_mesh};
use regrasp_api::{Contact, Mesh, Projection, SurfacePath, Vec3};

/// A contact counts as on the surface within this distance (m).
const ON_SURFACE: f64 = 1e-7;
/// A normal has unit length within this (no unit).
const UNIT: f64 = 1e-9;
/// How far a fingertip's centre may be from the radius over the surface (m).
const HELD: f64 = 1e-6;

/// The truth that contacts are held against: the mesh, and the radius of the fingertips.
#[derive(Clone, Copy)]
pub struct Ground<'a> {
    /// The object's mesh.
    pub mesh: &'a Mesh,
    /// Radius of the fingertips (m).
    pub radius: f64,
}

/// Law `contact-on-surface`: a finite point of the mesh, and a unit normal along which a fingertip touches
/// there and nowhere deeper.
///
/// On an object that is not convex, a neighbouring part may be nearer than the touch: then only point and
/// length are checked.
pub fn contact_on_surface(ground: &Ground<'_>, contact: &Contact) -> Kept {
    const LAW: &str = "contact-on-surface";
    let Contact { facet, p_OC, n_O } = contact;
    let finite = p_OC.iter().chain(n_O.iter()).all(|x| x.is_finite());
    ensure(LAW, finite, || format!("{contact:?} is not finite"))?;
    let norm = n_O.norm();
    ensure(LAW, (norm - 1.0).abs() <= UNIT, || format!("the normal's length is {norm:.9}"))?;
    let known = (*facet as usize) < ground.mesh.facets().len();
    // Most contacts lie inside the facet that they name, and have its normal: no search is needed.
    if known && n_O.dot(&ground.mesh.normal(*facet)) > 1.0 - 1e-15 && on_facet(ground, *facet, p_OC) {
        return Ok(());
    }
    let on = known && on_facet(ground, *facet, p_OC);
    let off = if on { 0.0 } else { (closest_on_mesh(ground.mesh, p_OC).point - p_OC).norm() };
    ensure(LAW, off <= ON_SURFACE, || format!("the point is {} off the mesh", length(off)))?;
    let center = p_OC + n_O * ground.radius;
    // What a wrong normal leads into is next door; now and then the whole mesh is asked.
    let found = match on && !is_looked_at(p_OC) {
        true => around(ground, *facet, &center),
        false => closest_on_mesh(ground.mesh, &center).distance,
    };
    let deep = ground.radius - found;
    let convex = ground.mesh.is_locally_convex();
    ensure(LAW, deep <= HELD || !convex, || {
        format!(
            "a fingertip there would stand {} inside the mesh: its normal is not the mesh's",
            length(deep)
        )
    })
}

/// The distance (m) of a point from a facet and those beside it; negative below the facet.
fn around(ground: &Ground<'_>, facet: u32, p: &Vec3) -> f64 {
    let mesh = ground.mesh;
    let distance = |facet: u32| (closest_on_facet(mesh, facet, p) - p).norm();
    let beside = mesh.neighbors(facet).iter().map(|neighbor| distance(neighbor.facet));
    let least = beside.fold(distance(facet), f64::min);
    if mesh.normal(facet).dot(&(p - mesh.corners(facet)[0])) < 0.0 { -least } else { least }
}

/// Of how many positions one is compared with all facets, which takes longer than the plugin does.
const RARE: u64 = 64;

/// Whether a position is one of those: told by its bits, so that the same calls are looked at in every run.
pub(crate) fn is_looked_at(p: &Vec3) -> bool {
    let bits = p.iter().fold(0_u64, |sum, x| (sum ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    (bits >> 40).is_multiple_of(RARE)
}

fn on_facet(ground: &Ground<'_>, facet: u32, p: &Vec3) -> bool {
    (closest_on_facet(ground.mesh, facet, p) - p).norm() <= ON_SURFACE
}

/// Law `project-closest`: the point of the mesh closest to `p_OF` (m), its distance, and the normal towards
/// it.
pub fn projection_kept(ground: &Ground<'_>, p_OF: &Vec3, found: &Projection) -> Kept {
    const LAW: &str = "project-closest";
    let true_distance = closest_on_mesh(ground.mesh, p_OF).distance;
    let claimed = found.distance;
    ensure(LAW, (claimed - true_distance).abs() <= ON_SURFACE, || {
        format!("says {}, the mesh is at {}", length(claimed), length(true_distance))
    })?;
    let reach = (p_OF - found.contact.p_OC).norm();
    ensure(LAW, (reach - claimed.abs()).abs() <= ON_SURFACE, || {
        format!("its point is {} away, its distance says {}", length(reach), length(claimed))
    })?;
    let aim = found.contact.p_OC + found.contact.n_O * claimed - p_OF;
    // Close to the surface rounding turns the direction.
    ensure(LAW, reach < 1e-6 || aim.norm() <= ON_SURFACE, || {
        "the normal does not point to the given position".into()
    })
}

/// Law `walk-distance`: on an object that is convex nobody comes farther than he walks.
pub fn walk_kept(ground: &Ground<'_>, from: &Contact, distance: f64, to: &Contact) -> Kept {
    let chord = (to.p_OC - from.p_OC).norm();
    ensure("walk-distance", chord <= distance.abs() + 1e-9 || !ground.mesh.is_locally_convex(), || {
        format!("a walk of {} ends {} away", length(distance), length(chord))
    })?;
    contact_on_surface(ground, to)
}

/// Laws of a path between two contacts: `path-ends`, `path-on-surface`, `path-lift`, `path-length`.
pub fn path_kept(ground: &Ground<'_>, from: &Contact, to: &Contact, path: &SurfacePath) -> Kept {
    let waypoints = &path.waypoints;
    let (Some(first), Some(last)) = (waypoints.first(), waypoints.last()) else {
        return broken("path-ends", "the path has no waypoint");
    };
    ensure("path-ends", first.contact == *from && last.contact == *to, || {
        let apart = (first.contact.p_OC - from.p_OC).norm().max((last.contact.p_OC - to.p_OC).norm());
        format!("the path does not start and end exactly at the given contacts ({} off)", length(apart))
    })?;
    ensure("path-lift", first.lift_length == 0.0, || "the lift does not start at 0".into())?;
    for pair in waypoints.windows(2) {
        let travelled = pair[1].lift_length - pair[0].lift_length;
        let [a, b] = [&pair[0].contact, &pair[1].contact].map(|contact| contact.tip_center(ground.radius));
        ensure("path-lift", travelled >= (b - a).norm() - 1e-9 && travelled.is_finite(), || {
            format!(
                "the fingertip's centre moves {}, its lift by {}",
                length((b - a).norm()),
                length(travelled)
            )
        })?;
    }
    waypoints.iter().try_for_each(|waypoint| {
        contact_on_surface(ground, &waypoint.contact)
            .map_err(|fault| super::Broken { law: "path-on-surface", what: fault.what })
    })?;
    let chord = (to.p_OC - from.p_OC).norm();
    ensure("path-length", path.length.is_finite() && path.length >= chord * (1.0 - 1e-9) - 1e-12, || {
        format!("length {}, the ends are {} apart", length(path.length), length(chord))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cube of 2 cm about the origin.
    fn cube() -> Mesh {
        let corner = |k: usize| {
            let side = |bit: usize| if k >> bit & 1 == 1 { 0.01 } else { -0.01 };
            Vec3::new(side(0), side(1), side(2))
        };
        let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        let facets = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        Mesh::new((0..8).map(corner).collect(), facets).unwrap()
    }

    #[test]
    fn contacts_are_held_against_the_mesh() {
        let mesh = cube();
        let ground = Ground { mesh: &mesh, radius: 0.01 };
        let facet = (0..12).find(|&facet| mesh.normal(facet).x > 0.5).unwrap();
        let p_OC = (mesh.corners(facet)[0] + mesh.corners(facet)[1] + mesh.corners(facet)[2]) / 3.0;
        let right = Contact { facet, p_OC, n_O: Vec3::x() };
        assert!(contact_on_surface(&ground, &right).is_ok());
        let edge = Contact { facet, p_OC: Vec3::new(0.01, 0.01, 0.0), n_O: Vec3::new(0.6, 0.8, 0.0) };
        assert!(contact_on_surface(&ground, &edge).is_ok(), "between the normals of an edge");
        let slanted = Vec3::new(0.999, 0.04, 0.0).normalize();
        for wrong in [
            Contact { n_O: slanted, ..right },
            Contact { n_O: -Vec3::x(), ..right },
            Contact { n_O: Vec3::x() * 1.001, ..right },
            Contact { p_OC: p_OC * 1.001, ..right },
            Contact { n_O: Vec3::new(f64::NAN, 0.0, 0.0), ..right },
        ] {
            let found = contact_on_surface(&ground, &wrong);
            assert_eq!(found.map_err(|fault| fault.law), Err("contact-on-surface"), "{wrong:?}");
        }
    }
}
