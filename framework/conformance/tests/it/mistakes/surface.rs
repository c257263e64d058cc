//! Mistakes of surfaces.

use regrasp_api::*;
use regrasp_conformance::reference::FacetSurface;
use std::collections::BTreeMap;
use std::sync::Mutex;

struct Mistaken {
    mistake: String,
    mesh: Mesh,
    right: FacetSurface,
    /// Paths by the facets of their ends.
    by_facets: Mutex<BTreeMap<(u32, u32), SurfacePath>>,
}

impl Mistaken {
    fn new(mistake: String, parts: &Parts<'_>) -> Self {
        let mesh = parts.object.mesh.clone();
        let right = FacetSurface::new(&mesh, parts.hand.fingertip_radius());
        Self { mistake, mesh, right, by_facets: Mutex::default() }
    }

    /// The least distance to an edge of these facets that `counts`.
    fn to_edges(&self, facets: impl Iterator<Item = u32>, contact: &Contact, counts: fn(f64) -> bool) -> f64 {
        let mut least = f64::INFINITY;
        for facet in facets {
            let corners = self.mesh.corners(facet);
            for (k, neighbor) in self.mesh.neighbors(facet).iter().enumerate() {
                let (a, b) = (corners[k], corners[(k + 1) % 3]);
                let along = (b - a).normalize();
                let to = contact.p_OC - a;
                // From the whole line, where the foot need not lie on the edge.
                let beside = (to - along * along.dot(&to)).norm();
                least = if counts(neighbor.bend.abs()) { least.min(beside) } else { least };
            }
        }
        least
    }
}

impl SurfaceParam for Mistaken {
    fn sample(&self, random: &mut Random) -> Contact {
        let mut contact = self.right.sample(random);
        match self.mistake.as_str() {
            // Three random weights over their sum draw the middle of the facet.
            "weights-over-their-sum" => {
                let [a, b, c] = self.mesh.corners(contact.facet);
                let w = [random.unit(), random.unit(), random.unit()];
                contact.p_OC = (a * w[0] + b * w[1] + c * w[2]) / (w[0] + w[1] + w[2]);
            }
            // Drawn on the ball around the object and projected: the middle of faces is drawn more often.
            "drawn-on-a-ball" => contact = self.right.project(&(random.direction() * 0.1), None).contact,
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
        let before = std::mem::take(path);
        let found = self.right.geodesic(from, to, path, context)?;
        let last = path.waypoints.len() - 1;
        match self.mistake.as_str() {
            // The buffer of the call before is not cleared.
            "old-path" => {
                let own = std::mem::replace(&mut path.waypoints, before.waypoints);
                path.waypoints.extend(own);
            }
            "stale-facets" => path.waypoints.iter_mut().for_each(|w| w.contact.facet = from.facet),
            "by-facets" => {
                let mut known = self.by_facets.lock().unwrap();
                *path = known.entry((from.facet, to.facet)).or_insert(path.clone()).clone();
            }
            "ends-at-vertices" if last > 1 => {
                let corners = self.mesh.corners(to.facet);
                let nearest = corners.iter().map(|p| (p - to.p_OC).norm()).fold(f64::INFINITY, f64::min);
                path.length += nearest;
            }
            "millimetres" => path.length *= 1e3,
            "one-facet-alone" if from.facet != to.facet => return Ok(false),
            // Twice round a hole where once would do.
            "the-long-way" if !self.mesh.is_locally_convex() && path.length > 0.02 => {
                let mut first = SurfacePath::default();
                let over = self.right.project(&-(0.5 * (from.p_OC + to.p_OC) * 4.0), None).contact;
                let mut own = Context::new(context.random.clone(), &Uninterrupted);
                self.right.geodesic(from, &over, &mut first, &mut own)?;
                let mut second = SurfacePath::default();
                self.right.geodesic(&over, to, &mut second, &mut own)?;
                let so_far = first.lift_length();
                let shift = |w: &Waypoint| Waypoint { lift_length: w.lift_length + so_far, ..*w };
                first.waypoints.extend(second.waypoints.iter().skip(1).map(shift));
                first.length += second.length;
                *path = first;
            }
            _ => {}
        }
        Ok(found)
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        let mut found = self.right.project(p_OF, hint);
        match self.mistake.as_str() {
            "unsigned" => found.distance = found.distance.abs(),
            "normals-of-facets" => found.contact.n_O = self.mesh.normal(found.contact.facet),
            "vertex-normals" if found.distance > 0.0 => {
                found.contact.n_O = found.contact.p_OC.normalize();
            }
            "hinted-facet-alone" => {
                if let Some(facet) = hint {
                    let corners = self.mesh.corners(facet);
                    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
                    // Goes down from the hint, and stays in its valley.
                    if (p_OF - middle).norm() > 0.02 {
                        let p_OC = regrasp_conformance::reference::closest_on_facet(&self.mesh, facet, p_OF);
                        let out = p_OF - p_OC;
                        found.distance = out.norm();
                        found.contact = Contact { facet, p_OC, n_O: out.normalize() };
                    }
                }
            }
            _ => {}
        }
        found
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        let straight = self.right.walk(from, direction_O, distance);
        match self.mistake.as_str() {
            // The direction is taken for a velocity.
            "speed-for-direction" => self.right.walk(from, direction_O, distance * direction_O.norm()),
            "keeps-its-normal" => Contact { n_O: from.n_O, ..straight },
            "stops-at-edges" => {
                let stays = |s: f64| self.right.walk(from, direction_O, s * distance).n_O == from.n_O;
                let part = (0..=16).rev().map(|k| f64::from(k) / 16.0).find(|s| stays(*s));
                self.right.walk(from, direction_O, part.unwrap_or(0.0) * distance)
            }
            // Straight ahead in space, then back onto the surface.
            "projected-chord" => {
                self.right.project(&(from.p_OC + direction_O.normalize() * distance), None).contact
            }
            _ => straight,
        }
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        let all = 0..self.mesh.facets().len() as u32;
        match self.mistake.as_str() {
            "every-edge-is-sharp" => self.to_edges(all, contact, |_| true),
            "no-edge-is-sharp" => f64::INFINITY,
            "own-edges-alone" => self.to_edges(contact.facet..contact.facet + 1, contact, |b| b > 0.5),
            _ => self.right.edge_distance(contact),
        }
    }
}

#[test]
fn caught() {
    let entry = crate::mistaken!(Surface, "surface", &[Slot::Surface], Mistaken::new);
    super::judge(
        &entry,
        &[
            ("weights-over-their-sum", "sample-uniform"),
            ("drawn-on-a-ball", "sample-uniform"),
            ("old-path", "geodesic-endpoints"),
            ("stale-facets", "geodesic-on-surface|geodesic-endpoints"),
            ("by-facets", "geodesic-endpoints"),
            ("ends-at-vertices", "geodesic-shortest|geodesic-length"),
            ("millimetres", "geodesic-shortest|geodesic-length"),
            ("one-facet-alone", "geodesic-endpoints|geodesic-shortest"),
            ("the-long-way", "geodesic-shortest"),
            ("unsigned", "project-exact"),
            ("normals-of-facets", "project-exact"),
            ("vertex-normals", "project-exact"),
            ("hinted-facet-alone", "project-ignores-hint"),
            ("speed-for-direction", "walk"),
            ("keeps-its-normal", "walk"),
            ("stops-at-edges", "walk"),
            ("projected-chord", "walk"),
            ("every-edge-is-sharp", "edge-distance"),
            ("no-edge-is-sharp", "edge-distance"),
            ("own-edges-alone", "edge-distance"),
        ],
    );
}
