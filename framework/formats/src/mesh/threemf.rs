//! 3MF: the meshes that the file builds, in metres.
//!
//! Format: "3MF Core Specification" 1.3, 3MF Consortium: a zip archive with the model as XML. Read are its
//! unit, objects of vertices and triangles or of other objects, and what is built of them with which
//! transforms. Colours, slices and lattices are ignored.

use super::Raw;
use super::gather::Gathered;
use nalgebra::Matrix4;
use regrasp_api::Vec3;
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::BTreeMap;
use std::io::{Cursor, Read};
use zip::ZipArchive;

type Element<'a> = Node<'a, 'a>;

/// The largest model (bytes, unpacked).
const MAX_BYTES: u64 = 1 << 30;
/// The most elements of a model.
const MAX_ELEMENTS: u32 = 10_000_000;

/// Everything that is built.
pub(super) fn parse(bytes: &[u8]) -> Result<Raw, String> {
    let text = model(bytes)?;
    let options = ParsingOptions { nodes_limit: MAX_ELEMENTS, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text.trim_start_matches('\u{feff}'), options)
        .map_err(|error| format!("its model is not well-formed XML: {error}"))?;
    let root = document.root_element();
    let unit = unit(root)?;
    let objects: BTreeMap<&str, Element<'_>> =
        descendants(root, "object").filter_map(|object| Some((object.attribute("id")?, object))).collect();
    let mut reader = Reader { objects, all: Gathered::default() };
    for item in descendants(root, "build").flat_map(|build| children(build, "item")) {
        reader.object(item, &Matrix4::identity(), 0)?;
    }
    let (mut vertices, facets) = reader.all.raw;
    vertices.iter_mut().for_each(|v| *v *= unit);
    Ok((vertices, facets))
}

/// The text of the archive's model.
fn model(bytes: &[u8]) -> Result<String, String> {
    let mut archive = ZipArchive::new(Cursor::new(bytes))
        .map_err(|error| format!("no zip archive, which 3MF is: {error}"))?;
    let mut names: Vec<String> =
        archive.file_names().filter_map(|name| Some(name.ok()?.into_owned())).collect();
    names.retain(|name| name.to_ascii_lowercase().ends_with(".model"));
    names.sort_by_key(|name| (!name.to_ascii_lowercase().ends_with("3d/3dmodel.model"), name.clone()));
    let name = names.first().ok_or("the archive holds no model")?;
    let file = archive.by_name(name).map_err(|error| format!("its model cannot be unpacked: {error}"))?;
    let mut text = String::new();
    file.take(MAX_BYTES)
        .read_to_string(&mut text)
        .map_err(|error| format!("its model cannot be unpacked: {error}"))?;
    Ok(text)
}

/// How many metres the file's unit has.
fn unit(root: Element<'_>) -> Result<f64, String> {
    Ok(match root.attribute("unit").unwrap_or("millimeter") {
        "micron" => 1e-6,
        "millimeter" => 1e-3,
        "centimeter" => 1e-2,
        "inch" => 0.0254,
        "foot" => 0.3048,
        "meter" => 1.0,
        other => return Err(format!("its unit \"{other}\" is not known")),
    })
}

struct Reader<'a> {
    objects: BTreeMap<&'a str, Element<'a>>,
    all: Gathered,
}

impl<'a> Reader<'a> {
    /// Adds the object that an item or a component names.
    fn object(&mut self, user: Element<'a>, above: &Matrix4<f64>, depth: usize) -> Result<(), String> {
        let in_place = |reason| format!("{}: {reason}", place(user));
        self.all.enter(depth).map_err(in_place)?;
        if user.attributes().any(|attribute| attribute.name() == "path") {
            return Err(in_place("its object lies in another part of the archive, which is not read".into()));
        }
        let id = user.attribute("objectid").unwrap_or_default();
        let object = self.objects.get(id).copied();
        let object = object.ok_or_else(|| in_place(format!("there is no object \"{id}\"")))?;
        if object.attribute("type").is_some_and(|kind| ["support", "other"].contains(&kind)) {
            return Ok(());
        }
        let transform = above * transform(user)?;
        for mesh in children(object, "mesh") {
            self.all.add(&self::mesh(mesh)?, &transform).map_err(in_place)?;
        }
        for component in children(object, "components").flat_map(|list| children(list, "component")) {
            self.object(component, &transform, depth + 1)?;
        }
        Ok(())
    }
}

fn mesh(mesh: Element<'_>) -> Result<Raw, String> {
    let vertex = |vertex: Element<'_>| -> Result<Vec3, String> {
        Ok(Vec3::new(number(vertex, "x")?, number(vertex, "y")?, number(vertex, "z")?))
    };
    let all = children(mesh, "vertices").flat_map(|list| children(list, "vertex"));
    let vertices = all.map(vertex).collect::<Result<Vec<_>, _>>()?;
    let corner = |triangle: Element<'_>, name: &str| {
        let index = triangle.attribute(name).and_then(|text| text.trim().parse::<u32>().ok());
        let known = index.filter(|&index| (index as usize) < vertices.len());
        known
            .ok_or_else(|| format!("{}: `{name}` names no vertex of the {}", place(triangle), vertices.len()))
    };
    let facet = |t: Element<'_>| -> Result<[u32; 3], String> {
        Ok([corner(t, "v1")?, corner(t, "v2")?, corner(t, "v3")?])
    };
    let all = children(mesh, "triangles").flat_map(|list| children(list, "triangle"));
    let facets = all.map(facet).collect::<Result<Vec<_>, _>>()?;
    Ok((vertices, facets))
}

/// The twelve numbers of a transform, column by column of a matrix that acts on columns.
fn transform(user: Element<'_>) -> Result<Matrix4<f64>, String> {
    let Some(text) = user.attribute("transform") else { return Ok(Matrix4::identity()) };
    let numbers: Option<Vec<f64>> = text.split_ascii_whitespace().map(|word| word.parse().ok()).collect();
    let numbers = numbers.filter(|all| all.len() == 12 && all.iter().all(|x| x.is_finite()));
    let m = numbers.ok_or_else(|| format!("{}: `transform` needs 12 finite numbers", place(user)))?;
    Ok(Matrix4::new(
        m[0], m[3], m[6], m[9], //
        m[1], m[4], m[7], m[10], //
        m[2], m[5], m[8], m[11], //
        0.0, 0.0, 0.0, 1.0,
    ))
}

fn number(element: Element<'_>, name: &str) -> Result<f64, String> {
    let number = element.attribute(name).and_then(|text| text.trim().parse::<f64>().ok());
    number
        .filter(|x| x.is_finite())
        .ok_or_else(|| format!("{}: `{name}` must be a finite number", place(element)))
}

fn descendants<'a>(element: Element<'a>, name: &'static str) -> impl Iterator<Item = Element<'a>> {
    element.descendants().filter(move |child| child.tag_name().name() == name)
}

fn children<'a>(element: Element<'a>, name: &'static str) -> impl Iterator<Item = Element<'a>> {
    element.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// An element with its line, for messages.
fn place(element: Element<'_>) -> String {
    let line = element.document().text_pos_at(element.range().start).row;
    format!("line {line}: <{}>", element.tag_name().name())
}
