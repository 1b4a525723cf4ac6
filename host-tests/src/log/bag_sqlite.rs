//! Reads the messages of a bag of ROS 2 that is a SQLite database, in the order in which they were written.

use super::{
    channel::{Channel, LONGEST_RECORD, MOST_TIMES_IN_ALL, Show, budget, damaged, text},
    source,
};
use crate::{
    failure::{Failure, Place},
    regular_file,
};
use indicatif::ProgressBar;
use rusqlite::{Connection, Error, ErrorCode, OpenFlags, Row, limits::Limit, types::ValueRef};
use std::{collections::BTreeMap, path::Path};

const RECOVER: &str = "copy it again, or recover what there is with `sqlite3 FILE .recover`";

/// The most topics of a bag. Chosen by hand.
const MOST_TOPICS: usize = 1 << 12;

/// The least bytes that a row takes in a file: a message of an IMU has 300. More rows than fit into the file mean that
/// its pages form a circle.
const SHORTEST_ROW: u64 = 4;

/// Calls `show` with every message and its channel, in the order of the file, until `show` breaks.
pub(super) fn each_message(
    path: &Path,
    progress: &ProgressBar,
    show: Show,
) -> Result<Vec<Channel>, Failure> {
    // SQLite opens the file by itself; this opens it for the messages of files that cannot be read.
    drop(source::open(path, progress)?);
    let (_, length) = regular_file::open(path)?;
    let fail = |error: Error| failure(path, &error);
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let database = Connection::open_with_flags(path, flags).map_err(fail)?;
    let longest = length.clamp(1 << 16, LONGEST_RECORD) as i32;
    database
        .set_limit(Limit::SQLITE_LIMIT_LENGTH, longest)
        .map_err(fail)?;
    database
        .execute_batch("PRAGMA trusted_schema = OFF; PRAGMA cell_size_check = ON;")
        .map_err(fail)?;
    // A view could compute without end.
    let tables = "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name IN ('topics', 'messages')";
    let tables: i64 = database
        .query_row(tables, [], |row| row.get(0))
        .map_err(fail)?;
    if tables != 2 {
        return Err(Place::file(path).failure(
            "a SQLite database without the tables of a bag",
            "give a bag of ROS 2, or export the table as CSV",
        ));
    }
    let channels = channels(&database).map_err(fail)?;
    if channels.len() > MOST_TOPICS {
        return Err(damaged(path, "the bag has too many topics", RECOVER));
    }
    let mut statement = database
        .prepare("SELECT topic_id, data FROM messages ORDER BY id")
        .map_err(fail)?;
    let mut rows = statement.query([]).map_err(fail)?;
    let (mut count, mut bytes) = (0, 0);
    while let Some(row) = rows.next().map_err(fail)? {
        let topic: i64 = row.get(0).map_err(fail)?;
        let ValueRef::Blob(data) = row.get_ref(1).map_err(fail)? else {
            return Err(damaged(path, "a message is no blob", RECOVER));
        };
        count += 1;
        bytes += data.len() as u64;
        if count > length / SHORTEST_ROW || bytes > budget(length, MOST_TIMES_IN_ALL) {
            return Err(damaged(
                path,
                "it has more messages than fit into the file",
                RECOVER,
            ));
        }
        progress.set_position(bytes.min(length));
        let channel = channels
            .get(&topic)
            .ok_or_else(|| damaged(path, "a message has no topic", RECOVER))?;
        const ZSTD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];
        if channel.imu().is_some() && data.starts_with(ZSTD) {
            return Err(Place::file(path).failure(
                "the messages are compressed one by one",
                "convert the bag with `ros2 bag convert` to storage mcap without compression",
            ));
        }
        if show(channel, data)?.is_break() {
            break;
        }
    }
    Ok(channels.into_values().collect())
}

fn channels(database: &Connection) -> Result<BTreeMap<i64, Channel>, Error> {
    let mut statement =
        database.prepare("SELECT id, name, type, serialization_format FROM topics")?;
    let channel = |row: &Row| {
        let part = |column: usize| match row.get_ref(column) {
            Ok(ValueRef::Text(bytes)) => text(bytes),
            _ => String::new(),
        };
        let channel = Channel {
            topic: part(1),
            schema: part(2),
            encoding: part(3),
            definition: "".into(),
        };
        Ok((row.get(0)?, channel))
    };
    statement
        .query_map([], channel)?
        .take(MOST_TOPICS + 1)
        .collect()
}

fn failure(path: &Path, error: &Error) -> Failure {
    match error.sqlite_error_code() {
        Some(ErrorCode::NotADatabase) => {
            Place::file(path).failure("not a SQLite database", "check the file")
        }
        Some(ErrorCode::CannotOpen | ErrorCode::PermissionDenied) => Place::file(path).failure(
            format!("SQLite cannot open it: {error}"),
            "check the file's permissions, and that it was closed after the recording",
        ),
        _ => damaged(path, &error.to_string(), RECOVER),
    }
}
