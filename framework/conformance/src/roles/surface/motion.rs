//! Walking, rigid motions of the object, purity.

use super::ground::{EXACT, build, object, on_each};
use super::point::is_contact;
use crate::law::{Subject, context, pure, random};
use crate::report::{Fault, Finding, ensure};
use regrasp_api::{Contact, Mesh, ObjectModel, Pose, Primitive, SurfacePath, Vec3};

pub(super) fn walk(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        let mut random = random(61);
        for distance in [0.0, 1e-4, 2e-3, 0.01, 0.04] {
            for _ in 0..10 {
                let (from, direction) = (ground.surface.sample(&mut random), random.direction());
                let to = ground.surface.walk(&from, &direction, distance);
                let chord = (to.p_OC - from.p_OC).norm();
                let text = || format!("a walk of {distance} m along {direction:?} from {from:?} to {to:?}");
                is_contact(ground, &to, 1e-7)?;
                // At a concave edge the contact jumps under a fingertip that stays.
                ensure(chord <= distance + 1e-9 || !ground.is_convex(), text)?;
                // Bent by an edge or two, a short way ends not much nearer.
                let short = distance <= 2e-3 && ground.is_convex();
                ensure(!short || chord >= 0.4 * distance - 1e-9, text)?;
                let longer = ground.surface.walk(&from, &(direction * 3.0), distance);
                let off = (longer.p_OC - to.p_OC).norm();
                ensure(off <= 1e-7, || {
                    format!("with three times the direction it ends {off:e} m beside {to:?}")
                })?;
                if let Some(Primitive::Cuboid { half_size }) = ground.object.primitive {
                    let tangent = direction - from.n_O * from.n_O.dot(&direction);
                    let flat = from.p_OC + tangent.normalize() * distance;
                    let stays = (0..3).all(|i| flat[i].abs() < half_size[i] + 1e-9);
                    ensure(!stays || (to.p_OC - flat).norm() <= EXACT, text)?;
                }
                if let Some(Primitive::Sphere { radius }) = ground.object.primitive {
                    let arc = 2.0 * radius * (distance / (2.0 * radius)).sin();
                    ensure((chord - arc).abs() <= 0.03 * arc + 1e-9, text)?;
                }
            }
        }
        Ok(())
    })
}

/// A point and a contact after the motion.
fn moved(X: &Pose, p: &Vec3) -> Vec3 {
    X.rotation * p + X.translation.vector
}

fn moved_contact(X: &Pose, contact: &Contact) -> Contact {
    Contact { p_OC: moved(X, &contact.p_OC), n_O: X.rotation * contact.n_O, ..*contact }
}

/// The same mesh in another frame.
fn moved_mesh(X: &Pose, mesh: &Mesh) -> Mesh {
    let vertices = mesh.vertices().iter().map(|p| moved(X, p)).collect();
    Mesh::new(vertices, mesh.facets().to_vec()).expect("a rigid motion keeps a mesh sound")
}

pub(super) fn rigid_motion(subject: &Subject<'_>) -> Finding {
    let mut random = random(62);
    let X = Pose::from_parts(Vec3::new(0.05, -0.02, 0.2).into(), random.rotation());
    let cube = Primitive::Cuboid { half_size: Vec3::new(0.0225, 0.02, 0.025) };
    let plain = ObjectModel { primitive: None, ..object(&cube, 12) };
    let other = ObjectModel::new(moved_mesh(&X, &plain.mesh), None, 0.1, 0.8);
    let (Some(here), Some(there)) = (build(subject, "mesh", plain)?, build(subject, "moved mesh", other)?)
    else {
        return Err(Fault::Skip("the plugin takes no mesh".into()));
    };
    for (from, to) in here.pairs(62, 30) {
        let p_OF = from.tip_center(0.02) + random.direction() * 1e-3;
        let (a, b) = (here.surface.project(&p_OF, None), there.surface.project(&moved(&X, &p_OF), None));
        let error = (moved(&X, &a.contact.p_OC) - b.contact.p_OC).norm();
        ensure((a.distance - b.distance).abs() <= EXACT && error <= 1e-7, || {
            format!("projects to {a:?}, after the motion {X:?} to {b:?}")
        })?;
        let [from_moved, to_moved] = [&from, &to].map(|contact| moved_contact(&X, contact));
        let lengths = [here.path(&from, &to)?.length, there.path(&from_moved, &to_moved)?.length];
        let tolerance = subject.demands.geodesic_tolerance;
        ensure((lengths[0] - lengths[1]).abs() <= tolerance * lengths[0] + 1e-9, || {
            format!("lengths {lengths:?} before and after the motion {X:?}")
        })?;
        let edges = [here.surface.edge_distance(&from), there.surface.edge_distance(&from_moved)];
        ensure((edges[0] - edges[1]).abs() <= EXACT, || format!("distances from edges {edges:?}"))?;
    }
    Ok(())
}

pub(super) fn surface_pure(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        let pairs = ground.pairs(63, 6);
        pure(pairs.len(), |i| {
            let (from, to) = pairs[i];
            let mut path = SurfacePath::default();
            let found = ground.surface.geodesic(&from, &to, &mut path, &mut context(0))?;
            let mut stream = random(i as u64);
            let projected = ground.surface.project(&from.tip_center(0.01), None);
            let walked = ground.surface.walk(&from, &to.n_O, 0.01);
            let edge = ground.surface.edge_distance(&to);
            Ok((ground.surface.sample(&mut stream), found, path, projected, walked, edge))
        })
    })
}
