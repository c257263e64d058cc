//! Reading XML: elements with their lines, attributes as text and numbers.

use crate::error::RobotFault as Fault;
use roxmltree::{Document, Node, ParsingOptions};

pub(crate) type Element<'a> = Node<'a, 'a>;

/// The most elements, texts and comments of a file: above this it describes no hand.
const MOST_NODES: u32 = 5_000_000;

/// No number of a robot's file is larger.
pub(crate) const LARGEST: f64 = 1e9;

/// What to do with a file of macros.
pub(crate) const EXPAND: &str =
    "a xacro file must be expanded first, as by `xacro hand.urdf.xacro > hand.urdf`";

/// Parses a document; a DOCTYPE is allowed, and nothing that it names is fetched.
pub(crate) fn parse(text: &str) -> Result<Document<'_>, Fault> {
    let options = ParsingOptions { allow_dtd: true, nodes_limit: MOST_NODES, ..Default::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let hint = if text.contains("xacro") { format!("; {EXPAND}") } else { String::new() };
        Fault::at(error.pos().row as usize, format!("not well-formed XML: {error}{hint}"))
    })
}

/// The line of an element, counted from 1.
pub(crate) fn line(element: &Element<'_>) -> usize {
    element.document().text_pos_at(element.range().start).row as usize
}

/// The children of this name.
pub(crate) fn children<'a>(element: &Element<'a>, name: &'static str) -> impl Iterator<Item = Element<'a>> {
    element.children().filter(move |child| child.is_element() && child.tag_name().name() == name)
}

/// The only child of this name; a second one is refused, since which of them counts nobody knows.
pub(crate) fn child<'a>(element: &Element<'a>, name: &'static str) -> Result<Option<Element<'a>>, Fault> {
    let mut all = children(element, name);
    let first = all.next();
    match all.next() {
        None => Ok(first),
        Some(second) => {
            let tag = element.tag_name().name();
            let message = format!("a second <{name}> in one <{tag}>: which of them counts? remove one");
            Err(Fault::at(line(&second), message))
        }
    }
}

/// A required attribute.
pub(crate) fn text(element: &Element<'_>, name: &str) -> Result<String, Fault> {
    let given = element.attribute(name).map(|text| text.trim().to_owned()).filter(|text| !text.is_empty());
    given.ok_or_else(|| {
        let tag = element.tag_name().name();
        Fault::at(line(element), format!("<{tag}> lacks the attribute `{name}`"))
    })
}

/// Numbers of an attribute, exactly `N` of them and all finite; `None` where it is absent.
pub(crate) fn numbers<const N: usize>(element: &Element<'_>, name: &str) -> Result<Option<[f64; N]>, Fault> {
    let Some(all) = list(element, name)? else { return Ok(None) };
    all.try_into().map(Some).map_err(|_| wrong(element, name, N))
}

/// Any count of numbers of an attribute, all finite; `None` where it is absent.
pub(crate) fn list(element: &Element<'_>, name: &str) -> Result<Option<Vec<f64>>, Fault> {
    let Some(text) = element.attribute(name) else { return Ok(None) };
    let read = text.split_whitespace().map(|word| word.parse::<f64>().ok().filter(|x| x.is_finite()));
    let all = read.collect::<Option<Vec<f64>>>().ok_or_else(|| wrong(element, name, 0))?;
    match all.iter().find(|x| x.abs() > LARGEST) {
        None => Ok(Some(all)),
        Some(&x) => {
            let (tag, most) = (element.tag_name().name(), LARGEST);
            let message = format!("<{tag} {name}>: {x:e} is outside -{most:e}..={most:e}");
            Err(Fault::at(line(element), message))
        }
    }
}

/// The refusal of an attribute that is not so many numbers (0: any count).
pub(crate) fn wrong(element: &Element<'_>, name: &str, count: usize) -> Fault {
    let wanted = match count {
        0 => "finite numbers",
        1 => "one finite number",
        2 => "two finite numbers",
        3 => "three finite numbers",
        4 => "four finite numbers",
        _ => "as many finite numbers as it needs",
    };
    let text = element.attribute(name).unwrap_or_default();
    let tag = element.tag_name().name();
    let hint = if text.contains(',') { ", with blanks between them, no commas" } else { "" };
    Fault::at(line(element), format!("<{tag} {name}=\"{text}\">: it must be {wanted}{hint}"))
}

/// A number of an attribute; `None` where it is absent.
pub(crate) fn number(element: &Element<'_>, name: &str) -> Result<Option<f64>, Fault> {
    Ok(numbers::<1>(element, name)?.map(|[x]| x))
}

/// Refuses a length that is not in (0, 1000) m.
pub(crate) fn positive(element: &Element<'_>, name: &str, value: f64) -> Result<f64, Fault> {
    if value > 0.0 && value < 1e3 {
        return Ok(value);
    }
    let tag = element.tag_name().name();
    let message = format!("<{tag}>: `{name}` = {value} m is outside (0, 1000); lengths are in metres");
    Err(Fault::at(line(element), message))
}

/// `line 3` or `lines 3, 9, … (40 in all)`.
pub(crate) fn places(lines: &[usize]) -> String {
    const SHOWN: usize = 12;
    let shown: Vec<String> = lines.iter().take(SHOWN).map(usize::to_string).collect();
    match lines.len() {
        1 => format!("line {}", shown[0]),
        count if count <= SHOWN => format!("lines {}", shown.join(", ")),
        count => format!("lines {}, … ({count} in all)", shown.join(", ")),
    }
}
