//! Opens the files that commands read. Only regular files are read: a pipe would be waited for without
//! end, and a device may never end.
//!
//! A file is read to the length that it had at first, even if it grows meanwhile, and one that becomes shorter is an error
//! rather than a shorter record.

use crate::failure::{Failure, Place};
use std::{
    collections::BTreeMap,
    fs::File,
    io::{self, Read, Seek, SeekFrom},
    path::{Path, PathBuf},
    sync::{Mutex, MutexGuard, PoisonError},
};

/// The files that are held to their length, with that length and the number of holders.
static HELD: Mutex<BTreeMap<PathBuf, (u64, usize)>> = Mutex::new(BTreeMap::new());

fn held() -> MutexGuard<'static, BTreeMap<PathBuf, (u64, usize)>> {
    HELD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A regular file, which ends where it did at first.
#[derive(Debug)]
pub struct RegularFile {
    file: File,
    at: u64,
    length: u64,
}

/// Opens a regular file at its beginning, and returns it with its length in bytes.
///
/// # Errors
/// When the path is no regular file, or the file cannot be opened.
pub fn open(path: &Path) -> Result<(RegularFile, u64), Failure> {
    let fail = |error| Place::file(path).io(&error);
    // A pipe is recognised before it is opened, because opening it waits for a writer.
    let metadata = path.metadata().map_err(fail)?;
    if metadata.is_dir() {
        return Err(Place::file(path).failure("is a directory", "name a file in it"));
    }
    if !metadata.is_file() {
        return Err(
            Place::file(path).failure("is not a regular file", "save its content as a file first")
        );
    }
    let file = File::open(path).map_err(fail)?;
    // The length is that of the file that was opened: another one may have taken its place meanwhile, as a curve that is saved again.
    let metadata = file.metadata().map_err(fail)?;
    let length = held().get(path).map_or(metadata.len(), |held| held.0);
    let at = 0;
    Ok((RegularFile { file, at, length }, length))
}

/// Holds a file to the length that it has now, however often it is opened, as long as this exists.
#[derive(Debug)]
pub struct Hold(PathBuf);

impl Hold {
    /// Holds a file. A folder or a file that cannot be read is held to nothing.
    pub fn new(path: &Path) -> Self {
        let length = path.metadata().map_or(0, |file| file.len());
        let mut held = held();
        held.entry(path.to_owned()).or_insert((length, 0)).1 += 1;
        Self(path.to_owned())
    }

    /// The length that the file is held to, and the one that it has now.
    pub fn lengths(&self) -> (u64, u64) {
        let now = self.0.metadata().map_or(0, |file| file.len());
        (held().get(&self.0).map_or(now, |held| held.0), now)
    }

    /// Holds the file to the end of its last complete line. Returns false if it is held to one already.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn cut_to_line(&self) -> Result<bool, Failure> {
        const BLOCK: u64 = 1 << 16;
        let (mut file, length) = open(&self.0)?;
        let mut end = length;
        while end > 0 {
            let start = end.saturating_sub(BLOCK);
            let mut block = Vec::new();
            let read = file
                .seek(SeekFrom::Start(start))
                .and_then(|_| (&mut file).take(end - start).read_to_end(&mut block));
            read.map_err(|error| Place::file(&self.0).io(&error))?;
            if let Some(at) = block.iter().rposition(|&byte| byte == b'\n') {
                end = start + at as u64 + 1;
                break;
            }
            end = start;
        }
        if let Some((held, _)) = held().get_mut(&self.0) {
            *held = end;
        }
        Ok(end < length)
    }
}

impl Drop for Hold {
    fn drop(&mut self) {
        let mut held = held();
        if let Some((_, holders)) = held.get_mut(&self.0) {
            *holders -= 1;
            if *holders == 0 {
                held.remove(&self.0);
            }
        }
    }
}

/// What an error says of a file that has become shorter.
const SHORTER: &str = "it became shorter while it was read";

impl RegularFile {
    /// What is known of the file.
    ///
    /// # Errors
    /// When the system does not tell.
    pub fn metadata(&self) -> io::Result<std::fs::Metadata> {
        self.file.metadata()
    }
}

impl Read for RegularFile {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.length.saturating_sub(self.at);
        let room = usize::try_from(left).map_or(buffer.len(), |left| left.min(buffer.len()));
        if room == 0 {
            return Ok(0);
        }
        let read = self.file.read(&mut buffer[..room])?;
        self.at += read as u64;
        match read {
            0 => Err(io::Error::other(SHORTER)),
            read => Ok(read),
        }
    }
}

impl Seek for RegularFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let to = match to {
            SeekFrom::End(back) => SeekFrom::Start(
                self.length
                    .checked_add_signed(back)
                    .ok_or(io::ErrorKind::InvalidInput)?,
            ),
            to => to,
        };
        self.at = self.file.seek(to)?;
        Ok(self.at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write as _;

    #[test]
    fn a_file_is_read_to_its_first_length_and_one_that_became_shorter_is_an_error() {
        let mut written = tempfile::NamedTempFile::new().unwrap();
        written.write_all(&[7; 1000]).unwrap();
        let path = written.path().to_owned();
        let hold = Hold::new(&path);
        let (mut early, length) = open(&path).unwrap();
        written.write_all(&[8; 500]).unwrap();
        assert_eq!((length, hold.lengths()), (1000, (1000, 1500)));
        for file in [&mut early, &mut open(&path).unwrap().0] {
            let mut bytes = Vec::new();
            file.read_to_end(&mut bytes).unwrap();
            assert_eq!(bytes, [7; 1000]);
            file.seek(SeekFrom::End(-10)).unwrap();
            assert_eq!(file.read_to_end(&mut bytes).unwrap(), 10);
        }
        written.as_file().set_len(900).unwrap();
        let mut file = open(&path).unwrap().0;
        let error = file.read_to_end(&mut Vec::new()).unwrap_err();
        assert_eq!(error.to_string(), SHORTER);
        drop(hold);
        assert_eq!(open(&path).unwrap().1, 900);
        assert!(held().get(&path).is_none());
    }

    #[test]
    fn a_file_is_held_to_its_last_complete_line() {
        let mut written = tempfile::NamedTempFile::new().unwrap();
        written.write_all(&[b'7'; 200_000]).unwrap();
        let hold = Hold::new(written.path());
        assert!(hold.cut_to_line().unwrap());
        assert_eq!(hold.lengths(), (0, 200_000));
        drop(hold);
        written.write_all(b"\n").unwrap();
        written.write_all(&[b'7'; 100_000]).unwrap();
        let hold = Hold::new(written.path());
        assert!(hold.cut_to_line().unwrap() && !hold.cut_to_line().unwrap());
        assert_eq!(hold.lengths(), (200_001, 300_001));
    }
}
