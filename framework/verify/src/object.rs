//! The object as the plan holds it: its facets, which must be those of what the scenario names, its mass and
//! friction.
//!
//! The facets of a primitive stand in the plan. They are held against the closed form here: every vertex on
//! the true surface, the facets closed and outward (what every mesh must be), and none farther from the true
//! surface than a patch of its size has to be.

use regrasp_api::{Limits, Mesh, MeshSource, ObjectModel, ObjectShape, Vec3};
use regrasp_plan::{Facets, Plan};

/// How far a vertex may be from the true surface, over the object's size: rounding.
const ON_SURFACE: f64 = 1e-9;
/// How far a facet may be from the true surface, over (longest length)²/(shortest length · number of facets).
/// A sphere's icosahedral facets reach 2.5, long cells on a cylinder 10.
const FACETING: f64 = 25.0;

/// The object of a plan; `Err` says what makes no sense in it.
pub(crate) fn object_of(plan: &Plan) -> Result<ObjectModel, String> {
    let description = &plan.scenario.problem.object;
    within("object.mass", description.mass, 1e-6, 1e3)?;
    within("object.friction", description.friction, 0.0, 10.0)?;
    let recorded = plan.object.as_ref().and_then(|object| object.surface.as_ref());
    let mesh = match (&description.shape, recorded) {
        (ObjectShape::Mesh(source), _) => {
            mesh_of(source).map_err(|reason| format!("the object: {reason}"))?
        }
        (shape, Some(facets)) => primitive(shape, facets)?,
        (_, None) => {
            return Err(
                "the plan holds no facets of its object, as plans of version 1 do not; plan again".into()
            );
        }
    };
    Ok(ObjectModel::new(mesh, None, description.mass, description.friction))
}

/// The object's weight in the hand's frame (N).
pub(crate) fn weight_H(plan: &Plan, object: &ObjectModel) -> Vec3 {
    Vec3::from(plan.scenario.problem.gravity) * object.mass
}

/// A mesh that a plan carries.
pub(crate) fn mesh_of(source: &MeshSource) -> Result<Mesh, String> {
    if source.file.is_some() {
        return Err("the mesh is in another file; a plan must stand alone".into());
    }
    let scale = source.scale.unwrap_or(1.0);
    within("scale", scale, 1e-9, 1e9)?;
    let vertices = source.vertices.iter().map(|&v| Vec3::from(v) * scale).collect();
    let mut facets = source.facets.clone();
    if source.flip.unwrap_or(false) {
        facets.iter_mut().for_each(|facet| facet.swap(1, 2));
    }
    Mesh::new(vertices, facets).map_err(|error| error.to_string())
}

/// The recorded facets of a primitive.
fn primitive(shape: &ObjectShape, facets: &Facets) -> Result<Mesh, String> {
    let closed_form = ClosedForm::of(shape)?;
    let vertices: Vec<Vec3> = facets.vertices.iter().map(|&v| Vec3::from(v)).collect();
    let mesh = Mesh::new(vertices, facets.facets.clone())
        .map_err(|error| format!("the recorded facets of the object: {error}"))?;
    let (shortest, longest) = closed_form.lengths();
    let off = |p: &Vec3| closed_form.distance(p).abs();
    // What is not a number is within nothing.
    let within = |distance: f64, most: f64| distance <= most;
    if let Some(v) = mesh.vertices().iter().position(|v| !within(off(v), ON_SURFACE * longest)) {
        return Err(format!("vertex {v} of the recorded facets is not on the object's surface"));
    }
    let most = FACETING * longest * longest / (shortest * mesh.facets().len() as f64);
    let far = |facet: u32| {
        let [a, b, c] = mesh.corners(facet);
        [(a + b + c) / 3.0, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0].iter().any(|p| !within(off(p), most))
    };
    match (0..mesh.facets().len() as u32).find(|&facet| far(facet)) {
        Some(facet) => Err(format!("facet {facet} of the recorded ones cuts off a part of the object")),
        None => Ok(mesh),
    }
}

/// A solid in closed form about its own origin (m).
enum ClosedForm {
    Ellipsoid(Vec3),
    Cuboid(Vec3),
    Cylinder { radius: f64, half: f64 },
    Capsule { radius: f64, half: f64 },
    Torus { ring: f64, tube: f64 },
}

impl ClosedForm {
    fn of(shape: &ObjectShape) -> Result<Self, String> {
        let form = match *shape {
            ObjectShape::Sphere { radius, .. } => Self::Ellipsoid(Vec3::repeat(radius)),
            ObjectShape::Ellipsoid { semi_axes, .. } => Self::Ellipsoid(semi_axes.into()),
            ObjectShape::Cuboid { size } => Self::Cuboid(Vec3::from(size) / 2.0),
            ObjectShape::Cylinder { radius, height, .. } => Self::Cylinder { radius, half: height / 2.0 },
            ObjectShape::Capsule { radius, height, .. } => Self::Capsule { radius, half: height / 2.0 },
            ObjectShape::Torus { ring_radius, tube_radius, .. } => {
                Self::Torus { ring: ring_radius, tube: tube_radius }
            }
            ObjectShape::Mesh(_) => return Err("a mesh has no closed form".into()),
        };
        let (shortest, longest) = form.lengths();
        within("object.shape", shortest, 1e-7, 1e3)?;
        within("object.shape", longest, 1e-7, 1e4)?;
        Ok(form)
    }

    /// The shortest and the longest length that its surface curves over (m).
    fn lengths(&self) -> (f64, f64) {
        match *self {
            Self::Ellipsoid(axes) => (axes.min(), axes.max()),
            Self::Cuboid(half) => (half.min(), half.max()),
            Self::Cylinder { radius, half } => (radius.min(half), radius.max(half)),
            Self::Capsule { radius, half } => (radius, radius + half),
            Self::Torus { ring, tube } => (tube, ring + tube),
        }
    }

    /// How far a point is from the surface (m), to first order close to it; negative inside.
    fn distance(&self, p: &Vec3) -> f64 {
        let around = p.x.hypot(p.y);
        match *self {
            Self::Ellipsoid(axes) => {
                let level = p.component_div(&axes).norm();
                let slope = p.component_div(&axes.component_mul(&axes)).norm() / level.max(1e-12);
                (level - 1.0) / slope.max(1e-12)
            }
            Self::Cuboid(half) => (p.abs() - half).max(),
            Self::Cylinder { radius, half } => (around - radius).max(p.z.abs() - half),
            Self::Capsule { radius, half } => around.hypot((p.z.abs() - half).max(0.0)) - radius,
            Self::Torus { ring, tube } => (around - ring).hypot(p.z) - tube,
        }
    }
}

/// Tolerances within reason: a plan that grants itself more would pass everything else.
pub(crate) fn check_limits(limits: &Limits) -> Result<(), String> {
    let tolerances = &limits.tolerances;
    within("limits.tolerances.closure", tolerances.closure, 1e-7, 1e-2)?;
    within("limits.tolerances.slip", tolerances.slip, 1e-7, 1e-2)?;
    within("limits.tolerances.normal", tolerances.normal, 1e-6, 0.5)?;
    within("limits.tolerances.clearance", tolerances.clearance, 0.0, 0.1)?;
    within("limits.tolerances.goal_position", tolerances.goal_position, 1e-9, 0.1)?;
    within("limits.tolerances.goal_angle", tolerances.goal_angle, 1e-9, 1.0)?;
    within("limits.resolution.lift", limits.resolution.lift, 1e-4, 0.2)?;
    within("limits.resolution.clearance", limits.resolution.clearance, 0.0, 0.05)?;
    limits.resolution.retreat.iter().try_for_each(|&r| within("limits.resolution.retreat", r, 0.0, 0.2))
}

fn within(key: &str, value: f64, low: f64, high: f64) -> Result<(), String> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(format!("`{key}` = {value} is outside {low} to {high}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shapes(facets: usize) -> [ObjectShape; 7] {
        [
            ObjectShape::Sphere { radius: 0.03, facets },
            ObjectShape::Ellipsoid { semi_axes: [0.04, 0.025, 0.02], facets },
            ObjectShape::Cuboid { size: [0.05, 0.03, 0.02] },
            ObjectShape::Cylinder { radius: 0.02, height: 0.09, facets },
            ObjectShape::Cylinder { radius: 0.03, height: 0.01, facets },
            ObjectShape::Capsule { radius: 0.02, height: 0.05, facets },
            ObjectShape::Torus { ring_radius: 0.04, tube_radius: 0.012, facets },
        ]
    }

    #[test]
    fn the_program_s_own_facets_are_taken_coarse_or_fine() {
        for shape in [80, 320, 1280, 5120].into_iter().flat_map(shapes) {
            let object = serde_json::json!({"shape": shape, "friction": 0.5});
            let object = regrasp_world::load_object(&serde_json::from_value(object).unwrap()).unwrap();
            let taken = primitive(&shape, &Facets::from(&object.mesh));
            assert!(taken.is_ok(), "{shape:?}: {}", taken.unwrap_err());
        }
    }

    /// A sphere of rings of facets that begin at this angle from the pole, and a flat lid.
    fn lidded(radius: f64, from: f64) -> Facets {
        let (rings, sides) = (40_u32, 40_u32);
        let mut vertices = Vec::new();
        for ring in 0..rings {
            let polar = from + (std::f64::consts::PI - 0.05 - from) * f64::from(ring) / f64::from(rings - 1);
            for side in 0..sides {
                let turn = std::f64::consts::TAU * f64::from(side) / f64::from(sides);
                let (s, c) = polar.sin_cos();
                vertices.push([radius * s * turn.cos(), radius * s * turn.sin(), radius * c]);
            }
        }
        let mut facets = Vec::new();
        for ring in 0..rings - 1 {
            for side in 0..sides {
                let at = |ring: u32, side: u32| ring * sides + side % sides;
                let (a, b) = (at(ring, side), at(ring, side + 1));
                let (c, d) = (at(ring + 1, side), at(ring + 1, side + 1));
                facets.extend([[a, c, d], [a, d, b]]);
            }
        }
        let last = (rings - 1) * sides;
        for side in 1..sides - 1 {
            facets.push([0, side, side + 1]);
            facets.push([last, last + side + 1, last + side]);
        }
        Facets { vertices, facets }
    }

    #[test]
    fn facets_that_cut_off_a_part_are_refused() {
        let sphere = ObjectShape::Sphere { radius: 0.03, facets: 3200 };
        assert!(primitive(&sphere, &lidded(0.03, 0.05)).is_ok());
        let cut = primitive(&sphere, &lidded(0.03, 0.8)).unwrap_err();
        assert!(cut.contains("cuts off"), "{cut}");
        let other = primitive(&sphere, &lidded(0.031, 0.05)).unwrap_err();
        assert!(other.contains("not on the object's surface"), "{other}");
    }
}
