//! What was found so far, on disk: one line for each member that is done, which a kill at any moment cannot
//! spoil.

use crate::{AtlasError, AtlasHand, Cell, Member, Told, Wish};
use serde_json::json;
use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The cells of an atlas that may be killed.
pub struct Journal {
    path: PathBuf,
    file: File,
    cells: Vec<Cell>,
    members: Vec<Member>,
}

impl Journal {
    /// Opens the journal of this wish and these hands, or begins it; `anew` throws away what there is.
    /// Refuses that of another atlas. A last line that is torn is cut off.
    pub fn open(path: &Path, wish: &Wish, hands: &[AtlasHand], anew: bool) -> Result<Self, AtlasError> {
        let failed = |cause| AtlasError::File { path: path.to_owned(), cause };
        let opened = OpenOptions::new().read(true).write(true).create(true).truncate(anew).open(path);
        let mut file = opened.map_err(failed)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes).map_err(failed)?;
        let head = identity(wish, hands);
        let members = wish.members(hands.iter().map(|hand| hand.name.as_str()));
        let whole = if head.as_bytes().starts_with(&bytes) && bytes.len() < head.len() {
            bytes.clear();
            0
        } else if bytes.starts_with(head.as_bytes()) {
            bytes.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1)
        } else {
            return Err(AtlasError::OtherAtlas { path: path.to_owned() });
        };
        file.set_len(whole as u64).and_then(|()| file.seek(SeekFrom::End(0))).map_err(failed)?;
        if whole == 0 {
            file.write_all(head.as_bytes()).map_err(failed)?;
        }
        let mut journal = Self { path: path.to_owned(), file, cells: Vec::new(), members };
        journal.read(&bytes[head.len().min(whole)..whole])?;
        Ok(journal)
    }

    /// Takes in the lines behind the first.
    fn read(&mut self, bytes: &[u8]) -> Result<(), AtlasError> {
        for (index, line) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
            let wrong =
                |reason: String| AtlasError::Journal { path: self.path.clone(), line: index + 2, reason };
            let cell: Cell = serde_json::from_slice(line).map_err(|error| wrong(error.to_string()))?;
            if self.members.get(cell.number) != Some(&cell.member) {
                return Err(wrong("it is no member of this atlas".into()));
            }
            self.cells.push(cell);
        }
        Ok(())
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
        &self.path
    }
}

impl Told for Journal {
    fn done(&mut self, cell: &Cell) -> Result<(), AtlasError> {
        let mut line = serde_json::to_vec(cell).expect("a cell is plain data with text keys");
        line.push(b'\n');
        // In one write: whatever becomes of the process, the line is there or its end is torn.
        let written = self.file.write_all(&line);
        written.map_err(|cause| AtlasError::File { path: self.path.clone(), cause })?;
        self.cells.push(cell.clone());
        Ok(())
    }
}

/// One line that tells this atlas from every other.
fn identity(wish: &Wish, hands: &[AtlasHand]) -> String {
    let hands: Vec<_> = hands.iter().map(|hand| json!([hand.name, hand.description])).collect();
    let line = json!({
        "format": "regrasp-atlas-part",
        "version": 1,
        "regrasp": env!("CARGO_PKG_VERSION"),
        "wish": wish,
        "hands": hands,
    });
    format!("{line}\n")
}
