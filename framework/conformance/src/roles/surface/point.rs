//! Laws of single points: samples, projections, distances to edges.

use super::ground::{EXACT, Ground, on_each};
use crate::law::{Subject, random};
use crate::report::{Finding, ensure};
use regrasp_api::{Contact, Primitive, Vec3};

/// The contact lies on the surface, and its normal is a unit vector that leads straight away from it.
pub(super) fn is_contact(ground: &Ground, contact: &Contact, exact: f64) -> Finding {
    let off = ground.closest(&contact.p_OC).distance;
    ensure(off.abs() <= exact, || format!("a contact {off:e} m off the surface: {contact:?}"))?;
    let length = contact.n_O.norm();
    ensure((length - 1.0).abs() <= 1e-9, || format!("a normal of length {length}: {contact:?}"))?;
    // Beside a concave edge another facet is closer.
    let height = ground.closest(&contact.tip_center(1e-5)).distance;
    let out = if ground.is_convex() { (height - 1e-5).abs() <= 1e-9 + exact } else { height > 0.0 };
    ensure(out, || format!("10 µm along the normal lies {height:e} m off the surface: {contact:?}"))
}

pub(super) fn sample_on_surface(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        let mut random = random(41);
        (0..200).try_for_each(|_| is_contact(ground, &ground.surface.sample(&mut random), EXACT))
    })
}

/// Parts of the surface, each with its share of the area: the thirds of a box's six faces, the octants of
/// round objects.
fn parts(ground: &Ground) -> (Vec<f64>, impl Fn(&Vec3) -> usize) {
    let half = match ground.object.primitive {
        Some(Primitive::Cuboid { half_size }) => Some(half_size),
        _ => None,
    };
    let shares = match half {
        Some(h) => {
            let areas = [h.y * h.z, h.z * h.x, h.x * h.y];
            let all = 2.0 * areas.iter().sum::<f64>();
            areas.iter().flat_map(|area| [area / (3.0 * all); 6]).collect()
        }
        None => vec![0.125; 8],
    };
    let place = move |p: &Vec3| match half {
        Some(half) => {
            let axis = p.component_div(&half).iamax();
            let along = (axis + 1) % 3;
            let third = (1.5 * (p[along] / half[along] + 1.0)).clamp(0.0, 2.9) as usize;
            6 * axis + 3 * usize::from(p[axis] > 0.0) + third
        }
        None => (0..3).map(|i| usize::from(p[i] > 0.0) << i).sum(),
    };
    (shares, place)
}

/// Every part of the surface is hit as often as its area says.
pub(super) fn sample_uniform(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        let (shares, place) = parts(ground);
        let (mut random, mut hits) = (random(42), vec![0_u32; shares.len()]);
        let count = 12_000;
        for _ in 0..count {
            hits[place(&ground.surface.sample(&mut random).p_OC)] += 1;
        }
        for (part, (share, hit)) in shares.iter().zip(&hits).enumerate() {
            let expected = share * f64::from(count);
            // Five standard deviations.
            ensure((f64::from(*hit) - expected).abs() < 5.0 * expected.sqrt(), || {
                format!(
                    "part {part} of {} is hit {hit} times of {count}, {expected:.0} expected",
                    shares.len()
                )
            })?;
        }
        Ok(())
    })
}

/// Places of fingertip centres: just above the surface, farther off, and inside.
fn places(ground: &Ground, key: u64) -> Vec<Vec3> {
    let mut random = random(key);
    let heights = [1e-3, 0.01, 0.018, 0.05, -0.002];
    let place = |i: usize| {
        let sample = ground.surface.sample(&mut random);
        sample.tip_center(heights[i % heights.len()]) + random.direction() * 5e-4
    };
    (0..100).map(place).collect()
}

pub(super) fn project_exact(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        for p_OF in places(ground, 43) {
            let (found, truth) = (ground.surface.project(&p_OF, None), ground.closest(&p_OF));
            let text = || format!("projects {p_OF:?} to {found:?}; the truth is {truth:?}");
            ensure((found.distance - truth.distance).abs() <= EXACT, text)?;
            let p_OC = found.contact.p_OC;
            ensure(((p_OF - p_OC).norm() - truth.distance.abs()).abs() <= EXACT, text)?;
            ensure(ground.closest(&p_OC).distance.abs() <= EXACT, text)?;
            if truth.distance > 1e-4 {
                let error = found.contact.n_O - (p_OF - p_OC).normalize();
                ensure(error.norm() <= 1e-6, text)?;
            }
        }
        Ok(())
    })
}

pub(super) fn project_ignores_hint(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        let mut random = random(44);
        for p_OF in places(ground, 44) {
            let plain = ground.surface.project(&p_OF, None);
            for hint in [plain.contact.facet, ground.surface.sample(&mut random).facet] {
                let hinted = ground.surface.project(&p_OF, Some(hint));
                let same = hinted.distance == plain.distance && hinted.contact.p_OC == plain.contact.p_OC;
                ensure(same, || format!("{plain:?} without hint, {hinted:?} with {hint}"))?;
            }
        }
        Ok(())
    })
}

pub(super) fn edge_distance(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        // Coarse facets about the ring's tube bend by as much as what may count as sharp.
        if !ground.is_convex() {
            return Ok(());
        }
        let mut random = random(45);
        for _ in 0..100 {
            let contact = ground.surface.sample(&mut random);
            let found = ground.surface.edge_distance(&contact);
            // On a face of a box the nearest edge is across the second largest coordinate.
            let truth = match ground.object.primitive {
                Some(Primitive::Cuboid { half_size }) => {
                    let mut gaps: Vec<f64> = (half_size - contact.p_OC.abs()).iter().copied().collect();
                    gaps.sort_by(f64::total_cmp);
                    gaps[1]
                }
                _ => f64::INFINITY,
            };
            ensure(found == truth || (found - truth).abs() <= EXACT, || {
                format!("{found} m from a sharp edge at {contact:?}, in truth {truth} m")
            })?;
        }
        Ok(())
    })
}
