//! From the geometries of a URDF to convex shapes of links.

use crate::hulls::Hulls;
use crate::rods;
use nalgebra::Point3;
use regrasp_api::{Mesh, MeshSource, PlacedShape, Pose, PoseDescription, Primitive, Shape, Vec3};
use regrasp_formats::RobotFault as Fault;
use regrasp_formats::{Geometry, Link, Packages, Solid};
use regrasp_world::convex_hull;
use std::f64::consts::PI;

/// Sides of the prism that stands for a cylinder; its edges stand out by 2 % of the radius.
const SIDES: usize = 16;

/// A convex solid in the frame B of what it belongs to: all points within `radius` of the hull of `corners`.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    pub shape: Shape,
    pub X_BS: Pose,
    /// In B (m).
    pub corners: Vec<Vec3>,
    pub radius: f64,
}

impl Piece {
    fn new(shape: Shape, X_BS: Pose, corners_S: &[Vec3], radius: f64) -> Self {
        let corners = corners_S.iter().map(|p| (X_BS * Point3::from(*p)).coords).collect();
        Self { shape, X_BS, corners, radius }
    }

    /// A box.
    pub fn cuboid(half: Vec3, X_BS: Pose) -> Self {
        let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
        let corner = |i: usize| Vec3::new(sign(i & 1), sign(i & 2), sign(i & 4)).component_mul(&half);
        let corners: Vec<Vec3> = (0..8).map(corner).collect();
        Self::new(Shape::Box { size: (half * 2.0).into() }, X_BS, &corners, 0.0)
    }

    /// All within `radius` of the line between two points, in B (m).
    pub fn capsule([from, to]: [Vec3; 2], radius: f64) -> Self {
        let shape = Shape::Capsule { from: from.into(), to: to.into(), radius };
        Self { shape, X_BS: Pose::identity(), corners: vec![from, to], radius }
    }

    /// A convex mesh, in B.
    pub fn of_mesh(mesh: &Mesh) -> Self {
        let shape = Shape::Mesh(MeshSource::of(mesh));
        Self::new(shape, Pose::identity(), mesh.vertices(), 0.0)
    }

    /// The piece, given in B, in a frame A.
    pub fn moved(self, X_AB: &Pose) -> Self {
        let corners = self.corners.iter().map(|p| (X_AB * Point3::from(*p)).coords).collect();
        Self { X_BS: X_AB * self.X_BS, corners, ..self }
    }

    pub fn placed(&self) -> PlacedShape {
        let still = self.X_BS == Pose::identity();
        let pose = if still { PoseDescription::default() } else { PoseDescription::from(&self.X_BS) };
        PlacedShape { shape: self.shape.clone(), pose }
    }

    /// The corners, and for rounded pieces the ends of their balls along the axes.
    pub fn spread(&self) -> impl Iterator<Item = Vec3> + '_ {
        let reach = Vec3::repeat(self.radius);
        self.corners.iter().flat_map(move |p| [p - reach, p + reach])
    }

    /// How far the piece reaches in the direction `n` (m).
    pub fn reach(&self, n: &Vec3) -> f64 {
        self.corners.iter().map(|p| n.dot(p)).fold(f64::NEG_INFINITY, f64::max) + self.radius
    }
}

/// Reads geometries, each mesh file once.
#[derive(Debug)]
pub(crate) struct Shaper {
    hulls: Hulls,
    /// What was done to which link's shapes.
    pub notes: Vec<String>,
}

impl Shaper {
    /// The meshes of the links' collision shapes (visual ones where there are none) are read at once, on all
    /// processors.
    pub fn new(packages: Packages, most_pieces: usize, links: &[Link]) -> Self {
        let used = links.iter().filter_map(|link| match (&link.collision, &link.visual) {
            (Ok(collision), Ok(visual)) if collision.is_empty() => Some(visual),
            (Ok(collision), _) => Some(collision),
            (Err(_), _) => None,
        });
        let meshes = used.flatten().filter_map(|solid| match &solid.geometry {
            Geometry::Mesh { file, scale } => Some((file.as_str(), *scale)),
            _ => None,
        });
        Self { hulls: Hulls::new(packages, most_pieces, meshes), notes: Vec::new() }
    }

    /// The convex pieces of a link, in its frame: of `<collision>`, or of `<visual>` where there is none.
    pub fn pieces(&mut self, link: &Link) -> Result<Vec<Piece>, Fault> {
        let collision = link.collision.as_ref().map_err(Clone::clone)?;
        let (solids, source) = match (&collision[..], &link.visual) {
            ([], Err(fault)) => return Err(fault.clone()),
            ([], Ok(visual)) if visual.is_empty() => return Ok(Vec::new()),
            ([], Ok(visual)) => (&visual[..], "visual (it has no collision)"),
            (collision, _) => (collision, "collision"),
        };
        let (all, done) = self.all(solids)?;
        self.notes.push(format!("link `{}`: {} from its {source}", link.name, done.join(", ")));
        Ok(all)
    }

    /// The convex pieces of a link as it is seen, in its frame; none where a mesh of it cannot be read:
    /// nothing depends on them alone.
    pub fn seen(&mut self, link: &Link) -> Vec<Piece> {
        let seen = link.visual.as_ref().ok().and_then(|visual| self.all(visual).ok());
        seen.map(|(pieces, _)| pieces).unwrap_or_default()
    }

    fn all(&mut self, solids: &[Solid]) -> Result<(Vec<Piece>, Vec<String>), Fault> {
        let (mut all, mut done) = (Vec::new(), Vec::new());
        let solids = rods::joined(solids);
        for solid in solids.iter().map(AsRef::as_ref) {
            let (pieces, what) = self.solid(solid)?;
            all.extend(pieces);
            done.push(what);
        }
        Ok((all, done))
    }

    fn solid(&mut self, solid: &Solid) -> Result<(Vec<Piece>, String), Fault> {
        let X = solid.X_LS;
        let one = |piece: Piece, what: &str| Ok((vec![piece], what.to_owned()));
        match &solid.geometry {
            Geometry::Box { size } => one(Piece::cuboid(Vec3::from(*size) / 2.0, X), "a box"),
            Geometry::Sphere { radius } => {
                let piece = Piece::new(Shape::Sphere { radius: *radius }, X, &[Vec3::zeros()], *radius);
                one(piece, "a ball")
            }
            Geometry::Capsule { radius, length } => {
                let ends = [-0.5, 0.5].map(|s| Vec3::new(0.0, 0.0, s * length));
                let shape = Shape::Capsule { from: ends[0].into(), to: ends[1].into(), radius: *radius };
                one(Piece::new(shape, X, &ends, *radius), "a capsule")
            }
            Geometry::Cylinder { radius, length } => {
                let points = prism(*radius, *length);
                let mesh = convex_hull(&points).ok_or_else(|| {
                    Fault::at(solid.line, "the cylinder is thinner than a micrometre; lengths are in metres")
                })?;
                one(Piece::of_mesh(&mesh).moved(&X), &format!("a prism of {SIDES} sides around a cylinder"))
            }
            Geometry::Ellipsoid { semi_axes } => {
                let mesh = convex_hull(&ellipsoid(*semi_axes)).ok_or_else(|| {
                    Fault::at(solid.line, "the ellipsoid is thinner than a micrometre; lengths are in metres")
                })?;
                one(Piece::of_mesh(&mesh).moved(&X), "a polytope around an ellipsoid")
            }
            Geometry::Mesh { file, scale } => self.mesh(solid, file, *scale),
        }
    }

    fn mesh(&mut self, solid: &Solid, name: &str, scale: [f64; 3]) -> Result<(Vec<Piece>, String), Fault> {
        let convex = self.hulls.of(name, scale).map_err(|reason| Fault::at(solid.line, reason))?;
        let pieces = match convex.flat {
            Some(corners) => vec![boxed(corners, &solid.X_LS)],
            None => convex.parts.iter().map(|mesh| Piece::of_mesh(mesh).moved(&solid.X_LS)).collect(),
        };
        Ok((pieces, convex.what.clone()))
    }
}

fn boxed((low, high): (Vec3, Vec3), X: &Pose) -> Piece {
    let half = (high - low) / 2.0;
    Piece::cuboid(half, X * Pose::translation(low.x + half.x, low.y + half.y, low.z + half.z))
}

/// Points of an ellipsoid, dense enough that their hull stays within 1 % of it.
fn ellipsoid(semi_axes: [f64; 3]) -> Vec<Vec3> {
    let mesh = regrasp_world::primitive_mesh(&Primitive::Sphere { radius: 1.0 }, 320);
    let unit = mesh.map(|mesh| mesh.vertices().to_vec()).unwrap_or_default();
    unit.into_iter().map(|v| v.component_mul(&Vec3::from(semi_axes)) * 1.005).collect()
}

/// The corners of a prism about z around a cylinder.
fn prism(radius: f64, length: f64) -> Vec<Vec3> {
    let outer = radius / (PI / SIDES as f64).cos();
    let corner = |i: usize| {
        let (sin, cos) = (2.0 * PI * (i % SIDES) as f64 / SIDES as f64).sin_cos();
        let z = if i < SIDES { -0.5 } else { 0.5 };
        Vec3::new(outer * cos, outer * sin, z * length)
    };
    (0..2 * SIDES).map(corner).collect()
}
