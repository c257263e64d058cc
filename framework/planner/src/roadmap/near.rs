//! The nodes nearest to a pose, by a look at all of them: some nanoseconds a node.

use super::nodes::ScanPose;
use regrasp_api::Pose;

/// How far two poses are apart (m): displacement, and turn times `turn_length`.
pub(crate) fn apart(a: &ScanPose, b: &ScanPose, turn_length: f32) -> f32 {
    let displacement = square(a, b).sqrt();
    displacement + turn_length * 2.0 * cosine(a, b).min(1.0).acos()
}

/// A pose in single precision.
pub(crate) fn scan_pose(X_HO: &Pose) -> ScanPose {
    let (turn, p) = (X_HO.rotation.quaternion(), &X_HO.translation.vector);
    [turn.w, turn.i, turn.j, turn.k, p.x, p.y, p.z].map(|x| x as f32)
}

/// The `count` of `poses` that are nearest to `pose`, the nearest first, with how far they are.
pub(crate) fn nearest(
    poses: &[ScanPose],
    pose: &ScanPose,
    turn_length: f32,
    count: usize,
) -> Vec<(u32, f32)> {
    let mut best: Vec<(f32, u32)> = Vec::with_capacity(count + 1);
    let mut worst = f32::INFINITY;
    for (node, other) in poses.iter().enumerate() {
        let rank = rank(pose, other, turn_length);
        if rank >= worst {
            continue;
        }
        let place = best.partition_point(|&(smaller, _)| smaller <= rank);
        best.insert(place, (rank, node as u32));
        if best.len() > count {
            best.pop();
            worst = best[count - 1].0;
        }
    }
    let found = |(_, node): (f32, u32)| (node, apart(&poses[node as usize], pose, turn_length));
    best.into_iter().map(found).collect()
}

/// Grows as the distance does where turns are not large, and needs no arc cosine: 8 (1 - cos(θ/2)) ≈ θ².
fn rank(a: &ScanPose, b: &ScanPose, turn_length: f32) -> f32 {
    square(a, b) + turn_length * turn_length * 8.0 * (1.0 - cosine(a, b))
}

fn square(a: &ScanPose, b: &ScanPose) -> f32 {
    let [x, y, z] = [4, 5, 6].map(|i| a[i] - b[i]);
    x * x + y * y + z * z
}

/// The cosine of half of the angle between two orientations.
fn cosine(a: &ScanPose, b: &ScanPose) -> f32 {
    (a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Random, angle_between};

    #[test]
    fn nearest_are_found_and_measured() {
        let mut random = Random::from_key(5, 0, 0, 0);
        let mut draw = || Pose::from_parts((random.direction() * 0.01).into(), random.rotation());
        let all: Vec<Pose> = (0..400).map(|_| draw()).collect();
        let (at, poses) = (draw(), all.iter().map(scan_pose).collect::<Vec<_>>());
        let found = nearest(&poses, &scan_pose(&at), 0.03, 5);
        let far = |pose: &Pose| {
            (pose.translation.vector - at.translation.vector).norm()
                + 0.03 * angle_between(&pose.rotation, &at.rotation)
        };
        let mut distances: Vec<f64> = all.iter().map(far).collect();
        for &(node, distance) in &found {
            assert!((f64::from(distance) - distances[node as usize]).abs() < 1e-5);
        }
        distances.sort_by(f64::total_cmp);
        assert_eq!(found.len(), 5);
        assert!(f64::from(found[4].1) < distances[12], "the ranks are nearly those of the distance");
    }

    #[test]
    fn fewer_nodes_than_asked_for_are_all() {
        let poses = [scan_pose(&Pose::identity()); 3];
        assert_eq!(nearest(&poses, &poses[0], 0.03, 8).len(), 3);
    }
}
