//! The turns of a cube that take it to itself.

use regrasp_api::{Rotation, Vec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// All but the turn by nothing, smaller angles first: six by 90°, eight by 120°, nine by 180°.
pub(crate) fn cube() -> Vec<Rotation> {
    let axes = |directions: &[[f64; 3]], angle: f64| {
        let turn = move |&[x, y, z]: &[f64; 3]| {
            Rotation::from_axis_angle(&nalgebra::Unit::new_normalize(Vec3::new(x, y, z)), angle)
        };
        directions.iter().map(turn).collect::<Vec<_>>()
    };
    let faces = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let back = faces.map(|axis| axis.map(|x| -x));
    let corners = [[1.0, 1.0, 1.0], [1.0, 1.0, -1.0], [1.0, -1.0, 1.0], [-1.0, 1.0, 1.0]];
    let other_corners = corners.map(|axis| axis.map(|x| -x));
    let edges = [
        [1.0, 1.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, 0.0, 1.0],
        [1.0, 0.0, -1.0],
        [0.0, 1.0, 1.0],
        [0.0, 1.0, -1.0],
    ];
    [
        axes(&faces, FRAC_PI_2),
        axes(&back, FRAC_PI_2),
        axes(&corners, TAU / 3.0),
        axes(&other_corners, TAU / 3.0),
        axes(&faces, PI),
        axes(&edges, PI),
    ]
    .concat()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::angle_between;

    #[test]
    fn they_are_all_turns_of_the_cube_and_each_is_there_once() {
        let turns = cube();
        assert_eq!(turns.len(), 23);
        for (k, turn) in turns.iter().enumerate() {
            let matrix = turn.to_rotation_matrix();
            // A turn that takes the cube to itself permutes its axes: every entry is 0, 1 or -1.
            assert!(matrix.matrix().iter().all(|x| (x - x.round()).abs() < 1e-12), "{matrix}");
            assert!(turn.angle() > 1.0);
            assert!(turns[..k].iter().all(|other| angle_between(other, turn) > 1.0));
        }
    }
}
