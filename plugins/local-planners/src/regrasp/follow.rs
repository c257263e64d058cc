//! Following a geodesic at a height above the surface.

use super::flight::Flight;
use crate::common::{bisection, with_spare};
use regrasp_api::{Contact, FingerJoints, Reason, SurfacePath, slerp_normals};

/// Fills `lengths` with how far (m) a fingertip has travelled at each waypoint when it moves at `height` (m).
///
/// The lift's own length is that of height 0; where the normal turns by an angle, the centre's arc is longer
/// by height times angle.
fn measure(slide: &SurfacePath, height: f64, lengths: &mut Vec<f64>) {
    lengths.clear();
    lengths.push(0.0);
    let mut length = 0.0;
    for pair in slide.waypoints.windows(2) {
        let (a, b) = (&pair[0].contact.n_O, &pair[1].contact.n_O);
        let angle = a.cross(b).norm().atan2(a.dot(b));
        length += pair[1].lift_length - pair[0].lift_length + height * angle;
        lengths.push(length);
    }
}

/// The contact after `length` (m) of the measured way.
fn contact_at(slide: &SurfacePath, lengths: &[f64], length: f64) -> Contact {
    let last = lengths.len() - 1;
    let next = lengths.partition_point(|&passed| passed < length).clamp(1.min(last), last);
    let (a, b) = (&slide.waypoints[next.saturating_sub(1)].contact, &slide.waypoints[next].contact);
    let span = lengths[next] - lengths[next.saturating_sub(1)];
    if span <= 0.0 {
        return *b;
    }
    let t = ((length - lengths[next - 1]) / span).clamp(0.0, 1.0);
    Contact { facet: a.facet, p_OC: a.p_OC.lerp(&b.p_OC, t), n_O: slerp_normals(&a.n_O, &b.n_O, t) }
}

impl Flight<'_> {
    /// Appends the way from the lifted posture `a`, without it, to `b` above the contacts of `slide`, the
    /// height (m) going straight from `low` to `high`; or says what bars it.
    pub fn follow(
        &self,
        slide: &SurfacePath,
        lengths: &mut Vec<f64>,
        (low, high): (f64, f64),
        (a, b): (&FingerJoints, &FingerJoints),
        postures: &mut Vec<FingerJoints>,
    ) -> Result<(), Reason> {
        measure(slide, low.max(high), lengths);
        let total = lengths[lengths.len() - 1];
        let way = total.hypot(high - low);
        let count = ((way / self.task.resolution.regrasp_step).ceil() as usize).max(1);
        let (hand, base) = (self.task.hand, postures.len());
        let spare = &hand.finger(self.finger).spare;
        postures.resize(base + count, *b);
        for halving in bisection(count) {
            let s = halving.middle as f64 / count as f64;
            let low_end = if halving.ends.0 == 0 { *a } else { postures[base + halving.ends.0 - 1] };
            let near = low_end.interpolate(&postures[base + halving.ends.1 - 1], halving.fraction());
            let contact = contact_at(slide, lengths, s * total);
            let p_HF = self.center(&contact, low + (high - low) * s);
            let near = with_spare(spare, &near, (a, b), s);
            let joints = hand.inverse(self.finger, &p_HF, &near).ok_or(Reason::Reach)?;
            if !self.free_in_air(&joints) {
                return Err(Reason::Collision);
            }
            postures[base + halving.middle - 1] = joints;
        }
        self.bridge(a, base, postures)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use regrasp_api::Vec3;

    /// 20 mm on a facet, a right angle about an edge at radius 10 mm, 30 mm down the next facet.
    fn around_an_edge() -> SurfacePath {
        let contact = |x, z, n_O| Contact { facet: 0, p_OC: Vec3::new(x, 0.0, z), n_O };
        let mut slide = SurfacePath::default();
        slide.restart(contact(-0.02, 0.0, Vec3::z()));
        slide.push(contact(0.0, 0.0, Vec3::z()), 0.02);
        slide.push(contact(0.0, 0.0, Vec3::x()), 0.01 * std::f64::consts::FRAC_PI_2);
        slide.push(contact(0.0, -0.03, Vec3::x()), 0.03);
        slide
    }

    #[test]
    fn arcs_are_longer_higher_up_and_steps_even() {
        let (slide, mut lengths) = (around_an_edge(), Vec::new());
        measure(&slide, 0.008, &mut lengths);
        let total = 0.05 + 0.018 * std::f64::consts::FRAC_PI_2;
        assert!((lengths[3] - total).abs() < 1e-15);
        let centers: Vec<_> = (0..=1000)
            .map(|i| contact_at(&slide, &lengths, total * f64::from(i) / 1000.0).tip_center(0.018))
            .collect();
        for pair in centers.windows(2) {
            let step = (pair[1] - pair[0]).norm();
            // A chord over one of the arc's ends is a little shorter than the way.
            assert!(step <= total / 1000.0 * (1.0 + 1e-9) && step > total / 1000.0 * 0.999, "{step}");
        }
        assert_eq!(contact_at(&slide, &lengths, 0.0), slide.waypoints[0].contact);
        assert_eq!(contact_at(&slide, &lengths, total).p_OC, slide.waypoints[3].contact.p_OC);
    }

    #[test]
    fn a_way_without_length_stays_where_it_is() {
        let (mut slide, mut lengths) = (SurfacePath::default(), Vec::new());
        slide.restart(around_an_edge().waypoints[0].contact);
        measure(&slide, 0.008, &mut lengths);
        assert_eq!(contact_at(&slide, &lengths, 0.0), slide.waypoints[0].contact);
    }
}
