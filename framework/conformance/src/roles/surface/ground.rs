//! The objects on which surfaces are tried, and what is true of them.

use crate::fixtures::Bench;
use crate::law::{Subject, random};
use crate::reference::{Closest, closest_on_mesh};
use crate::report::{Fault, Finding, broken, ensure};
use regrasp_api::{
    Build, Contact, Hand, Mesh, ObjectModel, Parts, Primitive, Random, SurfaceParam, SurfacePath, Vec3,
};
use regrasp_world::primitive_mesh;

/// Points count as on the surface within this distance (m).
pub(super) const EXACT: f64 = 1e-8;

/// A surface under test, and the truth about its object.
pub(super) struct Ground {
    pub name: &'static str,
    pub surface: Box<dyn SurfaceParam>,
    pub object: ObjectModel,
    pub radius: f64,
}

impl Ground {
    /// The closest point of the true surface, which is the mesh, to `p` (m, in O).
    pub fn closest(&self, p: &Vec3) -> Closest {
        closest_on_mesh(&self.object.mesh, p)
    }

    /// Whether no two points of the object lie on different sides of its surface.
    pub fn is_convex(&self) -> bool {
        self.object.mesh.is_locally_convex()
    }

    /// A path between two contacts.
    pub fn path(&self, from: &Contact, to: &Contact) -> Finding<SurfacePath> {
        let mut path = SurfacePath::default();
        let found = self.surface.geodesic(from, to, &mut path, &mut crate::law::context(0))?;
        ensure(found || !self.is_convex(), || format!("{}: no path from {from:?} to {to:?}", self.name))?;
        if found { Ok(path) } else { Err(Fault::Skip("the fingertip cannot follow".into())) }
    }

    /// Pairs of contacts: samples, projections, and ones on edges and at vertices.
    pub fn pairs(&self, key: u64, count: usize) -> Vec<(Contact, Contact)> {
        let mut random = random(key);
        let mesh = &self.object.mesh;
        let odd = |random: &mut Random| {
            let [a, b, _] = mesh.corners(random.index(mesh.facets().len()) as u32);
            let p = if random.index(2) == 0 { a } else { a.lerp(&b, random.unit()) };
            // Straight out of the middle: between the normals that meet there, as the objects are round about
            // it.
            self.surface.project(&(p * 1.2), None).contact
        };
        let contact = |random: &mut Random, i: usize| match i % 3 {
            0 => odd(random),
            _ => self.surface.sample(random),
        };
        (0..count).map(|i| (contact(&mut random, i), contact(&mut random, i / 2))).collect()
    }
}

/// The objects: name, closed form, wished number of facets.
fn objects() -> [(&'static str, Primitive, usize); 5] {
    [
        ("sphere", Primitive::Sphere { radius: 0.03 }, 320),
        ("cube", Primitive::Cuboid { half_size: Vec3::repeat(0.0225) }, 12),
        // 1 : 2 : 5: who draws facets instead of area is seen here.
        ("bar", Primitive::Cuboid { half_size: Vec3::new(0.01, 0.02, 0.05) }, 12),
        ("ellipsoid", Primitive::Ellipsoid { semi_axes: Vec3::new(0.04, 0.03, 0.025) }, 320),
        ("torus", Primitive::Torus { ring_radius: 0.035, tube_radius: 0.012 }, 400),
    ]
}

/// Builds the plugin for one object; `None` where it refuses the object.
pub(super) fn build(
    subject: &Subject<'_>,
    name: &'static str,
    object: ObjectModel,
) -> Finding<Option<Ground>> {
    let Build::Surface(build) = subject.entry.build else { return broken("it builds another role") };
    let hand = &Bench::free_sphere().world.hand;
    let surface =
        match build(&subject.demands.settings, &Parts { object: &object, ..Bench::free_sphere().parts() }) {
            Err(regrasp_api::BuildError::Unsupported(_)) => return Ok(None),
            built => built?,
        };
    Ok(Some(Ground { name, surface, object, radius: hand.fingertip_radius() }))
}

/// Tries something on every object that the plugin takes; it must take one.
pub(super) fn on_each(subject: &Subject<'_>, mut check: impl FnMut(&Ground) -> Finding) -> Finding {
    let mut taken = 0;
    for (name, primitive, facets) in objects() {
        let Some(ground) = build(subject, name, object(&primitive, facets))? else { continue };
        taken += 1;
        check(&ground).map_err(|fault| match fault {
            Fault::Broken(reason) => Fault::Broken(format!("{name}: {reason}")),
            skip => skip,
        })?;
    }
    if taken > 0 { Ok(()) } else { Err(Fault::Skip("the plugin takes none of the kit's objects".into())) }
}

pub(super) fn object(primitive: &Primitive, facets: usize) -> ObjectModel {
    ObjectModel::new(mesh(primitive, facets), Some(*primitive), 0.1, 0.8)
}

fn mesh(primitive: &Primitive, facets: usize) -> Mesh {
    primitive_mesh(primitive, facets).expect("the kit's own lengths are sound")
}
