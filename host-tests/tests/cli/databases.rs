//! Reads bags that are databases without a trace beside them, whatever state they are in.

use program::{output, refusal};
use rusqlite::Connection;
use std::{
    fs,
    path::{Path, PathBuf},
};
use tempfile::TempDir;

const HUMBLE: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../tests/fixtures/origins/humble.db3"
);

/// A folder with a copy of a bag.
fn copied() -> (TempDir, PathBuf) {
    let folder = TempDir::new().unwrap();
    let bag = folder.path().join("a.db3");
    fs::copy(HUMBLE, &bag).unwrap();
    (folder, bag)
}

/// The names and bytes of the files in a folder.
fn files(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let mut files: Vec<_> = entries
        .map(|entry| (entry.path(), fs::read(entry.path()).unwrap()))
        .collect();
    files.sort();
    files
}

/// The number of samples that are read of each axis.
fn samples(folder: &Path) -> u64 {
    let fit = output(folder, &["fit", "a.db3", "--repeats", "keep"]);
    let (before, _) = fit.split_once(" samples at ").unwrap();
    before.rsplit(' ').next().unwrap().parse().unwrap()
}

/// Repeats the messages of the bag with later stamps, as long as `more` of them.
fn grow(database: &Connection, more: u32) {
    let last: i64 = database
        .query_row("SELECT max(id) FROM messages", [], |row| row.get(0))
        .unwrap();
    let mut message: Vec<u8> = database
        .query_row("SELECT data FROM messages WHERE id = ?", [last], |row| {
            row.get(0)
        })
        .unwrap();
    for i in 1..=more {
        let nanoseconds = u32::from_le_bytes(message[8..12].try_into().unwrap()) + 5_000_000;
        message[8..12].copy_from_slice(&nanoseconds.to_le_bytes());
        database
            .execute(
                "INSERT INTO messages SELECT ?1, topic_id, timestamp + ?2, ?3 FROM messages WHERE id = ?4",
                (last + i64::from(i), i64::from(i) * 5_000_000, &message, last),
            )
            .unwrap();
    }
}

#[test]
fn a_bag_is_read_without_a_trace_beside_it() {
    let (folder, bag) = copied();
    // A bag of the resilient profile that was closed.
    let database = Connection::open(&bag).unwrap();
    database.pragma_update(None, "journal_mode", "wal").unwrap();
    database.close().unwrap();
    let before = files(folder.path());
    assert_eq!(before.len(), 1);
    assert_eq!(samples(folder.path()), 24);
    output(folder.path(), &["diagnose", "a.db3"]);
    assert_eq!(files(folder.path()), before);
}

#[test]
fn a_bag_that_was_not_closed_is_read_with_its_log() {
    let (folder, bag) = copied();
    let database = Connection::open(&bag).unwrap();
    database.pragma_update(None, "journal_mode", "wal").unwrap();
    database
        .pragma_update(None, "wal_autocheckpoint", 0)
        .unwrap();
    grow(&database, 16);
    let live = files(folder.path());
    assert_eq!(live.len(), 3);
    assert_eq!(samples(folder.path()), 40);
    assert_eq!(files(folder.path()), live);
    // As after a power cut: the log is there, and its index is not.
    let cut = TempDir::new().unwrap();
    for name in ["a.db3", "a.db3-wal"] {
        fs::copy(folder.path().join(name), cut.path().join(name)).unwrap();
    }
    let before = files(cut.path());
    assert_eq!(samples(cut.path()), 40);
    assert_eq!(files(cut.path()), before);
}

#[test]
fn a_locked_bag_is_read_and_one_with_a_journal_is_refused_as_not_closed() {
    let (folder, bag) = copied();
    let database = Connection::open(&bag).unwrap();
    database.execute_batch("BEGIN EXCLUSIVE").unwrap();
    assert_eq!(samples(folder.path()), 24);
    // A change that does not fit into the cache is written to the bag, which the journal can take back.
    database.pragma_update(None, "cache_size", 1).unwrap();
    grow(&database, 200);
    let before = files(folder.path());
    assert_eq!(before.len(), 2);
    let line = refusal(folder.path(), &["fit", "a.db3"]);
    let expected = "a.db3: the bag was not closed: a.db3-journal holds its last change; ";
    assert!(line.starts_with(expected), "{line}");
    assert_eq!(files(folder.path()), before);
    database.execute_batch("ROLLBACK").unwrap();
    assert_eq!(samples(folder.path()), 24);
    // Some programs leave a journal without content.
    fs::write(folder.path().join("a.db3-journal"), [0; 512]).unwrap();
    assert_eq!(samples(folder.path()), 24);
}
