//! XML in memory.

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};
use regrasp_api::{Pose, Vec3};

/// An XML document that is being written.
pub(crate) struct Xml(Writer<Vec<u8>>);

/// An attribute.
pub(crate) type Attribute<'a> = (&'a str, String);

impl Xml {
    pub fn new() -> Self {
        let mut xml = Self(Writer::new_with_indent(Vec::new(), b' ', 2));
        xml.write(Event::Decl(BytesDecl::new("1.0", None, None)));
        xml.comment(concat!("Written by regrasp ", env!("CARGO_PKG_VERSION")));
        xml
    }

    /// An element with what `inside` writes into it.
    pub fn element(&mut self, name: &str, attributes: &[Attribute<'_>], inside: impl FnOnce(&mut Self)) {
        self.write(Event::Start(start(name, attributes)));
        inside(self);
        self.write(Event::End(BytesEnd::new(name)));
    }

    /// An element with nothing inside.
    pub fn empty(&mut self, name: &str, attributes: &[Attribute<'_>]) {
        self.write(Event::Empty(start(name, attributes)));
    }

    pub fn comment(&mut self, text: &str) {
        // Two hyphens would end it.
        let text = format!(" {} ", text.replace("--", "- -"));
        self.write(Event::Comment(BytesText::from_escaped(text)));
    }

    pub fn into_bytes(self) -> Vec<u8> {
        let mut bytes = self.0.into_inner();
        bytes.push(b'\n');
        bytes
    }

    fn write(&mut self, event: Event<'_>) {
        self.0.write_event(event).expect("writing to memory does not fail");
    }
}

fn start<'a>(name: &'a str, attributes: &'a [Attribute<'_>]) -> BytesStart<'a> {
    let mut start = BytesStart::new(name);
    start.extend_attributes(attributes.iter().map(|(key, value)| (*key, value.as_str())));
    start
}

/// Numbers with blanks between, every digit kept.
pub(crate) fn numbers<'a>(values: impl IntoIterator<Item = &'a f64>) -> String {
    let texts: Vec<String> = values.into_iter().map(f64::to_string).collect();
    texts.join(" ")
}

/// Position of a pose (m).
pub(crate) fn position(pose: &Pose) -> String {
    numbers(pose.translation.vector.iter())
}

/// The unit vector along `axis`.
pub(crate) fn direction(axis: &[f64; 3]) -> String {
    numbers(Vec3::from(*axis).normalize().iter())
}
