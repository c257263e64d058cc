//! What is found, as JSON and as tables.

use crate::text::csv_line;
use crate::{ANGLES_DEG, AtlasHand, Bin, Cell, CellSummary, Share, Summary, Wish};
use serde::Serialize;

/// The file: its format comes first, so that it is known by its beginning.
#[derive(Serialize)]
struct Document<'a> {
    format: &'static str,
    version: u32,
    regrasp: &'static str,
    wish: &'a Wish,
    hands: Vec<Hand<'a>>,
    angles_deg: [f64; ANGLES_DEG.len()],
    cells: Vec<Entry<'a>>,
    map: &'a [Bin],
}

#[derive(Serialize)]
struct Hand<'a> {
    name: &'a str,
    fingers: usize,
    contact_model: &'static str,
}

#[derive(Serialize)]
struct Entry<'a> {
    size_mm: f64,
    summary: &'a CellSummary,
    cell: &'a Cell,
}

impl<'a> Hand<'a> {
    fn of(hand: &'a AtlasHand) -> Self {
        let contact_model = if hand.is_soft() { "soft-finger" } else { "pcwf" };
        Self { name: &hand.name, fingers: hand.fingers(), contact_model }
    }
}

impl<'a> Entry<'a> {
    fn of(cell: &'a Cell, summary: &'a CellSummary) -> Self {
        Self { size_mm: cell.member.size_mm(), summary, cell }
    }
}

/// The whole atlas as JSON text; SI units but where a key ends with `_mm` or `_deg`.
pub fn json(wish: &Wish, hands: &[AtlasHand], cells: &[Cell], summary: &Summary) -> String {
    let entry = |(cell, summary)| Entry::of(cell, summary);
    let document = Document {
        format: "regrasp-atlas",
        version: 1,
        regrasp: env!("CARGO_PKG_VERSION"),
        wish,
        hands: hands.iter().map(Hand::of).collect(),
        angles_deg: ANGLES_DEG,
        cells: cells.iter().zip(&summary.cells).map(entry).collect(),
        map: &summary.bins,
    };
    serde_json::to_string_pretty(&document).expect("plain data is written without fault") + "\n"
}

/// One row for each member: what was asked, the share with its interval, regrasps, and the cause where no
/// grasp exists.
pub fn cells_csv(cells: &[Cell], summary: &Summary) -> String {
    let mut text = String::from(
        "hand,shape,size_mm,friction,mass_kg,grasps,poses,reached,goals,share,share_low,share_high,\
         regrasps_median,regrasps_90,share_to_90_deg,share_to_135_deg,share_to_180_deg,cause\n",
    );
    for (cell, of) in cells.iter().zip(&summary.cells) {
        let ends = of.share.estimate.map(|share| [share.value, share.low, share.high]);
        let share = |share: &Share| number(share.estimate.map(|share| share.value));
        let mut fields = member(cell);
        let counts = [cell.grasps.to_string(), cell.poses.to_string()];
        fields.extend(counts.into_iter().chain([of.share.reached.to_string(), of.share.of.to_string()]));
        fields.extend((0..3).map(|k| number(ends.map(|ends| ends[k]))));
        fields.extend([number(of.regrasps_median), number(of.regrasps_90)]);
        fields.extend(of.by_angle.iter().map(share));
        fields.push(cell.cause.clone().unwrap_or_default());
        text += &csv_line(&fields);
    }
    text
}

/// The columns that both tables begin with.
fn member(cell: &Cell) -> Vec<String> {
    let member = &cell.member;
    vec![
        member.hand.clone(),
        member.shape.name().into(),
        member.size_mm().to_string(),
        member.friction.to_string(),
        number(member.mass),
    ]
}

/// One row for each attempt.
pub fn attempts_csv(cells: &[Cell]) -> String {
    let mut text = String::from(
        "hand,shape,size_mm,friction,mass_kg,goal,axis_x,axis_y,axis_z,angle_deg,start_x,start_y,start_z,\
         found,tries,regrasps\n",
    );
    for cell in cells {
        for (goal, attempt) in cell.attempts.iter().enumerate() {
            let mut fields = member(cell);
            fields.push(goal.to_string());
            fields.extend(attempt.axis.map(|x| x.to_string()));
            fields.push(attempt.angle_deg.to_string());
            fields.extend(attempt.start.map(|x| x.to_string()));
            fields.extend([attempt.found.name().into(), attempt.tries.to_string()]);
            fields.push(attempt.regrasps.map_or(String::new(), |n| n.to_string()));
            text += &csv_line(&fields);
        }
    }
    text
}

fn number(value: Option<f64>) -> String {
    value.map_or(String::new(), |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::summary::tests::{attempt, cell};

    #[test]
    fn tables_have_a_row_for_each_thing_and_as_many_fields_as_heads() {
        let attempts = vec![attempt([0.0, 0.0, 1.0], 30.0, Some(2)), attempt([1.0, 0.0, 0.0], 170.0, None)];
        let cells = [cell(0, "a", 0.02, attempts), cell(1, "b", 0.03, Vec::new())];
        let summary = Summary::of(&cells);
        for (text, rows) in [(cells_csv(&cells, &summary), 2), (attempts_csv(&cells), 2)] {
            let lines: Vec<&str> = text.lines().collect();
            assert_eq!(lines.len(), 1 + rows, "{text}");
            let fields = |line: &str| line.matches(',').count();
            assert!(lines.iter().all(|line| fields(line) == fields(lines[0])), "{text}");
        }
        assert!(cells_csv(&cells, &summary).contains("a,cube,20,0.8,,9,99,1,2,0.5,"));
    }
}
