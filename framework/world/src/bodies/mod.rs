//! Which bodies a mesh holds: one rigid object is one piece, hollows allowed.

mod crossing;
mod union;

use regrasp_api::{Mesh, Vec3};
use thiserror::Error;

/// Why a closed mesh is no rigid object.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BodyFault {
    /// A body's facets look inward.
    #[error(
        "body {body} of {count} ({facets} facets, near {at:.4?}) is inside out: it lies in no other body, \
         and its facets look inward; reverse \
         the order of their vertices"
    )]
    InsideOut {
        /// Which body, counted from 1.
        body: usize,
        /// How many bodies there are.
        count: usize,
        /// Its number of facets.
        facets: usize,
        /// A point of it (m).
        at: [f64; 3],
    },
    /// Two bodies share space, and their surfaces cross.
    #[error(
        "bodies {first} and {second} of {count} overlap near {at:.4?}, and their union could not be made; \
         unite them in the program that made \
         them (Boolean union)"
    )]
    Overlap {
        /// One body, counted from 1.
        first: usize,
        /// The other.
        second: usize,
        /// How many bodies there are.
        count: usize,
        /// Where their surfaces cross (m).
        at: [f64; 3],
    },
    /// A surface crosses itself.
    #[error(
        "the surface crosses itself in {count} places, the first near {at:.4?}; repair the mesh there, or \
         let `regrasp object FILE --repair -o clean.stl` make a closed surface of it"
    )]
    Crossing {
        /// How many pairs of facets cross.
        count: usize,
        /// Where the first two do (m).
        at: [f64; 3],
    },
    /// Two facets lie back to back.
    #[error(
        "the surface folds back on itself near {at:.4?}, a wall without thickness; remove it or give it \
         some, \
         or let `regrasp object FILE --repair -o clean.stl` make a closed surface of it"
    )]
    Fold {
        /// Where (m).
        at: [f64; 3],
    },
    /// Bodies that do not touch.
    #[error(
        "the mesh holds {count} bodies that are not one piece, the second ({facets} facets) near {at:.4?}; \
         a rigid object is one piece: keep one, \
         unite them, or say `object.assembly = true` if they are fixed to each other"
    )]
    Apart {
        /// How many bodies there are.
        count: usize,
        /// The second one's number of facets.
        facets: usize,
        /// A point of it (m).
        at: [f64; 3],
    },
}

/// One connected surface of a mesh.
struct Part {
    facets: Vec<u32>,
    /// Volume (m³); negative where the facets look inward.
    volume: f64,
    at: Vec3,
    /// Points all over it.
    samples: Vec<Vec3>,
    lower: Vec3,
    upper: Vec3,
}

/// About as many points tell where a surface lies that may touch others.
const SAMPLES: usize = 16;
/// A winding number this near to a whole one is no matter of touching.
const WHOLE: f64 = 0.01;

/// A mesh as one rigid object, and what was done for that.
#[derive(Clone, Debug, PartialEq)]
pub struct RigidBody {
    /// The mesh (m).
    pub mesh: Mesh,
    /// How many bodies that overlap or touch were united; 0 where none were.
    pub united: usize,
    /// How many bodies within others were left out.
    pub within: usize,
}

impl RigidBody {
    /// What was done, for people; nothing where nothing was.
    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.united > 0 {
            let united = self.united;
            remarks.push(format!(
                "{united} bodies that overlap or touch were united; what they share counts once"
            ));
        }
        match self.within {
            0 => {}
            1 => remarks.push("a body within another was left out: it is part of it".into()),
            within => {
                remarks.push(format!("{within} bodies within others were left out: they are part of them"))
            }
        }
        remarks
    }
}

/// The mesh as one rigid object, or why it is none.
///
/// Bodies that overlap, or touch by faces, are united. A body within another is part of it and left out; a
/// surface that looks inward within a body is a hollow. Several bodies that do not touch pass as an
/// `assembly` only. Cost: about 3 µs a facet.
pub fn rigid_body(mesh: Mesh, assembly: bool) -> Result<RigidBody, BodyFault> {
    let (parts, part_of) = parts(&mesh);
    match crossing::check(&mesh, &part_of, parts.len()) {
        Err(fault @ BodyFault::Overlap { first, second, .. }) => {
            let inward = [first, second].into_iter().find(|&body| parts[body - 1].volume < 0.0);
            return match inward {
                Some(body) => Err(inside_out(&parts, body - 1)),
                None => match union::united(&mesh, &parts, is_sound) {
                    Some(mesh) => Ok(RigidBody { mesh, united: parts.len(), within: 0 }),
                    None => Err(fault),
                },
            };
        }
        checked => checked?,
    }
    let mut kept = vec![true; parts.len()];
    let mut apart = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let around: i64 = (0..parts.len()).filter(|&j| j != i).map(|j| turns(&mesh, &parts[j], part)).sum();
        match (part.volume > 0.0, around > 0) {
            (true, true) => kept[i] = false,
            (true, false) => apart.push(i),
            (false, true) => {}
            (false, false) => return Err(inside_out(&parts, i)),
        }
    }
    if let (Some(&second), false) = (apart.get(1), assembly) {
        if let Some(mesh) = union::joined(&mesh, &parts, is_sound) {
            return Ok(RigidBody { mesh, united: parts.len(), within: 0 });
        }
        let second = &parts[second];
        return Err(BodyFault::Apart {
            count: apart.len(),
            facets: second.facets.len(),
            at: second.at.into(),
        });
    }
    let within = kept.iter().filter(|&&kept| !kept).count();
    if within == 0 {
        return Ok(RigidBody { mesh, united: 0, within });
    }
    let facets = mesh.facets().iter().zip(&part_of).filter(|(_, part)| kept[**part as usize]);
    let facets: Vec<[u32; 3]> = facets.map(|(facet, _)| *facet).collect();
    let mesh = Mesh::new(mesh.vertices().to_vec(), facets).unwrap_or(mesh);
    Ok(RigidBody { mesh, united: 0, within })
}

fn inside_out(parts: &[Part], i: usize) -> BodyFault {
    let (count, facets) = (parts.len(), parts[i].facets.len());
    BodyFault::InsideOut { body: i + 1, count, facets, at: parts[i].at.into() }
}

/// Whether bodies became one piece that crosses itself nowhere.
fn is_sound(mesh: &Mesh) -> bool {
    let (parts, part_of) = parts(mesh);
    let pieces = parts.iter().filter(|part| part.volume > 0.0).count();
    pieces == 1 && crossing::check(mesh, &part_of, parts.len()).is_ok()
}

/// The mesh with every body that lies in no other turned the right way out.
pub fn outward_bodies(mesh: Mesh) -> Mesh {
    let (parts, part_of) = parts(&mesh);
    let inward = |i: usize| {
        let around = (0..parts.len()).filter(|&j| j != i).map(|j| turns(&mesh, &parts[j], &parts[i]).abs());
        parts[i].volume < 0.0 && around.sum::<i64>() == 0
    };
    let inward: Vec<bool> = (0..parts.len()).map(inward).collect();
    if !inward.contains(&true) {
        return mesh;
    }
    let turned = |(f, part): (&[u32; 3], &u32)| if inward[*part as usize] { [f[0], f[2], f[1]] } else { *f };
    let facets = mesh.facets().iter().zip(&part_of).map(turned).collect();
    Mesh::new(mesh.vertices().to_vec(), facets).unwrap_or(mesh)
}

/// The volume (m³; negative where it looks inward) and the facets of each connected surface.
pub(crate) fn facets_of_bodies(mesh: &Mesh) -> Vec<(f64, Vec<u32>)> {
    parts(mesh).0.into_iter().map(|part| (part.volume, part.facets)).collect()
}

/// How many connected surfaces a mesh has.
pub fn body_count(mesh: &Mesh) -> usize {
    parts(mesh).0.len()
}

/// The connected surfaces, and which one each facet belongs to.
fn parts(mesh: &Mesh) -> (Vec<Part>, Vec<u32>) {
    let mut part_of = vec![u32::MAX; mesh.facets().len()];
    let (mut parts, mut open) = (Vec::new(), Vec::new());
    for first in 0..part_of.len() as u32 {
        if part_of[first as usize] != u32::MAX {
            continue;
        }
        let name = parts.len() as u32;
        part_of[first as usize] = name;
        open.push(first);
        let mut facets = Vec::new();
        while let Some(facet) = open.pop() {
            facets.push(facet);
            for neighbor in mesh.neighbors(facet) {
                let place = &mut part_of[neighbor.facet as usize];
                if *place == u32::MAX {
                    *place = name;
                    open.push(neighbor.facet);
                }
            }
        }
        parts.push(part(mesh, facets));
    }
    (parts, part_of)
}

fn part(mesh: &Mesh, facets: Vec<u32>) -> Part {
    let at = mesh.corners(facets[0])[0];
    let (mut volume, mut lower, mut upper) = (0.0, at, at);
    for &facet in &facets {
        let [a, b, c] = mesh.corners(facet).map(|corner| corner - at);
        volume += a.dot(&b.cross(&c)) / 6.0;
        for corner in mesh.corners(facet) {
            (lower, upper) = (lower.inf(&corner), upper.sup(&corner));
        }
    }
    let middle = |&facet: &u32| mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
    let samples = facets.iter().step_by(facets.len().div_ceil(SAMPLES)).map(middle).collect();
    Part { facets, volume, at, samples, lower, upper }
}

/// How often a surface winds around another that does not cross it: 1 around one within a body, -1 within a
/// body that is inside out.
///
/// Where the two touch, points of the one lie on the other, and tell nothing: another point is asked.
fn turns(mesh: &Mesh, part: &Part, other: &Part) -> i64 {
    let is_in_box = |p: &Vec3| (0..3).all(|k| p[k] >= part.lower[k] && p[k] <= part.upper[k]);
    if !other.samples.iter().all(is_in_box) {
        return 0;
    }
    let off = |winding: f64| (winding - winding.round()).abs();
    let mut best = f64::NAN;
    for p in &other.samples {
        let winding = winding(mesh, part, p);
        if best.is_nan() || off(winding) < off(best) {
            best = winding;
        }
        if off(best) < WHOLE {
            break;
        }
    }
    best.round() as i64
}

/// How often a surface winds around a point.
///
/// The sum of the solid angles of its facets (van Oosterom and Strackee, "The solid angle of a plane
/// triangle", IEEE Trans. Biomed. Eng. 1983).
fn winding(mesh: &Mesh, part: &Part, p: &Vec3) -> f64 {
    let angle = |&facet: &u32| {
        let [a, b, c] = mesh.corners(facet).map(|corner| corner - p);
        let (x, y, z) = (a.norm(), b.norm(), c.norm());
        let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
        2.0 * a.dot(&b.cross(&c)).atan2(below)
    };
    part.facets.iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

#[cfg(test)]
mod tests;
