//! The velocity constraint of rolling contact and its solution for one finger.
//!
//! A. Cole, J. Hauser, S. Sastry, "Kinematics and control of multifingered hands with rolling contact", IEEE
//! T-AC 1989: the material points of both bodies at the contact have one velocity.

use regrasp_api::{FingerJoints, MAX_FINGER_JOINTS, Mat3, TipKinematics, Vec3};

/// Velocity, in H, of the fingertip's material point at the contact, per joint speed.
///
/// The tip is a ball of radius r about its centre; with the outward normal n the material point lies at -r n
/// from the centre, so that v = J_v q' + J_w q' × (-r n) = Σ (J_v + r n × J_w)ⱼ q'ⱼ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactJacobian {
    columns: [Vec3; MAX_FINGER_JOINTS],
    count: usize,
}

impl ContactJacobian {
    /// For a finger of `count` joints that touches with the outward normal `n_H`.
    pub fn new(tip: &TipKinematics, count: usize, n_H: &Vec3, radius: f64) -> Self {
        let lever = n_H * radius;
        let mut columns = [Vec3::zeros(); MAX_FINGER_JOINTS];
        for (j, column) in columns[..count].iter_mut().enumerate() {
            let spin: Vec3 = tip.J_w.column(j).into();
            *column = tip.J_v.column(j) + lever.cross(&spin);
        }
        Self { columns, count }
    }

    fn columns(&self) -> &[Vec3] {
        &self.columns[..self.count]
    }

    /// The joint speeds that move the material point with velocity `v_H`, of least norm where joints are
    /// spare; `None` at a singularity.
    pub fn speeds(&self, v_H: &Vec3) -> Option<FingerJoints> {
        if let [a, b, c] = self.columns() {
            return solve([*a, *b, *c], v_H).map(|x| FingerJoints::from_slice(x.as_slice()));
        }
        let gram: Mat3 = self.columns().iter().map(|column| column * column.transpose()).sum();
        let weights = solve([0, 1, 2].map(|j| gram.column(j).into()), v_H)?;
        let mut speeds = FingerJoints::zeros(self.count);
        speeds.iter_mut().zip(self.columns()).for_each(|(speed, column)| *speed = column.dot(&weights));
        Some(speeds)
    }
}

/// Solves a x₀ + b x₁ + c x₂ = v by Cramer's rule; `None` where the columns span no volume to speak of.
fn solve([a, b, c]: [Vec3; 3], v: &Vec3) -> Option<Vec3> {
    let bc = b.cross(&c);
    let volume = a.dot(&bc);
    if volume.abs() <= 1e-6 * a.norm() * b.norm() * c.norm() {
        return None;
    }
    Some(Vec3::new(v.dot(&bc), a.dot(&v.cross(&c)), a.dot(&b.cross(v))) / volume)
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::{Random, Rotation, TipJacobian};

    impl ContactJacobian {
        /// Velocity (m per unit) of the material point for these joint speeds.
        fn velocity(&self, speeds: &[f64]) -> Vec3 {
            self.columns().iter().zip(speeds).map(|(column, &speed)| column * speed).sum()
        }
    }

    fn random_tip(count: usize) -> TipKinematics {
        let mut random = Random::from_key(5, count as u64, 0, 0);
        let mut matrix =
            || TipJacobian::from_fn(|_, j| if j < count { random.range(-1.0, 1.0) } else { 0.0 });
        TipKinematics { p_HF: Vec3::zeros(), R_HF: Rotation::identity(), J_v: matrix(), J_w: matrix() }
    }

    #[test]
    fn speeds_reproduce_the_velocity_and_are_least_in_norm() {
        let v = Vec3::new(0.3, -0.2, 0.5);
        for count in 3..=MAX_FINGER_JOINTS {
            let jacobian = ContactJacobian::new(&random_tip(count), count, &Vec3::z(), 0.1);
            let speeds = jacobian.speeds(&v).unwrap();
            assert!((jacobian.velocity(&speeds) - v).norm() < 1e-12);
            // Least norm: no part in the null space, where A A⁺ x = x must hold.
            let again = jacobian.speeds(&jacobian.velocity(&speeds)).unwrap();
            assert!(again.max_difference(&speeds) < 1e-10);
            let mut other = speeds;
            if count > 3 {
                let null = null_vector(&jacobian);
                other.iter_mut().zip(null).for_each(|(a, b)| *a += 0.1 * b);
                assert!((jacobian.velocity(&other) - v).norm() < 1e-10);
                let norm = |x: &FingerJoints| x.iter().map(|x| x * x).sum::<f64>();
                assert!(norm(&other) > norm(&speeds));
            }
        }
    }

    /// A vector that the first four columns map to zero.
    fn null_vector(jacobian: &ContactJacobian) -> Vec<f64> {
        let [a, b, c, d] = *jacobian.columns().first_chunk::<4>().unwrap();
        let x = solve([a, b, c], &d).unwrap();
        let mut null = vec![x.x, x.y, x.z, -1.0];
        null.resize(jacobian.count, 0.0);
        null
    }

    #[test]
    fn a_singular_finger_has_no_answer() {
        let mut tip = random_tip(3);
        tip.J_v.set_column(2, &(tip.J_v.column(0) * 2.0));
        tip.J_w.set_column(2, &(tip.J_w.column(0) * 2.0));
        assert!(ContactJacobian::new(&tip, 3, &Vec3::z(), 0.1).speeds(&Vec3::x()).is_none());
    }
}
