//! From cap to cap: where both rims are crossed.

use super::{Cap, wrapped};
use std::f64::consts::PI;

/// Angles tried on each rim.
const PLACES: usize = 32;
/// The best pairs of angles from which the search is begun.
const STARTS: usize = 6;
/// Newton steps; half a dozen are common.
const STEPS: usize = 100;

/// The way over a cap from one of its points to its rim, as a function of the angle there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub cap: Cap,
    /// The rim's radius (m).
    pub radius: f64,
    /// The point's distance (m) from the axis.
    pub out: f64,
    /// Its angle about the axis (rad).
    pub angle: f64,
}

impl Crossing {
    /// The length (m) to the rim at an angle (rad).
    pub fn length(&self, angle: f64) -> f64 {
        self.jet(angle)[0]
    }

    /// The length and its first two derivatives by the angle.
    fn jet(&self, angle: f64) -> [f64; 3] {
        let (sin, cos) = (angle - self.angle).sin_cos();
        let (R, out) = (self.radius, self.out);
        match self.cap {
            Cap::Flat => {
                // The law of cosines, without cancellation.
                let half = ((angle - self.angle) / 2.0).sin();
                let f = ((R - out).powi(2) + 4.0 * R * out * half * half).sqrt().max(f64::MIN_POSITIVE);
                let slope = R * out * sin / f;
                [f, slope, (R * out * cos - slope * slope) / f]
            }
            Cap::Round => {
                // On a half ball with sin λ = out / R the arc θ has cos θ = sin λ cos(angle).
                let share = (out / R).min(1.0);
                let cos_arc = share * cos;
                let sin_arc = (share * sin).hypot((1.0 - share * share).sqrt()).max(f64::MIN_POSITIVE);
                let slope = share * sin / sin_arc;
                [R * sin_arc.atan2(cos_arc), R * slope, R * cos_arc * (1.0 - slope * slope) / sin_arc]
            }
        }
    }
}

/// The sum of three pieces, its gradient and its second derivatives (αα, αβ, ββ).
struct Jet {
    length: f64,
    slope: [f64; 2],
    bend: [f64; 3],
}

fn jet((a, b): &(Crossing, Crossing), radius: f64, height: f64, at: [f64; 2]) -> Jet {
    let (f, g) = (a.jet(at[0]), b.jet(at[1]));
    let turn = wrapped(at[0] - at[1]);
    let side = (radius * turn).hypot(height);
    let (slope, bend) = (radius * radius * turn / side, (radius * height).powi(2) / side.powi(3));
    Jet {
        length: f[0] + side + g[0],
        slope: [f[1] + slope, g[1] - slope],
        bend: [f[2] + bend, -bend, g[2] + bend],
    }
}

/// The angles at which the shortest path between points of two caps crosses their rims; `height` (m) lies
/// between the rims.
pub(super) fn between(ends: (Crossing, Crossing), radius: f64, height: f64) -> [f64; 2] {
    let mut tried: Vec<(f64, [f64; 2])> = Vec::with_capacity(PLACES * PLACES);
    let angle = |i: usize| 2.0 * PI * i as f64 / PLACES as f64;
    let over = |end: &Crossing| std::array::from_fn::<f64, PLACES, _>(|i| end.length(angle(i)));
    let sides: [f64; PLACES] = std::array::from_fn(|i| (radius * wrapped(angle(i))).hypot(height));
    let (f, g) = (over(&ends.0), over(&ends.1));
    let value = |i: usize, j: usize| f[i] + sides[(i + PLACES - j) % PLACES] + g[j];
    for i in 0..PLACES {
        for j in 0..PLACES {
            let here = value(i, j);
            let around = [0, 1, PLACES - 1];
            let is_lowest = around
                .iter()
                .all(|di| around.iter().all(|dj| here <= value((i + di) % PLACES, (j + dj) % PLACES)));
            if is_lowest {
                tried.push((here, [angle(i), angle(j)]));
            }
        }
    }
    tried.sort_by(|a, b| a.0.total_cmp(&b.0));
    let found = tried.iter().take(STARTS).map(|start| improve(&ends, radius, height, start.1));
    found.min_by(|a, b| a.0.total_cmp(&b.0)).map_or([ends.0.angle, ends.1.angle], |best| best.1)
}

/// Newton's method, steps damped until they are shorter.
fn improve(ends: &(Crossing, Crossing), radius: f64, height: f64, start: [f64; 2]) -> (f64, [f64; 2]) {
    let mut at = start;
    let mut here = jet(ends, radius, height, at);
    let mut damping = 0.0;
    for _ in 0..STEPS {
        let (x, y) = (here.bend[0] + damping, here.bend[2] + damping);
        let determinant = x * y - here.bend[1] * here.bend[1];
        let step = [
            (-y * here.slope[0] + here.bend[1] * here.slope[1]) / determinant,
            (here.bend[1] * here.slope[0] - x * here.slope[1]) / determinant,
        ];
        let next = [at[0] + step[0], at[1] + step[1]];
        let there = jet(ends, radius, height, next);
        if x > 0.0 && determinant > 0.0 && there.length <= here.length {
            let still = step[0].abs().max(step[1].abs()) < 1e-14;
            (at, here, damping) = (next, there, if damping < 1e-9 * radius { 0.0 } else { damping / 8.0 });
            if still {
                break;
            }
        } else {
            damping = (damping * 4.0).max(1e-6 * radius);
            if damping > 1e12 * radius {
                break;
            }
        }
    }
    (here.length, at)
}
