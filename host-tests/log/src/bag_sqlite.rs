//! Reads the messages of a bag of ROS 2 that is a SQLite database, in the order in which they were written.
//!
//! The schema of a database is code that SQLite runs: views, generated columns and virtual tables compute what is not in
//! the file. Only plain tables are read, and no query takes more steps than the file has bytes for.

use super::{
    bag_database::Database,
    channel::{Budget, Channel, LONG_NAMES, MOST_CHANNELS, Show, UNPACKS_TOO_MUCH, damaged},
};
use crate::failure::{Failure, Place};
use indicatif::ProgressBar;
use rusqlite::{Connection, Error, ErrorCode, types::ValueRef};
use std::{collections::BTreeMap, path::Path};

const RECOVER: &str = "copy it again, or recover what there is with `sqlite3 FILE .recover`";

/// The least bytes that a row takes in a file: a message of an IMU has 300. More rows than fit into the file mean that
/// its pages form a circle.
const SHORTEST_ROW: u64 = 4;

const MESSAGES: &str = "SELECT topic_id, data FROM messages ORDER BY id";
const TOPICS: &str = "SELECT id, name, type, serialization_format FROM topics";

/// Calls `show` with every message and its channel, in the order of the file, until `show` breaks.
pub(super) fn each_message(
    path: &Path,
    progress: &ProgressBar,
    claims: &mut Budget,
    show: Show,
) -> Result<Vec<Channel>, Failure> {
    let opened = Database::open(path, progress)?;
    let length = opened.length();
    claims.add(opened.log_length());
    let fail = |error: Error| failure(path, &error);
    let database = opened.connection();
    if !are_plain(database).map_err(fail)? {
        return Err(Place::file(path).failure(
            "a SQLite database without the tables of a bag",
            "give a bag of ROS 2, or export the table as CSV",
        ));
    }
    let channels = channels(path, database, claims)?;
    let mut statement = database.prepare(MESSAGES).map_err(fail)?;
    let mut rows = statement.query([]).map_err(fail)?;
    let (mut count, mut bytes) = (0, 0);
    while let Some(row) = rows.next().map_err(fail)? {
        let topic: i64 = row.get(0).map_err(fail)?;
        let ValueRef::Blob(data) = row.get_ref(1).map_err(fail)? else {
            return Err(damaged(path, "a message is no blob", RECOVER));
        };
        count += 1;
        bytes += data.len() as u64;
        if count > length / SHORTEST_ROW {
            return Err(damaged(
                path,
                "it has more messages than fit into the file",
                RECOVER,
            ));
        }
        let unpacked = claims.unpack(data.len() as u64);
        unpacked.ok_or_else(|| damaged(path, UNPACKS_TOO_MUCH, RECOVER))?;
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
    opened.check_unchanged(path)?;
    Ok(channels.into_values().collect())
}

/// Whether the tables of a bag are there, have only columns that are stored, and are stored in the order of their
/// identifiers, so that nothing is computed and nothing sorted.
fn are_plain(database: &Connection) -> Result<bool, Error> {
    // A virtual table has no root page.
    let tables = "SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND rootpage > 0 \
                  AND name IN ('topics', 'messages')";
    let tables: i64 = database.query_row(tables, [], |row| row.get(0))?;
    if tables != 2 {
        return Ok(false);
    }
    for table in ["topics", "messages"] {
        let mut is_plain = true;
        database.pragma(None, "table_xinfo", table, |column| {
            is_plain &= column.get::<_, i64>("hidden")? == 0;
            Ok(())
        })?;
        if !is_plain {
            return Ok(false);
        }
    }
    let mut plan = database.prepare(&format!("EXPLAIN QUERY PLAN {MESSAGES}"))?;
    let steps = plan.query_map([], |step| step.get::<_, String>("detail"))?;
    let steps = steps.collect::<Result<Vec<_>, _>>()?;
    Ok(!steps.iter().any(|step| step.contains("TEMP B-TREE")))
}

fn channels(
    path: &Path,
    database: &Connection,
    claims: &mut Budget,
) -> Result<BTreeMap<i64, Channel>, Failure> {
    let fail = |error: Error| failure(path, &error);
    let mut statement = database.prepare(TOPICS).map_err(fail)?;
    let mut rows = statement.query([]).map_err(fail)?;
    let mut channels = BTreeMap::new();
    let mut count = 0;
    while let Some(row) = rows.next().map_err(fail)? {
        count += 1;
        if count > MOST_CHANNELS {
            return Err(damaged(path, "the bag has too many topics", RECOVER));
        }
        let mut name = |column: usize| {
            let bytes = match row.get_ref(column) {
                Ok(ValueRef::Text(bytes)) => bytes,
                _ => b"",
            };
            let name = claims.name(bytes);
            name.ok_or_else(|| damaged(path, LONG_NAMES, RECOVER))
        };
        let channel = Channel {
            topic: name(1)?,
            schema: name(2)?,
            encoding: name(3)?,
            definition: "".into(),
        };
        channels.insert(row.get(0).map_err(fail)?, channel);
    }
    Ok(channels)
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
        Some(ErrorCode::OperationInterrupted) => damaged(
            path,
            "it takes more steps to read than it has bytes",
            RECOVER,
        ),
        _ => damaged(path, &error.to_string(), RECOVER),
    }
}
