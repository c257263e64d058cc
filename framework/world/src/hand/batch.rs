//! Kinematics of many postures of one finger, several side by side.

use super::chain::FingerChain;
use super::lanes::{LANES, Lane, Motion, Vectors, velocities};
use regrasp_api::MAX_FINGER_JOINTS;
use std::array;

/// Some columns of a table of numbers, row after row: those from `first` on.
#[derive(Clone, Copy, Debug)]
pub struct Columns<N> {
    /// All numbers of the table.
    pub numbers: N,
    /// How many columns the table has.
    pub width: usize,
    /// The first column that is meant.
    pub first: usize,
}

impl<N: AsRef<[f64]>> Columns<N> {
    fn rows(&self) -> usize {
        self.numbers.as_ref().len() / self.width.max(1)
    }
}

impl Columns<&mut [f64]> {
    /// Puts one lane of some vectors into a row: all their x, then all y, then all z.
    #[inline]
    fn put_all(&mut self, row: usize, vectors: &[Vectors], lane: usize) {
        let count = vectors.len();
        let row = &mut self.numbers[row * self.width + self.first..][..3 * count];
        let (xs, others) = row.split_at_mut(count);
        let (ys, zs) = others.split_at_mut(count);
        for (((v, x), y), z) in vectors.iter().zip(xs).zip(ys).zip(zs) {
            [*x, *y, *z] = v.get(lane);
        }
    }
}

impl FingerChain {
    /// The tip's centre (m) in H for each row of joint positions, in three columns.
    pub fn tip_centers(&self, joints: &Columns<&[f64]>, centers: &mut Columns<&mut [f64]>) {
        let rows = joints.rows();
        for first in (0..rows).step_by(LANES) {
            let q = self.side_by_side(joints, first, rows);
            let mut p = Vectors::all(&self.p_HF0);
            for (screw, q) in self.screws.iter().zip(q).rev() {
                p = Motion::new(screw, q).points(screw, &p);
            }
            (first..rows.min(first + LANES)).for_each(|row| centers.put_all(row, &[p], row - first));
        }
    }

    /// The Jacobian of the tip's centre in H for each row of joint positions: three rows of as many columns
    /// as there are joints, one after the other.
    pub fn tip_jacobians(&self, joints: &Columns<&[f64]>, jacobians: &mut Columns<&mut [f64]>) {
        let (rows, count) = (joints.rows(), self.screws.len());
        let mut columns = [Vectors::all(&self.p_HF0); MAX_FINGER_JOINTS];
        for first in (0..rows).step_by(LANES) {
            let q = self.side_by_side(joints, first, rows);
            let mut p = Vectors::all(&self.p_HF0);
            for k in (0..count).rev() {
                let (screw, motion) = (&self.screws[k], Motion::new(&self.screws[k], q[k]));
                p = motion.points(screw, &p);
                // Those of later joints were found with this one at 0.
                columns[k + 1..count].iter_mut().for_each(|v| *v = motion.vectors(screw, v));
                columns[k] = velocities(screw, &p);
            }
            for coupling in &self.couplings {
                let driven = columns[coupling.joint];
                columns[coupling.driver] = columns[coupling.driver].plus(coupling.multiplier, &driven);
                columns[coupling.joint] = driven.plus(-1.0, &driven);
            }
            for row in first..rows.min(first + LANES) {
                jacobians.put_all(row, &columns[..count], row - first);
            }
        }
    }

    /// The joints' positions in the rows from `first` on, the driven ones where their drivers have them; the
    /// last row again where there are no more.
    #[inline]
    fn side_by_side(&self, joints: &Columns<&[f64]>, first: usize, rows: usize) -> [Lane; MAX_FINGER_JOINTS] {
        let mut q = [[0.0; LANES]; MAX_FINGER_JOINTS];
        for lane in 0..LANES {
            let row = (first + lane).min(rows - 1);
            let own = &joints.numbers[row * joints.width + joints.first..][..self.screws.len()];
            own.iter().zip(&mut q).for_each(|(&value, q)| q[lane] = value);
        }
        for coupling in &self.couplings {
            let driver = q[coupling.driver];
            q[coupling.joint] = array::from_fn(|i| coupling.multiplier * driver[i] + coupling.offset);
        }
        q
    }
}
