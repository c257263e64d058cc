//! Mistakes of surfaces.

use regrasp::api::{
    CallError, Contact, Context, Parts, Projection, Random, Slot, SurfaceParam, SurfacePath, Vec3,
};

struct Liar {
    lie: String,
    honest: Box<dyn SurfaceParam>,
}

impl SurfaceParam for Liar {
    fn sample(&self, random: &mut Random) -> Contact {
        let mut contact = self.honest.sample(random);
        match self.lie.as_str() {
            // As smooth shading does it.
            "smooth-normals" => contact.n_O = contact.p_OC.normalize(),
            "long-normals" => contact.n_O *= 1.001,
            "inward" => contact.n_O = -contact.n_O,
            "a-little-outside" => contact.p_OC *= 1.001,
            _ => {}
        }
        contact
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        let found = self.honest.geodesic(from, to, path, context)?;
        let last = path.waypoints.len().saturating_sub(1);
        match self.lie.as_str() {
            "starts-beside" if found => path.waypoints[0].contact.p_OC.x += 1e-9,
            "chord" if found => path.length = 0.9 * (to.p_OC - from.p_OC).norm(),
            "stands-still" if found => path.waypoints[last].lift_length = 0.0,
            _ => {}
        }
        Ok(found)
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        let mut found = self.honest.project(p_OF, hint);
        match self.lie.as_str() {
            "tip-not-centre" => found.distance -= 0.010,
            "believes-hints" if hint.is_some() => found.distance += 1e-6,
            _ => {}
        }
        found
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.honest.walk(from, direction_O, distance)
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        let honest = self.honest.edge_distance(contact);
        if self.lie == "below-zero" { 1e-3 - honest } else { honest }
    }
}

crate::liar!(Surface, "surface", &[Slot::Surface], |lie, parts: &Parts<'_>| {
    Ok(Liar { lie, honest: parts.plugins.surface(None, "", parts)? })
});

#[test]
fn caught() {
    super::judge(
        Slot::Surface,
        &[
            ("smooth-normals", "contact-on-surface"),
            ("long-normals", "contact-on-surface"),
            ("inward", "contact-on-surface"),
            ("a-little-outside", "contact-on-surface"),
            ("starts-beside", "path-ends"),
            ("chord", "path-length"),
            ("stands-still", "path-lift"),
            ("tip-not-centre", "project-closest"),
            ("believes-hints", "project-hint"),
            ("below-zero", "edge-distance"),
        ],
    );
}
