//! A MuJoCo model of hand, object and obstacles, with the trajectory of its motors.
//!
//! Links are weightless (`gravcomp`), as plans take them to be, and have a nominal mass. Links do not collide
//! with one another: plans are free of that. The object is a primitive where it is one and MuJoCo has it;
//! else its mesh, of which MuJoCo takes the convex hull; else, where it is not convex, one thin wedge below
//! each facet, so that its surface is the plan's.

use crate::names::{OBJECT, ROOT, file_stem};
use crate::solid::{Piece, Solid};
use crate::trajectory::{controls, motors, target};
use crate::urdf::{LINK_MASS, stl};
use crate::xml::{Xml, direction, numbers, position};
use crate::{File, Scene};
use regrasp_api::{JointKind, Mat3, Mesh, Pose, Primitive, Vec3};

/// How thick (as a part of the object's radius) the wedges of an object are that is not convex.
const WEDGE: f64 = 0.1;

/// `STEM.mjcf.xml`, meshes as STL, `STEM.controls.csv`.
pub(crate) fn files(scene: &Scene<'_>, stem: &str) -> Vec<File> {
    let mut assets = Assets { stem, meshes: Vec::new(), wedges: Vec::new() };
    let object = assets.object(scene);
    let bodies = Bodies::new(scene, &mut assets);
    let mut xml = Xml::new();
    let name = scene.plan.scenario.name.clone();
    xml.element("mujoco", &[("model", name)], |xml| {
        xml.comment(
            "The world's frame is the plan's frame H. Masses of links are nominal and their weight \
            is compensated.",
        );
        xml.empty("compiler", &[("angle", "radian".into()), ("autolimits", "true".into())]);
        options(xml, scene);
        assets.write(xml);
        xml.element("worldbody", &[], |xml| bodies.write(xml, scene, &object));
        drivers(xml, scene);
        actuators(xml, scene);
        start(xml, scene);
    });
    let mut files = vec![File { name: format!("{stem}.mjcf.xml"), bytes: xml.into_bytes() }];
    files.extend(
        assets.meshes.into_iter().map(|(name, mesh)| File { name: format!("{name}.stl"), bytes: stl(&mesh) }),
    );
    files.push(controls(scene, format!("{stem}.controls.csv")));
    files
}

fn options(xml: &mut Xml, scene: &Scene<'_>) {
    // Elliptic cones are the plan's own; a high ratio of the constraints' impedances keeps held objects from
    // creeping out of the grasp.
    let mut option: Attributes = vec![
        ("timestep", "0.0005".into()),
        ("integrator", "implicitfast".into()),
        ("cone", "elliptic".into()),
        ("impratio", "100".into()),
        ("gravity", numbers(&scene.plan.scenario.problem.gravity)),
    ];
    if has_torsion(scene) {
        // MuJoCo softens torsional friction by (mu/gamma)², some 40,000 here: a pinched object would turn out
        // of the fingers. These steps undo that.
        option.push(("noslip_iterations", "5".into()));
    }
    xml.empty("option", &option);
    xml.empty("size", &[("memory", "200M".into())]);
    // Stiff contacts: by MuJoCo's own defaults fingertips sink in by half a millimetre, and grasps turn by as
    // much and slip.
    xml.element("default", &[], |xml| {
        xml.empty("geom", &[("solref", "0.002 1".into()), ("solimp", "0.95 0.99 0.0001 0.5 2".into())]);
    });
}

type Attributes = Vec<(&'static str, String)>;

/// Meshes that the model refers to.
struct Assets<'a> {
    stem: &'a str,
    meshes: Vec<(String, Mesh)>,
    /// Vertices of thin wedges.
    wedges: Vec<(String, [Vec3; 4])>,
}

impl Assets<'_> {
    fn mesh(&mut self, name: &str, mesh: &Mesh) -> String {
        let name = format!("{}.{}.{}", self.stem, file_stem(name), self.meshes.len());
        self.meshes.push((name.clone(), mesh.clone()));
        name
    }

    /// The geometries of one piece of hand or obstacle.
    fn piece(&mut self, body: &str, piece: &Piece) -> Attributes {
        let mesh =
            |assets: &mut Self| vec![("type", "mesh".into()), ("mesh", assets.mesh(body, &piece.mesh))];
        let mut attributes = match piece.solid {
            Solid::Primitive(primitive) => geometry(&primitive).unwrap_or_else(|| mesh(self)),
            Solid::HalfSpace => vec![("type", "plane".into()), ("size", "1 1 0.1".into())],
            Solid::Mesh => mesh(self),
        };
        attributes.extend(place(&piece.X_BS));
        attributes
    }

    /// The geometries of the object, in O.
    fn object(&mut self, scene: &Scene<'_>) -> Vec<Attributes> {
        match scene.object.primitive.as_ref().and_then(geometry) {
            Some(geometry) => vec![geometry],
            None if scene.object.mesh.is_locally_convex() => {
                vec![vec![("type", "mesh".into()), ("mesh", self.mesh(OBJECT, &scene.object.mesh))]]
            }
            None => self.wedges(&scene.object.mesh),
        }
    }

    fn wedges(&mut self, mesh: &Mesh) -> Vec<Attributes> {
        let depth = WEDGE * mesh.radius();
        for facet in 0..mesh.facets().len() as u32 {
            let [a, b, c] = mesh.corners(facet);
            let below = (a + b + c) / 3.0 - mesh.normal(facet) * depth.min(mesh.area(facet).sqrt());
            self.wedges.push((format!("{OBJECT}.{facet}"), [a, b, c, below]));
        }
        let geometry = |(name, _): &(String, _)| vec![("type", "mesh".into()), ("mesh", name.clone())];
        self.wedges.iter().map(geometry).collect()
    }

    fn write(&self, xml: &mut Xml) {
        xml.element("asset", &[], |xml| {
            for (name, _) in &self.meshes {
                xml.empty("mesh", &[("name", name.clone()), ("file", format!("{name}.stl"))]);
            }
            for (name, vertices) in &self.wedges {
                let all = numbers(vertices.iter().flat_map(|vertex| vertex.iter()));
                xml.empty("mesh", &[("name", name.clone()), ("vertex", all)]);
            }
        });
    }
}

/// A primitive as MuJoCo knows it; `None` where it does not.
fn geometry(primitive: &Primitive) -> Option<Attributes> {
    let (kind, size) = match primitive {
        Primitive::Sphere { radius } => ("sphere", vec![*radius]),
        Primitive::Ellipsoid { semi_axes } => ("ellipsoid", semi_axes.as_slice().to_vec()),
        Primitive::Cuboid { half_size } => ("box", half_size.as_slice().to_vec()),
        Primitive::Cylinder { radius, half_height } => ("cylinder", vec![*radius, *half_height]),
        Primitive::Capsule { radius, half_height } => ("capsule", vec![*radius, *half_height]),
        Primitive::Torus { .. } => return None,
    };
    Some(vec![("type", kind.into()), ("size", numbers(&size))])
}

/// The geometries of hand and obstacles.
struct Bodies {
    palm: Vec<Attributes>,
    links: Vec<Vec<Vec<Attributes>>>,
    tip: Attributes,
    obstacles: Vec<Attributes>,
}

impl Bodies {
    fn new(scene: &Scene<'_>, assets: &mut Assets<'_>) -> Self {
        let solids = &scene.solids;
        let mut all = |name: &str, pieces: &[Piece]| -> Vec<Attributes> {
            pieces.iter().map(|piece| assets.piece(name, piece)).collect()
        };
        let mut links = Vec::new();
        for (names, joints) in scene.names.links.iter().zip(&solids.links) {
            links.push(names.iter().zip(joints).map(|(name, pieces)| all(name, pieces)).collect());
        }
        Self {
            palm: all(ROOT, &solids.palm),
            links,
            tip: all("tip", std::slice::from_ref(&solids.tip)).remove(0),
            obstacles: all("obstacle", &solids.obstacles),
        }
    }

    fn write(&self, xml: &mut Xml, scene: &Scene<'_>, object: &[Attributes]) {
        for (geometry, name) in self
            .palm
            .iter()
            .map(|palm| (palm, None))
            .chain(self.obstacles.iter().zip(scene.names.obstacles.iter().map(Some)))
        {
            geom(xml, geometry, HAND, name.map(String::as_str), &scene_friction(scene));
        }
        for finger in 0..scene.origins.len() {
            self.link(xml, scene, finger, 0);
        }
        self.object(xml, scene, object);
    }

    /// The link behind a joint, and within it the rest of the finger.
    fn link(&self, xml: &mut Xml, scene: &Scene<'_>, finger: usize, joint: usize) {
        let description = &scene.description().finger[finger];
        let friction = scene_friction(scene);
        let Some(parameters) = description.joint.get(joint) else {
            let (name, [x, y, z]) = (scene.names.tips[finger].clone(), description.tip);
            let body = [("name", name.clone()), ("pos", numbers(&[x, y, z])), ("gravcomp", "1".into())];
            xml.element("body", &body, |xml| {
                inertial(xml, LINK_MASS.0, &Vec3::zeros(), &Mat3::from_diagonal_element(LINK_MASS.1));
                geom(xml, &self.tip, HAND, Some(&name), &friction);
            });
            return;
        };
        let mut body = vec![("name", scene.names.links[finger][joint].clone()), ("gravcomp", "1".into())];
        body.extend(place(&scene.origins[finger][joint]));
        xml.element("body", &body, |xml| {
            inertial(xml, LINK_MASS.0, &Vec3::zeros(), &Mat3::from_diagonal_element(LINK_MASS.1));
            let kind = match parameters.kind {
                JointKind::Revolute => "hinge",
                JointKind::Prismatic => "slide",
            };
            xml.empty(
                "joint",
                &[
                    ("name", scene.names.joints[finger][joint].clone()),
                    ("type", kind.into()),
                    ("axis", direction(&parameters.axis)),
                    ("range", numbers(&[parameters.lower, parameters.upper])),
                    // A motor's rotor: without it the light links would ask for far smaller steps.
                    (
                        "armature",
                        if parameters.kind == JointKind::Revolute { "0.0001".into() } else { "0.05".into() },
                    ),
                ],
            );
            for geometry in &self.links[finger][joint] {
                geom(xml, geometry, HAND, None, &friction);
            }
            self.link(xml, scene, finger, joint + 1);
        });
    }

    fn object(&self, xml: &mut Xml, scene: &Scene<'_>, geometries: &[Attributes]) {
        let object = &scene.object;
        let first = scene.keys()[0].1;
        let mut body = vec![("name", OBJECT.to_owned())];
        body.extend(place(&first.X_HO));
        xml.element("body", &body, |xml| {
            xml.empty("freejoint", &[("name", format!("{OBJECT}-free"))]);
            inertial(xml, object.mass, &object.p_OCm, &object.inertia_OCm);
            for geometry in geometries {
                geom(xml, geometry, OBJECT_SIDE, None, &scene_friction(scene));
            }
        });
    }
}

/// What collides with what: `contype` and `conaffinity` of hand and obstacles, which meet the object alone
/// ...
const HAND: [&str; 2] = ["1", "2"];
/// ... and of the object.
const OBJECT_SIDE: [&str; 2] = ["2", "1"];

fn has_torsion(scene: &Scene<'_>) -> bool {
    scene.plan.claims.contact.cone.is_some_and(|cone| cone.gamma > 0.0)
}

/// Dimension of contacts, and sliding, torsional (m) and rolling friction: soft fingers carry torques about
/// their normals.
fn scene_friction(scene: &Scene<'_>) -> [(&'static str, String); 2] {
    let gamma = scene.plan.claims.contact.cone.map_or(0.0, |cone| cone.gamma);
    let dimension = if has_torsion(scene) { "4" } else { "3" };
    [("condim", dimension.into()), ("friction", numbers(&[scene.object.friction, gamma, 0.0]))]
}

fn geom(
    xml: &mut Xml,
    geometry: &Attributes,
    side: [&str; 2],
    name: Option<&str>,
    friction: &[(&'static str, String); 2],
) {
    let mut attributes = geometry.clone();
    attributes.extend([("contype", side[0].to_owned()), ("conaffinity", side[1].to_owned())]);
    attributes.extend(friction.iter().cloned());
    attributes.extend(name.map(|name| ("name", name.to_owned())));
    xml.empty("geom", &attributes);
}

fn place(X: &Pose) -> [(&'static str, String); 2] {
    let q = X.rotation.quaternion();
    [("pos", position(X)), ("quat", numbers(&[q.w, q.i, q.j, q.k]))]
}

fn inertial(xml: &mut Xml, mass: f64, p: &Vec3, inertia: &Mat3) {
    let entries = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)].map(|place| inertia[place]);
    xml.empty(
        "inertial",
        &[("pos", numbers(p.iter())), ("mass", mass.to_string()), ("fullinertia", numbers(&entries))],
    );
}

/// Joints that others drive.
fn drivers(xml: &mut Xml, scene: &Scene<'_>) {
    xml.element("equality", &[], |xml| {
        for (finger, names) in scene.names.joints.iter().enumerate() {
            for (joint, name) in names.iter().enumerate() {
                let Some(driver) = scene.driver(finger, joint) else { continue };
                xml.empty(
                    "joint",
                    &[
                        ("joint1", name.clone()),
                        ("joint2", names[driver.joint].clone()),
                        ("polycoef", numbers(&[driver.offset, driver.multiplier, 0.0, 0.0, 0.0])),
                    ],
                );
            }
        }
    });
}

/// Motors with a stiffness and damping, saturated at the joints' efforts; what they aim at may lie beyond the
/// joints' limits.
fn actuators(xml: &mut Xml, scene: &Scene<'_>) {
    xml.element("actuator", &[], |xml| {
        for (finger, joint) in motors(scene) {
            let parameters = &scene.description().finger[finger].joint[joint];
            let prismatic = parameters.kind == JointKind::Prismatic;
            let name = scene.names.joints[finger][joint].clone();
            xml.empty(
                "position",
                &[
                    ("name", name.clone()),
                    ("joint", name),
                    ("kp", scene.forces.stiffness(prismatic).to_string()),
                    ("kv", scene.forces.damping(prismatic).to_string()),
                    ("forcerange", numbers(&[-parameters.effort, parameters.effort])),
                ],
            );
        }
    });
}

/// The motion's first state as the model's keyframe.
fn start(xml: &mut Xml, scene: &Scene<'_>) {
    let q = scene.keys()[0].1;
    let X = &q.X_HO;
    let turn = X.rotation.quaternion();
    let joints = q.joints.iter().flat_map(|(_, joints)| joints.to_vec());
    let object = X.translation.vector.iter().copied().chain([turn.w, turn.i, turn.j, turn.k]);
    let positions: Vec<f64> = joints.chain(object).collect();
    let targets: Vec<f64> = motors(scene).map(|motor| target(scene, 0, q, motor)).collect();
    xml.element("keyframe", &[], |xml| {
        let (qpos, ctrl) = (numbers(&positions), numbers(&targets));
        xml.empty("key", &[("name", "start".into()), ("qpos", qpos), ("ctrl", ctrl)]);
    });
}
