//! The surface that contacts live on, where it is a twin of the object's own: how far fingertips are from the
//! true one.
//!
//! A twin is believed nothing. It must be made of this object's mesh, its bound must be what the scenario
//! asks for, and the bound must hold: for each touching fingertip at each sample of the motion, and for a
//! fingertip put all over the twin, wherever it enters the twin nowhere.

use crate::order::in_order;
use crate::scene::Scene;
use crate::solid::Solid;
use crate::touch::Touch;
use crate::verdict::{Check, Gauge, Side};
use regrasp_api::{
    ContactSurface, ContactSurfaceWord, MAX_FINGERS, Mesh, ObjectModel, ObjectShape, Twin, Vec3, mesh_digest,
};
use regrasp_plan::{Place, Plan};

/// The largest bound (m) that a twin may have unasked.
const FARTHEST: f64 = 3e-4;
/// Places on the twin are no farther apart than this many fingertip radii ...
const SPACING: f64 = 0.1;
/// ... or there are about as many as this.
const MOST_PLACES: f64 = 40_000.0;
/// Into how many shares the facets are dealt.
const SHARES: usize = 8;
/// How deep (m) the ball may sink into the twin at a place where it can be.
const SINK: f64 = 1e-6;

/// The twin that a plan holds, if it is one of this object's and as near as the scenario asks for.
pub(crate) fn twin(plan: &Plan, object: &ObjectModel, radius: f64) -> Result<Option<Twin>, String> {
    let Some(surface) = plan.object.as_ref().and_then(|object| object.contact_surface.as_ref()) else {
        return Ok(None);
    };
    let description = &plan.scenario.problem.object;
    if !matches!(description.shape, ObjectShape::Mesh(_)) || radius <= 0.0 {
        return Err("a contact surface is for meshes and fingertips with a radius".into());
    }
    let most = match description.contact_surface {
        Some(ContactSurface::Word(ContactSurfaceWord::Exact)) => {
            return Err("contacts live on a twin of the mesh, and the scenario wants the mesh itself".into());
        }
        Some(ContactSurface::Within(nearness)) => nearness.tolerance,
        Some(ContactSurface::Word(ContactSurfaceWord::Auto)) | None => FARTHEST,
    };
    if !(0.0..=most).contains(&surface.bound) {
        return Err(format!("the contact surface's bound of {} m is outside 0..={most} m", surface.bound));
    }
    if surface.digest != mesh_digest(&object.mesh) {
        return Err("the contact surface was made of another mesh".into());
    }
    let vertices = surface.vertices.iter().map(|&v| v.into()).collect();
    let mesh =
        Mesh::new(vertices, surface.facets.clone()).map_err(|e| format!("the contact surface: {e}"))?;
    Ok(Some(Twin { mesh, bound: surface.bound, tolerance: most }))
}

/// How far touching fingertips are from the object's own surface.
pub(crate) struct SurfaceCheck {
    gauge: Option<Gauge>,
    radius: f64,
    facets: [u32; MAX_FINGERS],
}

impl SurfaceCheck {
    /// For a scene whose contacts live on a twin; there is nothing to check where they do not.
    pub(crate) fn new(scene: &Scene, radius: f64, closure: f64) -> Self {
        let limit = scene.bound + closure;
        let gauge = scene.has_twin().then(|| Gauge::new("contact-surface", "m", Side::AtMost, limit));
        Self { gauge, radius, facets: [0; MAX_FINGERS] }
    }

    /// Looks all over the twin, if there is one, on so many threads.
    pub(crate) fn look_all_over(&mut self, scene: &Scene, threads: usize) {
        let Some(gauge) = &mut self.gauge else { return };
        let gap = all_over(scene, self.radius, threads);
        gauge.note(gap, || Place { note: Some("on the contact surface".into()), ..Default::default() });
    }

    /// Takes in what was gathered later in the plan.
    pub(crate) fn join(&mut self, later: Self) {
        if let (Some(gauge), Some(later)) = (&mut self.gauge, later.gauge) {
            gauge.join(later);
        }
    }

    /// Takes in a touching fingertip.
    pub(crate) fn contact(
        &mut self,
        scene: &Scene,
        finger: usize,
        p_OTip: &Vec3,
        place: impl FnOnce() -> Place,
    ) {
        let Some(gauge) = &mut self.gauge else { return };
        let touch = Touch::of_object(scene, p_OTip, self.radius, self.facets[finger]);
        self.facets[finger] = touch.facet;
        gauge.note(touch.gap.abs(), place);
    }

    pub(crate) fn check(self) -> Option<Check> {
        self.gauge.map(Gauge::check)
    }
}

/// The farthest (m), on either side, that a ball touching the twin is from touching the object: looked for on
/// so many threads. The facets are shared out alike whatever their number.
fn all_over(scene: &Scene, radius: f64, threads: usize) -> f64 {
    let spacing = (SPACING * radius).max((scene.touched.area() / MOST_PLACES).sqrt());
    let share = |first: usize| {
        let facets = (first as u32..scene.touched.facet_count()).step_by(SHARES);
        let mut near = 0;
        facets.fold(0.0f64, |worst, facet| worst_on(scene, radius, spacing, facet, &mut near, worst))
    };
    let mut worst = 0.0f64;
    in_order(SHARES, threads, share, |_, found| {
        worst = if worst.is_nan() || found.is_nan() { f64::NAN } else { worst.max(found) };
    });
    worst
}

/// The same over one facet, or `worst` where that is more; `near` is where to look first.
fn worst_on(scene: &Scene, radius: f64, spacing: f64, facet: u32, near: &mut u32, mut worst: f64) -> f64 {
    let twin = &scene.touched;
    let (corners, n) = twin.corners(facet);
    let longest = (0..3).map(|k| (corners[(k + 1) % 3] - corners[k]).norm()).fold(0.0, f64::max);
    let pieces = (longest / spacing).ceil().clamp(1.0, 1000.0) as usize;
    for p in places(corners, pieces) {
        let center = p + n * radius;
        let touch = Touch::of_object(scene, &center, radius, *near);
        *near = touch.facet;
        if touch.gap.abs() > worst && is_free(twin, &center, radius, facet) {
            worst = touch.gap.abs();
        }
    }
    worst
}

/// Whether a ball that touches a facet there enters the twin nowhere else.
fn is_free(twin: &Solid, center: &Vec3, radius: f64, facet: u32) -> bool {
    let closest = twin.closest(center, facet);
    (center - closest.point).norm() >= radius - SINK
}

/// The nodes of a triangle's grid with so many pieces a side, corners included.
fn places([a, b, c]: [Vec3; 3], pieces: usize) -> impl Iterator<Item = Vec3> {
    let part = move |i: usize| i as f64 / pieces as f64;
    (0..=pieces).flat_map(move |i| (0..=pieces - i).map(move |j| a + (b - a) * part(i) + (c - a) * part(j)))
}
