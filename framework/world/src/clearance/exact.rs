//! Exact distances by parry3d.

use super::border::{to_glam, to_parry};
use super::hull::Hull;
use super::rod::{Bounds, Rod};
use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::{self, ClosestPoints, PointQuery, PointQueryWithLocation};
use parry3d_f64::shape::{Ball, Capsule, ConvexPolyhedron, Cuboid, Segment, Shape, TriMesh, TriMeshFlags};
use regrasp_api::{Mesh, Pose, Vec3};
use std::sync::{Arc, OnceLock};

/// A solid in its own frame S.
#[derive(Clone)]
pub(crate) enum Solid {
    Rod(Rod),
    /// A box about the origin.
    Cuboid {
        half_size: Vec3,
    },
    /// Everything with normal · x ≤ offset; the normal has length 1.
    HalfSpace {
        normal: Vec3,
        offset: f64,
    },
    Mesh(Arc<MeshSolid>),
}

/// A closed mesh, prepared for distances.
pub(crate) struct MeshSolid {
    /// With a tree that takes long to build, and that round and flat objects hardly ever need: see
    /// [`Self::surface`].
    surface: OnceLock<TriMesh>,
    vertices: Vec<Vec3>,
    facets: Vec<[u32; 3]>,
    /// One vertex of each connected component: the surfaces being apart, it tells whether the component is
    /// inside another body.
    roots: Vec<Vec3>,
    pub bounds: Bounds,
    /// The mesh as a hull, where it is convex.
    pub hull: Option<Hull>,
    /// The same for parry, where it has few enough corners to be looked through.
    polyhedron: Option<ConvexPolyhedron>,
}

/// Hulls of links have fewer corners than this.
const FEW_CORNERS: usize = 300;

impl MeshSolid {
    pub fn new(mesh: &Mesh) -> Self {
        let roots = roots(mesh);
        let hull = Hull::of(mesh, roots.len());
        let is_small = hull.is_some() && mesh.vertices().len() <= FEW_CORNERS;
        let corners = is_small.then(|| mesh.vertices().iter().map(to_glam).collect());
        let polyhedron =
            corners.and_then(|corners| ConvexPolyhedron::from_convex_mesh(corners, mesh.facets()));
        let bounds = Bounds::of(mesh.vertices().iter().copied());
        let (vertices, facets) = (mesh.vertices().to_vec(), mesh.facets().to_vec());
        Self { surface: OnceLock::new(), vertices, facets, roots, bounds, hull, polyhedron }
    }

    /// The surface for parry, made when it is first asked for: the same whoever asks.
    fn surface(&self) -> &TriMesh {
        self.surface.get_or_init(|| {
            let vertices = self.vertices.iter().map(to_glam).collect();
            TriMesh::with_flags(vertices, self.facets.clone(), TriMeshFlags::ORIENTED)
                .expect("a checked mesh has facets")
        })
    }

    /// Signed distance of a point (m) that is known to be at most `limit` (m) from the surface, which makes
    /// it cheaper.
    pub fn signed_distance_within(&self, p: &Vec3, limit: f64) -> f64 {
        let p = to_glam(p);
        let limit = limit * (1.0 + 1e-9);
        let projection = self
            .surface()
            .project_local_point_and_get_location_with_max_dist(p, false, limit)
            .map_or_else(|| self.surface().project_local_point(p, false), |(projection, _)| projection);
        let distance = (p - projection.point).length();
        if projection.is_inside { -distance } else { distance }
    }

    /// The same (m), at most `limit` (m) as is known, where the facet `near` is likely to be close to the
    /// point: it becomes the closest one.
    pub fn signed_distance_near(&self, p: &Vec3, limit: f64, near: &mut u32) -> f64 {
        let point = to_glam(p);
        // A facet's own distance is a bound that leaves little of the rest to be looked at.
        let known = self.surface().triangle(*near).distance_to_local_point(point, true);
        let limit = limit.min(known) * (1.0 + 1e-9) + f64::MIN_POSITIVE;
        match self.surface().project_local_point_and_get_location_with_max_dist(point, false, limit) {
            Some((projection, (facet, _))) => {
                *near = facet;
                let distance = (point - projection.point).length();
                if projection.is_inside { -distance } else { distance }
            }
            None => self.signed_distance_within(p, f64::MAX),
        }
    }

    /// Whether the rod, in the mesh's frame, is farther from the solid than `clear` (m).
    pub fn clear_of_rod(&self, rod: &Rod, clear: f64) -> bool {
        let radius = rod.radius + clear;
        let touches = if rod.a == rod.b {
            self.surface().distance_to_local_point(to_glam(&rod.a), false).abs() <= radius
        } else {
            let capsule = Capsule::new(to_glam(&rod.a), to_glam(&rod.b), radius);
            let identity = ParryPose::identity();
            query::intersection_test(&identity, self.surface(), &identity, &capsule)
                .map_or(true, |answer| answer.intersecting)
        };
        !touches && !self.contains(&rod.a)
    }

    fn contains(&self, p: &Vec3) -> bool {
        self.bounds.distance(p) == 0.0 && self.surface().contains_local_point(to_glam(p))
    }

    /// The least n · x over the solid (m).
    pub fn lowest(&self, n: &Vec3) -> f64 {
        self.vertices.iter().map(|v| v.dot(n)).fold(f64::INFINITY, f64::min)
    }
}

/// One vertex of each connected component.
fn roots(mesh: &Mesh) -> Vec<Vec3> {
    let mut seen = vec![false; mesh.facets().len()];
    let (mut roots, mut open) = (Vec::new(), Vec::new());
    for first in 0..seen.len() as u32 {
        if seen[first as usize] {
            continue;
        }
        roots.push(mesh.corners(first)[0]);
        open.push(first);
        seen[first as usize] = true;
        while let Some(facet) = open.pop() {
            for neighbor in mesh.neighbors(facet) {
                if !std::mem::replace(&mut seen[neighbor.facet as usize], true) {
                    open.push(neighbor.facet);
                }
            }
        }
    }
    roots
}

/// The exact distance (m) of two solids at their poses in H, 0 where they overlap.
///
/// Two half-spaces never meet here: palm and obstacles do not move against each other, and links have none.
pub(crate) fn distance(a: &Solid, X_HA: &Pose, b: &Solid, X_HB: &Pose) -> f64 {
    match (a, b) {
        (Solid::HalfSpace { normal, offset }, other) => above(normal, *offset, &X_HA.inv_mul(X_HB), other),
        (other, Solid::HalfSpace { normal, offset }) => above(normal, *offset, &X_HB.inv_mul(X_HA), other),
        _ => {
            let X_AB = X_HA.inv_mul(X_HB);
            if holds(a, &X_AB, b) || holds(b, &X_AB.inverse(), a) {
                return 0.0;
            }
            let (core_a, core_b) = (Core::of(a), Core::of(b));
            let identity = ParryPose::identity();
            let apart = query::distance(
                &core_a.placed(identity),
                core_a.shape(),
                &core_b.placed(to_parry(&X_AB)),
                core_b.shape(),
            )
            .expect("parry knows the distance of balls, segments, boxes and meshes")
            .distance;
            (apart - core_a.radius - core_b.radius).max(0.0)
        }
    }
}

/// Whether two solids are more than `clear` (m) apart; for pairs of convex ones there is a faster way.
pub(super) fn farther(a: &Solid, X_HA: &Pose, b: &Solid, X_HB: &Pose, clear: f64) -> bool {
    if matches!(a, Solid::HalfSpace { .. }) || matches!(b, Solid::HalfSpace { .. }) {
        return distance(a, X_HA, b, X_HB) > clear;
    }
    let X_AB = X_HA.inv_mul(X_HB);
    let (core_a, core_b) = (Core::convex_of(a), Core::convex_of(b));
    let identity = ParryPose::identity();
    let nearest = query::closest_points(
        &core_a.placed(identity),
        core_a.shape(),
        &core_b.placed(to_parry(&X_AB)),
        core_b.shape(),
        clear + core_a.radius + core_b.radius,
    );
    let nearest = nearest.expect("parry knows the nearest points of balls, segments, boxes and meshes");
    matches!(nearest, ClosestPoints::Disjoint) && !holds(a, &X_AB, b) && !holds(b, &X_AB.inverse(), a)
}

/// How far `solid` (its frame S seen from the half-space's) stays above the plane.
fn above(normal: &Vec3, offset: f64, X_AS: &Pose, solid: &Solid) -> f64 {
    let n_S = X_AS.rotation.inverse() * normal;
    let lowest = match solid {
        Solid::Rod(rod) => rod.a.dot(&n_S).min(rod.b.dot(&n_S)) - rod.radius,
        Solid::Cuboid { half_size } => -half_size.dot(&n_S.abs()),
        Solid::Mesh(mesh) => mesh.lowest(&n_S),
        Solid::HalfSpace { .. } => return 0.0,
    };
    (lowest + normal.dot(&X_AS.translation.vector) - offset).max(0.0)
}

/// Whether a mesh `a` holds a part of `b` inside it, judged by one point of each part.
fn holds(a: &Solid, X_AB: &Pose, b: &Solid) -> bool {
    let Solid::Mesh(mesh) = a else { return false };
    let inside = |p: &Vec3| mesh.contains(&(X_AB * nalgebra::Point3::from(*p)).coords);
    match b {
        Solid::Rod(rod) => inside(&rod.a),
        Solid::Cuboid { .. } => inside(&Vec3::zeros()),
        Solid::Mesh(other) => other.roots.iter().any(inside),
        Solid::HalfSpace { .. } => false,
    }
}

/// A solid without its thickness, as parry has it: segments and points are more exact than capsules.
struct Core<'a> {
    shape: CoreShape<'a>,
    /// Its origin in S.
    origin: Vec3,
    radius: f64,
}

enum CoreShape<'a> {
    Ball(Ball),
    Segment(Segment),
    Cuboid(Cuboid),
    Mesh(&'a TriMesh),
    Polyhedron(&'a ConvexPolyhedron),
}

impl<'a> Core<'a> {
    fn of(solid: &'a Solid) -> Self {
        let at_origin = |shape| Self { shape, origin: Vec3::zeros(), radius: 0.0 };
        match solid {
            Solid::Rod(rod) if rod.a == rod.b => {
                Self { shape: CoreShape::Ball(Ball::new(rod.radius)), origin: rod.a, radius: 0.0 }
            }
            Solid::Rod(rod) => {
                let segment = Segment::new(to_glam(&rod.a), to_glam(&rod.b));
                Self { radius: rod.radius, ..at_origin(CoreShape::Segment(segment)) }
            }
            Solid::Cuboid { half_size } => at_origin(CoreShape::Cuboid(Cuboid::new(to_glam(half_size)))),
            Solid::Mesh(mesh) => at_origin(CoreShape::Mesh(mesh.surface())),
            Solid::HalfSpace { .. } => unreachable!("half-spaces are handled before"),
        }
    }

    /// The same, convex meshes as such.
    fn convex_of(solid: &'a Solid) -> Self {
        let mut core = Self::of(solid);
        if let Solid::Mesh(mesh) = solid
            && let Some(polyhedron) = &mesh.polyhedron
        {
            core.shape = CoreShape::Polyhedron(polyhedron);
        }
        core
    }

    /// The core's pose, its solid being at `X_S`.
    fn placed(&self, X_S: ParryPose) -> ParryPose {
        X_S.prepend_translation(to_glam(&self.origin))
    }

    fn shape(&self) -> &dyn Shape {
        match &self.shape {
            CoreShape::Ball(shape) => shape,
            CoreShape::Segment(shape) => shape,
            CoreShape::Cuboid(shape) => shape,
            CoreShape::Mesh(shape) => *shape,
            CoreShape::Polyhedron(shape) => *shape,
        }
    }
}
