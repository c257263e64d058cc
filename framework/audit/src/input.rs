//! What a plugin was called with, as JSON: SI units, frames as in the plan file.

use regrasp_api::{
    Cone, Configuration, Contact, Context, FingerSet, Grasp, GraspContact, JointBound, PerFinger, Pose,
    PoseRequest, Random, Target, Vec3,
};
use serde_json::{Value, json};

pub(crate) fn vector(v: &Vec3) -> Value {
    json!([v.x, v.y, v.z])
}

pub(crate) fn pose(X: &Pose) -> Value {
    let q = X.rotation.quaternion();
    json!({ "position": vector(&X.translation.vector), "orientation": [q.w, q.i, q.j, q.k] })
}

pub(crate) fn contact(contact: &Contact) -> Value {
    json!({ "facet": contact.facet, "point_O": vector(&contact.p_OC), "normal_O": vector(&contact.n_O) })
}

pub(crate) fn contacts(contacts: &PerFinger<Option<Contact>>) -> Value {
    contacts.iter().map(|(_, place)| place.as_ref().map_or(Value::Null, contact)).collect()
}

pub(crate) fn configuration(q: &Configuration) -> Value {
    let joints: Vec<Vec<f64>> = q.joints.iter().map(|(_, joints)| joints.to_vec()).collect();
    json!({ "object": pose(&q.X_HO), "joints": joints, "contacts": contacts(&q.contacts) })
}

pub(crate) fn fingers(set: FingerSet) -> Value {
    set.iter().map(|finger| finger.0).collect()
}

fn cone(cone: &Cone<'_>) -> Value {
    match cone {
        Cone::Elliptic { mu, gamma } => json!({ "mu": mu, "gamma": gamma }),
        Cone::Grained(grain) => {
            json!({ "mu": grain.mu, "gamma": grain.gamma, "axis_O": vector(&grain.axis_O) })
        }
        Cone::Polyhedral(edges) => {
            let edges: Vec<_> = edges.iter().map(|e| [e.tangential[0], e.tangential[1], e.torsion]).collect();
            json!({ "edges": edges })
        }
    }
}

pub(crate) fn grasp(grasp: &Grasp<'_>) -> Value {
    let joint = |joint: &JointBound| {
        let column = joint.column_O;
        [column.x, column.y, column.z, joint.spin, joint.limit]
    };
    let contact = |(i, contact): (usize, &GraspContact<'_>)| {
        let mut value = json!({
            "finger": contact.finger.0,
            "point_O": vector(&contact.p_OC),
            "normal_O": vector(&contact.n_O),
            "cone": cone(&contact.cone),
        });
        if let Some(efforts) = grasp.efforts(i) {
            value["efforts"] = efforts.joints().iter().map(|bound| json!(joint(bound))).collect();
        }
        value
    };
    let contacts: Vec<_> = grasp.contacts().iter().enumerate().map(contact).collect();
    json!({ "contacts": contacts, "gravity_O": vector(&grasp.g_O) })
}

pub(crate) fn request(request: &PoseRequest<'_>) -> Value {
    match request {
        PoseRequest::Anywhere => json!("anywhere"),
        PoseRequest::At(X_HO) => json!({ "at": pose(X_HO) }),
        PoseRequest::Near { configuration: near, radius, angle } => {
            json!({ "near": configuration(near), "radius": radius, "angle": angle })
        }
    }
}

pub(crate) fn target(target: &Target<'_>) -> Value {
    match target {
        Target::Grasp(q) => json!({ "grasp": configuration(q) }),
        Target::Transfer(X_HO) => json!({ "transfer": pose(X_HO) }),
        Target::Regrasp { finger, contact: place, joints } => json!({
            "regrasp": { "finger": finger.0, "contact": place.map(contact), "joints": joints.to_vec() }
        }),
    }
}

/// The state of a random stream.
pub(crate) fn random_state(random: &Random) -> Value {
    random.state().iter().map(|word| format!("{word:016x}")).collect()
}

/// The state of the call's random stream.
pub(crate) fn random(context: &Context<'_>) -> Value {
    random_state(&context.random)
}
