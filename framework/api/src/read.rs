//! Reading a file that may not end.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The bytes of a file that has at most `most` of them; devices and pipes are read no further, either.
///
/// A larger one is an error of kind [`ErrorKind::FileTooLarge`] that says both sizes; a folder one of kind
/// [`ErrorKind::IsADirectory`].
pub fn read_at_most(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let found = file.metadata()?;
    if found.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    let mut bytes = Vec::new();
    if found.len() <= most {
        bytes.reserve_exact(found.len() as usize + 1);
        file.take(most + 1).read_to_end(&mut bytes)?;
    }
    match found.len() > most || bytes.len() as u64 > most {
        true => Err(io::Error::new(ErrorKind::FileTooLarge, too_large(most))),
        false => Ok(bytes),
    }
}

fn too_large(most: u64) -> String {
    format!("it holds more than {} MB, the most that such a file may have", most >> 20)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_end_is_refused() {
        let error = read_at_most(Path::new("/dev/zero"), 1 << 20);
        if cfg!(unix) {
            assert_eq!(error.unwrap_err().kind(), ErrorKind::FileTooLarge);
        }
    }

    #[test]
    fn a_file_may_have_just_as_many_bytes() {
        let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/src/read.rs"));
        let size = std::fs::metadata(path).unwrap().len();
        assert_eq!(read_at_most(path, size).unwrap().len() as u64, size);
        assert_eq!(read_at_most(path, size - 1).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert_eq!(read_at_most(path.parent().unwrap(), size).unwrap_err().kind(), ErrorKind::IsADirectory);
    }
}
