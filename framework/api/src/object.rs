//! The object as the planner sees it: mesh, mass and friction.

use crate::{Mat3, Mesh, Vec3};

/// A solid in closed form, about its own origin and along its own axes (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Primitive {
    /// A ball.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// An ellipsoid.
    Ellipsoid {
        /// Half the lengths along x, y, z.
        semi_axes: Vec3,
    },
    /// A box.
    Cuboid {
        /// Half the lengths along x, y, z.
        half_size: Vec3,
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Half the height.
        half_height: f64,
    },
    /// A cylinder along z with half balls at its ends.
    Capsule {
        /// Radius.
        radius: f64,
        /// Half the height of the cylindrical part.
        half_height: f64,
    },
    /// A ring about z.
    Torus {
        /// Distance of the tube's centre from z.
        ring_radius: f64,
        /// Radius of the tube.
        tube_radius: f64,
    },
}

impl Primitive {
    /// Half the size of the box along the axes around it (m).
    pub fn half_size(&self) -> Vec3 {
        match *self {
            Self::Sphere { radius } => Vec3::repeat(radius),
            Self::Ellipsoid { semi_axes } => semi_axes,
            Self::Cuboid { half_size } => half_size,
            Self::Cylinder { radius, half_height } => Vec3::new(radius, radius, half_height),
            Self::Capsule { radius, half_height } => Vec3::new(radius, radius, radius + half_height),
            Self::Torus { ring_radius, tube_radius } => {
                let wide = ring_radius + tube_radius;
                Vec3::new(wide, wide, tube_radius)
            }
        }
    }
}

/// A surface that fingertips touch in place of a rough mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Twin {
    /// The surface, in O.
    pub mesh: Mesh,
    /// How far at most (m) a fingertip that touches the twin is from touching the object, and how deep at
    /// most it enters it.
    pub bound: f64,
    /// What was wished of the bound (m).
    pub tolerance: f64,
}

/// The rigid object. Its frame is O; the mesh is its true surface.
#[derive(Clone, Debug)]
pub struct ObjectModel {
    /// The surface.
    pub mesh: Mesh,
    /// The closed form that the mesh approximates, if any.
    pub primitive: Option<Primitive>,
    /// Mass (kg).
    pub mass: f64,
    /// Centre of mass Cm in O (m).
    pub p_OCm: Vec3,
    /// Inertia about the centre of mass, in O (kg·m²).
    pub inertia_OCm: Mat3,
    /// Coefficient of friction between object and fingertips, no unit.
    pub friction: f64,
    /// What contacts live on, where that is not the mesh itself.
    pub twin: Option<Twin>,
}

impl ObjectModel {
    /// An object of uniform density with the given mass (kg).
    pub fn new(mesh: Mesh, primitive: Option<Primitive>, mass: f64, friction: f64) -> Self {
        let unit = mesh.mass_properties();
        let inertia_OCm = unit.inertia_OCm * (mass / unit.volume);
        Self { mesh, primitive, mass, p_OCm: unit.p_OCm, inertia_OCm, friction, twin: None }
    }

    /// The surface that contacts live on: the twin, or the mesh itself.
    pub fn contact_mesh(&self) -> &Mesh {
        self.twin.as_ref().map_or(&self.mesh, |twin| &twin.mesh)
    }

    /// How far (m) a touching fingertip may be from the true surface, on either side; 0 where contacts live
    /// on the mesh.
    pub fn contact_bound(&self) -> f64 {
        self.twin.as_ref().map_or(0.0, |twin| twin.bound)
    }
}
