//! The exact distances of all pairs, for what is shown to a user.

use super::apart::farther;
use super::exact::{self, Solid};
use super::finger::{FingerBodies, PlacedFinger};
use super::rod::Bounds;
use super::{SceneClearance, ordered};
use regrasp_api::{Body, Configuration, PairDistance, Pose};
use std::collections::BTreeMap;

/// A solid of some body where it is.
struct Item<'a> {
    body: Body,
    solid: &'a Solid,
    X_HS: Pose,
    bounds: Bounds,
}

/// The least distance of each pair of bodies so far.
struct Table {
    limit: f64,
    least: BTreeMap<(Body, Body), f64>,
}

impl Table {
    fn compare(&mut self, a: &Item<'_>, b: &Item<'_>) {
        let is_far = a.bounds.clear_of(&b.bounds, self.limit)
            || farther(a.solid, &a.X_HS, b.solid, &b.X_HS, self.limit);
        if is_far {
            return;
        }
        let distance = exact::distance(a.solid, &a.X_HS, b.solid, &b.X_HS);
        if distance <= self.limit {
            let least = self.least.entry(ordered(a.body, b.body)).or_insert(distance);
            *least = least.min(distance);
        }
    }
}

/// All pairs at most `limit` (m) apart, in the order of their bodies.
pub(super) fn distances(scene: &SceneClearance, q: &Configuration, limit: f64) -> Vec<PairDistance> {
    let mut table = Table { limit, least: BTreeMap::new() };
    let object = object_item(scene, &q.X_HO);
    let fixed: Vec<_> = scene
        .fixed
        .iter()
        .map(|fixed| Item {
            body: fixed.body,
            solid: &fixed.placed.solid,
            X_HS: fixed.placed.X_BS,
            bounds: fixed.placed.bounds(),
        })
        .collect();
    let placed: Vec<_> = q.joints.iter().map(|(finger, joints)| scene.place(finger, joints)).collect();
    let fingers: Vec<Vec<Item<'_>>> = scene.fingers.iter().zip(&placed).map(finger_items).collect();
    fixed.iter().for_each(|item| table.compare(&object, item));
    for (f, (bodies, items)) in scene.fingers.iter().zip(&fingers).enumerate() {
        let holds = q.contacts[placed[f].finger].is_some();
        for (part, item) in items.iter().enumerate() {
            let touches = |i: usize| bodies.by_construction(part, &scene.fixed[i]);
            fixed
                .iter()
                .enumerate()
                .filter(|&(i, _)| !touches(i))
                .for_each(|(_, other)| table.compare(item, other));
            if !(holds && matches!(item.body, Body::Fingertip(_))) {
                table.compare(item, &object);
            }
            for (g, others) in fingers.iter().enumerate().skip(f + 1) {
                let compared = others
                    .iter()
                    .enumerate()
                    .filter(|(j, _)| !bodies.touches_other(part, &scene.fingers[g], *j));
                compared.for_each(|(_, other)| table.compare(item, other));
            }
        }
        bodies.pairs.iter().for_each(|&(i, j)| table.compare(&items[i], &items[j]));
    }
    table.least.into_iter().map(|(pair, distance)| PairDistance { pair, distance }).collect()
}

fn object_item<'a>(scene: &'a SceneClearance, X_HO: &Pose) -> Item<'a> {
    let middle = (X_HO * nalgebra::Point3::from(scene.object.p_OMiddle)).coords;
    let half = nalgebra::Vector3::repeat(scene.object.radius);
    let bounds = Bounds { lower: middle - half, upper: middle + half };
    Item { body: Body::Object, solid: &scene.object.solid, X_HS: *X_HO, bounds }
}

fn finger_items<'a>((bodies, placed): (&'a FingerBodies, &PlacedFinger)) -> Vec<Item<'a>> {
    let item = |(part, rod): (usize, &super::rod::Rod)| {
        let (solid, X_HS) = bodies.solid(placed, part);
        Item { body: bodies.parts[part].body, solid, X_HS, bounds: rod.bounds() }
    };
    placed.rods.iter().enumerate().map(item).collect()
}
