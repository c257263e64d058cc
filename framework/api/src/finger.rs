//! Fingers by index, sets of fingers, and one value for each finger of a hand.

use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut};

/// The most fingers that a hand may have.
pub const MAX_FINGERS: usize = 8;
/// The most joints that one finger may have.
pub const MAX_FINGER_JOINTS: usize = 7;

/// Which finger of the hand, counted from 0 in the order of the hand file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct FingerIndex(pub u8);

impl FingerIndex {
    /// As an index into arrays.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// A set of fingers of one hand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FingerSet(u8);

impl FingerSet {
    /// No finger.
    pub const EMPTY: Self = Self(0);

    /// The first `count` fingers, `count` ≤ [`MAX_FINGERS`].
    pub fn first(count: usize) -> Self {
        debug_assert!(count <= MAX_FINGERS);
        Self(((1_u16 << count) - 1) as u8)
    }

    /// The one finger `finger`.
    pub fn only(finger: FingerIndex) -> Self {
        Self(1 << finger.0)
    }

    /// Whether `finger` belongs to the set.
    pub fn contains(self, finger: FingerIndex) -> bool {
        self.0 & (1 << finger.0) != 0
    }

    /// The set with `finger` added.
    #[must_use]
    pub fn with(self, finger: FingerIndex) -> Self {
        Self(self.0 | 1 << finger.0)
    }

    /// The set with `finger` taken away.
    #[must_use]
    pub fn without(self, finger: FingerIndex) -> Self {
        Self(self.0 & !(1 << finger.0))
    }

    /// The fingers of both sets.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The fingers that both sets share.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// How many fingers.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// Whether no finger belongs to the set.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// The set as bits, finger 0 lowest: a small array index.
    pub fn bits(self) -> u8 {
        self.0
    }

    /// The set whose bits are `bits`, finger 0 lowest.
    pub fn from_bits(bits: u8) -> Self {
        Self(bits)
    }

    /// The fingers in ascending order.
    pub fn iter(self) -> impl Iterator<Item = FingerIndex> {
        (0..MAX_FINGERS as u8).map(FingerIndex).filter(move |&finger| self.contains(finger))
    }
}

impl FromIterator<FingerIndex> for FingerSet {
    fn from_iter<I: IntoIterator<Item = FingerIndex>>(fingers: I) -> Self {
        fingers.into_iter().fold(Self::EMPTY, Self::with)
    }
}

/// One value for each finger of a hand, stored in place (no allocation).
#[derive(Clone, Copy, Debug)]
pub struct PerFinger<T> {
    count: u8,
    values: [T; MAX_FINGERS],
}

impl<T: Copy> PerFinger<T> {
    /// `value` for each of `count` ≤ [`MAX_FINGERS`] fingers.
    pub fn filled(count: usize, value: T) -> Self {
        assert!(count <= MAX_FINGERS, "a hand has at most {MAX_FINGERS} fingers");
        Self { count: count as u8, values: [value; MAX_FINGERS] }
    }

    /// The value that `make` gives for each of `count` ≤ [`MAX_FINGERS`] fingers.
    pub fn from_fn(count: usize, mut make: impl FnMut(FingerIndex) -> T) -> Self {
        let mut all = Self::filled(count, make(FingerIndex(0)));
        for finger in all.fingers().skip(1) {
            all[finger] = make(finger);
        }
        all
    }

    /// The fingers in ascending order.
    pub fn fingers(&self) -> impl Iterator<Item = FingerIndex> + use<T> {
        (0..self.count).map(FingerIndex)
    }

    /// Finger and value, in ascending order of fingers.
    pub fn iter(&self) -> impl Iterator<Item = (FingerIndex, &T)> {
        self.values[..usize::from(self.count)]
            .iter()
            .enumerate()
            .map(|(i, value)| (FingerIndex(i as u8), value))
    }

    /// The values as a slice, finger 0 first.
    pub fn as_slice(&self) -> &[T] {
        &self.values[..usize::from(self.count)]
    }
}

impl<T: Copy> PerFinger<T> {
    /// How many fingers.
    pub fn len(&self) -> usize {
        usize::from(self.count)
    }

    /// Whether there is no finger at all.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }
}

impl<T: Copy + PartialEq> PartialEq for PerFinger<T> {
    fn eq(&self, other: &Self) -> bool {
        self.as_slice() == other.as_slice()
    }
}

impl<T> Index<FingerIndex> for PerFinger<T> {
    type Output = T;
    fn index(&self, finger: FingerIndex) -> &T {
        &self.values[..usize::from(self.count)][finger.index()]
    }
}

impl<T> IndexMut<FingerIndex> for PerFinger<T> {
    fn index_mut(&mut self, finger: FingerIndex) -> &mut T {
        &mut self.values[..usize::from(self.count)][finger.index()]
    }
}

/// The joint positions of one finger, base to tip (rad; m for the prismatic joints of free fingertips).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FingerJoints {
    count: u8,
    values: [f64; MAX_FINGER_JOINTS],
}

impl FingerJoints {
    /// `count` ≤ [`MAX_FINGER_JOINTS`] joints at 0.
    pub fn zeros(count: usize) -> Self {
        assert!(count <= MAX_FINGER_JOINTS, "a finger has at most {MAX_FINGER_JOINTS} joints");
        Self { count: count as u8, values: [0.0; MAX_FINGER_JOINTS] }
    }

    /// A copy of `values` (rad; m where prismatic), at most [`MAX_FINGER_JOINTS`].
    pub fn from_slice(values: &[f64]) -> Self {
        let mut joints = Self::zeros(values.len());
        joints.copy_from_slice(values);
        joints
    }

    /// The joints a fraction `s` of the way to `other`: the motion that a plan means between two states.
    #[must_use]
    pub fn interpolate(&self, other: &Self, s: f64) -> Self {
        let mut joints = *self;
        joints.iter_mut().zip(other.iter()).for_each(|(a, b)| *a += (b - *a) * s);
        joints
    }

    /// The largest absolute difference of a joint (rad or m).
    pub fn max_difference(&self, other: &Self) -> f64 {
        self.iter().zip(other.iter()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }
}

impl std::ops::Deref for FingerJoints {
    type Target = [f64];
    fn deref(&self) -> &[f64] {
        &self.values[..usize::from(self.count)]
    }
}

impl std::ops::DerefMut for FingerJoints {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.values[..usize::from(self.count)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_hold_what_was_put_in() {
        let set: FingerSet = [FingerIndex(0), FingerIndex(2), FingerIndex(7)].into_iter().collect();
        assert_eq!(set.iter().map(|f| f.0).collect::<Vec<_>>(), [0, 2, 7]);
        assert_eq!((set.len(), set.without(FingerIndex(2)).len()), (3, 2));
        assert_eq!(FingerSet::first(8).len(), 8);
        assert_eq!(FingerSet::first(4).intersection(set).bits(), 0b101);
    }

    #[test]
    fn per_finger_ignores_unused_places() {
        let mut a = PerFinger::filled(3, 0);
        let mut b = PerFinger::filled(3, 1);
        for finger in a.fingers() {
            (a[finger], b[finger]) = (5, 5);
        }
        assert_eq!(a, b);
        assert_ne!(a, PerFinger::filled(4, 5));
    }
}
