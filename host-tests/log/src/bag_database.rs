//! Opens a SQLite database for reading, such that nothing is written beside it, no lock is taken or waited for, and no
//! other file decides what is read.
//!
//! SQLite looks for a journal and for a write-ahead log beside a database, and makes files of its own there. With
//! `immutable` it does not. The write-ahead log of a bag that was not closed holds the last messages of it, so that both
//! are copied to the temporary folder and read there.

use super::{
    channel::{LONGEST_RECORD, damaged},
    source,
};
use crate::{
    failure::{Failure, Place},
    regular_file,
};
use indicatif::ProgressBar;
use rusqlite::{Connection, OpenFlags, limits::Limit};
use std::{
    ffi::OsString,
    fs::Metadata,
    io::{self, Read as _},
    path::{Path, PathBuf},
    time::SystemTime,
};
use tempfile::TempDir;

/// A query calls back every so many steps of SQLite's machine. A row of a bag takes some ten. Chosen by hand.
const STEPS: i32 = 10_000;

/// The steps that a query may take for each byte of the file, and beside them.
const MOST_STEPS_PER_BYTE: u64 = 64;
const MOST_STEPS: u64 = 10_000_000;

/// The first bytes of a journal that has something to roll back.
const HOT: [u8; 8] = [0xd9, 0xd5, 0x05, 0xf9, 0x20, 0xa1, 0x63, 0xd7];

/// A database that is open.
pub(super) struct Database {
    connection: Connection,
    length: u64,
    log_length: u64,
    /// The state of the file when it was opened.
    opened: State,
    /// The copy that is read in its place. It vanishes with this.
    _copy: Option<TempDir>,
}

/// The length of a file, and when it was written last.
type State = (u64, Option<SystemTime>);

fn state(file: &Metadata) -> State {
    (file.len(), file.modified().ok())
}

impl Database {
    /// Opens a database.
    pub(super) fn open(path: &Path, progress: &ProgressBar) -> Result<Self, Failure> {
        let io = |error: io::Error| Place::file(path).io(&error);
        // SQLite opens the file by itself; this opens it for the messages of files that cannot be read.
        drop(source::open(path, progress)?);
        let (file, length) = regular_file::open(path)?;
        let opened = state(&file.metadata().map_err(io)?);
        check_journal(path)?;
        let log = beside(path, "-wal").filter(|log| has_bytes(log));
        let (mut copy, mut log_length) = (None, 0);
        if let Some(log) = log {
            log_length = log.metadata().map_err(io)?.len();
            copy = Some(copied(path, &log).map_err(io)?);
        }
        let read = copy.as_ref().map(|copy| copy.path().join(COPY));
        let connection = connected(
            read.as_deref().unwrap_or(path),
            read.is_some(),
            length + log_length,
        );
        let connection = connection.map_err(|error| {
            damaged(path, &error.to_string(), "check the file, or copy it again")
        })?;
        let database = Self {
            connection,
            length: length + log_length,
            log_length,
            opened,
            _copy: copy,
        };
        database.check_unchanged(path)?;
        Ok(database)
    }

    pub(super) const fn connection(&self) -> &Connection {
        &self.connection
    }

    /// The length of the file and of its log in bytes.
    pub(super) const fn length(&self) -> u64 {
        self.length
    }

    /// The length of its log in bytes.
    pub(super) const fn log_length(&self) -> u64 {
        self.log_length
    }

    /// Checks that nobody has written to the file since it was opened: without a lock, what was read would be a mixture.
    pub(super) fn check_unchanged(&self, path: &Path) -> Result<(), Failure> {
        let file = path
            .metadata()
            .map_err(|error| Place::file(path).io(&error))?;
        if state(&file) == self.opened {
            return Ok(());
        }
        Err(Place::file(path).failure(
            "another program wrote to it while it was read",
            "end the recording first",
        ))
    }
}

/// The name of the copy in its folder.
const COPY: &str = "bag.db3";

/// The file beside a database with this behind its name, if it is a regular file: a pipe would be waited for.
fn beside(path: &Path, end: &str) -> Option<PathBuf> {
    let mut name = OsString::from(path);
    name.push(end);
    let file = PathBuf::from(name);
    file.is_file().then_some(file)
}

fn has_bytes(file: &Path) -> bool {
    file.metadata().is_ok_and(|file| file.len() > 0)
}

/// Refuses a database that has a journal to roll back. A journal names files that SQLite would delete, so that it is left
/// to whoever owns them.
fn check_journal(path: &Path) -> Result<(), Failure> {
    let Some(journal) = beside(path, "-journal") else {
        return Ok(());
    };
    let mut start = [0; HOT.len()];
    let read = std::fs::File::open(&journal).and_then(|mut file| file.read_exact(&mut start));
    if read.is_err() || start != HOT {
        return Ok(());
    }
    let name = journal.file_name().unwrap_or_default().to_string_lossy();
    Err(Place::file(path).failure(
        format!("the bag was not closed: {name} holds its last change"),
        "end the recording, or take the change back with `sqlite3 FILE .tables`",
    ))
}

/// Copies a database and its write-ahead log to a folder of its own.
fn copied(path: &Path, log: &Path) -> io::Result<TempDir> {
    let folder = TempDir::new()?;
    let copy = folder.path().join(COPY);
    std::fs::copy(log, folder.path().join(format!("{COPY}-wal")))?;
    std::fs::copy(path, copy)?;
    Ok(folder)
}

fn connected(path: &Path, has_log: bool, length: u64) -> rusqlite::Result<Connection> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY
        | OpenFlags::SQLITE_OPEN_NO_MUTEX
        | OpenFlags::SQLITE_OPEN_URI;
    let immutable = if has_log { "" } else { "?immutable=1" };
    let address = format!("{}{immutable}", address(path));
    let mut connection = Connection::open_with_flags(address, flags)?;
    // The limits come before the first query, which reads the schema.
    let longest = length.clamp(1 << 16, LONGEST_RECORD) as i32;
    connection.set_limit(Limit::SQLITE_LIMIT_LENGTH, longest)?;
    let most = MOST_STEPS_PER_BYTE.saturating_mul(length) + MOST_STEPS;
    let mut left = most / STEPS as u64;
    let count = move || {
        left = left.saturating_sub(1);
        left == 0
    };
    connection.progress_handler(STEPS, Some(count))?;
    connection.execute_batch("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;")?;
    Ok(connection)
}

/// The address of a file as a URI, in which no part of its name has a meaning.
fn address(path: &Path) -> String {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut address = String::from("file://");
    let bytes = path.as_os_str().as_encoded_bytes();
    if cfg!(windows) {
        address.push('/');
    }
    for &byte in bytes {
        match byte {
            b'\\' if cfg!(windows) => address.push('/'),
            b'/' | b'.' | b'-' | b'_' | b'0'..=b'9' | b'a'..=b'z' | b'A'..=b'Z' => {
                address.push(byte.into());
            }
            _ => address.push_str(&format!("%{byte:02X}")),
        }
    }
    address
}
