//! For each law of surfaces one liar that breaks it and no other.
use crate::support;

use regrasp_api::*;
use regrasp_conformance::reference::FacetSurface;

/// What a liar does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Lie {
    Nothing,
    SamplesBeside,
    SamplesTheUpperHalf,
    SamplesFacetsAlike,
    SamplesNearTheMiddle,
    ClosedForm,
    ProjectsToVertices,
    BelievesHints,
    EdgesAreSoft,
    StartsBeside,
    CutsCorners,
    CountsTheContactsWay,
    LengthOfTheChord,
    Detours,
    LongerBackwards,
    WalksTooShort,
    CountsEachLeg,
    KnowsUpAndDown,
    OnlyAtHome,
}

struct Liar {
    honest: FacetSurface,
    mesh: Mesh,
    radius: f64,
    lie: Lie,
    home: std::thread::ThreadId,
}

impl Liar {
    fn path(
        &self,
        from: &Contact,
        to: &Contact,
        context: &mut Context<'_>,
    ) -> Result<SurfacePath, CallError> {
        let mut path = SurfacePath::default();
        self.honest.geodesic(from, to, &mut path, context)?;
        Ok(path)
    }

    /// Whether the object is the kit's ball, of 30 mm.
    fn is_ball(&self) -> bool {
        self.mesh.vertices().iter().all(|v| (v.norm() - 0.03).abs() < 1e-9)
    }

    /// Adds up the lengths of a path.
    fn measure(&self, path: &mut SurfacePath) {
        path.length = 0.0;
        for i in 1..path.waypoints.len() {
            let (a, b) = (path.waypoints[i - 1], path.waypoints[i].contact);
            let way = (b.p_OC - a.contact.p_OC).norm();
            let turn = a.contact.n_O.cross(&b.n_O).norm().atan2(a.contact.n_O.dot(&b.n_O));
            path.waypoints[i].lift_length = a.lift_length + way + self.radius * turn;
            path.length += way;
        }
    }

    /// From one contact over a third to the other.
    fn detour(
        &self,
        from: &Contact,
        over: &Contact,
        to: &Contact,
        context: &mut Context<'_>,
    ) -> Result<SurfacePath, CallError> {
        let mut path = self.path(from, over, context)?;
        let rest = self.path(over, to, context)?;
        let so_far = path.lift_length();
        let shifted = |w: &Waypoint| Waypoint { lift_length: w.lift_length + so_far, ..*w };
        path.waypoints.extend(rest.waypoints.iter().skip(1).map(shifted));
        path.length += rest.length;
        Ok(path)
    }
}

impl SurfaceParam for Liar {
    fn sample(&self, random: &mut Random) -> Contact {
        let mut contact = self.honest.sample(random);
        match self.lie {
            // Only where the other checks do not look: they take their first samples.
            Lie::SamplesBeside if random.index(40) == 0 => contact.n_O = -contact.n_O,
            Lie::SamplesTheUpperHalf => {
                while contact.p_OC.z < 0.0 && random.index(3) == 0 {
                    contact = self.honest.sample(random);
                }
            }
            // Each facet as often as any other, whatever its area.
            Lie::SamplesFacetsAlike => {
                let facet = random.index(self.mesh.facets().len()) as u32;
                let [a, b, c] = self.mesh.corners(facet);
                let (s, t) = (random.unit().sqrt(), random.unit());
                let p_OC = a * (1.0 - s) + b * (s * (1.0 - t)) + c * (s * t);
                contact = Contact { facet, p_OC, n_O: self.mesh.normal(facet) };
            }
            // The same face, but nearer to its middle.
            Lie::SamplesNearTheMiddle => {
                let inner = Contact { p_OC: contact.p_OC * 0.8, ..contact };
                contact = self.honest.project(&inner.tip_center(0.01), None).contact;
            }
            // On a ball around the mesh, where the kit's ball is round.
            Lie::ClosedForm if self.is_ball() => {
                contact.n_O = contact.p_OC.normalize();
                contact.p_OC = contact.n_O * 0.03;
            }
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
        if self.lie != Lie::CountsEachLeg {
            context.count_call(Slot::Surface);
        }
        let counts = context;
        let context = &mut Context::new(counts.random.clone(), &Uninterrupted);
        *path = self.path(from, to, context)?;
        if self.lie == Lie::CountsEachLeg {
            path.waypoints.iter().for_each(|_| counts.count_call(Slot::Surface));
        }
        let last = path.waypoints.len() - 1;
        let apart = path.length > 1e-3;
        match self.lie {
            Lie::StartsBeside if apart => path.waypoints[0].contact.facet ^= 1,
            Lie::CutsCorners if last >= 3 => {
                let middle = &mut path.waypoints[last / 2].contact;
                middle.p_OC -= middle.n_O * 1e-6;
                self.measure(path);
            }
            Lie::CountsTheContactsWay => {
                for i in 1..=last {
                    let way = (path.waypoints[i].contact.p_OC - path.waypoints[i - 1].contact.p_OC).norm();
                    path.waypoints[i].lift_length = path.waypoints[i - 1].lift_length + way;
                }
            }
            Lie::LengthOfTheChord => path.length = (to.p_OC - from.p_OC).norm(),
            Lie::Detours if apart && from.facet != to.facet => {
                // The same detour there and back, and in any frame.
                let (a, b) = if from.facet < to.facet { (from, to) } else { (to, from) };
                let side = (b.p_OC - a.p_OC).cross(&(a.n_O + b.n_O)) * 0.3;
                let over =
                    self.honest.project(&(0.5 * (a.p_OC + b.p_OC) + (a.n_O + b.n_O) * 0.05 + side), None);
                *path = self.detour(from, &over.contact, to, context)?;
            }
            // There is the shortest way; back it goes a little way on and returns.
            Lie::LongerBackwards if apart && from.p_OC.x > to.p_OC.x => {
                let beyond = self.honest.walk(to, &(from.n_O.cross(&to.n_O) + Vec3::z()), 4e-4 * path.length);
                *path = self.detour(from, &beyond, to, context)?;
            }
            _ => {}
        }
        Ok(true)
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        let mut found = self.honest.project(p_OF, None);
        match (self.lie, hint) {
            (Lie::ProjectsToVertices, _) if found.distance > 0.04 => found.distance -= 1e-6,
            (Lie::BelievesHints, Some(facet)) if facet != found.contact.facet => found.distance += 1e-12,
            (Lie::OnlyAtHome, _) if std::thread::current().id() != self.home => found.contact.facet += 1,
            _ => {}
        }
        found
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        let part = if self.lie == Lie::WalksTooShort { 0.9 } else { 1.0 };
        self.honest.walk(from, direction_O, part * distance)
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        let honest = self.honest.edge_distance(contact);
        match self.lie {
            Lie::EdgesAreSoft => honest + 1e-3,
            Lie::KnowsUpAndDown if self.mesh.vertices().iter().any(|v| v.z > 0.1) => honest + 1e-3,
            _ => honest,
        }
    }
}

macro_rules! liar {
    ($lie:expr) => {
        Entry {
            id: "surface/liar",
            slots: &[Slot::Surface],
            summary: "says what it likes",
            references: &["nobody"],
            schema: NoSettings::schema,
            check: check_settings::<NoSettings>,
            build: Build::Surface(|json, parts| {
                NoSettings::from_json(json)?;
                let (mesh, radius) = (parts.object.mesh.clone(), parts.hand.fingertip_radius());
                let (honest, home) = (FacetSurface::new(&mesh, radius), std::thread::current().id());
                Ok(Box::new(Liar { honest, mesh, radius, lie: $lie, home }))
            }),
        }
    };
}

#[test]
fn each_liar_fails_its_check_and_no_other() {
    let liars = [
        (liar!(Lie::SamplesBeside), "sample-on-surface"),
        (liar!(Lie::SamplesTheUpperHalf), "sample-uniform"),
        (liar!(Lie::SamplesFacetsAlike), "sample-uniform"),
        (liar!(Lie::SamplesNearTheMiddle), "sample-uniform"),
        (liar!(Lie::ProjectsToVertices), "project-exact"),
        (liar!(Lie::BelievesHints), "project-ignores-hint"),
        (liar!(Lie::EdgesAreSoft), "edge-distance"),
        (liar!(Lie::StartsBeside), "geodesic-endpoints"),
        (liar!(Lie::CutsCorners), "geodesic-on-surface"),
        (liar!(Lie::CountsTheContactsWay), "geodesic-lift"),
        (liar!(Lie::LengthOfTheChord), "geodesic-length"),
        (liar!(Lie::Detours), "geodesic-shortest"),
        (liar!(Lie::LongerBackwards), "geodesic-symmetric"),
        (liar!(Lie::WalksTooShort), "walk"),
        (liar!(Lie::CountsEachLeg), "geodesic-counted"),
        (liar!(Lie::KnowsUpAndDown), "surface-rigid-motion"),
        (liar!(Lie::OnlyAtHome), "surface-pure"),
    ];
    support::judge(Slot::Surface, &liar!(Lie::Nothing), &liars, &[]);
}

#[test]
fn a_closed_form_in_place_of_the_mesh_is_no_surface() {
    let report = regrasp_conformance::check(&liar!(Lie::ClosedForm));
    assert!(report.failed().contains(&"sample-on-surface"), "{report}");
}
