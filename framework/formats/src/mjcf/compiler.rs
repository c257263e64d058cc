//! Settings of the whole file, and the poses that depend on them.

use super::classes::Styled;
use super::tag::Tag;
use crate::error::RobotFault as Fault;
use nalgebra::{Matrix3, Rotation3, Unit};
use regrasp_api::{Pose, Rotation, Vec3};

/// `<compiler>`; those of included files count too, the last one where they differ.
#[derive(Debug)]
pub(super) struct Compiler {
    degrees: bool,
    euler: [char; 3],
    pub mesh_folder: String,
    pub strip_path: bool,
    pub auto_limits: bool,
}

impl Compiler {
    pub fn new(root: &Tag) -> Result<Self, Fault> {
        let mut compiler = Self {
            degrees: true,
            euler: ['x', 'y', 'z'],
            mesh_folder: String::new(),
            strip_path: false,
            auto_limits: true,
        };
        let mut assets = None;
        for tag in root.all("compiler") {
            compiler.read(tag)?;
            assets = tag.own("assetdir").map(str::to_owned).or(assets);
        }
        if compiler.mesh_folder.is_empty() {
            compiler.mesh_folder = assets.unwrap_or_default();
        }
        Ok(compiler)
    }

    fn read(&mut self, tag: &Tag) -> Result<(), Fault> {
        let wrong = |name: &str, value: &str, known: &str| {
            tag.fault(format!("<compiler {name}=\"{value}\">: it must be {known}"))
        };
        for (name, value) in &tag.attributes {
            match (name.as_str(), value.trim()) {
                ("angle", "degree") => self.degrees = true,
                ("angle", "radian") => self.degrees = false,
                ("angle", value) => return Err(wrong("angle", value, "`degree` or `radian`")),
                ("coordinate", "local") => {}
                ("coordinate", value) => return Err(wrong("coordinate", value, "`local`")),
                ("eulerseq", value) => {
                    let letters: Option<[char; 3]> = value.chars().collect::<Vec<_>>().try_into().ok();
                    let known = letters.filter(|all| all.iter().all(|c| "xyzXYZ".contains(*c)));
                    self.euler =
                        known.ok_or_else(|| wrong("eulerseq", value, "three of x, y, z, X, Y, Z"))?;
                }
                ("meshdir", value) => self.mesh_folder = value.to_owned(),
                ("strippath", value) => self.strip_path = value == "true",
                ("autolimits", value) => self.auto_limits = value == "true",
                _ => {}
            }
        }
        Ok(())
    }

    /// An angle of the file (rad).
    pub fn angle(&self, value: f64) -> f64 {
        if self.degrees { value.to_radians() } else { value }
    }

    /// The pose of an element in the frame around it.
    pub fn pose(&self, tag: &Styled<'_>) -> Result<Pose, Fault> {
        let p = Vec3::from(tag.numbers::<3>("pos")?.unwrap_or_default());
        Ok(Pose::from_parts(p.into(), self.rotation(tag)?))
    }

    fn rotation(&self, tag: &Styled<'_>) -> Result<Rotation, Fault> {
        let zero = |name: &str| tag.tag.fault(format!("<{} {name}> must not be zero", tag.tag.name));
        if let Some([w, x, y, z]) = tag.numbers::<4>("quat")? {
            let q = nalgebra::Quaternion::new(w, x, y, z);
            return if q.norm() < 1e-9 { Err(zero("quat")) } else { Ok(Rotation::from_quaternion(q)) };
        }
        if let Some([x, y, z, angle]) = tag.numbers::<4>("axisangle")? {
            let axis = Unit::try_new(Vec3::new(x, y, z), 1e-12).ok_or_else(|| zero("axisangle"))?;
            return Ok(Rotation::from_axis_angle(&axis, self.angle(angle)));
        }
        if let Some(angles) = tag.numbers::<3>("euler")? {
            return Ok(self.euler(angles));
        }
        if let Some([a, b, c, d, e, f]) = tag.numbers::<6>("xyaxes")? {
            let x = Vec3::new(a, b, c).try_normalize(1e-12).ok_or_else(|| zero("xyaxes"))?;
            let y = Vec3::new(d, e, f);
            let y = (y - x * x.dot(&y)).try_normalize(1e-12).ok_or_else(|| zero("xyaxes"))?;
            let R = Matrix3::from_columns(&[x, y, x.cross(&y)]);
            return Ok(Rotation::from_rotation_matrix(&Rotation3::from_matrix_unchecked(R)));
        }
        if let Some([x, y, z]) = tag.numbers::<3>("zaxis")? {
            let to = Vec3::new(x, y, z);
            return if to.norm() < 1e-12 { Err(zero("zaxis")) } else { Ok(from_z(&to)) };
        }
        Ok(Rotation::identity())
    }

    fn euler(&self, angles: [f64; 3]) -> Rotation {
        let turns = self.euler.iter().zip(angles);
        turns.fold(Rotation::identity(), |R, (axis, angle)| {
            let about = match axis.to_ascii_lowercase() {
                'x' => Vec3::x_axis(),
                'y' => Vec3::y_axis(),
                _ => Vec3::z_axis(),
            };
            let turn = Rotation::from_axis_angle(&about, self.angle(angle));
            // Small letters turn about the moved axes, capitals about the fixed ones.
            if axis.is_ascii_lowercase() { R * turn } else { turn * R }
        })
    }
}

/// The smallest turn that takes z to a direction.
pub(super) fn from_z(to: &Vec3) -> Rotation {
    Rotation::rotation_between(&Vec3::z(), to)
        .unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI))
}
