//! `<geom>`: shapes that touch and shapes that are only seen.

use super::Reader;
use super::classes::Styled;
use super::compiler::{Compiler, from_z};
use super::tag::Tag;
use crate::error::RobotFault as Fault;
use crate::robot::{Geometry, Solid};
use regrasp_api::{Pose, Vec3};
use std::collections::BTreeMap;

/// The meshes of `<asset>`, by name.
#[derive(Debug, Default)]
pub(super) struct Meshes(BTreeMap<String, Mesh>);

#[derive(Clone, Debug)]
struct Mesh {
    /// `None` for one that is given in place.
    file: Option<String>,
    scale: [f64; 3],
    is_moved: bool,
}

impl Meshes {
    pub fn new(root: &Tag, reader: &Reader<'_>) -> Result<Self, Fault> {
        let mut meshes = BTreeMap::new();
        for tag in root.all("asset").flat_map(|asset| asset.all("mesh")) {
            let styled = reader.classes.of(tag, None)?;
            let file = tag.own("file").map(|name| path(name, &reader.compiler));
            let stem = tag.own("file").and_then(|name| {
                let last = name.replace('\\', "/").rsplit('/').next()?.to_owned();
                Some(last.rsplit_once('.').map_or(last.clone(), |(stem, _)| stem.to_owned()))
            });
            let Some(name) = tag.own("name").map(str::to_owned).or(stem) else {
                return Err(tag.fault("<mesh> has neither `name` nor `file`"));
            };
            let is_moved = styled.text("refpos").is_some() || styled.text("refquat").is_some();
            let scale = styled.numbers::<3>("scale")?.unwrap_or([1.0; 3]);
            meshes.insert(name, Mesh { file, scale, is_moved });
        }
        Ok(Self(meshes))
    }
}

/// A file of `<asset>`, relative to the MJCF.
fn path(name: &str, compiler: &Compiler) -> String {
    let name = name.replace('\\', "/");
    let name = if compiler.strip_path { name.rsplit('/').next().unwrap_or_default() } else { &name };
    match compiler.mesh_folder.trim_end_matches('/') {
        "" => name.to_owned(),
        _ if name.starts_with('/') => name.to_owned(),
        folder => format!("{folder}/{name}"),
    }
}

/// What a geom is for.
pub(super) enum Role {
    Touches,
    Seen,
    /// An infinite plane, a height field: no part of a hand.
    None(String),
}

/// Whether a geom takes part in contacts.
pub(super) fn role(geom: &Styled<'_>) -> Result<Role, Fault> {
    let kind = kind(geom);
    if ["plane", "hfield", "sdf"].contains(&kind) {
        return Ok(Role::None(kind.to_owned()));
    }
    let mask = |name: &str| Ok::<_, Fault>(geom.number(name)?.unwrap_or(1.0) != 0.0);
    Ok(if mask("contype")? || mask("conaffinity")? { Role::Touches } else { Role::Seen })
}

fn kind<'t>(geom: &'t Styled<'_>) -> &'t str {
    let with_mesh = || if geom.tag.own("mesh").is_some() { "mesh" } else { "sphere" };
    geom.text("type").unwrap_or_else(with_mesh)
}

/// The shape of a geom in its body's frame.
pub(super) fn solid(geom: &Styled<'_>, meshes: &Meshes, compiler: &Compiler) -> Result<Solid, Fault> {
    let line = geom.tag.line;
    let X = compiler.pose(geom)?;
    let kind = kind(geom);
    if kind != "mesh" && geom.text("mesh").is_some() && geom.text("size").is_none() {
        let message = format!(
            "<geom type=\"{kind}\" mesh=…>: fitting a {kind} to a mesh is not done; make it type=\"mesh\""
        );
        return Err(geom.tag.fault(message));
    }
    let (X_LS, geometry) = match kind {
        "sphere" => (X, Geometry::Sphere { radius: sizes::<1>(geom)?[0] }),
        "box" => (X, Geometry::Box { size: sizes::<3>(geom)?.map(|half| 2.0 * half) }),
        "ellipsoid" => (X, Geometry::Ellipsoid { semi_axes: sizes::<3>(geom)? }),
        "capsule" | "cylinder" => {
            let (X, radius, length) = rod(geom, X)?;
            let is_capsule = kind == "capsule";
            let shape = if is_capsule {
                Geometry::Capsule { radius, length }
            } else {
                Geometry::Cylinder { radius, length }
            };
            (X, shape)
        }
        "mesh" => (X, mesh(geom, meshes)?),
        other => return Err(geom.tag.fault(format!("<geom type=\"{other}\"> is no shape that is known"))),
    };
    Ok(Solid { line, X_LS, geometry })
}

/// Pose, radius and length (m) of a shape along z, whose ends may be given.
fn rod(geom: &Styled<'_>, X: Pose) -> Result<(Pose, f64, f64), Fault> {
    match geom.numbers::<6>("fromto")? {
        None => {
            let [radius, half] = sizes::<2>(geom)?;
            Ok((X, radius, 2.0 * half))
        }
        Some([a, b, c, d, e, f]) => {
            let (from, to) = (Vec3::new(a, b, c), Vec3::new(d, e, f));
            let length = (to - from).norm();
            if length < 1e-9 {
                return Err(geom.tag.fault("<geom fromto>: both ends are the same"));
            }
            // MuJoCo's z points from the second end to the first.
            let X = Pose::from_parts(((from + to) / 2.0).into(), from_z(&(from - to)));
            Ok((X, sizes::<1>(geom)?[0], length))
        }
    }
}

/// The first `N` sizes, all positive.
fn sizes<const N: usize>(geom: &Styled<'_>) -> Result<[f64; N], Fault> {
    let given = geom.list("size")?.unwrap_or_default();
    let first = given.get(..N).and_then(|first| <[f64; N]>::try_from(first).ok());
    match first {
        Some(sizes) if sizes.iter().all(|x| *x > 0.0 && *x < 1e3) => Ok(sizes),
        _ => {
            let message = format!(
                "<geom size=\"{}\">: {N} positive numbers are needed (m)",
                geom.text("size").unwrap_or("")
            );
            Err(geom.tag.fault(message))
        }
    }
}

fn mesh(geom: &Styled<'_>, meshes: &Meshes) -> Result<Geometry, Fault> {
    let name = geom.text("mesh").ok_or_else(|| geom.tag.fault("<geom type=\"mesh\"> names no `mesh`"))?;
    let found = meshes.0.get(name);
    let mesh =
        found.ok_or_else(|| geom.tag.fault(format!("there is no <mesh name=\"{name}\"> in <asset>")))?;
    if mesh.is_moved {
        return Err(geom
            .tag
            .fault(format!("the mesh `{name}` has a `refpos` or `refquat`, which is not read")));
    }
    let file = mesh.file.clone().ok_or_else(|| {
        geom.tag
            .fault(format!("the mesh `{name}` is given by `vertex`, which is not read; write it to a file"))
    })?;
    Ok(Geometry::Mesh { file, scale: mesh.scale })
}
