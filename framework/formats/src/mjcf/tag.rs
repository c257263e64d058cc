//! The elements of an MJCF file with those of the files that it includes.

use crate::decode::read_xml;
use crate::error::RobotFault as Fault;
use crate::xml::{LARGEST, line, parse};
use std::path::{Path, PathBuf};

/// How deep files may include each other.
const DEEPEST: usize = 16;
/// The most elements of all files together.
const MOST: usize = 1_000_000;

/// An element.
#[derive(Clone, Debug, Default)]
pub(super) struct Tag {
    pub name: String,
    pub attributes: Vec<(String, String)>,
    pub children: Vec<Tag>,
    /// The line in its own file, counted from 1.
    pub line: usize,
}

impl Tag {
    pub fn own(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(key, _)| key == name).map(|(_, value)| value.trim())
    }

    /// The children of this name.
    pub fn all<'t>(&'t self, name: &'static str) -> impl Iterator<Item = &'t Tag> + use<'t> {
        self.children.iter().filter(move |child| child.name == name)
    }

    /// The numbers that an attribute's text holds, all finite and of a size that a robot's have.
    pub fn numbers_of(&self, name: &str, text: &str) -> Result<Vec<f64>, Fault> {
        let known = |x: &f64| x.abs() <= LARGEST;
        let read = text.split_whitespace().map(|word| word.parse::<f64>().ok().filter(known));
        read.collect::<Option<_>>().ok_or_else(|| {
            let most = LARGEST;
            let tag = &self.name;
            self.fault(format!("<{tag} {name}=\"{text}\">: it must be numbers in -{most:e}..={most:e}"))
        })
    }

    pub fn fault(&self, message: impl Into<String>) -> Fault {
        Fault::at(self.line, message)
    }
}

/// The root of a file, the files that it includes in their places.
pub(super) fn load(path: &Path) -> Result<Tag, Fault> {
    let mut count = 0;
    file(path, path.parent().unwrap_or(Path::new("")), 0, &mut count)
}

fn file(path: &Path, home: &Path, depth: usize, count: &mut usize) -> Result<Tag, Fault> {
    let text = read_xml(path)?;
    let document = parse(&text)?;
    convert(&document.root_element(), home, depth, count)
}

fn convert(
    element: &crate::xml::Element<'_>,
    home: &Path,
    depth: usize,
    count: &mut usize,
) -> Result<Tag, Fault> {
    *count += 1;
    if *count > MOST {
        return Err(Fault::of_file(format!("more than {MOST} elements; is it a hand?")));
    }
    let attributes = element.attributes().map(|a| (a.name().to_owned(), a.value().to_owned())).collect();
    let mut tag =
        Tag { name: element.tag_name().name().to_owned(), attributes, line: line(element), ..Tag::default() };
    for child in element.children().filter(|child| child.is_element()) {
        if child.tag_name().name() == "include" {
            let name = child.attribute("file").unwrap_or_default();
            if depth == DEEPEST {
                let message =
                    format!("files include each other more than {DEEPEST} deep; does one include itself?");
                return Err(Fault::at(line(&child), message));
            }
            // Relative to the outermost file, as MuJoCo has it; else to the including one, as people expect.
            let path: PathBuf = home.join(name);
            let included = file(&path, home, depth + 1, count).map_err(|fault| {
                let at = fault.line.map(|line| format!(", line {line}")).unwrap_or_default();
                let message = format!("in the included `{}`{at}: {}", path.display(), fault.message);
                Fault::at(line(&child), message)
            })?;
            tag.children.extend(included.children);
        } else {
            tag.children.push(convert(&child, home, depth, count)?);
        }
    }
    Ok(tag)
}
