//! A hand about objects of three shapes.
#![allow(dead_code, missing_docs)]

use regrasp_api::*;
use regrasp_world::{ChainHand, load_object};
use std::path::Path;

pub const G: Vec3 = Vec3::new(0.0, 0.0, -9.81);

pub fn hand() -> ChainHand {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios/hands/four-finger.toml");
    ChainHand::new(toml::from_str(&std::fs::read_to_string(file).unwrap()).unwrap()).unwrap()
}

pub fn object(shape: &str) -> ObjectModel {
    let text = format!("friction = 0.8\nmass = 0.1\nshape = {shape}\n");
    let description: ObjectDescription = toml::from_str(&text).unwrap();
    load_object(&description).unwrap()
}

pub fn shapes() -> [ObjectModel; 3] {
    [
        "{ kind = \"sphere\", radius = 0.03 }",
        "{ kind = \"cuboid\", size = [0.045, 0.045, 0.045] }",
        // Concave between its fins: fingers touch outside.
        "{ kind = \"torus\", ring_radius = 0.022, tube_radius = 0.012 }",
    ]
    .map(object)
}

/// Four fingers about the object's middle, on the facet that faces each.
pub fn ring(hand: &ChainHand, object: &ObjectModel) -> Configuration {
    let X_HO = Pose::translation(0.0, 0.0, 0.085);
    let joints = PerFinger::from_fn(4, |finger| hand.finger(finger).rest);
    let mut q = Configuration { X_HO, joints, contacts: PerFinger::filled(4, None) };
    let ways = [Vec3::x(), Vec3::y(), -Vec3::x(), -Vec3::y()];
    for (finger, way) in joints.fingers().zip(ways) {
        let contact = facing(&object.mesh, &way);
        let p_HF = X_HO * nalgebra::Point3::from(contact.tip_center(hand.fingertip_radius()));
        q.joints[finger] = hand.inverse(finger, &p_HF.coords, &joints[finger]).expect("within reach");
        q.contacts[finger] = Some(contact);
    }
    q
}

fn facing(mesh: &Mesh, way: &Vec3) -> Contact {
    let middle = |facet: u32| mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
    let facets = 0..mesh.facets().len() as u32;
    let off = |facet: &u32| (way * middle(*facet).dot(way) - middle(*facet)).norm() - middle(*facet).dot(way);
    let facet = facets.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    Contact { facet, p_OC: middle(facet), n_O: mesh.normal(facet) }
}
