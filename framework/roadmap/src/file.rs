//! The file: a head as text, then words.
//!
//! Sixteen bytes tell what it is; then follow the version and the length of the head (32 bits each), the head
//! as JSON, padded with spaces to a multiple of eight, a row of 32-bit words for each node, four for each
//! edge, zeros up to a multiple of eight, and a digest of everything before it; the lowest byte first.

use crate::digest::digest;
use crate::{Identity, RoadmapError};
use regrasp_planner::roadmap::{Roadmap, RoadmapParts};
use serde::{Deserialize, Serialize};
use std::path::Path;

const MAGIC: &[u8; 16] = b"regrasp-roadmap\n";
const VERSION: u32 = 1;
/// Bytes before the head.
const FIXED: usize = MAGIC.len() + 8;
/// The largest file that is read (bytes): a hundred million nodes.
const MOST: u64 = 16 << 30;

/// The head.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    /// The program's version, for people.
    regrasp: String,
    identity: Identity,
    joints: Vec<usize>,
    seed: u64,
    samples: u64,
    learnt: u64,
    /// Words of all rows.
    row_words: u64,
    /// Words of all edges.
    link_words: u64,
}

/// Writes a roadmap, in one piece or not at all.
pub fn save(path: &Path, roadmap: &Roadmap, identity: &Identity) -> Result<(), RoadmapError> {
    let bytes = bytes(roadmap, identity);
    Ok(regrasp_plan::write_file(path, |out| out.write_all(&bytes))?)
}

/// Reads a roadmap, and what it is bound to.
pub fn load(path: &Path) -> Result<(Roadmap, Identity), RoadmapError> {
    let file = |cause| RoadmapError::File { path: path.to_owned(), cause };
    let bytes = regrasp_api::read_at_most(path, MOST).map_err(file)?;
    parse(&bytes).map_err(|fault| fault.of(path))
}

fn bytes(roadmap: &Roadmap, identity: &Identity) -> Vec<u8> {
    let RoadmapParts { joints, seed, samples, learnt, rows, links } = roadmap.parts();
    let head = Head {
        regrasp: env!("CARGO_PKG_VERSION").into(),
        identity: identity.clone(),
        joints,
        seed,
        samples,
        learnt,
        row_words: rows.len() as u64,
        link_words: links.len() as u64,
    };
    let mut head = serde_json::to_string(&head).expect("texts and numbers are JSON");
    head.extend(std::iter::repeat_n(' ', head.len().next_multiple_of(8) - head.len()));
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend((head.len() as u32).to_le_bytes());
    bytes.extend(head.as_bytes());
    bytes.extend(rows.iter().chain(&links).flat_map(|word| word.to_le_bytes()));
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes.extend(digest(&bytes).to_le_bytes());
    bytes
}

/// What is wrong with the bytes of a file.
#[derive(Debug, PartialEq)]
enum Fault {
    Foreign,
    Version(u32),
    Truncated(u64, u64),
    Damaged(&'static str),
}

impl Fault {
    fn of(self, path: &Path) -> RoadmapError {
        let path = path.to_owned();
        match self {
            Self::Foreign => RoadmapError::Foreign { path },
            Self::Version(found) => RoadmapError::Version { path, found, known: VERSION },
            Self::Truncated(found, needed) => RoadmapError::Truncated { path, found, needed },
            Self::Damaged(what) => RoadmapError::Damaged { path, what },
        }
    }
}

fn parse(bytes: &[u8]) -> Result<(Roadmap, Identity), Fault> {
    if !bytes.starts_with(MAGIC) {
        return Err(Fault::Foreign);
    }
    let found = bytes.len() as u64;
    let number = |at: usize| Some(u32::from_le_bytes(bytes.get(at..at + 4)?.try_into().ok()?));
    let version = number(MAGIC.len()).ok_or(Fault::Truncated(found, FIXED as u64))?;
    if version != VERSION {
        return Err(Fault::Version(version));
    }
    let length = number(MAGIC.len() + 4).ok_or(Fault::Truncated(found, FIXED as u64))? as usize;
    let body = FIXED + length;
    let head = bytes.get(FIXED..body).ok_or(Fault::Truncated(found, body as u64))?;
    let head: Head =
        serde_json::from_slice(head).map_err(|_| Fault::Damaged("its head is no longer readable"))?;
    let ends = ends(&head, body).ok_or(Fault::Damaged("its head names lengths that no file has"))?;
    let [rows_end, links_end, sum_at] = ends;
    let needed = sum_at as u64 + 8;
    if found != needed {
        let longer = Fault::Damaged("there is something behind its end");
        return Err(if found < needed { Fault::Truncated(found, needed) } else { longer });
    }
    if digest(&bytes[..sum_at]).to_le_bytes() != bytes[sum_at..] {
        return Err(Fault::Damaged("its digest is not that of what it holds"));
    }
    let parts = RoadmapParts {
        joints: head.joints,
        seed: head.seed,
        samples: head.samples,
        learnt: head.learnt,
        rows: words(&bytes[body..rows_end]),
        links: words(&bytes[rows_end..links_end]),
    };
    let roadmap = Roadmap::from_parts(parts).ok_or(Fault::Damaged("what it holds is no graph"))?;
    Ok((roadmap, head.identity))
}

/// Where rows end, where edges end, and where the digest stands; `None` where no memory holds that much.
fn ends(head: &Head, body: usize) -> Option<[usize; 3]> {
    let end = |begin: usize, words: u64| begin.checked_add(usize::try_from(words.checked_mul(4)?).ok()?);
    let rows = end(body, head.row_words)?;
    let links = end(rows, head.link_words)?;
    let digest = links.checked_next_multiple_of(8)?;
    digest.checked_add(8)?;
    Some([rows, links, digest])
}

fn words(bytes: &[u8]) -> Vec<u32> {
    let word = |part: &[u8]| u32::from_le_bytes(part.try_into().expect("parts have four bytes"));
    bytes.chunks_exact(4).map(word).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Named;
    use regrasp_api::Random;

    fn identity() -> Identity {
        let named = |name: &str| Named { name: name.into(), digest: "0".into() };
        Identity { hand: named("h"), object: named("o"), settings: "1".into(), sampling: "2".into() }
    }

    fn roadmap() -> Roadmap {
        // Two nodes of a hand with one finger of one joint, and an edge between them.
        let row = |x: f32| [0.0, 1.0, 0.0, 0.0, 0.0, x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.5].map(f32::to_bits);
        let rows = [row(0.0), row(0.1)].concat();
        let links = vec![1, 0, 4 << 8, 0.1_f32.to_bits()];
        let parts = RoadmapParts { joints: vec![1], seed: 7, samples: 9, learnt: 1, rows, links };
        Roadmap::from_parts(parts).unwrap()
    }

    #[test]
    fn a_file_gives_back_what_was_written() {
        let bytes = bytes(&roadmap(), &identity());
        assert_eq!(parse(&bytes).unwrap(), (roadmap(), identity()));
    }

    #[test]
    fn whatever_is_cut_off_or_changed_is_found() {
        let whole = bytes(&roadmap(), &identity());
        for end in 0..whole.len() {
            let fault = parse(&whole[..end]).unwrap_err();
            let wanted = matches!(fault, Fault::Truncated(found, _) if found == end as u64);
            assert!(wanted || end < MAGIC.len() && fault == Fault::Foreign, "{end}: {fault:?}");
        }
        for at in 0..whole.len() {
            let mut changed = whole.clone();
            changed[at] ^= 0x10;
            assert!(parse(&changed).is_err(), "byte {at}");
        }
        let mut other = whole.clone();
        other[MAGIC.len()] = 9;
        assert_eq!(parse(&other).unwrap_err(), Fault::Version(9));
        let longer = [whole, vec![0; 8]].concat();
        assert!(matches!(parse(&longer), Err(Fault::Damaged(_))));
    }

    /// Who means harm sets the digest right again.
    #[test]
    fn what_is_changed_with_its_digest_is_a_graph_or_refused() {
        let whole = bytes(&roadmap(), &identity());
        let mut random = Random::from_key(11, 0, 0, 0);
        let mut graphs = 0;
        for _ in 0..20_000 {
            let mut changed = whole.clone();
            for _ in 0..1 + random.index(3) {
                let at = FIXED + random.index(whole.len() - FIXED - 8);
                changed[at] = [0, 0xff, 0x7f, changed[at] ^ 1 << random.index(8)][random.index(4)];
            }
            let sum_at = changed.len() - 8;
            let sum = digest(&changed[..sum_at]).to_le_bytes();
            changed[sum_at..].copy_from_slice(&sum);
            let Ok((roadmap, identity)) = parse(&changed) else { continue };
            assert_eq!(bytes(&roadmap, &identity).len(), changed.len());
            graphs += 1;
        }
        assert!((1_000..19_000).contains(&graphs), "{graphs}");
        for joints in [vec![usize::MAX, 2], vec![9, 9], vec![1; 9]] {
            assert!(Roadmap::from_parts(RoadmapParts { joints, ..roadmap().parts() }).is_none());
        }
    }

    #[test]
    fn lengths_that_no_file_has_are_no_panic() {
        let json = String::from_utf8_lossy(&bytes(&roadmap(), &identity())[FIXED..]).into_owned();
        for lie in [u64::MAX, u64::MAX / 4, 1 << 40] {
            let head = json.replace("\"row_words\":24", &format!("\"row_words\":{lie}"));
            let head = &head[..=head.rfind('}').unwrap()];
            let mut bytes = MAGIC.to_vec();
            bytes.extend(VERSION.to_le_bytes());
            bytes.extend((head.len() as u32).to_le_bytes());
            bytes.extend(head.as_bytes());
            assert!(parse(&bytes).is_err());
        }
    }
}
