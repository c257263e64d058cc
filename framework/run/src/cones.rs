//! The cones of a plan's contacts, as its file records them.

use regrasp_api::{Cone, Configuration, Contact, ContactModel, FingerIndex};
use regrasp_plan::{ConeClaim, ConeRecord, Motion, SegmentRecord};
use std::collections::BTreeMap;

/// The number of each contact's cone, by finger.
type Numbers = Vec<Option<usize>>;

/// The cones that the contacts of a motion have at rest.
pub(crate) struct Cones {
    /// The different cones, in the order in which they are met.
    list: Vec<ConeRecord>,
    /// For each segment and state the numbers of its contacts' cones.
    numbers: Vec<Vec<Numbers>>,
}

impl Cones {
    /// What `model` says of every contact under the friction coefficient `mu`.
    pub fn of(motion: &Motion, model: &dyn ContactModel, mu: f64) -> Self {
        let mut book = Book { model, mu, list: Vec::new(), known: BTreeMap::new(), last: Vec::new() };
        let segments = motion.segments.iter();
        let numbers =
            segments.map(|segment| segment.states.iter().map(|q| book.numbers(q)).collect()).collect();
        Self { list: book.list, numbers }
    }

    /// The elliptic cone that all contacts share, if they do.
    pub fn shared(&self) -> Option<ConeClaim> {
        match self.list.as_slice() {
            [ConeRecord::Elliptic(cone)] => Some(*cone),
            _ => None,
        }
    }

    /// The cones one by one, where they do not share an elliptic one; each state then gets the numbers of its
    /// own.
    pub fn record(self, segments: &mut [SegmentRecord]) -> Vec<ConeRecord> {
        if self.shared().is_some() {
            return Vec::new();
        }
        for (segment, numbers) in segments.iter_mut().zip(self.numbers) {
            for (state, numbers) in segment.states.iter_mut().zip(numbers) {
                state.cones = Some(numbers);
            }
        }
        self.list
    }
}

/// The cones met so far.
struct Book<'a> {
    model: &'a dyn ContactModel,
    mu: f64,
    list: Vec<ConeRecord>,
    /// Their numbers, by all their digits.
    known: BTreeMap<String, usize>,
    /// The cone that each finger's last contact had, with its number: nearly always the next one's, too.
    last: Vec<Option<(Cone<'static>, usize)>>,
}

impl Book<'_> {
    fn numbers(&mut self, q: &Configuration) -> Numbers {
        self.last.resize(q.contacts.len(), None);
        let number = |(finger, contact): (FingerIndex, &Option<Contact>)| {
            let cone = self.model.cone(finger, contact.as_ref()?, self.mu);
            if let Some((last, number)) = &self.last[finger.index()]
                && *last == cone
            {
                return Some(*number);
            }
            let number = self.book(&cone);
            self.last[finger.index()] = Some((cone.into_owned(), number));
            Some(number)
        };
        q.contacts.iter().map(number).collect()
    }

    /// The number of a cone, which may be new.
    fn book(&mut self, cone: &Cone<'_>) -> usize {
        let record = ConeRecord::of(cone);
        let next = self.list.len();
        let number = *self.known.entry(format!("{record:?}")).or_insert(next);
        if number == next {
            self.list.push(record);
        }
        number
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{PerFinger, Pose, Vec3};
    use regrasp_plan::{Segment, SegmentKind};

    /// Finger 0 has a grain, if the model has one at all.
    struct Grain(bool);

    impl ContactModel for Grain {
        fn cone(&self, finger: FingerIndex, _contact: &Contact, mu: f64) -> Cone<'_> {
            match self.0 && finger == FingerIndex(0) {
                true => Cone::grained(&Vec3::x(), [mu, 0.5 * mu], 0.0),
                false => Cone::Elliptic { mu, gamma: 0.0 },
            }
        }
        fn fewest_contacts(&self) -> usize {
            3
        }
    }

    fn motion() -> Motion {
        let contact = Contact { facet: 0, p_OC: Vec3::z(), n_O: Vec3::z() };
        let mut contacts = PerFinger::filled(3, Some(contact));
        contacts[FingerIndex(1)] = None;
        let joints = PerFinger::filled(3, Default::default());
        let q = Configuration { X_HO: Pose::identity(), joints, contacts };
        let (kind, states) = (SegmentKind::Transfer, vec![q.clone(), q]);
        let times = vec![0.0, 1.0];
        Motion { segments: vec![Segment { times, ..Segment::new(kind, states) }] }
    }

    #[test]
    fn a_cone_that_all_share_is_said_once() {
        let cones = Cones::of(&motion(), &Grain(false), 0.8);
        assert_eq!(cones.shared(), Some(ConeClaim::round(0.8, 0.0)));
        assert!(cones.record(&mut []).is_empty());
    }

    #[test]
    fn cones_that_differ_are_numbered_by_contact() {
        let cones = Cones::of(&motion(), &Grain(true), 0.8);
        assert_eq!(cones.shared(), None);
        assert_eq!(cones.numbers, [vec![vec![Some(0), None, Some(1)]; 2]]);
        let list = cones.record(&mut []);
        let grains = list.iter().map(|record| match record {
            ConeRecord::Elliptic(cone) => cone.grain.is_some(),
            _ => panic!("{record:?}"),
        });
        assert_eq!(grains.collect::<Vec<_>>(), [true, false]);
    }
}
