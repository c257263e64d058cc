//! Role 3: the object's surface as fingertips see it.

use crate::{CallError, Contact, Context, Random, Vec3, slerp_normals};

/// A point where a fingertip's centre comes closest to the object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    /// The closest point, with the unit normal towards the given position.
    pub contact: Contact,
    /// Signed distance (m) of the given position from the surface; negative inside.
    pub distance: f64,
}

/// One point of a surface path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waypoint {
    /// Where the fingertip touches.
    pub contact: Contact,
    /// Length (m) travelled by the fingertip's centre from the path's start to here.
    pub lift_length: f64,
}

/// A path of contacts on the offset surface, joined by straight segments of `p_OC` and arcs of `n_O`.
///
/// At a convex edge `p_OC` stays and `n_O` turns; at a concave edge two waypoints with equal fingertip
/// centres follow each other, and the contact jumps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfacePath {
    /// The waypoints, with nondecreasing `lift_length`, the first at 0.
    pub waypoints: Vec<Waypoint>,
    /// Length (m) of the path of the contact point on the object's surface.
    pub length: f64,
}

impl SurfacePath {
    /// Starts afresh at `start`, keeping the allocation.
    pub fn restart(&mut self, start: Contact) {
        self.waypoints.clear();
        self.waypoints.push(Waypoint { contact: start, lift_length: 0.0 });
        self.length = 0.0;
    }

    /// Appends `contact`, which the fingertip's centre reaches after `travelled` more metres.
    pub fn push(&mut self, contact: Contact, travelled: f64) {
        let so_far = self.waypoints.last().map_or(0.0, |last| last.lift_length);
        self.waypoints.push(Waypoint { contact, lift_length: so_far + travelled });
    }

    /// Length (m) that the fingertip's centre travels.
    pub fn lift_length(&self) -> f64 {
        self.waypoints.last().map_or(0.0, |last| last.lift_length)
    }

    /// The contact a fraction `s` in [0, 1] of the lift's length along the path; exact at both ends.
    pub fn at(&self, s: f64) -> Contact {
        let last = self.waypoints.len() - 1;
        if s <= 0.0 || last == 0 {
            return self.waypoints[0].contact;
        }
        if s >= 1.0 {
            return self.waypoints[last].contact;
        }
        let wanted = s * self.lift_length();
        let next = self.waypoints.partition_point(|waypoint| waypoint.lift_length < wanted).clamp(1, last);
        let (from, to) = (&self.waypoints[next - 1], &self.waypoints[next]);
        let span = to.lift_length - from.lift_length;
        if span <= 0.0 {
            return to.contact;
        }
        let t = (wanted - from.lift_length) / span;
        let (a, b) = (&from.contact, &to.contact);
        Contact { facet: a.facet, p_OC: a.p_OC.lerp(&b.p_OC, t), n_O: slerp_normals(&a.n_O, &b.n_O, t) }
    }
}

/// The object's surface: points, normals, shortest paths, projection.
///
/// Built once for an object and a fingertip radius; prepares there what it likes. There is one true surface,
/// the object's mesh ([`crate::ObjectModel::mesh`]): points and normals are the mesh's, whatever closed form
/// stood behind it. What a plugin chooses are paths, samples and where walks lead. Laws: equivariant under a
/// rigid motion of the object; `geodesic` starts and ends exactly at the contacts it was given, and its
/// length is at least the chord and symmetric in its ends to the plugin's tolerance.
pub trait SurfaceParam: Send + Sync {
    /// A random contact, uniform over the area that a fingertip can touch.
    fn sample(&self, random: &mut Random) -> Contact;

    /// Fills `path` with the shortest path from `from` to `to` and its lift; `false` where the fingertip
    /// cannot follow.
    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError>;

    /// The contact closest to the fingertip centre `p_OF` (m).
    ///
    /// `hint`, the facet of a contact nearby, may make the call cheaper, never change its answer.
    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection;

    /// The contact reached by walking straight ahead from `from` along `direction_O` (any vector; its
    /// tangential part counts) for `distance` (m) of the contact point on the surface.
    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact;

    /// Distance (m), along the surface's facets or straight, from the contact to the nearest sharp edge;
    /// infinite where there is none.
    fn edge_distance(&self, contact: &Contact) -> f64;
}
const _: Option<&dyn SurfaceParam> = None; // must stay object safe
