//! The stable grasps that a search found, as a cache for learning pipelines.

use crate::npy::{Archive, three};
use crate::{ExportError, File};
use regrasp_api::{Configuration, FingerIndex, HandDescription, Vec3};
use serde_json::{Value, json};

/// A stable grasp.
#[derive(Clone, Debug)]
pub struct GraspRecord {
    /// Object pose, joints and contacts.
    pub q: Configuration,
    /// The component of the manipulation graph that it belongs to: the smallest number of a grasp in it.
    pub component: usize,
    /// The margin that the stability test gives it; what it measures is the test's matter.
    pub margin: f64,
}

/// Stable grasps of one hand and object.
#[derive(Clone, Debug)]
pub struct Grasps<'a> {
    /// The scenario's name.
    pub scenario: &'a str,
    /// The hand.
    pub hand: &'a HandDescription,
    /// Id of the stability test.
    pub stability_test: &'a str,
    /// Id of the contact model.
    pub contact_model: &'a str,
    /// The grasps; one's number is its place.
    pub grasps: &'a [GraspRecord],
}

impl Grasps<'_> {
    /// As JSON: `grasps` is a list of `{component, margin, object: {position, orientation [w,x,y,z]}, joints:
    /// [[…] per finger], contacts: [null | {point_O, normal_O} per finger]}`; m, rad, the object's pose in H.
    pub fn json(&self, name: &str) -> File {
        let grasps: Vec<Value> = self.grasps.iter().map(grasp).collect();
        let document = json!({
            "format": "regrasp-grasps",
            "version": 1,
            "scenario": self.scenario,
            "hand": self.hand.name,
            "fingers": self.hand.finger.iter().map(|finger| &finger.name).collect::<Vec<_>>(),
            "contact_model": self.contact_model,
            "stability_test": self.stability_test,
            "grasps": grasps,
        });
        File { name: name.into(), bytes: format!("{document:#}\n").into_bytes() }
    }

    /// As NumPy arrays, for G grasps, F fingers and J joints: `component` (G), `margin` (G),
    /// `object_position` (G, 3), `object_orientation` (G, 4: w, x, y, z), `joints` (G, J), `contact_point_O`
    /// and `contact_normal_O` (G, F, 3; NaN for free fingers), `joint_names`, `finger_names`.
    pub fn npz(&self, name: &str) -> Result<File, ExportError> {
        let mut archive = Archive::new();
        let names = crate::names::Names::new(self.hand, &[]);
        let joints: Vec<&str> = names.joints.iter().flatten().map(String::as_str).collect();
        let fingers: Vec<&str> = self.hand.finger.iter().map(|finger| finger.name.as_str()).collect();
        let (g, f) = (self.grasps.len(), fingers.len());
        let components: Vec<i64> = self.grasps.iter().map(|grasp| grasp.component as i64).collect();
        archive.whole("component", &[g], &components)?;
        archive.floats("margin", &[g], self.grasps.iter().map(|grasp| grasp.margin))?;
        archive.floats("object_position", &[g, 3], self.grasps.iter().flat_map(|grasp| pose(&grasp.q).0))?;
        archive.floats(
            "object_orientation",
            &[g, 4],
            self.grasps.iter().flat_map(|grasp| pose(&grasp.q).1),
        )?;
        let postures =
            self.grasps.iter().flat_map(|grasp| grasp.q.joints.iter().flat_map(|(_, q)| q.to_vec()));
        archive.floats("joints", &[g, joints.len()], postures)?;
        let vectors = |pick: fn(&Configuration, FingerIndex) -> Option<Vec3>| {
            let one = |grasp: &GraspRecord| {
                (0..f).flat_map(|finger| three(pick(&grasp.q, FingerIndex(finger as u8)))).collect::<Vec<_>>()
            };
            self.grasps.iter().flat_map(one).collect::<Vec<_>>()
        };
        archive.floats("contact_point_O", &[g, f, 3], vectors(|q, finger| Some(q.contacts[finger]?.p_OC)))?;
        archive.floats("contact_normal_O", &[g, f, 3], vectors(|q, finger| Some(q.contacts[finger]?.n_O)))?;
        archive.texts("joint_names", &joints)?;
        archive.texts("finger_names", &fingers)?;
        Ok(File { name: name.into(), bytes: archive.finish()? })
    }
}

fn pose(q: &Configuration) -> ([f64; 3], [f64; 4]) {
    let turn = q.X_HO.rotation.quaternion();
    (q.X_HO.translation.vector.into(), [turn.w, turn.i, turn.j, turn.k])
}

fn grasp(grasp: &GraspRecord) -> Value {
    let (position, orientation) = pose(&grasp.q);
    let vector = |v: Vec3| <[f64; 3]>::from(v);
    let contact = |contact: &Option<regrasp_api::Contact>| {
        contact.map(|contact| json!({ "point_O": vector(contact.p_OC), "normal_O": vector(contact.n_O) }))
    };
    json!({
        "component": grasp.component,
        "margin": grasp.margin,
        "object": { "position": position, "orientation": orientation },
        "joints": grasp.q.joints.iter().map(|(_, joints)| joints.to_vec()).collect::<Vec<_>>(),
        "contacts": grasp.q.contacts.iter().map(|(_, c)| contact(c)).collect::<Vec<_>>(),
    })
}
