//! How a plan looks as text: pretty where people read, one line for each state.

use serde::Serialize;
use serde_json::ser::{Formatter, PrettyFormatter, Serializer};
use std::io::{self, Write};

/// Containers nested deeper than this are written on one line. A plan's states lie just below: object,
/// segments, segment, states.
const PRETTY_DEPTH: usize = 4;

/// Writes `value` as JSON: two spaces of indent, and every value nested more than four deep on one line; ends
/// with a line break.
///
/// Deterministic: keys in the order of the fields (of the keys in maps), numbers in the shortest form that
/// reads back exactly. Numbers that are not finite become null.
pub fn write_json<T: Serialize>(value: &T, writer: &mut dyn Write) -> io::Result<()> {
    let formatter = Layered { pretty: PrettyFormatter::new(), depth: 0 };
    let mut serializer = Serializer::with_formatter(&mut *writer, formatter);
    value.serialize(&mut serializer).map_err(io::Error::from)?;
    writer.write_all(b"\n")
}

/// Pretty down to [`PRETTY_DEPTH`], compact below.
struct Layered {
    pretty: PrettyFormatter<'static>,
    depth: usize,
}

impl Layered {
    fn is_pretty(&self) -> bool {
        self.depth <= PRETTY_DEPTH
    }

    fn separate<W: ?Sized + Write>(writer: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { writer.write_all(b", ") }
    }
}

impl Formatter for Layered {
    fn begin_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        if self.is_pretty() { self.pretty.begin_array(writer) } else { writer.write_all(b"[") }
    }

    fn end_array<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        let pretty = self.is_pretty();
        self.depth -= 1;
        if pretty { self.pretty.end_array(writer) } else { writer.write_all(b"]") }
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if self.is_pretty() {
            self.pretty.begin_array_value(writer, first)
        } else {
            Self::separate(writer, first)
        }
    }

    fn end_array_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.is_pretty() { self.pretty.end_array_value(writer) } else { Ok(()) }
    }

    fn begin_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.depth += 1;
        if self.is_pretty() { self.pretty.begin_object(writer) } else { writer.write_all(b"{") }
    }

    fn end_object<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        let pretty = self.is_pretty();
        self.depth -= 1;
        if pretty { self.pretty.end_object(writer) } else { writer.write_all(b"}") }
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if self.is_pretty() {
            self.pretty.begin_object_key(writer, first)
        } else {
            Self::separate(writer, first)
        }
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.pretty.begin_object_value(writer)
    }

    fn end_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        if self.is_pretty() { self.pretty.end_object_value(writer) } else { Ok(()) }
    }
}
