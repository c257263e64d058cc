//! Straight ahead over side and caps.

use super::{Cap, Patch, Tube, azimuth};
use crate::parametric::curve::{Curve, Form};
use regrasp_api::Vec3;

/// Rims crossed before a walk ends where it is.
const MOST_RIMS: usize = 100_000;

/// A point on its way over a patch.
struct Walker<'a> {
    tube: &'a Tube,
    p: Vec3,
    /// Unit vector in the tangent plane.
    along: Vec3,
    left: f64,
    spacing: f64,
    curve: &'a mut Curve,
}

/// The unit vector around z and the one away from it.
fn around(p: &Vec3) -> (Vec3, Vec3) {
    let (sin, cos) = azimuth(p).sin_cos();
    (Vec3::new(-sin, cos, 0.0), Vec3::new(cos, sin, 0.0))
}

/// Appends the straightest path.
pub(super) fn walk(tube: &Tube, from: &Vec3, along: &Vec3, distance: f64, spacing: f64, curve: &mut Curve) {
    let Some((mut patch, along)) = head_out(tube, from, along) else { return };
    let mut walker = Walker { tube, p: *from, along, left: distance, spacing, curve };
    for _ in 0..MOST_RIMS {
        if walker.left <= 0.0 {
            break;
        }
        patch = match (patch, tube.cap) {
            (Patch::Side, _) => walker.side(),
            (Patch::Cap(sign), Cap::Flat) => walker.flat(sign),
            (Patch::Cap(sign), Cap::Round) => walker.round(sign),
        };
    }
}

/// The patch into which a direction leads, and the unit direction in it.
fn head_out(tube: &Tube, from: &Vec3, along: &Vec3) -> Option<(Patch, Vec3)> {
    let n = tube.normal(from);
    let flat = |n: &Vec3| (along - n * n.dot(along)).try_normalize(0.0);
    let on_rim = (from.z.abs() - tube.half_height).abs() < super::ON_RIM * tube.radius;
    if tube.cap == Cap::Flat && on_rim && tube.patch(from) == Patch::Side {
        let sign = from.z.signum();
        let (_, out) = around(from);
        let over = along - Vec3::z() * along.z;
        let onto_cap = over.dot(&out) < 0.0 && -along.dot(&out) > -sign * along.z;
        if onto_cap || sign * along.z > 0.0 {
            // What leads up from the side leads inwards on the cap.
            let inwards = if onto_cap { over } else { along - (out + Vec3::z() * sign) * (sign * along.z) };
            return Some((Patch::Cap(sign), (inwards - Vec3::z() * inwards.z).try_normalize(0.0)?));
        }
    }
    Some((tube.patch(from), flat(&n)?))
}

impl Walker<'_> {
    /// A helix to the next rim.
    fn side(&mut self) -> Patch {
        let (tangent, _) = around(&self.p);
        let (turn, rise) = (self.along.dot(&tangent), self.along.z);
        let end = self.tube.half_height.copysign(rise);
        let to_rim = if rise == 0.0 { f64::INFINITY } else { ((end - self.p.z) / rise).max(0.0) };
        let run = to_rim.min(self.left);
        let (angle, z, R) = (azimuth(&self.p), self.p.z, self.tube.radius);
        let tube = *self.tube;
        let at = |t: f64| tube.side(angle + turn * run * t / R, z + rise * run * t);
        let to = if run == to_rim { tube.side(angle + turn * run / R, end) } else { at(1.0) };
        self.advance(run, to, at);
        let (tangent, out) = around(&to);
        self.along = match tube.cap {
            Cap::Flat if run == to_rim => tangent * turn - out * rise.abs(),
            _ => tangent * turn + Vec3::z() * rise,
        };
        if run == to_rim { Patch::Cap(end.signum()) } else { Patch::Side }
    }

    /// A chord to the rim.
    fn flat(&mut self, sign: f64) -> Patch {
        let (p, R) = (self.p, self.tube.radius);
        let ahead = p.xy().dot(&self.along.xy());
        let to_rim = ((ahead * ahead + R * R - p.xy().norm_squared()).max(0.0).sqrt() - ahead).max(0.0);
        let run = to_rim.min(self.left);
        let along = self.along;
        let mut to = p + along * run;
        if run == to_rim {
            to = self.tube.side(azimuth(&to), sign * self.tube.half_height);
        }
        self.advance(run, to, |t| p + along * (run * t));
        let (tangent, out) = around(&to);
        self.along = tangent * along.dot(&tangent) - Vec3::z() * (sign * along.dot(&out).abs());
        if run == to_rim { Patch::Side } else { Patch::Cap(sign) }
    }

    /// A great circle to the rim.
    fn round(&mut self, sign: f64) -> Patch {
        let (middle, R) = (self.tube.middle(sign), self.tube.radius);
        let (n, along) = ((self.p - middle).normalize(), self.along);
        let to_rim = R * (sign * n.z).max(0.0).atan2(-sign * along.z);
        let run = to_rim.min(self.left);
        let at = |t: f64| middle + (n * (t * run / R).cos() + along * (t * run / R).sin()) * R;
        self.advance(run, at(1.0), at);
        self.along = along * (run / R).cos() - n * (run / R).sin();
        if run == to_rim { Patch::Side } else { Patch::Cap(sign) }
    }

    fn advance(&mut self, run: f64, to: Vec3, at: impl Fn(f64) -> Vec3) {
        self.curve.arc(run, self.spacing, &to, at);
        self.p = to;
        self.left -= run;
    }
}
