//! An animated glTF 2.0 binary.
//!
//! The node `hand` has the plan's frame H, z upwards; the node `world` above it turns z to glTF's y. Each
//! joint is a node that turns or slides inside a fixed node that places it, so that linear interpolation of
//! its keys is the plan's motion. Nodes and meshes are called after what they are: the palm, links,
//! fingertips, the object, obstacles. Numbers are 32-bit: at a hand's size 1e-8 m.
//!
//! The Khronos Group, "glTF 2.0 specification", 2021.

mod buffer;

use crate::names::{OBJECT, ROOT};
use crate::solid::Piece;
use crate::{File, Scene};
use buffer::Buffer;
use regrasp_api::{JointKind, Mesh, Pose, Rotation, Vec3};
use serde_json::{Value, json};
use std::f64::consts::FRAC_1_SQRT_2;

/// One file, `STEM.glb`.
pub(crate) fn files(scene: &Scene<'_>, stem: &str) -> Vec<File> {
    let mut document = Document::default();
    let mut children = Vec::new();
    children.extend(document.pieces("palm", &scene.solids.palm, PALM));
    for finger in 0..scene.origins.len() {
        children.push(document.finger(scene, finger));
    }
    for (name, piece) in scene.names.obstacles.iter().zip(&scene.solids.obstacles) {
        let mesh = document.mesh(name, &piece.mesh, |_| OBSTACLE);
        children.push(document.node(name, &piece.X_BMesh(), &[], Some(mesh)));
    }
    let object = document.object(scene);
    children.push(object);
    let hand = document.node(ROOT, &Pose::identity(), &children, None);
    // z upwards becomes y upwards.
    let upright =
        json!({ "name": "world", "children": [hand], "rotation": [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2] });
    document.nodes.push(upright);
    document.animate(scene, object);
    vec![File { name: format!("{stem}.glb"), bytes: document.into_bytes(&scene.plan.scenario.name) }]
}

type Colour = [u8; 3];
const PALM: Colour = [110, 116, 124];
const LINK: Colour = [150, 156, 165];
const TIP: Colour = [214, 120, 60];
const OBSTACLE: Colour = [96, 125, 96];
/// The object's facets, by the octants in which they lie, so that one sees it turn.
const OBJECT_TONES: [Colour; 2] = [[70, 130, 180], [235, 238, 242]];

#[derive(Default)]
struct Document {
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    buffer: Buffer,
    channels: Vec<Value>,
    samplers: Vec<Value>,
    /// For each finger and joint the node that moves.
    joints: Vec<Vec<usize>>,
}

impl Document {
    fn node(&mut self, name: &str, X: &Pose, children: &[usize], mesh: Option<usize>) -> usize {
        let q = X.rotation.quaternion();
        let mut node = json!({
            "name": name,
            "translation": <[f64; 3]>::from(X.translation.vector),
            "rotation": [q.i, q.j, q.k, q.w],
        });
        // Empty lists are not allowed.
        if !children.is_empty() {
            node["children"] = json!(children);
        }
        if let Some(mesh) = mesh {
            node["mesh"] = json!(mesh);
        }
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    /// The shapes of one part, called after it, with a number behind where there are several.
    fn pieces(&mut self, part: &str, pieces: &[Piece], colour: Colour) -> Vec<usize> {
        let one = |(k, piece): (usize, &Piece)| {
            let name = if pieces.len() == 1 { part.to_owned() } else { format!("{part}-{}", k + 1) };
            let mesh = self.mesh(&name, &piece.mesh, |_| colour);
            self.node(&name, &piece.X_BMesh(), &[], Some(mesh))
        };
        pieces.iter().enumerate().map(one).collect()
    }

    /// The chain of a finger, from its tip back to its first joint; gives the node that hangs on the hand.
    fn finger(&mut self, scene: &Scene<'_>, finger: usize) -> usize {
        let description = &scene.description().finger[finger];
        let ball = self.mesh(&scene.names.tips[finger], &scene.solids.tip.mesh, |_| TIP);
        let [x, y, z] = description.tip;
        let mut below = self.node(&scene.names.tips[finger], &Pose::translation(x, y, z), &[], Some(ball));
        let mut moving = Vec::new();
        for joint in (0..description.joint.len()).rev() {
            let link = &scene.names.links[finger][joint];
            let mut children = self.pieces(link, &scene.solids.links[finger][joint], LINK);
            children.push(below);
            let node = self.node(&scene.names.joints[finger][joint], &Pose::identity(), &children, None);
            moving.push(node);
            let name = format!("{}-origin", scene.names.joints[finger][joint]);
            below = self.node(&name, &scene.origins[finger][joint], &[node], None);
        }
        moving.reverse();
        self.joints.push(moving);
        below
    }

    fn object(&mut self, scene: &Scene<'_>) -> usize {
        let tone = |middle: Vec3| {
            let behind = middle.iter().filter(|x| **x < 0.0).count();
            OBJECT_TONES[behind % 2]
        };
        let mesh = self.mesh(OBJECT, &scene.object.mesh, tone);
        self.node(OBJECT, &scene.keys()[0].1.X_HO, &[], Some(mesh))
    }

    /// A mesh with flat facets, each in the colour that its middle gets.
    fn mesh(&mut self, name: &str, mesh: &Mesh, colour: impl Fn(Vec3) -> Colour) -> usize {
        let facets = 0..mesh.facets().len() as u32;
        let corners = facets.clone().flat_map(|facet| mesh.corners(facet));
        let normals = facets.clone().flat_map(|facet| [mesh.normal(facet); 3]);
        let colours = facets.flat_map(|facet| [colour(mesh.corners(facet).iter().sum()); 3]);
        let attributes = json!({
            "POSITION": self.buffer.vectors(corners, true),
            "NORMAL": self.buffer.vectors(normals, false),
            "COLOR_0": self.buffer.colours(colours),
        });
        self.meshes
            .push(json!({ "name": name, "primitives": [{ "attributes": attributes, "material": 0 }] }));
        self.meshes.len() - 1
    }

    fn animate(&mut self, scene: &Scene<'_>, object: usize) {
        let keys = scene.keys();
        let times = self.buffer.times(keys.iter().map(|&(time, _)| time));
        for finger in scene.fingers() {
            for (j, joint) in scene.description().finger[finger.index()].joint.iter().enumerate() {
                let axis = Vec3::from(joint.axis).normalize();
                let node = self.joints[finger.index()][j];
                let values = keys.iter().map(|(_, q)| q.joints[finger][j]);
                match joint.kind {
                    JointKind::Revolute => {
                        let turns = values.map(|angle| Rotation::from_scaled_axis(axis * angle));
                        let output = self.buffer.rotations(turns);
                        self.channel(node, "rotation", times, output);
                    }
                    JointKind::Prismatic => {
                        let output = self.buffer.vectors(values.map(|way| axis * way), false);
                        self.channel(node, "translation", times, output);
                    }
                }
            }
        }
        let positions = self.buffer.vectors(keys.iter().map(|(_, q)| q.X_HO.translation.vector), false);
        self.channel(object, "translation", times, positions);
        let turns = self.buffer.rotations(keys.iter().map(|(_, q)| q.X_HO.rotation));
        self.channel(object, "rotation", times, turns);
    }

    fn channel(&mut self, node: usize, path: &str, input: usize, output: usize) {
        let sampler = self.samplers.len();
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": "LINEAR" }));
        self.channels.push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }

    fn into_bytes(self, name: &str) -> Vec<u8> {
        let (views, accessors, data) = self.buffer.into_parts();
        let document = json!({
            "asset": { "version": "2.0", "generator": concat!("regrasp ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "name": name, "nodes": [self.nodes.len() - 1] }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": [{ "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.8 } }],
            "animations": [{ "name": "plan", "channels": self.channels, "samplers": self.samplers }],
            "accessors": accessors,
            "bufferViews": views,
            "buffers": [{ "byteLength": data.len() }],
        });
        container(document.to_string().into_bytes(), data)
    }
}

/// The two chunks of a `.glb` file: JSON padded by blanks, data padded by zeros, to multiples of four bytes.
fn container(mut text: Vec<u8>, mut data: Vec<u8>) -> Vec<u8> {
    text.resize(text.len().next_multiple_of(4), b' ');
    data.resize(data.len().next_multiple_of(4), 0);
    let word = |value: usize| (value as u32).to_le_bytes();
    let total = 12 + 8 + text.len() + 8 + data.len();
    [
        b"glTF".as_slice(),
        &word(2),
        &word(total),
        &word(text.len()),
        b"JSON",
        &text,
        &word(data.len()),
        b"BIN\0",
        &data,
    ]
    .concat()
}
