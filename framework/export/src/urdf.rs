//! Hand and object as URDF, with their meshes and the trajectory beside them.
//!
//! URDF has no capsules: one is a cylinder and two balls. A half-space is a slab. Plans know no masses of
//! links, which simulators want: every link gets [`LINK_MASS`].

use crate::names::{OBJECT, ROOT, file_stem};
use crate::solid::{Piece, SLAB, Solid};
use crate::trajectory::trajectory;
use crate::xml::{Xml, direction, numbers, position};
use crate::{File, Scene};
use regrasp_api::{JointKind, Mat3, Mesh, Pose, Primitive};

/// Mass (kg) and diagonal of the inertia (kg·m²) of every link, for want of better.
pub(crate) const LINK_MASS: (f64, f64) = (0.02, 1e-5);

/// `STEM.hand.urdf` with obstacles, `STEM.object.urdf`, meshes as STL, `STEM.trajectory.csv`.
pub(crate) fn files(scene: &Scene<'_>, stem: &str) -> Vec<File> {
    let mut xml = Xml::new();
    let mut meshes = Meshes { stem, files: Vec::new() };
    xml.element("robot", &[("name", scene.description().name.clone())], |xml| hand(xml, scene, &mut meshes));
    let mesh = format!("{stem}.object.stl");
    let mut files = vec![
        File { name: format!("{stem}.hand.urdf"), bytes: xml.into_bytes() },
        File { name: format!("{stem}.object.urdf"), bytes: object(scene, &mesh) },
        File { name: mesh, bytes: stl(&scene.object.mesh) },
        trajectory(scene, format!("{stem}.trajectory.csv")),
    ];
    files.extend(meshes.files);
    files
}

/// The meshes of links and obstacles, as they are named.
struct Meshes<'a> {
    stem: &'a str,
    files: Vec<File>,
}

fn hand(xml: &mut Xml, scene: &Scene<'_>, meshes: &mut Meshes<'_>) {
    xml.comment("The frame of the link `hand` is the plan's frame H. Masses of links are nominal.");
    link(xml, ROOT, &scene.solids.palm, true, meshes);
    for finger in 0..scene.origins.len() {
        let mut parent = ROOT;
        for (joint, X) in scene.origins[finger].iter().enumerate() {
            let child = &scene.names.links[finger][joint];
            link(xml, child, &scene.solids.links[finger][joint], true, meshes);
            moving(xml, (scene, finger, joint), (parent, child), X);
            parent = child;
        }
        let tip = &scene.names.tips[finger];
        link(xml, tip, std::slice::from_ref(&scene.solids.tip), true, meshes);
        let [x, y, z] = scene.description().finger[finger].tip;
        fixed(xml, parent, tip, &Pose::translation(x, y, z));
    }
    for (name, piece) in scene.names.obstacles.iter().zip(&scene.solids.obstacles) {
        link(xml, name, std::slice::from_ref(piece), false, meshes);
        fixed(xml, ROOT, name, &Pose::identity());
    }
}

fn link(xml: &mut Xml, name: &str, pieces: &[Piece], has_mass: bool, meshes: &mut Meshes<'_>) {
    let shapes: Vec<_> = pieces.iter().flat_map(|piece| meshes.geometry(name, piece)).collect();
    xml.element("link", &[("name", name.into())], |xml| {
        if has_mass {
            inertial(xml, LINK_MASS.0, &Pose::identity(), &Mat3::from_diagonal_element(LINK_MASS.1));
        }
        for kind in ["visual", "collision"] {
            for (X, geometry, attributes) in &shapes {
                xml.element(kind, &[], |xml| {
                    origin(xml, X);
                    xml.element("geometry", &[], |xml| xml.empty(geometry, attributes));
                });
            }
        }
    });
}

/// One solid in URDF's terms: pose, element, attributes.
type Geometry = (Pose, &'static str, Vec<(&'static str, String)>);

impl Meshes<'_> {
    /// The elements of one solid: pose, name, attributes.
    fn geometry(&mut self, link: &str, piece: &Piece) -> Vec<Geometry> {
        let X = piece.X_BS;
        let ball = |radius: f64| vec![("radius", radius.to_string())];
        let rod = |radius: f64, half_height: f64| {
            let length = ("length", (2.0 * half_height).to_string());
            (X, "cylinder", [ball(radius), vec![length]].concat())
        };
        match piece.solid {
            Solid::Primitive(Primitive::Sphere { radius }) => vec![(X, "sphere", ball(radius))],
            Solid::Primitive(Primitive::Cuboid { half_size }) => {
                vec![(X, "box", vec![("size", numbers((half_size * 2.0).iter()))])]
            }
            Solid::Primitive(Primitive::Cylinder { radius, half_height }) => vec![rod(radius, half_height)],
            Solid::Primitive(Primitive::Capsule { radius, half_height }) => {
                let end = |z: f64| (X * Pose::translation(0.0, 0.0, z), "sphere", ball(radius));
                vec![rod(radius, half_height), end(half_height), end(-half_height)]
            }
            Solid::HalfSpace => {
                let size = numbers(&[SLAB.0, SLAB.0, SLAB.1]);
                vec![(piece.X_BMesh(), "box", vec![("size", size)])]
            }
            Solid::Primitive(Primitive::Ellipsoid { .. } | Primitive::Torus { .. }) | Solid::Mesh => {
                let name = format!("{}.{}.{}.stl", self.stem, file_stem(link), self.files.len());
                self.files.push(File { name: name.clone(), bytes: stl(&piece.mesh) });
                vec![(X, "mesh", vec![("filename", name)])]
            }
        }
    }
}

fn moving(
    xml: &mut Xml,
    (scene, finger, index): (&Scene<'_>, usize, usize),
    (parent, child): (&str, &str),
    X: &Pose,
) {
    let joint = &scene.description().finger[finger].joint[index];
    let kind = match joint.kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
    };
    let name = scene.names.joints[finger][index].clone();
    xml.element("joint", &[("name", name), ("type", kind.into())], |xml| {
        origin(xml, X);
        xml.empty("parent", &[("link", parent.into())]);
        xml.empty("child", &[("link", child.into())]);
        xml.empty("axis", &[("xyz", direction(&joint.axis))]);
        let (lower, upper) = (("lower", joint.lower), ("upper", joint.upper));
        let limits = [lower, upper, ("effort", joint.effort), ("velocity", joint.velocity)];
        xml.empty("limit", &limits.map(|(key, value)| (key, value.to_string())));
        if let Some(driver) = scene.driver(finger, index) {
            let (multiplier, offset) = (driver.multiplier.to_string(), driver.offset.to_string());
            let of = ("joint", scene.names.joints[finger][driver.joint].clone());
            xml.empty("mimic", &[of, ("multiplier", multiplier), ("offset", offset)]);
        }
    });
}

fn fixed(xml: &mut Xml, parent: &str, child: &str, X: &Pose) {
    let head = [("name", format!("{child}-mount")), ("type", "fixed".into())];
    xml.element("joint", &head, |xml| {
        origin(xml, X);
        xml.empty("parent", &[("link", parent.into())]);
        xml.empty("child", &[("link", child.into())]);
    });
}

fn object(scene: &Scene<'_>, mesh: &str) -> Vec<u8> {
    let mut xml = Xml::new();
    let object = &scene.object;
    let X_OCm = Pose::translation(object.p_OCm.x, object.p_OCm.y, object.p_OCm.z);
    let name = scene.plan.scenario.problem.object.name.clone();
    xml.element("robot", &[("name", name)], |xml| {
        xml.comment("The link's frame is the plan's frame O.");
        xml.element("link", &[("name", OBJECT.into())], |xml| {
            inertial(xml, object.mass, &X_OCm, &object.inertia_OCm);
            for kind in ["visual", "collision"] {
                let file = [("filename", mesh.to_owned())];
                xml.element(kind, &[], |xml| xml.element("geometry", &[], |xml| xml.empty("mesh", &file)));
            }
        });
    });
    xml.into_bytes()
}

fn inertial(xml: &mut Xml, mass: f64, X: &Pose, inertia: &Mat3) {
    xml.element("inertial", &[], |xml| {
        origin(xml, X);
        xml.empty("mass", &[("value", mass.to_string())]);
        let entries =
            [("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2)];
        xml.empty("inertia", &entries.map(|(key, i, j)| (key, inertia[(i, j)].to_string())));
    });
}

/// Position and fixed-axis roll, pitch and yaw.
fn origin(xml: &mut Xml, X: &Pose) {
    let (roll, pitch, yaw) = X.rotation.euler_angles();
    xml.empty("origin", &[("xyz", position(X)), ("rpy", numbers(&[roll, pitch, yaw]))]);
}

/// A mesh as a binary STL file (32-bit floating-point numbers).
pub fn stl(mesh: &Mesh) -> Vec<u8> {
    let mut bytes = format!("{:<80}", concat!("regrasp ", env!("CARGO_PKG_VERSION"))).into_bytes();
    bytes.extend((mesh.facets().len() as u32).to_le_bytes());
    for facet in 0..mesh.facets().len() as u32 {
        let [a, b, c] = mesh.corners(facet);
        for vector in [mesh.normal(facet), a, b, c] {
            bytes.extend(vector.iter().flat_map(|&x| (x as f32).to_le_bytes()));
        }
        bytes.extend([0, 0]);
    }
    bytes
}
