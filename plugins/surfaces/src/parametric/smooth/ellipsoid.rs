//! The ellipsoid.

use super::{SIDES, Smooth};
use regrasp_api::{Vec3, any_orthogonal, slerp_normals};
use std::f64::consts::TAU;

/// An ellipsoid about the origin, along the axes.
#[derive(Clone, Copy, Debug)]
pub(in crate::parametric) struct Ellipsoid {
    /// Half the lengths along the axes (m).
    pub semi_axes: Vec3,
}

impl Ellipsoid {
    /// Half the gradient of Σ xᵢ²/aᵢ².
    fn gradient(&self, p: &Vec3) -> Vec3 {
        p.zip_map(&self.semi_axes, |x, a| x / (a * a))
    }

    /// The direction of a point after the ellipsoid was squeezed to a ball.
    fn squeezed(&self, p: &Vec3) -> Vec3 {
        p.component_div(&self.semi_axes).try_normalize(0.0).unwrap_or(Vec3::z())
    }
}

impl Smooth for Ellipsoid {
    fn normal(&self, p: &Vec3) -> Vec3 {
        self.gradient(p).try_normalize(0.0).unwrap_or(Vec3::z())
    }

    fn turning(&self, p: &Vec3, along: &Vec3) -> Vec3 {
        let gradient = self.gradient(p);
        let size = gradient.norm();
        let (n, change) = (gradient / size, self.gradient(along) / size);
        change - n * n.dot(&change)
    }

    fn curvature(&self, p: &Vec3) -> f64 {
        (self.semi_axes.product() * self.gradient(p).norm_squared()).powi(-2)
    }

    fn pace(&self, p: &Vec3, along: &Vec3) -> f64 {
        // The change of the gradient over its size: besides the normal's turning, how the curvature changes.
        self.gradient(along).norm() / self.gradient(p).norm() + self.curvature(p).sqrt()
    }

    fn onto(&self, p: &Vec3) -> Vec3 {
        self.squeezed(p).component_mul(&self.semi_axes)
    }

    fn joins(&self, p: &Vec3, q: &Vec3) -> bool {
        self.squeezed(p).dot(&self.squeezed(q)) > 0.4
    }

    fn core(&self, _: &Vec3) -> Vec3 {
        Vec3::zeros()
    }

    fn size(&self) -> f64 {
        self.semi_axes.max()
    }

    /// Two arcs of great circles of the squeezed ball that meet on the great circle of equal distance from
    /// both ends.
    fn via(&self, a: &Vec3, b: &Vec3, side: usize) -> impl Fn(f64) -> Vec3 {
        let (u, v) = (self.squeezed(a), self.squeezed(b));
        let apart = v - u;
        let near = (u + v).try_normalize(1e-12).unwrap_or_else(|| any_orthogonal(&u));
        let aside = near.cross(&apart).try_normalize(0.0).unwrap_or_else(|| any_orthogonal(&near));
        let (sin, cos) = (TAU * side as f64 / SIDES as f64).sin_cos();
        let (middle, semi_axes) = (near * cos + aside * sin, self.semi_axes);
        move |t| {
            let (from, to, t) = if t < 0.5 { (u, middle, 2.0 * t) } else { (middle, v, 2.0 * t - 1.0) };
            slerp_normals(&from, &to, t).component_mul(&semi_axes)
        }
    }
}
