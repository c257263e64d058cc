//! COLLADA (`.dae`): the triangles and polygons of its scene, in metres.
//!
//! Format: "COLLADA – Digital Asset Schema Release 1.4.1", Khronos Group, 2008. Read are geometries of type
//! `<mesh>`, the nodes of the visual scene with their transforms, and the asset's `<unit>`. As in ROS, where
//! most such files of robots come from, `<up_axis>` does not turn the mesh: its coordinates are those of the
//! link. Materials, lights, skins and animations are ignored.

mod geometry;
mod scene;

use super::Raw;
use crate::decode::decode;
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::BTreeMap;

type Element<'a> = Node<'a, 'a>;

/// The most elements of a file: each costs memory, large meshes have few.
const MAX_ELEMENTS: u32 = 10_000_000;

/// The whole scene, or where there is none every geometry as it is.
pub(super) fn parse(bytes: &[u8]) -> Result<Raw, String> {
    let text = decode(bytes).map_err(|fault| fault.message)?;
    let options = ParsingOptions { nodes_limit: MAX_ELEMENTS, allow_dtd: true, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text.trim_start_matches('\u{feff}'), options)
        .map_err(|error| format!("not well-formed XML: {error}"))?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        return Err(format!("the outermost element is <{}>, not <COLLADA>", root.tag_name().name()));
    }
    let file = File { root, by_id: ids(root) };
    let (mut vertices, facets) = scene::read(&file)?;
    let unit = file.unit()?;
    vertices.iter_mut().for_each(|v| *v *= unit);
    if !vertices.iter().all(|v| v.iter().all(|x| x.is_finite())) {
        return Err("a coordinate is not finite".into());
    }
    Ok((vertices, facets))
}

/// The file's elements.
struct File<'a> {
    root: Element<'a>,
    by_id: BTreeMap<&'a str, Element<'a>>,
}

fn ids<'a>(root: Element<'a>) -> BTreeMap<&'a str, Element<'a>> {
    root.descendants().filter_map(|element| Some((element.attribute("id")?, element))).collect()
}

impl<'a> File<'a> {
    /// What `attribute` of an element, a reference like `#name`, names.
    fn target(&self, element: Element<'a>, attribute: &str) -> Result<Element<'a>, String> {
        let url = element.attribute(attribute).unwrap_or_default();
        let named = url.strip_prefix('#').and_then(|id| self.by_id.get(id)).copied();
        named
            .ok_or_else(|| format!("{}: `{attribute}` = \"{url}\" names nothing in the file", place(element)))
    }

    /// How many metres the file's unit has.
    fn unit(&self) -> Result<f64, String> {
        let unit = child(self.root, "asset").and_then(|asset| child(asset, "unit"));
        let Some(text) = unit.and_then(|unit| unit.attribute("meter")) else { return Ok(1.0) };
        let meter: Option<f64> = text.trim().parse().ok();
        meter
            .filter(|meter| (1e-9..=1e6).contains(meter))
            .ok_or_else(|| format!("<unit meter=\"{text}\">: it must be a number of metres in 1e-9..=1e6"))
    }
}

fn child<'a>(element: Element<'a>, name: &str) -> Option<Element<'a>> {
    children(element, name).next()
}

fn children<'a>(element: Element<'a>, name: &str) -> impl Iterator<Item = Element<'a>> {
    element.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// An element with its line, for messages.
fn place(element: Element<'_>) -> String {
    let line = element.document().text_pos_at(element.range().start).row;
    format!("line {line}: <{}>", element.tag_name().name())
}

/// The numbers of an element's text.
fn numbers<T: std::str::FromStr>(element: Element<'_>) -> Result<Vec<T>, String> {
    let read = |word: &str| word.parse().map_err(|_| format!("{}: `{word}` is no number", place(element)));
    element
        .children()
        .filter_map(|part| part.text())
        .flat_map(str::split_ascii_whitespace)
        .map(read)
        .collect()
}
