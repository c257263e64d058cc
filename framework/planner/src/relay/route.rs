//! A route: straight motions of the object through poses in turn, measured by one length.

use regrasp_api::{Pose, angle_between, interpolate};

/// Straight motions through poses in turn.
///
/// A place on it is its length from the beginning (m): displacements, and turns times the object's radius.
#[derive(Clone, Debug)]
pub(crate) struct Route {
    poses: Vec<Pose>,
    /// The place of each pose.
    places: Vec<f64>,
    /// Which pose is to be reached; what lies beyond is looked at alone.
    target: usize,
    turn_length: f64,
}

impl Route {
    /// Through `poses`, at least two, to that with the index `target`; a turn by one radian counts as
    /// `turn_length` (m).
    pub fn new(poses: Vec<Pose>, target: usize, turn_length: f64) -> Self {
        let mut places = vec![0.0];
        for pair in poses.windows(2) {
            places.push(places[places.len() - 1] + length(&pair[0], &pair[1], turn_length));
        }
        Self { poses, places, target, turn_length }
    }

    /// The end of what is looked at.
    pub fn end(&self) -> f64 {
        self.places[self.places.len() - 1]
    }

    /// The poses to be passed after a place, up to the target, in turn, with their own places.
    pub fn ahead(&self, place: f64) -> impl Iterator<Item = (&Pose, f64)> {
        let all = self.poses.iter().zip(self.places.iter().copied());
        all.take(self.target + 1).skip(1).filter(move |&(_, there)| there > place)
    }

    /// The object's pose at a place.
    pub fn at(&self, place: f64) -> Pose {
        let next = self.places.partition_point(|&there| there <= place).clamp(1, self.poses.len() - 1);
        let (from, to) = (self.places[next - 1], self.places[next]);
        let s = if to > from { ((place - from) / (to - from)).clamp(0.0, 1.0) } else { 1.0 };
        interpolate(&self.poses[next - 1], &self.poses[next], s)
    }

    /// The place of a pose on the straight motion from that at `from`.
    pub fn place_of(&self, from: (&Pose, f64), X_HO: &Pose) -> f64 {
        from.1 + length(from.0, X_HO, self.turn_length)
    }

    /// What a turn by this angle (rad) counts (m).
    pub fn of_turn(&self, angle: f64) -> f64 {
        angle * self.turn_length
    }
}

fn length(from: &Pose, to: &Pose, turn_length: f64) -> f64 {
    let displacement = (from.translation.vector - to.translation.vector).norm();
    displacement + turn_length * angle_between(&from.rotation, &to.rotation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Rotation, Vec3};

    #[test]
    fn places_are_lengths_and_poses_are_found_again() {
        let turned = |angle| {
            let R_HO = Rotation::from_scaled_axis(Vec3::z() * angle);
            Pose::from_parts(Vec3::new(0.0, 0.0, 0.1).into(), R_HO)
        };
        let route = Route::new(vec![turned(0.0), turned(1.0), turned(0.5), turned(2.0)], 2, 0.03);
        assert!((route.places[2] - 0.045).abs() < 1e-12 && (route.end() - 0.09).abs() < 1e-12);
        assert!(angle_between(&route.at(0.015).rotation, &turned(0.5).rotation) < 1e-12);
        assert!(angle_between(&route.at(0.06).rotation, &turned(1.0).rotation) < 1e-12);
        let ahead: Vec<f64> = route.ahead(0.01).map(|(_, place)| place).collect();
        assert!((ahead[0] - 0.03).abs() < 1e-12 && ahead.len() == 2, "what lies beyond is no target");
        assert!(route.ahead(0.045 + 1e-9).next().is_none());
        let place = route.place_of((&turned(1.0), 0.03), &turned(0.75));
        assert!((place - 0.0375).abs() < 1e-12);
    }
}
