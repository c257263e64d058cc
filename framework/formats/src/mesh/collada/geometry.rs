//! One geometry: its positions, and its primitives as triangles.

use super::super::polygon::triangulate;
use super::super::{Raw, check_count};
use super::{Element, File, child, children, numbers, place};
use regrasp_api::Vec3;

/// The triangles of a `<geometry>`, in its own frame and the file's unit; empty where it is no `<mesh>` or
/// has only lines.
pub(super) fn read(file: &File<'_>, geometry: Element<'_>) -> Result<Raw, String> {
    let Some(mesh) = child(geometry, "mesh") else { return Ok((Vec::new(), Vec::new())) };
    let (mut vertices, mut facets) = (Vec::new(), Vec::new());
    for primitive in mesh.children().filter(|child| child.is_element()) {
        let Some(kind) = Kind::of(primitive) else { continue };
        let (offset, stride, points) = inputs(file, primitive)?;
        let first = vertices.len() as u32;
        let count = points.len() as u32;
        vertices.extend(points);
        for polygon in kind.polygons(primitive, offset, stride)? {
            if let Some(bad) = polygon.iter().find(|&&corner| corner >= count) {
                return Err(format!("{}: corner {bad} of only {count}", place(primitive)));
            }
            let corners: Vec<u32> = polygon.iter().map(|corner| first + corner).collect();
            kind.cut(&corners, &vertices, &mut facets);
            check_count(facets.len())?;
        }
    }
    Ok((vertices, facets))
}

/// How a primitive lists its corners.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Triangles,
    Strips,
    Fans,
    /// One polygon after the other, their numbers of corners in `<vcount>`.
    List,
    /// One `<p>` for each polygon.
    Polygons,
}

impl Kind {
    fn of(primitive: Element<'_>) -> Option<Self> {
        Some(match primitive.tag_name().name() {
            "triangles" => Self::Triangles,
            "tristrips" => Self::Strips,
            "trifans" => Self::Fans,
            "polylist" => Self::List,
            "polygons" => Self::Polygons,
            _ => return None,
        })
    }

    /// The corners of each polygon, strip or fan.
    fn polygons(self, primitive: Element<'_>, offset: usize, stride: usize) -> Result<Vec<Vec<u32>>, String> {
        let corners = |p: Element<'_>| -> Result<Vec<u32>, String> {
            Ok(numbers::<u32>(p)?.chunks_exact(stride).map(|corner| corner[offset]).collect())
        };
        let mut all = children(primitive, "p").map(corners).collect::<Result<Vec<_>, _>>()?;
        for outline in children(primitive, "ph") {
            if children(outline, "h").any(|hole| hole.text().is_some_and(|text| !text.trim().is_empty())) {
                return Err(format!(
                    "{}: a polygon with holes; export the mesh as triangles",
                    place(outline)
                ));
            }
            all.extend(children(outline, "p").map(corners).collect::<Result<Vec<_>, _>>()?);
        }
        match self {
            Self::Strips | Self::Fans | Self::Polygons => Ok(all),
            Self::Triangles => Ok(all
                .iter()
                .flatten()
                .copied()
                .collect::<Vec<_>>()
                .chunks_exact(3)
                .map(<[u32]>::to_vec)
                .collect()),
            Self::List => {
                let Some(counts) = child(primitive, "vcount") else {
                    return Err(format!("{} lacks its <vcount>", place(primitive)));
                };
                let all: Vec<u32> = all.into_iter().flatten().collect();
                let mut rest = &all[..];
                let mut polygons = Vec::new();
                for count in numbers::<usize>(counts)? {
                    let Some((polygon, after)) = rest.split_at_checked(count) else {
                        return Err(format!(
                            "{}: <vcount> wants more corners than <p> has",
                            place(primitive)
                        ));
                    };
                    polygons.push(polygon.to_vec());
                    rest = after;
                }
                Ok(polygons)
            }
        }
    }

    /// Appends the triangles of one of them.
    fn cut(self, corners: &[u32], vertices: &[Vec3], facets: &mut Vec<[u32; 3]>) {
        match self {
            _ if corners.len() < 3 => {}
            Self::Strips => facets.extend(corners.windows(3).enumerate().map(|(i, w)| match i % 2 {
                0 => [w[0], w[1], w[2]],
                _ => [w[1], w[0], w[2]],
            })),
            Self::Fans => facets.extend(corners[1..].windows(2).map(|w| [corners[0], w[0], w[1]])),
            Self::Triangles | Self::List | Self::Polygons => triangulate(corners, vertices, facets),
        }
    }
}

/// Where the corner's position stands among the indices of a corner, how many indices a corner has, and the
/// positions.
fn inputs(file: &File<'_>, primitive: Element<'_>) -> Result<(usize, usize, Vec<Vec3>), String> {
    let (mut stride, mut found) = (1, None);
    for input in children(primitive, "input") {
        let offset: usize = input
            .attribute("offset")
            .unwrap_or("0")
            .trim()
            .parse()
            .ok()
            .filter(|&offset| offset < 64)
            .ok_or_else(|| format!("{}: its `offset` must be a whole number below 64", place(input)))?;
        stride = stride.max(offset + 1);
        if input.attribute("semantic") == Some("VERTEX") {
            found = Some((offset, file.target(input, "source")?));
        }
    }
    let Some((offset, shared)) = found else {
        return Err(format!("{} lacks its <input semantic=\"VERTEX\">", place(primitive)));
    };
    let position = children(shared, "input").find(|input| input.attribute("semantic") == Some("POSITION"));
    let Some(position) = position else {
        return Err(format!("{} lacks its <input semantic=\"POSITION\">", place(shared)));
    };
    Ok((offset, stride, positions(file, file.target(position, "source")?)?))
}

/// The points of a `<source>`.
fn positions(file: &File<'_>, source: Element<'_>) -> Result<Vec<Vec3>, String> {
    let accessor = child(source, "technique_common").and_then(|common| child(common, "accessor"));
    let array = match accessor {
        Some(accessor) => file.target(accessor, "source")?,
        None => child(source, "float_array").ok_or_else(|| format!("{} has no numbers", place(source)))?,
    };
    let given = |name: &str, default: usize| -> Result<usize, String> {
        let Some((accessor, text)) = accessor.and_then(|a| Some((a, a.attribute(name)?))) else {
            return Ok(default);
        };
        text.trim().parse().map_err(|_| format!("{}: `{name}` = \"{text}\" is no number", place(accessor)))
    };
    let (stride, offset) = (given("stride", 3)?, given("offset", 0)?);
    let all = numbers::<f64>(array)?;
    let places = accessor.map_or(Ok([0, 1, 2]), axes)?;
    if stride <= *places.iter().max().unwrap_or(&2) || offset > all.len() {
        return Err(format!("{}: points need three numbers each", place(source)));
    }
    Ok(all[offset..]
        .chunks(stride)
        .filter_map(|p| Some(Vec3::new(*p.get(places[0])?, *p.get(places[1])?, *p.get(places[2])?)))
        .collect())
}

/// Where x, y and z stand among the numbers of a point: as its parameters are called, those without a name
/// being left out.
fn axes(accessor: Element<'_>) -> Result<[usize; 3], String> {
    let named: Vec<(usize, &str)> = children(accessor, "param")
        .enumerate()
        .filter_map(|(i, param)| Some((i, param.attribute("name")?)))
        .collect();
    let place_of = |axis: &str| named.iter().find(|(_, name)| name.eq_ignore_ascii_case(axis)).map(|p| p.0);
    match (place_of("x"), place_of("y"), place_of("z"), &named[..]) {
        (Some(x), Some(y), Some(z), _) => Ok([x, y, z]),
        (.., []) => Ok([0, 1, 2]),
        (.., [a, b, c, ..]) => Ok([a.0, b.0, c.0]),
        _ => Err(format!("{}: points need three parameters with names", place(accessor))),
    }
}
