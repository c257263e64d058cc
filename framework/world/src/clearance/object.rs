//! The object as a body.

use super::apart::farther;
use super::convex::{Convex, Verdict};
use super::exact::{MeshSolid, Solid};
use super::field::Field;
use super::rod::{Bounds, Rod};
use regrasp_api::{Mesh, ObjectModel, Pose, Vec3};
use std::sync::Arc;

/// The object: bounds that decide nearly always, and the exact mesh for the rest.
pub(crate) struct ObjectBody {
    mesh: Arc<MeshSolid>,
    pub solid: Solid,
    bound: Bound,
    /// A box that holds the mesh: its centre in O and half its size.
    hull: (Vec3, Convex),
    pub p_OMiddle: Vec3,
    /// Radius about `p_OMiddle` of a ball that holds the mesh, and the twin (m).
    pub radius: f64,
    /// What fingertips touch in place of a rough mesh, and how far at most the two are apart for them (m).
    twin: Option<(Box<ObjectBody>, f64)>,
}

enum Bound {
    Convex(Convex),
    Field(Field),
}

impl ObjectBody {
    /// `wide`: the largest radius of a rod that will be asked about, and the clearance (m).
    pub fn new(object: &ObjectModel, wide: f64) -> Self {
        let mut body = Self::of_mesh(object, &object.mesh, wide);
        if let Some(twin) = &object.twin {
            let touched = Self::of_mesh(object, &twin.mesh, wide);
            body.radius = body.radius.max(touched.radius + (touched.p_OMiddle - body.p_OMiddle).norm());
            body.twin = Some((Box::new(touched), twin.bound));
        }
        body
    }

    fn of_mesh(object: &ObjectModel, surface: &Mesh, wide: f64) -> Self {
        let mesh = Arc::new(MeshSolid::new(surface));
        let Bounds { lower, upper } = mesh.bounds;
        let p_OMiddle = (lower + upper) * 0.5;
        let vertices = surface.vertices();
        let radius = vertices.iter().map(|v| (v - p_OMiddle).norm()).fold(0.0, f64::max);
        let bound = match object.primitive.and_then(|form| Convex::around(form, planes(object))) {
            Some(convex) => Bound::Convex(convex),
            None => Bound::Field(Field::new(mesh.clone(), wide)),
        };
        let hull = (p_OMiddle, Convex::cuboid((upper - lower) * 0.5));
        Self {
            solid: Solid::Mesh(mesh.clone()),
            mesh,
            bound,
            hull,
            p_OMiddle,
            radius: radius * (1.0 + 1e-12),
            twin: None,
        }
    }

    /// Whether a rod, given in O, is farther from the object than `clear` (m); exact.
    #[inline]
    pub fn clear_of_rod(&self, rod_O: &Rod, clear: f64) -> bool {
        let verdict = match &self.bound {
            Bound::Convex(convex) => convex.verdict(rod_O, clear),
            Bound::Field(field) => field.verdict(rod_O, clear),
        };
        match verdict {
            Verdict::Free => true,
            Verdict::Close => false,
            Verdict::Unknown if self.mesh.hull.is_some() => {
                let here = Pose::identity();
                farther(&Solid::Rod(*rod_O), &here, &self.solid, &here, clear)
            }
            Verdict::Unknown => self.mesh.clear_of_rod(rod_O, clear),
        }
    }

    /// Whether a fingertip that holds nothing, given in O, keeps `wanted` (m) from what it would touch; from
    /// a rough mesh itself it keeps as much once that is all that is ever kept, `clear`, and on its way there
    /// less by what the two surfaces may be apart.
    pub fn clear_of_tip(&self, rod_O: &Rod, wanted: f64, clear: f64) -> bool {
        let Some((twin, bound)) = &self.twin else { return self.clear_of_rod(rod_O, wanted) };
        let from_mesh = if wanted < clear { wanted - bound } else { wanted };
        twin.clear_of_rod(rod_O, wanted) && (from_mesh <= 0.0 || self.clear_of_rod(rod_O, from_mesh))
    }

    /// An upper bound of n · x over the object, x in O from O's origin (m).
    #[inline]
    pub fn height(&self, n_O: &Vec3) -> f64 {
        let (center, hull) = &self.hull;
        let boxed = n_O.dot(center) + hull.height(n_O);
        match &self.bound {
            Bound::Convex(convex) => convex.height(n_O).min(boxed),
            Bound::Field(_) => boxed,
        }
    }

    /// The exact lowest n · x over the object (m).
    pub fn lowest(&self, n_O: &Vec3) -> f64 {
        self.mesh.lowest(n_O)
    }
}

fn planes(object: &ObjectModel) -> impl Iterator<Item = (Vec3, f64)> {
    let mesh = &object.mesh;
    (0..mesh.facets().len() as u32).map(move |facet| {
        let n = mesh.normal(facet);
        (n, n.dot(&mesh.corners(facet)[0]))
    })
}
