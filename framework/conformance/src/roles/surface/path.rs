//! Laws of shortest paths.

use super::ground::{Ground, on_each};
use super::point::is_contact;
use crate::law::{Subject, context, counted_once};
use crate::reference::FacetSurface;
use crate::report::{Fault, Finding, ensure};
use regrasp_api::{Contact, Slot, SurfaceParam, SurfacePath, Waypoint};

/// Pairs of contacts on each object.
const PAIRS: usize = 18;
/// How far (m) the straight line between two waypoints may leave the surface: half of a plan's tolerance for
/// closure.
const BETWEEN: f64 = 1e-5;

/// Tries something on paths over each object that a fingertip can follow.
fn on_paths(
    subject: &Subject<'_>,
    mut check: impl FnMut(&Ground, &(Contact, Contact), &SurfacePath) -> Finding,
) -> Finding {
    on_each(subject, |ground| {
        for pair in ground.pairs(51, PAIRS) {
            match ground.path(&pair.0, &pair.1) {
                Ok(path) => check(ground, &pair, &path)?,
                Err(Fault::Skip(_)) => {}
                Err(fault) => return Err(fault),
            }
        }
        Ok(())
    })
}

pub(super) fn endpoints(subject: &Subject<'_>) -> Finding {
    on_paths(subject, |ground, (from, to), path| {
        let first = path.waypoints.first().map(|w| (w.contact, w.lift_length));
        let last = path.waypoints.last().map(|w| w.contact);
        ensure(first == Some((*from, 0.0)) && last == Some(*to), || {
            format!("the path from {from:?} to {to:?} begins at {first:?} and ends at {last:?}")
        })?;
        let ends = [path.at(0.0), path.at(1.0)];
        ensure(ends == [*from, *to], || format!("its ends are {ends:?}, not {from:?} and {to:?}"))?;
        between_the_same_facets(ground, (from, to))?;
        restarts(ground, (from, to), path)
    })?;
    // From a contact to itself.
    on_each(subject, |ground| {
        let contact = ground.pairs(52, 1)[0].0;
        let path = ground.path(&contact, &contact)?;
        let stays = path.length.abs() <= 1e-9 && path.lift_length() <= 1e-9;
        ensure(stays && path.at(0.5).p_OC == contact.p_OC, || format!("from a contact to itself: {path:?}"))
    })
}

/// Another point of the facet that holds a contact.
fn beside(ground: &Ground, contact: &Contact) -> Contact {
    let mesh = &ground.object.mesh;
    let facet = ground.closest(&contact.p_OC).facet;
    let [a, b, c] = mesh.corners(facet);
    let p_OC = contact.p_OC.lerp(&((a + b + c) / 3.0), 0.3);
    ground.surface.project(&(p_OC + mesh.normal(facet) * 1e-3), None).contact
}

/// A path between the same facets is another one.
fn between_the_same_facets(ground: &Ground, (from, to): (&Contact, &Contact)) -> Finding {
    let (a, b) = (beside(ground, from), beside(ground, to));
    let path = match ground.path(&a, &b) {
        Err(Fault::Skip(_)) => return Ok(()),
        path => path?,
    };
    let ends = [path.waypoints.first(), path.waypoints.last()].map(|w| w.map(|w| w.contact));
    ensure(ends == [Some(a), Some(b)], || format!("the path from {a:?} to {b:?} has the ends {ends:?}"))
}

/// What a path held before is none of its waypoints.
fn restarts(ground: &Ground, (from, to): (&Contact, &Contact), path: &SurfacePath) -> Finding {
    let old = Waypoint { contact: *to, lift_length: 1.0 };
    let mut used = SurfacePath { waypoints: vec![old; 2], length: 1.0 };
    ground.surface.geodesic(from, to, &mut used, &mut context(0))?;
    ensure(used == *path, || {
        "it goes on where the path that it is given ends, and does not restart it".into()
    })
}

pub(super) fn on_surface(subject: &Subject<'_>) -> Finding {
    on_paths(subject, |ground, _, path| {
        let (inner, convex) = (path.waypoints.len().saturating_sub(1), ground.is_convex());
        for waypoint in path.waypoints.get(1..inner).unwrap_or_default() {
            let off = ground.closest(&waypoint.contact.p_OC).distance;
            ensure(off.abs() <= 1e-7, || format!("a waypoint {off:e} m off the surface: {waypoint:?}"))?;
            if convex {
                is_contact(ground, &waypoint.contact, 1e-7)?;
            }
        }
        // At a concave edge the contact jumps under a fingertip that stays.
        let center = |w: &Waypoint| w.contact.tip_center(ground.radius);
        let slides = |pair: &&[Waypoint]| convex || (center(&pair[1]) - center(&pair[0])).norm() > 1e-9;
        for pair in path.waypoints.windows(2).filter(slides) {
            let middle = pair[0].contact.p_OC.lerp(&pair[1].contact.p_OC, 0.5);
            let off = ground.closest(&middle).distance;
            ensure(off.abs() <= BETWEEN, || {
                format!("{off:e} m off the surface between {:?} and {:?}", pair[0], pair[1])
            })?;
        }
        Ok(())
    })
}

pub(super) fn lift(subject: &Subject<'_>) -> Finding {
    on_paths(subject, |ground, _, path| {
        for pair in path.waypoints.windows(2) {
            let (a, b) = (&pair[0].contact, &pair[1].contact);
            let travelled = pair[1].lift_length - pair[0].lift_length;
            let chord = (b.tip_center(ground.radius) - a.tip_center(ground.radius)).norm();
            let turn = a.n_O.cross(&b.n_O).norm().atan2(a.n_O.dot(&b.n_O));
            let longest = (b.p_OC - a.p_OC).norm() + ground.radius * turn;
            // At a concave edge the contact jumps under a fingertip that stays.
            let jump = chord < 1e-9;
            let fits = travelled >= chord - 1e-9 && (jump || travelled <= 1.001 * longest + 1e-9);
            ensure(travelled >= 0.0 && fits, || {
                format!("the fingertip travels {travelled:e} m, its ends are {chord:e} m apart: {pair:?}")
            })?;
        }
        Ok(())
    })
}

pub(super) fn length(subject: &Subject<'_>) -> Finding {
    on_paths(subject, |ground, (from, to), path| {
        let chord = (to.p_OC - from.p_OC).norm();
        ensure(path.length >= chord * (1.0 - 1e-9) - 1e-12, || {
            format!("length {} m, but the ends are {chord} m apart: {from:?} {to:?}", path.length)
        })?;
        let legs = path.waypoints.windows(2).map(|w| (w[1].contact.p_OC - w[0].contact.p_OC).norm());
        let sum: f64 = legs.sum();
        // Under a concave edge the contact jumps.
        ensure(!ground.is_convex() || (path.length - sum).abs() <= 1e-6 * sum + 1e-9, || {
            format!("length {} m, but the waypoints add up to {sum} m: {from:?} {to:?}", path.length)
        })
    })
}

/// By how much (relative) a fingertip's way over a dented object may be longer than that of a point.
const AROUND: f64 = 0.5;

pub(super) fn shortest(subject: &Subject<'_>) -> Finding {
    let tolerance = subject.demands.geodesic_tolerance;
    let mut reference: Option<(&str, FacetSurface)> = None;
    on_paths(subject, |ground, (from, to), path| {
        if reference.as_ref().is_none_or(|(name, _)| *name != ground.name) {
            reference = Some((ground.name, FacetSurface::new(&ground.object.mesh, ground.radius)));
        }
        let (_, facets) = reference.as_ref().expect("it was just made");
        // Where a fingertip cannot follow every dent it may have to go round, but not much.
        let tolerance = if ground.is_convex() { tolerance } else { AROUND };
        let longest = over_facets(facets, from, to)?;
        ensure(path.length <= longest * (1.0 + tolerance) + 1e-9, || {
            format!("length {} m, but {longest} m is possible: {from:?} {to:?}", path.length)
        })
    })
}

/// The length (m) of the reference's path between the points of the facets closest to two contacts.
fn over_facets(facets: &FacetSurface, from: &Contact, to: &Contact) -> Finding<f64> {
    let [a, b] = [from, to].map(|contact| facets.project(&contact.p_OC, None).contact);
    let mut path = SurfacePath::default();
    facets.geodesic(&a, &b, &mut path, &mut context(0))?;
    Ok(path.length)
}

pub(super) fn symmetric(subject: &Subject<'_>) -> Finding {
    let tolerance = subject.demands.geodesic_tolerance;
    on_paths(subject, |ground, (from, to), path| {
        if !ground.is_convex() {
            return Ok(());
        }
        let back = ground.path(to, from)?;
        ensure((path.length - back.length).abs() <= tolerance * path.length + 1e-9, || {
            format!("{} m there, {} m back: {from:?} {to:?}", path.length, back.length)
        })
    })
}

pub(super) fn counted(subject: &Subject<'_>) -> Finding {
    on_each(subject, |ground| {
        let ((from, to), mut context) = (ground.pairs(53, 2)[1], context(0));
        ground.surface.geodesic(&from, &to, &mut SurfacePath::default(), &mut context)?;
        counted_once(&context, Slot::Surface)
    })
}
