//! Palm and obstacles: bodies fixed to the hand's frame H.

use super::apart::farther;
use super::body::Placed;
use super::convex::{Convex, Verdict};
use super::exact::Solid;
use super::field::Field;
use super::object::ObjectBody;
use super::rod::{Bounds, Rod};
use crate::error::WorldError;
use crate::hand::{ChainHand, LinkFrame};
use regrasp_api::{Body, Pose, Vec3};

/// One solid of the palm or an obstacle.
pub(crate) struct Fixed {
    pub body: Body,
    pub placed: Placed,
    /// The solid's frame S in H.
    X_HS: LinkFrame,
    bounds: Bounds,
    shape: FixedShape,
}

enum FixedShape {
    Rod(Rod),
    HalfSpace { normal: Vec3, offset: f64 },
    Cuboid { bound: Convex, half_size: Vec3 },
    Mesh(Field),
}

impl Fixed {
    /// `wide`: the largest radius of a rod that will be asked about, and the clearance (m).
    pub fn new(body: Body, placed: Placed, wide: f64) -> Self {
        let shape = match &placed.solid {
            Solid::Rod(rod) => FixedShape::Rod(*rod),
            Solid::HalfSpace { normal, offset } => FixedShape::HalfSpace { normal: *normal, offset: *offset },
            Solid::Cuboid { half_size } => {
                FixedShape::Cuboid { bound: Convex::cuboid(*half_size), half_size: *half_size }
            }
            Solid::Mesh(mesh) => FixedShape::Mesh(Field::new(mesh.clone(), wide)),
        };
        Self { body, X_HS: (&placed.X_BS).into(), bounds: placed.bounds(), placed, shape }
    }

    /// Whether what the box `bounds` (in H) holds is certainly farther than `clear` (m).
    #[inline]
    pub fn clear_of_bounds(&self, bounds: &Bounds, clear: f64) -> bool {
        self.bounds.clear_of(bounds, clear)
    }

    /// Whether a rod, given in H, is farther than `clear` (m); exact.
    pub fn clear_of_rod(&self, rod: &Rod, clear: f64) -> bool {
        let verdict = match &self.shape {
            FixedShape::Rod(own) => return own.clear_of(rod, clear),
            FixedShape::HalfSpace { normal, offset } => {
                return normal.dot(&rod.a).min(normal.dot(&rod.b)) - offset > rod.radius + clear;
            }
            FixedShape::Cuboid { bound, .. } => bound.verdict(&rod.seen_from(&self.X_HS), clear),
            FixedShape::Mesh(field) => field.verdict(&rod.seen_from(&self.X_HS), clear),
        };
        match verdict {
            Verdict::Free => true,
            Verdict::Close => false,
            Verdict::Unknown => self.is_farther(&Solid::Rod(*rod), &Pose::identity(), clear),
        }
    }

    /// Whether a solid at `X_HS` is farther than `clear` (m); exact.
    pub fn is_farther(&self, solid: &Solid, X_HS: &Pose, clear: f64) -> bool {
        farther(&self.placed.solid, &self.placed.X_BS, solid, X_HS, clear)
    }

    /// Whether the object is farther than `clear` (m); exact. `frame` is `X_HO` with its rotation as a
    /// matrix.
    pub fn clear_of_object(&self, object: &ObjectBody, X_HO: &Pose, frame: &LinkFrame, clear: f64) -> bool {
        let p_HMiddle = frame.point(&object.p_OMiddle);
        if self.bounds.distance(&p_HMiddle) > object.radius + clear {
            return true;
        }
        match &self.shape {
            FixedShape::Rod(rod) => return object.clear_of_rod(&rod.seen_from(frame), clear),
            FixedShape::HalfSpace { normal, offset } => {
                let n_O = frame.R_HL.tr_mul(normal);
                let least = clear + offset - normal.dot(&frame.p_HL);
                return -object.height(&-n_O) > least || object.lowest(&n_O) > least;
            }
            FixedShape::Cuboid { half_size, .. }
                if self.a_side_separates(half_size, object, frame, clear) =>
            {
                return true;
            }
            FixedShape::Mesh(field) => {
                let p_SMiddle = Rod::ball(p_HMiddle, 0.0).seen_from(&self.X_HS).a;
                if field.lower(&p_SMiddle) > object.radius + clear {
                    return true;
                }
            }
            FixedShape::Cuboid { .. } => (),
        }
        self.is_farther(&object.solid, X_HO, clear)
    }

    /// Whether a plane parallel to a side of the box, or square to the line between the centres, keeps the
    /// object away.
    fn a_side_separates(&self, half_size: &Vec3, object: &ObjectBody, frame: &LinkFrame, clear: f64) -> bool {
        let p_SO = self.X_HS.R_HL.tr_mul(&(frame.p_HL - self.X_HS.p_HL));
        let p_SMiddle = Rod::ball(frame.point(&object.p_OMiddle), 0.0).seen_from(&self.X_HS).a;
        let R_SO = self.X_HS.R_HL.tr_mul(&frame.R_HL);
        let separates = |n_S: Vec3| {
            let n_O = R_SO.tr_mul(&n_S);
            let least = clear + half_size.dot(&n_S.abs()) - n_S.dot(&p_SO);
            -object.height(&-n_O) > least || object.lowest(&n_O) > least
        };
        let toward = (p_SMiddle - p_SMiddle.sup(&-half_size).inf(half_size)).try_normalize(0.0);
        let sides = [Vec3::x(), Vec3::y(), Vec3::z()].into_iter().zip(p_SMiddle.iter());
        // Beyond no other side is the object's middle farther away.
        let beyond = |&(axis, side): &(Vec3, &f64)| side.abs() - half_size.dot(&axis);
        let side = sides.max_by(|a, b| beyond(a).total_cmp(&beyond(b)));
        side.is_some_and(|(axis, side)| separates(axis * side.signum())) || toward.is_some_and(separates)
    }
}

/// The palm alone.
pub(crate) struct Palm(Vec<Fixed>);

impl Palm {
    /// `wide`: the largest radius of a ball that will be asked about, and the clearance (m).
    pub fn new(hand: &ChainHand, wide: f64) -> Result<Self, WorldError> {
        let palm = Placed::read_all(hand.palm_shapes(), "hand.palm")?;
        Ok(Self(palm.into_iter().map(|placed| Fixed::new(Body::Palm, placed, wide)).collect()))
    }

    /// Whether a ball at `p_HB` is farther than `clear` (m) from all of the palm.
    pub fn is_clear_of(&self, p_HB: Vec3, radius: f64, clear: f64) -> bool {
        self.0.iter().all(|solid| solid.clear_of_rod(&Rod::ball(p_HB, radius), clear))
    }
}
