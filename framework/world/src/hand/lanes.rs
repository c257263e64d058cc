//! Eight numbers side by side: loops over them become vector instructions.

use super::screw::Screw;
use regrasp_api::{JointKind, Vec3};
use std::array;
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

/// How many postures go side by side.
pub(super) const LANES: usize = 8;

/// One number of each.
pub(super) type Lane = [f64; LANES];

/// Angles up to this size (rad) are reduced by two parts of π/2, exactly enough; larger ones go the slow way.
const LARGE: f64 = 1e5;
/// The first 33 bits of π/2, so that its product with a count of quarter turns is exact ...
const QUARTER_HIGH: f64 = f64::from_bits(FRAC_PI_2.to_bits() & !0xF_FFFF);
/// ... and the rest; the last number is π/2 less its nearest `f64`.
const QUARTER_LOW: f64 = (FRAC_PI_2 - QUARTER_HIGH) + 6.123_233_995_736_766e-17;
/// Added to a number it leaves the nearest whole one in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// Sines and cosines, to an ulp or two.
#[inline]
pub(super) fn sin_cos(angles: &Lane) -> (Lane, Lane) {
    let (mut sines, mut cosines) = ([0.0; LANES], [0.0; LANES]);
    // A number that is none counts as large.
    if !angles.iter().all(|angle| angle.abs() <= LARGE) {
        for (i, angle) in angles.iter().enumerate() {
            (sines[i], cosines[i]) = angle.sin_cos();
        }
        return (sines, cosines);
    }
    for i in 0..LANES {
        let shifted = angles[i] * FRAC_2_PI + WHOLE;
        let (quarters, count) = (shifted.to_bits(), shifted - WHOLE);
        let (sin, cos) = within_a_quarter((angles[i] - count * QUARTER_HIGH) - count * QUARTER_LOW);
        // Odd quarters swap the two, and each changes its sign in two of four.
        let swap = (sin.to_bits() ^ cos.to_bits()) & (quarters & 1).wrapping_neg();
        sines[i] = f64::from_bits((sin.to_bits() ^ swap) ^ ((quarters & 2) << 62));
        cosines[i] = f64::from_bits((cos.to_bits() ^ swap) ^ ((quarters.wrapping_add(1) & 2) << 62));
    }
    (sines, cosines)
}

/// Taylor's series for angles up to π/4 (rad): what is left out is below 1e-17.
#[inline]
fn within_a_quarter(x: f64) -> (f64, f64) {
    /// 1/k!.
    const fn over(k: u64) -> f64 {
        let (mut factorial, mut i) = (1_u64, 2);
        while i <= k {
            factorial *= i;
            i += 1;
        }
        1.0 / factorial as f64
    }
    let z = x * x;
    let s = over(13) - z * (over(15) - z * over(17));
    let s = over(5) - z * (over(7) - z * (over(9) - z * (over(11) - z * s)));
    let c = over(12) - z * (over(14) - z * over(16));
    let c = over(4) - z * (over(6) - z * (over(8) - z * (over(10) - z * c)));
    (x - x * z * (over(3) - z * s), 1.0 - (0.5 * z - z * z * c))
}

/// Points or vectors side by side.
#[derive(Clone, Copy)]
pub(super) struct Vectors {
    pub x: Lane,
    pub y: Lane,
    pub z: Lane,
}

impl Vectors {
    /// The same vector in every lane.
    #[inline]
    pub fn all(v: &Vec3) -> Self {
        Self { x: [v.x; LANES], y: [v.y; LANES], z: [v.z; LANES] }
    }

    /// The vector in one lane.
    #[inline]
    pub fn get(&self, lane: usize) -> [f64; 3] {
        [self.x[lane], self.y[lane], self.z[lane]]
    }

    /// `self + s · other`.
    #[inline]
    pub fn plus(&self, s: f64, other: &Self) -> Self {
        let sum = |a: &Lane, b: &Lane| array::from_fn(|i| a[i] + s * b[i]);
        Self { x: sum(&self.x, &other.x), y: sum(&self.y, &other.y), z: sum(&self.z, &other.z) }
    }

    /// `a × self`.
    #[inline]
    fn crossed_by(&self, a: &Vec3) -> Self {
        let part = |a: f64, u: &Lane, b: f64, v: &Lane| array::from_fn(|i| a * u[i] - b * v[i]);
        Self {
            x: part(a.y, &self.z, a.z, &self.y),
            y: part(a.z, &self.x, a.x, &self.z),
            z: part(a.x, &self.y, a.y, &self.x),
        }
    }
}

/// One joint's motion in every lane.
pub(super) struct Motion {
    /// Positions of the joint (rad; m).
    q: Lane,
    sin: Lane,
    /// 1 - cos q.
    versine: Lane,
}

impl Motion {
    /// The motion of `screw`'s joint by `q`.
    #[inline]
    pub fn new(screw: &Screw, q: Lane) -> Self {
        let (sin, cos) = match screw.kind {
            JointKind::Revolute => sin_cos(&q),
            JointKind::Prismatic => ([0.0; LANES], [1.0; LANES]),
        };
        Self { q, sin, versine: cos.map(|cos| 1.0 - cos) }
    }

    /// Where it takes points (m).
    #[inline]
    pub fn points(&self, screw: &Screw, p: &Vectors) -> Vectors {
        match screw.kind {
            JointKind::Revolute => {
                let point = Vectors::all(&screw.point);
                self.vectors(screw, &p.plus(-1.0, &point)).plus(1.0, &point)
            }
            JointKind::Prismatic => {
                let moved = |p: &Lane, axis: f64| array::from_fn(|i| p[i] + axis * self.q[i]);
                Vectors {
                    x: moved(&p.x, screw.axis.x),
                    y: moved(&p.y, screw.axis.y),
                    z: moved(&p.z, screw.axis.z),
                }
            }
        }
    }

    /// Where it takes free vectors: v + sin q · a×v + (1 - cos q) · a×(a×v) (Rodrigues).
    #[inline]
    pub fn vectors(&self, screw: &Screw, v: &Vectors) -> Vectors {
        if screw.kind == JointKind::Prismatic {
            return *v;
        }
        let once = v.crossed_by(&screw.axis);
        let twice = once.crossed_by(&screw.axis);
        let sum = |v: &Lane, once: &Lane, twice: &Lane| {
            array::from_fn(|i| v[i] + (self.sin[i] * once[i] + self.versine[i] * twice[i]))
        };
        Vectors {
            x: sum(&v.x, &once.x, &twice.x),
            y: sum(&v.y, &once.y, &twice.y),
            z: sum(&v.z, &once.z, &twice.z),
        }
    }
}

/// Velocities of points (m), which move with the joint, per joint speed.
#[inline]
pub(super) fn velocities(screw: &Screw, p: &Vectors) -> Vectors {
    match screw.kind {
        JointKind::Revolute => p.plus(-1.0, &Vectors::all(&screw.point)).crossed_by(&screw.axis),
        JointKind::Prismatic => Vectors::all(&screw.axis),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn sines_and_cosines_are_those_of_the_library() {
        let mut random = Random::from_key(1, 0, 0, 0);
        let mut worst = 0.0_f64;
        for size in [1e-9, 1e-3, 1.0, 10.0, 1e4, 1e5] {
            for _ in 0..2000 {
                let angles = array::from_fn(|_| random.range(-size, size));
                let (sines, cosines) = sin_cos(&angles);
                for (i, angle) in angles.iter().enumerate() {
                    worst = worst.max((sines[i] - angle.sin()).abs()).max((cosines[i] - angle.cos()).abs());
                }
            }
        }
        assert!(worst < 4e-16, "{worst}");
    }

    #[test]
    fn quarter_turns_large_angles_and_what_is_no_number_are_right() {
        let angles = [0.0, FRAC_PI_2, -FRAC_PI_2, 3.0 * FRAC_PI_2, -0.0, 1e9, -1e300, f64::NAN];
        let both = |angles: &Lane| (sin_cos(angles), angles.map(f64::sin), angles.map(f64::cos));
        let small: Lane = array::from_fn(|i| angles[i % 5]);
        for ((sines, cosines), wanted_sines, wanted_cosines) in [both(&angles), both(&small)] {
            for i in 0..LANES {
                let near = |a: f64, b: f64| a.is_nan() && b.is_nan() || (a - b).abs() <= 2e-16;
                assert!(near(sines[i], wanted_sines[i]) && near(cosines[i], wanted_cosines[i]), "{i}");
            }
        }
    }
}
