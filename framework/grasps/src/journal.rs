//! What was found so far, on disk: a file that only grows, chunk by chunk, so that a killed search goes on.
//!
//! One line of text says which search it is; then follow blocks of 64-bit words, the lowest byte first: one
//! for each chunk, with its number, how many grasps and regrasps it holds, its counts, these, and a checksum.
//! A block that is not whole is cut off.

use crate::collect::{Kept, Search, Sink};
use crate::counts::Counts;
use crate::graph::Edge;
use crate::grasp::BulkGrasp;
use crate::write::Rows;
use crate::{GraspsError, Layout};
use regrasp_api::FingerIndex;
use std::fs::{File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Words before the counts of a block: its mark, the chunk's number, grasps, regrasps.
const HEAD: usize = 4;
const MARK: u64 = u64::from_le_bytes(*b"regrasps");
/// More grasps or regrasps are in no chunk: such a block is not whole.
const MOST: u64 = 1 << 24;
/// Words of a regrasp.
const OF_EDGE: usize = 3;

/// The grasps of a search that may be killed.
pub struct Journal {
    path: PathBuf,
    file: File,
    layout: Layout,
    /// Where the blocks begin (bytes).
    begin: u64,
}

impl Journal {
    /// Opens the search that `identity`, one line of text, names, or begins it; `anew` throws away what there
    /// is. Refuses the file of another search.
    pub fn open(path: &Path, identity: &str, layout: Layout, anew: bool) -> Result<Self, GraspsError> {
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(anew).open(path);
        let failed = |cause| GraspsError::File { path: path.to_owned(), cause };
        let mut journal = Self { path: path.to_owned(), file: file.map_err(failed)?, layout, begin: 0 };
        match journal.claim(identity) {
            Ok(true) => Ok(journal),
            Ok(false) => Err(GraspsError::OtherSearch { path: path.to_owned() }),
            Err(cause) => Err(failed(cause)),
        }
    }

    /// Whether the file is this search's: its first line says so, or it has none yet.
    fn claim(&mut self, identity: &str) -> io::Result<bool> {
        let line = format!("{identity}\n");
        self.begin = line.len() as u64;
        let mut there = String::new();
        let length = line.len() as u64;
        // What is no text is no search of ours.
        let read = BufReader::new((&self.file).take(length)).read_line(&mut there);
        if read.is_ok() && there.len() < line.len() && line.starts_with(&there) {
            self.file.set_len(0)?;
            self.file.seek(SeekFrom::Start(0))?;
            self.file.write_all(line.as_bytes())?;
            return Ok(true);
        }
        Ok(there == line)
    }

    /// Takes what is there into the search, and cuts off what is not whole.
    pub fn resume(&mut self, search: &mut Search<'_>) -> Result<(), GraspsError> {
        let end = self.blocks(&mut |kept| {
            search.resume(kept);
            Ok(())
        });
        let cut = end.and_then(|end| {
            self.file.set_len(end)?;
            self.file.seek(SeekFrom::Start(end))
        });
        cut.map(drop).map_err(|cause| self.failed(cause))
    }

    /// Deletes the file: what it held is elsewhere now.
    pub fn delete(self) -> Result<(), GraspsError> {
        std::fs::remove_file(&self.path).map_err(|cause| self.failed(cause))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    fn failed(&self, cause: io::Error) -> GraspsError {
        GraspsError::File { path: self.path.clone(), cause }
    }

    /// Every whole block in turn; where the last ends (bytes).
    fn blocks(&self, take: &mut dyn FnMut(&Kept) -> io::Result<()>) -> io::Result<u64> {
        let mut file = &self.file;
        file.seek(SeekFrom::Start(self.begin))?;
        let (mut reader, mut end) = (BufReader::with_capacity(1 << 20, file), self.begin);
        while let Some(words) = self.block(&mut reader)? {
            take(&self.read(&words))?;
            end += 8 * (words.len() as u64 + 1);
        }
        Ok(end)
    }

    /// The words of the next block without its checksum; `None` where there is none that is whole.
    fn block(&self, reader: &mut impl Read) -> io::Result<Option<Vec<u64>>> {
        let Some(mut words) = words(reader, HEAD)? else { return Ok(None) };
        let [mark, _, grasps, edges] = words[..] else { return Ok(None) };
        if mark != MARK || grasps > MOST || edges > MOST {
            return Ok(None);
        }
        let rest = Counts::WORDS + grasps as usize * self.layout.words() + edges as usize * OF_EDGE;
        let Some(mut more) = self::words(reader, rest + 1)? else { return Ok(None) };
        let sum = more.pop();
        words.extend(more);
        Ok((sum == Some(checksum(&words))).then_some(words))
    }

    fn read(&self, words: &[u64]) -> Kept {
        let (head, rest) = words.split_at(HEAD);
        let (counts, rest) = rest.split_at(Counts::WORDS);
        let (grasps, edges) = rest.split_at(head[2] as usize * self.layout.words());
        let edge = |words: &[u64]| Edge { from: words[0], to: words[1], finger: FingerIndex(words[2] as u8) };
        Kept {
            chunk: head[1],
            grasps: grasps.chunks_exact(self.layout.words()).map(|row| self.layout.decode(row)).collect(),
            edges: edges.chunks_exact(OF_EDGE).map(edge).collect(),
            counts: Counts::of_words(counts),
        }
    }
}

impl Sink for Journal {
    fn take(&mut self, kept: &Kept) -> Result<(), GraspsError> {
        let mut words = vec![MARK, kept.chunk, kept.grasps.len() as u64, kept.edges.len() as u64];
        words.extend(kept.counts.words());
        kept.grasps.iter().for_each(|grasp| self.layout.encode(grasp, &mut words));
        words.extend(kept.edges.iter().flat_map(|edge| [edge.from, edge.to, u64::from(edge.finger.0)]));
        words.push(checksum(&words));
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.file.write_all(&bytes).map_err(|cause| self.failed(cause))
    }
}

impl Rows for Journal {
    fn each(&self, take: &mut dyn FnMut(&BulkGrasp) -> io::Result<()>) -> io::Result<()> {
        self.blocks(&mut |kept| kept.grasps.iter().try_for_each(&mut *take)).map(drop)
    }

    fn each_edge(&self, take: &mut dyn FnMut(&Edge) -> io::Result<()>) -> io::Result<()> {
        self.blocks(&mut |kept| kept.edges.iter().try_for_each(&mut *take)).map(drop)
    }
}

/// So many words; `None` where the file ends before.
fn words(reader: &mut impl Read, count: usize) -> io::Result<Option<Vec<u64>>> {
    let mut bytes = vec![0; 8 * count];
    match reader.read_exact(&mut bytes) {
        Ok(()) => {
            let word = |part: &[u8]| u64::from_le_bytes(part.try_into().expect("parts have eight bytes"));
            Ok(Some(bytes.chunks_exact(8).map(word).collect()))
        }
        Err(error) if error.kind() == io::ErrorKind::UnexpectedEof => Ok(None),
        Err(error) => Err(error),
    }
}

/// Tells a whole block from one that was cut short or mixed up.
fn checksum(words: &[u64]) -> u64 {
    words.iter().fold(MARK, |sum, word| (sum.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15))
}
