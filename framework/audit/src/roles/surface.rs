//! Surfaces under audit.

use crate::auditor::{Key, bits};
use crate::laws::{self, Ground, Kept, ensure};
use crate::{Audited, input};
use regrasp_api::{CallError, Contact, Context, Projection, Random, SurfaceParam, SurfacePath, Vec3};
use serde_json::json;
use std::cell::RefCell;

fn alike<T: PartialEq>(first: &T, again: &T) -> Kept {
    ensure("pure", first == again, || "the same call again answers otherwise".into())
}

impl Audited<'_, dyn SurfaceParam + '_> {
    fn ground(&self) -> Ground<'_> {
        Ground { mesh: &self.auditor.object.mesh, radius: self.auditor.radius }
    }
}

impl SurfaceParam for Audited<'_, dyn SurfaceParam + '_> {
    fn sample(&self, random: &mut Random) -> Contact {
        let before = random.clone();
        self.value(
            ("sample", Key::Short(random.state()[0])),
            |surface| surface.sample(random),
            || json!({ "random": input::random_state(&before) }),
            |surface, found| {
                alike(found, &surface.sample(&mut before.clone()))?;
                laws::contact_on_surface(&self.ground(), found)
            },
        )
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let path = RefCell::new(path);
        // The whole path is the answer.
        let walked = |surface: &dyn SurfaceParam, context: &mut Context<'_>| {
            let mut path = path.borrow_mut();
            let found = surface.geodesic(from, to, &mut path, context)?;
            Ok((found, found.then(|| path.clone())))
        };
        let answer = self.call(
            ("geodesic", Key::Short(bits(from.p_OC.iter().chain(to.p_OC.iter())))),
            context,
            walked,
            |_| json!({ "from": input::contact(from), "to": input::contact(to) }),
            |_, (_, path), _| match path {
                Some(path) => laws::path_kept(&self.ground(), from, to, path),
                None => Ok(()),
            },
        );
        answer.map(|(found, _)| found)
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        self.value(
            ("project", Key::Short(bits(p_OF.iter()))),
            |surface| surface.project(p_OF, hint),
            || json!({ "p_OF": input::vector(p_OF), "hint": hint }),
            |surface, found| {
                let plain = surface.project(p_OF, None);
                // On an edge either facet may be named.
                let same = (plain.distance - found.distance).abs() <= 1e-9
                    && (plain.contact.p_OC - found.contact.p_OC).norm() <= 1e-7;
                let convex = self.ground().mesh.is_locally_convex();
                ensure("project-hint", same || !convex, || {
                    format!(
                        "the hint changes the distance from {:e} m to {:e} m",
                        plain.distance, found.distance
                    )
                })?;
                if laws::is_looked_at(p_OF) {
                    laws::projection_kept(&self.ground(), p_OF, found)
                } else {
                    Ok(())
                }
            },
        )
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.value(
            ("walk", Key::Short(bits(from.p_OC.iter().chain(direction_O.iter())))),
            |surface| surface.walk(from, direction_O, distance),
            || {
                json!({
                    "from": input::contact(from),
                    "direction_O": input::vector(direction_O),
                    "distance": distance,
                })
            },
            |surface, found| {
                alike(found, &surface.walk(from, direction_O, distance))?;
                laws::walk_kept(&self.ground(), from, distance, found)
            },
        )
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.value(
            ("edge_distance", Key::Short(bits(contact.p_OC.iter()))),
            |surface| surface.edge_distance(contact),
            || json!({ "contact": input::contact(contact) }),
            |surface, found| {
                alike(found, &surface.edge_distance(contact))?;
                ensure("edge-distance", *found >= 0.0, || format!("{found} m is no distance"))
            },
        )
    }
}
