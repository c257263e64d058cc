//! A table with one row a state, as comma-separated values (RFC 4180).

use crate::table::{Row, object_head};
use crate::{File, Scene};

/// One file: columns in the order of [`head`]; a cell is empty where there is nothing to say, such as the
/// contact of a free finger.
pub(crate) fn files(scene: &Scene<'_>, stem: &str) -> Vec<File> {
    let mut table = Table::new(&head(scene));
    for row in scene.rows() {
        table.line(&cells(scene, &row));
    }
    vec![File { name: format!("{stem}.csv"), bytes: table.into_bytes() }]
}

fn head(scene: &Scene<'_>) -> Vec<String> {
    let mut head: Vec<String> = ["time", "segment", "kind", "moving_finger"].map(String::from).into();
    head.extend(scene.names.joints.iter().flatten().map(|joint| format!("joint.{joint}")));
    head.extend(scene.names.joints.iter().flatten().map(|joint| format!("velocity.{joint}")));
    head.extend(object_head());
    for finger in &scene.description().finger {
        let name = &finger.name;
        head.extend(vector(&format!("{name}.tip_H"), &["x", "y", "z"]));
        for what in ["contact_point_O", "contact_normal_O", "contact_point_H", "contact_normal_H", "force_H"]
        {
            head.extend(vector(&format!("{name}.{what}"), &["x", "y", "z"]));
        }
        head.push(format!("{name}.torque_about_normal"));
    }
    head.push("force_margin".into());
    head
}

fn vector(name: &str, axes: &[&str]) -> Vec<String> {
    axes.iter().map(|axis| format!("{name}.{axis}")).collect()
}

fn cells(scene: &Scene<'_>, row: &Row<'_>) -> Vec<String> {
    let number = |value: &f64| value.to_string();
    let moving =
        row.moving().map_or(String::new(), |finger| scene.description().finger[finger.index()].name.clone());
    let mut cells = vec![row.time.to_string(), row.segment.to_string(), row.kind_name().into(), moving];
    cells.extend(row.q.joints.iter().flat_map(|(_, joints)| joints.iter().map(number).collect::<Vec<_>>()));
    let joints = scene.names.joints.iter().map(Vec::len).sum();
    match row.velocities() {
        Some(velocities) => cells.extend(velocities.iter().map(number)),
        None => cells.extend(vec![String::new(); joints]),
    }
    let (position, orientation) = row.object();
    cells.extend(position.iter().chain(&orientation).map(number));
    for finger in scene.fingers() {
        cells.extend(scene.tip(row, finger).iter().map(number));
        let touch = scene.touch(row, finger);
        let vectors = touch.as_ref().map(|t| [t.point_O, t.normal_O, t.point_H, t.normal_H]);
        let exerted = touch.as_ref().and_then(|touch| touch.exerted);
        match vectors {
            Some(vectors) => cells.extend(vectors.iter().flatten().map(number)),
            None => cells.extend(vec![String::new(); 12]),
        }
        match exerted {
            Some(exerted) => cells.extend(exerted.force.iter().chain([&exerted.spin]).map(number)),
            None => cells.extend(vec![String::new(); 4]),
        }
    }
    cells.push(scene.forces.margin(row.state).map_or(String::new(), |margin| margin.to_string()));
    cells
}

/// Comma-separated values in memory.
pub(crate) struct Table(String);

impl Table {
    pub fn new(head: &[String]) -> Self {
        let mut table = Self(String::new());
        table.line(head);
        table
    }

    pub fn line(&mut self, cells: &[String]) {
        let quoted: Vec<String> = cells.iter().map(|cell| quoted(cell)).collect();
        self.0.push_str(&quoted.join(","));
        self.0.push_str("\r\n");
    }

    pub fn into_bytes(self) -> Vec<u8> {
        self.0.into_bytes()
    }
}

/// In quotes where it must be; a name that a spreadsheet would take for a formula begins with an apostrophe.
fn quoted(cell: &str) -> String {
    let is_formula = cell.starts_with(['=', '+', '-', '@', '\t']) && cell.parse::<f64>().is_err();
    let cell = if is_formula { format!("'{cell}") } else { cell.to_owned() };
    if cell.contains([',', '"', '\n', '\r']) { format!("\"{}\"", cell.replace('"', "\"\"")) } else { cell }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        let mut table = Table::new(&["a".into(), "b,c".into()]);
        table.line(&["say \"x\"".into(), String::new()]);
        table.line(&["=cmd".into(), "-1.5e-3".into()]);
        assert_eq!(table.0, "a,\"b,c\"\r\n\"say \"\"x\"\"\",\r\n'=cmd,-1.5e-3\r\n");
    }
}
