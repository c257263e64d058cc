//! What was found so far, on disk: one line for each member that is done.

use crate::{AtlasError, AtlasHand, Cell, Member, Told, Wish};
use regrasp_plan::JournalError;
use serde_json::{Value, json};
use std::path::Path;

/// The cells of an atlas that may be killed.
pub struct Journal {
    file: regrasp_plan::Journal,
    cells: Vec<Cell>,
    members: Vec<Member>,
}

impl Journal {
    /// Opens the journal of this wish and these hands, or begins it; `anew` throws away what there is.
    /// Refuses that of another atlas.
    pub fn open(path: &Path, wish: &Wish, hands: &[AtlasHand], anew: bool) -> Result<Self, AtlasError> {
        let (file, cells) = regrasp_plan::Journal::open::<Cell>(path, &identity(wish, hands), anew)?;
        let members = wish.members(hands.iter().map(|hand| hand.name.as_str()));
        let is_strange = |cell: &Cell| members.get(cell.number) != Some(&cell.member);
        match cells.iter().position(is_strange) {
            Some(index) => {
                let (path, reason) = (path.to_owned(), "it is no member of this atlas".to_owned());
                Err(JournalError::Line { path, line: index + 2, reason }.into())
            }
            None => Ok(Self { file, cells, members }),
        }
    }

    /// What is done, in the order of the family.
    pub fn cells(&self) -> Vec<Cell> {
        let mut cells = self.cells.clone();
        cells.sort_by_key(|cell| cell.number);
        cells.dedup_by_key(|cell| cell.number);
        cells
    }

    /// How many members there are in all.
    pub fn members(&self) -> usize {
        self.members.len()
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.file.path()
    }
}

impl Told for Journal {
    fn done(&mut self, cell: &Cell) -> Result<(), AtlasError> {
        self.file.append(cell)?;
        self.cells.push(cell.clone());
        Ok(())
    }
}

/// What tells this atlas from every other.
fn identity(wish: &Wish, hands: &[AtlasHand]) -> Value {
    let hands: Vec<_> = hands.iter().map(|hand| json!([hand.name, hand.description])).collect();
    json!({
        "format": "regrasp-atlas-part",
        "version": 1,
        "regrasp": env!("CARGO_PKG_VERSION"),
        "wish": wish,
        "hands": hands,
    })
}
