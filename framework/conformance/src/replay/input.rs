//! What a call was given, out of its JSON: the opposite of what the audit writes.

use super::{ReplayError, form};
use regrasp_api::{
    Cone, ConeEdge, Configuration, Contact, EffortBounds, FingerIndex, FingerJoints, FingerSet, Grasp,
    GraspContact, JointBound, MAX_FINGER_JOINTS, MAX_FINGERS, PerFinger, Pose, Random, Rotation, Vec3,
};
use serde_json::Value;

/// A value with the key that it stands at.
#[derive(Clone, Copy)]
pub(super) struct Input<'a> {
    value: &'a Value,
    key: &'a str,
}

type Read<T> = Result<T, ReplayError>;

impl<'a> Input<'a> {
    pub fn new(value: &'a Value, key: &'a str) -> Self {
        Self { value, key }
    }

    /// What stands under a key; `null` where nothing does.
    pub fn get(self, key: &'a str) -> Self {
        Self { value: &self.value[key], key }
    }

    pub fn is_null(self) -> bool {
        self.value.is_null()
    }

    fn wrong<T>(self, wanted: &str) -> Read<T> {
        Err(form(&format!("breach.input … {}", self.key), format!("{wanted} is wanted")))
    }

    fn items(self) -> Read<Vec<Self>> {
        match self.value.as_array() {
            Some(items) => Ok(items.iter().map(|value| Self { value, key: self.key }).collect()),
            None => self.wrong("a list"),
        }
    }

    /// A list of at most this many.
    fn few(self, most: usize) -> Read<Vec<Self>> {
        let items = self.items()?;
        if items.len() <= most { Ok(items) } else { self.wrong(&format!("a list of at most {most}")) }
    }

    /// A number; `null` is how JSON writes what is not finite.
    pub fn number(self) -> Read<f64> {
        match self.value {
            Value::Null => Ok(f64::NAN),
            value => value.as_f64().map_or_else(|| self.wrong("a number"), Ok),
        }
    }

    pub fn count(self) -> Read<u64> {
        self.value.as_u64().map_or_else(|| self.wrong("a whole number"), Ok)
    }

    fn numbers(self) -> Read<Vec<f64>> {
        self.items()?.into_iter().map(Self::number).collect()
    }

    pub fn vector(self) -> Read<Vec3> {
        match self.numbers()?[..] {
            [x, y, z] => Ok(Vec3::new(x, y, z)),
            _ => self.wrong("a list of three numbers"),
        }
    }

    pub fn finger(self) -> Read<FingerIndex> {
        match u8::try_from(self.count()?) {
            Ok(k) if usize::from(k) < MAX_FINGERS => Ok(FingerIndex(k)),
            _ => self.wrong("a finger"),
        }
    }

    pub fn fingers(self) -> Read<FingerSet> {
        let fingers: Read<Vec<_>> = self.items()?.into_iter().map(Self::finger).collect();
        Ok(fingers?.into_iter().collect())
    }

    pub fn pose(self) -> Read<Pose> {
        let p = self.get("position").vector()?;
        let [w, i, j, k] = self.get("orientation").numbers()?[..] else {
            return self.wrong("a list of four numbers");
        };
        // Not normalised again: the bits are what the call was given.
        let rotation = Rotation::new_unchecked(nalgebra::Quaternion::new(w, i, j, k));
        Ok(Pose::from_parts(p.into(), rotation))
    }

    pub fn contact(self) -> Read<Contact> {
        let facet = u32::try_from(self.get("facet").count()?).map_or_else(|_| self.wrong("a facet"), Ok)?;
        Ok(Contact { facet, p_OC: self.get("point_O").vector()?, n_O: self.get("normal_O").vector()? })
    }

    pub fn contact_or_none(self) -> Read<Option<Contact>> {
        if self.is_null() { Ok(None) } else { self.contact().map(Some) }
    }

    pub fn contacts(self) -> Read<PerFinger<Option<Contact>>> {
        self.per_finger(None, Self::contact_or_none)
    }

    pub fn joints(self) -> Read<FingerJoints> {
        self.few(MAX_FINGER_JOINTS)?;
        Ok(FingerJoints::from_slice(&self.numbers()?))
    }

    fn per_finger<T: Copy>(self, empty: T, read: impl Fn(Self) -> Read<T>) -> Read<PerFinger<T>> {
        let items = self.few(MAX_FINGERS)?;
        let mut all = PerFinger::filled(items.len(), empty);
        for (k, item) in items.into_iter().enumerate() {
            all[FingerIndex(k as u8)] = read(item)?;
        }
        Ok(all)
    }

    pub fn configuration(self) -> Read<Configuration> {
        Ok(Configuration {
            X_HO: self.get("object").pose()?,
            joints: self.get("joints").per_finger(FingerJoints::zeros(0), Self::joints)?,
            contacts: self.get("contacts").contacts()?,
        })
    }

    fn cone(self) -> Read<Cone<'static>> {
        let edges = self.get("edges");
        let axis = self.get("axis_O");
        if !axis.is_null() {
            let mu = self.get("mu");
            let mu = mu.numbers()?.try_into().or_else(|_| mu.wrong("a list of two numbers"))?;
            return Ok(Cone::grained(&axis.vector()?, mu, self.get("gamma").number()?));
        }
        if edges.is_null() {
            return Ok(Cone::Elliptic { mu: self.get("mu").number()?, gamma: self.get("gamma").number()? });
        }
        let edge = |item: Self| match item.numbers()?[..] {
            [x, y, torsion] => Ok(ConeEdge { tangential: [x, y], torsion }),
            _ => item.wrong("a list of three numbers"),
        };
        let edges: Read<Vec<ConeEdge>> = edges.items()?.into_iter().map(edge).collect();
        Ok(Cone::Polyhedral(edges?.into()))
    }

    pub fn grasp(self) -> Read<Grasp<'static>> {
        let mut grasp = Grasp::new(self.get("gravity_O").vector()?);
        for item in self.get("contacts").few(MAX_FINGERS)? {
            let contact = GraspContact {
                finger: item.get("finger").finger()?,
                p_OC: item.get("point_O").vector()?,
                n_O: item.get("normal_O").vector()?,
                cone: item.get("cone").cone()?,
            };
            let efforts = item.get("efforts");
            if efforts.is_null() {
                grasp.push(contact);
            } else {
                grasp.push_bounded(contact, efforts.efforts()?);
            }
        }
        Ok(grasp)
    }

    /// What the joints behind a contact can do.
    fn efforts(self) -> Read<EffortBounds> {
        let joint = |item: Self| match item.numbers()?[..] {
            [x, y, z, spin, limit] => Ok(JointBound { column_O: Vec3::new(x, y, z), spin, limit }),
            _ => item.wrong("a list of five numbers"),
        };
        let joints: Read<Vec<_>> = self.few(MAX_FINGER_JOINTS)?.into_iter().map(joint).collect();
        Ok(EffortBounds::from_joints(joints?))
    }

    /// The random stream; any, where the call draws none.
    pub fn random(self) -> Read<Random> {
        if self.is_null() {
            return Ok(Random::from_key(0, 0, 0, 0));
        }
        let word = |item: Self| {
            let text = item.value.as_str().and_then(|text| u64::from_str_radix(text, 16).ok());
            text.map_or_else(|| item.wrong("a word of 16 hexadecimal digits"), Ok)
        };
        let words: Read<Vec<u64>> = self.items()?.into_iter().map(word).collect();
        match words?[..] {
            [a, b, c, d] => Ok(Random::from_state([a, b, c, d])),
            _ => self.wrong("a list of four words"),
        }
    }
}
