//! `surface/parametric`: shortest paths of sphere, ellipsoid, cuboid, cylinder, capsule and torus in closed
//! form.
//!
//! # Two surfaces
//! The facets of the object's mesh are its true surface: plans are judged there, and contacts, samples and
//! projections lie there, exactly as with `surface/geodesic`. What comes from the closed form
//! ([`ClosedForm`]) is *where paths and walks lead*: the shortest path of the smooth solid between the points
//! that belong to the two contacts, followed on the facets through points at most `spacing` apart. A point of
//! the closed form and its partner on the facets lie on one ray from the centre or the axis. A path's
//! `length` is that of its way over the facets; [`Parametric::closed_form`] gives lengths and points of the
//! exact curve. Both agree better and better for finer meshes, and are the same on a cuboid.
//!
//! # How paths are found
//! - *Sphere*: great circles.
//! - *Cuboid*: straight lines over all sequences of unfolded faces.
//! - *Cylinder, capsule*: helices, and the caps' chords or great circles, with the best crossings of the
//!   rims.
//! - *Ellipsoid, torus*: the geodesic equation, solved between two points by shooting. A chain of points,
//!   relaxed from several sides, gives the first directions, so that the shortest of several geodesics is
//!   found.
//!
//! The sphere is exact to 1e-9 of its size, the others to 1e-6.
//!
//! # When to use it
//! Where paths should be those of the smooth object rather than of its facets: their course does not depend
//! on how the mesh is cut. A mesh without closed form is refused, and so is an ellipsoid flatter than 1 : 4.
//! `false` as with `surface/geodesic`: an end that cannot be touched, or a fingertip that would have to leap
//! (torus).

mod cuboid;
mod curve;
mod facets;
mod form;
mod rim;
mod smooth;
mod sphere;
mod tube;

pub use curve::Curve;
pub use form::ClosedForm;

use crate::hollows::Room;
use crate::lift::Leg;
use crate::rolling::{Rolling, rolling_answers};
use facets::{Corridor, Facets};
use regrasp_api::{
    Build, BuildError, Built, CallError, Contact, Context, Entry, ObjectModel, Parts, Primitive, Projection,
    Random, Settings, Slot, SurfaceParam, SurfacePath, Vec3, check_settings, inventory,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::cell::RefCell;

inventory::submit! {
    Entry {
        id: "surface/parametric",
        slots: &[Slot::Surface],
        summary: "Shortest paths of sphere, ellipsoid, cuboid, cylinder, capsule and torus in closed form",
        references: &[
            "do Carmo, Differential geometry of curves and surfaces, Prentice-Hall 1976 (geodesics, \
                Clairaut's relation, Jacobi fields)",
            "Sharir & Schorr, On shortest paths in polyhedral spaces, SIAM J. Comput. 15, 1986 (unfolded \
                faces)",
            "Itoh & Kiyohara, The cut loci and the conjugate loci on ellipsoids, Manuscripta Math. 114, \
                2004 (which sides to try)",
        ],
        schema: ParametricSettings::schema,
        check: check_settings::<ParametricSettings>,
        build: Build::Surface(build),
    }
}

fn build(json: &str, parts: &Parts<'_>) -> Built<dyn SurfaceParam> {
    let settings = ParametricSettings::from_json(json)?;
    Ok(Box::new(Parametric::new(&settings, parts.object, parts.hand.fingertip_radius())?))
}

/// The middle semi-axis of an ellipsoid over its shortest, at most.
const FLATTEST: f64 = 4.0;

/// Curves tried, each half as long again, until the way over the facets is as long as a walk.
const MOST_TRIES: usize = 8;

/// Settings of [`Parametric`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ParametricSettings {
    /// Largest distance between two points of the closed form's path through which the path over the facets
    /// is led, in radii of the object (the largest distance of a vertex from its origin). Default 0.06, a
    /// neutral choice.
    #[schemars(range(min = 0.005, max = 0.5), extend("x-unit" = "1"))]
    pub spacing: f64,
    /// An edge is sharp where its facets' normals differ by more than this angle (degrees). Default 30, as
    /// for `surface/geodesic`.
    #[schemars(range(min = 1.0, max = 180.0), extend("x-unit" = "degrees"))]
    pub sharp_angle_deg: f64,
    /// On solids that are not convex, the largest distance (m) between two places where the fingertip is
    /// checked; at most a fifth of its radius. Default 0.001, as for `surface/geodesic`.
    #[schemars(range(min = 1e-5, max = 1e-2), extend("x-unit" = "m"))]
    pub step: f64,
}

impl Default for ParametricSettings {
    fn default() -> Self {
        Self { spacing: 0.06, sharp_angle_deg: 30.0, step: 1e-3 }
    }
}

impl Settings for ParametricSettings {}

/// The facets of a primitive, with paths from its closed form.
#[derive(Debug)]
pub struct Parametric {
    form: ClosedForm,
    facets: Facets,
    rolling: Rolling,
    /// Largest distance (m) between two points of a curve.
    spacing: f64,
}

/// What a path needs beside the answer; one a thread, overwritten by every call.
#[derive(Default)]
struct Workspace {
    curve: Curve,
    corridor: Corridor,
    legs: Vec<Leg>,
    room: Room,
}

thread_local! {
    static WORKSPACE: RefCell<Workspace> = RefCell::new(Workspace::default());
}

impl Parametric {
    /// Prepares the surface of an object for fingertips of the given radius (m); refuses objects without
    /// closed form.
    pub fn new(settings: &ParametricSettings, object: &ObjectModel, radius: f64) -> Result<Self, BuildError> {
        settings.validate()?;
        let refused = |reason: &str| {
            BuildError::Unsupported(format!(
                "{reason}; use `surface/geodesic`, which takes any closed mesh, or describe the object as a \
                 sphere, ellipsoid, cuboid, cylinder, capsule or torus"
            ))
        };
        let primitive =
            object.primitive.ok_or_else(|| refused("the object is a mesh without closed form"))?;
        if is_flat(&primitive) {
            return Err(refused("ellipsoids flatter than 1 : 4 bend too sharply at their rim"));
        }
        let form = ClosedForm::new(&primitive);
        let facets = Facets::new(&primitive, &form, &object.mesh)
            .ok_or_else(|| refused("the object's mesh does not lie on the primitive that it stands for"))?;
        let rolling = Rolling::new(&object.mesh, radius, settings.sharp_angle_deg, settings.step);
        Ok(Self { form, facets, spacing: settings.spacing * object.mesh.radius(), rolling })
    }

    /// The exact surface: lengths and points of shortest paths, normals, walks.
    pub fn closed_form(&self) -> &ClosedForm {
        &self.form
    }

    /// The point (m) of the closed form that belongs to a point of the facets.
    pub fn on_closed_form(&self, p_OC: &Vec3) -> Vec3 {
        self.facets.out(&self.form, p_OC)
    }

    /// The contact at a distance (m) along legs that lead to an end; `None` where they are too short.
    fn cut(&self, legs: &[Leg], end: &Contact, distance: f64) -> Option<Contact> {
        let mut left = distance;
        let ends = legs.iter().skip(1).map(|leg| leg.p_OP).chain([end.p_OC]);
        for (leg, to) in legs.iter().zip(ends) {
            let length = (to - leg.p_OP).norm();
            if left <= length {
                let p_OC = if length > 0.0 { leg.p_OP.lerp(&to, left / length) } else { to };
                return Some(Contact {
                    facet: leg.facet,
                    p_OC,
                    n_O: self.rolling.polyhedron.mesh.normal(leg.facet),
                });
            }
            left -= length;
        }
        None
    }

    fn surfaces(&self) -> (&Rolling, &Facets, &ClosedForm) {
        (&self.rolling, &self.facets, &self.form)
    }
}

/// Whether a primitive is a disc-like ellipsoid on which the shooting may miss.
fn is_flat(primitive: &Primitive) -> bool {
    let Primitive::Ellipsoid { semi_axes } = primitive else { return false };
    let mut axes: [f64; 3] = (*semi_axes).into();
    axes.sort_by(f64::total_cmp);
    axes[1] > FLATTEST * axes[0]
}

impl SurfaceParam for Parametric {
    rolling_answers!();

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        context.count_call(Slot::Surface);
        context.proceed()?;
        WORKSPACE.with_borrow_mut(|workspace| {
            let Workspace { curve, corridor, legs, room } = workspace;
            let ends = [from, to].map(|contact| self.on_closed_form(&contact.p_OC));
            self.form.shortest(&ends[0], &ends[1], self.spacing, curve);
            let (start, end) = (self.rolling.spot(from), self.rolling.spot(to));
            legs.clear();
            corridor.follow(self.surfaces(), (&start, Some(&end)), curve, legs);
            Ok(self.rolling.roll((&start, &end), legs, path, room))
        })
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        let tangent = direction_O - from.n_O * from.n_O.dot(direction_O);
        if distance.is_nan() || distance <= 0.0 || tangent.norm() <= 1e-12 * direction_O.norm() {
            return *from;
        }
        WORKSPACE.with_borrow_mut(|workspace| {
            let Workspace { curve, corridor, legs, .. } = workspace;
            let (begin, start) = (self.on_closed_form(&from.p_OC), self.rolling.spot(from));
            // The way over the facets is about as long as the curve, but not quite.
            let mut enough = 1.1 * distance + self.spacing;
            for _ in 0..MOST_TRIES {
                self.form.walk(&begin, &tangent, enough, self.spacing, curve);
                legs.clear();
                let end = corridor.follow(self.surfaces(), (&start, None), curve, legs);
                if let Some(reached) = self.cut(legs, &end.contact, distance) {
                    return self.rolling.settled(reached);
                }
                enough *= 1.5;
            }
            *from
        })
    }
}
