//! How turns are sorted: by their axis into sectors of the sphere, by their angle into bands.

/// The ends of the bands of angles (degrees).
///
/// Of uniform turns 18 % lie in the first band, 34 % in the second, 48 % in the third: the density of the
/// angle grows as 1 - cos θ.
pub const ANGLES_DEG: [f64; 4] = [0.0, 90.0, 135.0, 180.0];

/// A part of the sphere of axes: one of fourteen, all of the same area. About each pole of z lies a cap, and
/// round it six sectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Sector {
    /// Whether the axis points to the side of z > 0.
    pub is_up: bool,
    /// The sector from 0 to 5, counted about z from x towards y; `None` for the cap.
    pub around: Option<usize>,
}

/// z on the border of a cap: a cap is a seventh of its half of the sphere (Archimedes: area grows with z).
pub(crate) const CAP: f64 = 6.0 / 7.0;
/// Sectors round a cap.
pub(crate) const AROUND: usize = 6;

impl Sector {
    /// All of them, the caps first.
    pub fn all() -> impl Iterator<Item = Self> {
        [true, false].into_iter().flat_map(|is_up| {
            let around = std::iter::once(None).chain((0..AROUND).map(Some));
            around.map(move |around| Self { is_up, around })
        })
    }

    /// The sector of an axis of length 1.
    pub fn of(axis: [f64; 3]) -> Self {
        let [x, y, z] = axis;
        let turn = y.atan2(x).rem_euclid(std::f64::consts::TAU) / std::f64::consts::TAU;
        let around = ((turn * AROUND as f64) as usize).min(AROUND - 1);
        Self { is_up: z >= 0.0, around: (z.abs() < CAP).then_some(around) }
    }

    /// In words: where its axes point.
    pub fn name(self) -> String {
        let side = if self.is_up { "+z" } else { "-z" };
        match self.around {
            None => format!("about {side}"),
            Some(k) => format!("{side} side, {} to {}° from x", k * 60, (k + 1) * 60),
        }
    }
}

/// The band of an angle (degrees).
pub(crate) fn band(angle_deg: f64) -> usize {
    ANGLES_DEG[1..ANGLES_DEG.len() - 1].iter().filter(|&&end| angle_deg >= end).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Random;

    #[test]
    fn sectors_are_of_one_size_and_bands_hold_what_they_say() {
        let (mut sectors, mut bands) = (std::collections::BTreeMap::new(), [0; 3]);
        let mut random = Random::from_key(1, 0, 0, 0);
        for _ in 0..14_000 {
            *sectors.entry(Sector::of(random.direction().into())).or_insert(0) += 1;
            bands[band(random.rotation().angle().to_degrees())] += 1;
        }
        assert_eq!(sectors.len(), Sector::all().count());
        // A thousand in each, give or take four deviations of a binomial count.
        assert!(sectors.values().all(|n: &i32| (n - 1000).abs() < 125), "{sectors:?}");
        let expected = [0.1817, 0.3432, 0.4751];
        for (found, expected) in bands.iter().zip(expected) {
            assert!((f64::from(*found) / 14_000.0 - expected).abs() < 0.017, "{bands:?}");
        }
    }

    #[test]
    fn poles_are_caps() {
        assert_eq!(Sector::of([0.0, 0.0, -1.0]), Sector { is_up: false, around: None });
        assert_eq!(Sector::of([1.0, -1e-18, 0.0]).around, Some(5));
        assert_eq!(Sector::of([1.0, 0.0, 0.0]).around, Some(0));
    }
}
