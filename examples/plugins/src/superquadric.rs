//! A surface that knows a closed form: a superquadric fitted to the object tells where to look on the mesh.
//!
//! There is one true surface, the object's mesh: points and normals are the mesh's, whatever closed form
//! stood behind it. So the closed form answers nothing itself: it gives the hint with which projections
//! begin.

use regrasp_api::{
    Build, CallError, Contact, Context, Entry, NoSettings, Projection, Random, Settings, Slot, SurfaceParam,
    SurfacePath, Vec3, check_settings, inventory,
};
use std::f64::consts::{PI, TAU};

/// Cells of the table of hints, round the z axis and along it.
const CELLS: (usize, usize) = (24, 12);

/// ((x/a)^(2/e₂) + (y/b)^(2/e₂))^(e₂/e₁) + (z/c)^(2/e₁) = 1 about a centre (A. Barr, "Superquadrics and
/// angle-preserving transformations", IEEE CG&A 1981, equation 2.10).
struct Superquadric {
    center_O: Vec3,
    semi_axes: Vec3,
    exponents: [f64; 2],
}

impl Superquadric {
    /// The one in the box of some points whose exponents fit them best, and how far they are from it on
    /// average (m).
    fn fit(points: &[Vec3]) -> (Self, f64) {
        let first = points[0];
        let low = points.iter().fold(first, |low, p| low.inf(p));
        let high = points.iter().fold(first, |high, p| high.sup(p));
        let (center_O, semi_axes) = ((low + high) / 2.0, (high - low) / 2.0);
        let steps = || (1..=10).map(|k| 0.2 * f64::from(k));
        let shapes =
            steps().flat_map(|a| steps().map(move |b| Self { center_O, semi_axes, exponents: [a, b] }));
        let off = |shape: &Self| points.iter().map(|p| shape.distance(p)).sum::<f64>() / points.len() as f64;
        let best = shapes.map(|shape| (off(&shape), shape)).min_by(|a, b| a.0.total_cmp(&b.0));
        let (off, shape) = best.expect("a hundred shapes are tried");
        (shape, off)
    }

    /// How much longer a vector from the centre is than that to the surface in its direction.
    fn stretch(&self, v: &Vec3) -> f64 {
        let [e1, e2] = self.exponents;
        let [x, y, z] = v.component_div(&self.semi_axes).abs().into();
        let level = (x.powf(2.0 / e2) + y.powf(2.0 / e2)).powf(e2 / e1) + z.powf(2.0 / e1);
        level.powf(e1 / 2.0)
    }

    /// The distance of a point along its ray (A. Gross, T. Boult, "Error of fit measures for recovering
    /// parametric solids", ICCV 1988).
    fn distance(&self, p: &Vec3) -> f64 {
        let v = p - self.center_O;
        v.norm() * (1.0 - 1.0 / self.stretch(&v).max(1e-9)).abs()
    }

    /// The surface's point in a direction.
    fn at(&self, direction: &Vec3) -> Vec3 {
        self.center_O + direction / self.stretch(direction)
    }
}

/// The default surface, which begins to look where the superquadric says.
struct Guided {
    inner: Box<dyn SurfaceParam>,
    center_O: Vec3,
    /// The facet of the contact nearest to the superquadric's point in each cell's direction.
    hints: Vec<u32>,
    /// How far the mesh is from the superquadric on average (m).
    fit: f64,
}

fn cell(v: &Vec3) -> usize {
    let part = |x: f64, count: usize| ((x * count as f64) as usize).min(count - 1);
    let round = part(v.y.atan2(v.x) / TAU + 0.5, CELLS.0);
    let along = part((v.z / v.norm().max(1e-12)).clamp(-1.0, 1.0).acos() / PI, CELLS.1);
    round * CELLS.1 + along
}

fn middle(k: usize) -> Vec3 {
    let round = ((k / CELLS.1) as f64 + 0.5) / CELLS.0 as f64 * TAU - PI;
    let along = ((k % CELLS.1) as f64 + 0.5) / CELLS.1 as f64 * PI;
    Vec3::new(along.sin() * round.cos(), along.sin() * round.sin(), along.cos())
}

impl SurfaceParam for Guided {
    fn sample(&self, random: &mut Random) -> Contact {
        self.inner.sample(random)
    }

    fn geodesic(
        &self,
        from: &Contact,
        to: &Contact,
        path: &mut SurfacePath,
        context: &mut Context<'_>,
    ) -> Result<bool, CallError> {
        // The wrapped surface counts the call.
        context.note(Slot::Surface, "superquadric_fit", self.fit);
        self.inner.geodesic(from, to, path, context)
    }

    fn project(&self, p_OF: &Vec3, hint: Option<u32>) -> Projection {
        let hint = hint.unwrap_or_else(|| self.hints[cell(&(p_OF - self.center_O))]);
        self.inner.project(p_OF, Some(hint))
    }

    fn walk(&self, from: &Contact, direction_O: &Vec3, distance: f64) -> Contact {
        self.inner.walk(from, direction_O, distance)
    }

    fn edge_distance(&self, contact: &Contact) -> f64 {
        self.inner.edge_distance(contact)
    }
}

/// How the plugin presents itself.
pub const ENTRY: Entry = Entry {
    id: "surface/superquadric",
    slots: &[Slot::Surface],
    summary: "the default surface, whose projections begin where a fitted superquadric says",
    references: &["Barr, Superquadrics and angle-preserving transformations, CG&A 1981"],
    schema: NoSettings::schema,
    check: check_settings::<NoSettings>,
    build: Build::Surface(|json, parts| {
        NoSettings::from_json(json)?;
        let inner = parts.plugins.surface(None, "", parts)?;
        let (shape, fit) = Superquadric::fit(parts.object.mesh.vertices());
        let facet = |k| inner.project(&shape.at(&middle(k)), None).contact.facet;
        let hints = (0..CELLS.0 * CELLS.1).map(facet).collect();
        Ok(Box::new(Guided { inner, center_O: shape.center_O, hints, fit }))
    }),
};
inventory::submit! { ENTRY }
