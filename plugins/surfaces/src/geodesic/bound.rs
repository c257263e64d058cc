//! Lower bounds of the way that is left to the target.

use crate::polyhedron::{HalfEdge, Planar};
use regrasp_api::Vec3;
use std::marker::PhantomData;

/// Lower bounds (m) of surface paths to one target.
#[derive(Clone, Copy, Debug)]
pub(super) struct LowerBound<'a> {
    p_OT: Vec3,
    prepared: PhantomData<&'a ()>,
}

impl LowerBound<'_> {
    pub fn new(p_OT: Vec3) -> Self {
        Self { p_OT, prepared: PhantomData }
    }

    /// Of paths that leave a point.
    pub fn of_point(&self, p_OP: &Vec3) -> f64 {
        (p_OP - self.p_OT).norm()
    }

    /// Of paths that come straight from an unfolded source through a part of an edge.
    pub fn through(&self, _frame: &HalfEdge, _source: &Planar, _ends: [f64; 2], _so_far: f64) -> f64 {
        0.0
    }
}
