//! Reads the messages of a bag of ROS 1, format 2.0, from its beginning to its end, with one chunk in memory at a
//! time (<https://wiki.ros.org/Bags/Format/2.0>).
//!
//! No library is used, because rosbag 0.6 panics on a bag that was not closed, and allocates what a damaged chunk
//! claims.

use super::{
    channel::{
        Budget, Channel, LONG_NAMES, LONGEST_RECORD, MOST_CHANNELS, MOST_TIMES_AT_ONCE, Show,
        UNPACKS_TOO_MUCH, budget, damaged,
    },
    source,
};
use crate::{
    failure::{Failure, Place, quoted},
    regular_file,
};
use bzip2::read::BzDecoder;
use indicatif::ProgressBar;
use std::{
    collections::BTreeMap,
    io::{ErrorKind, Read},
    ops::ControlFlow,
    path::Path,
};

const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

const REPAIR: &str = "copy it again, or recover what there is with `rosbag reindex`";

/// The longest header of a record, and the longest message definition, in bytes. Chosen by hand.
const LONGEST_HEADER: u64 = 1 << 20;

/// The kinds of records.
mod op {
    pub(super) const MESSAGE: u8 = 2;
    pub(super) const BAG: u8 = 3;
    pub(super) const CHUNK: u8 = 5;
    pub(super) const CONNECTION: u8 = 7;
}

/// The fields in the header of a record, each with its name.
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn get(&self, wanted: &str) -> Option<&'a [u8]> {
        let mut rest = self.0;
        while let Some((field, behind)) = cut(rest) {
            rest = behind;
            let at = field.iter().position(|&byte| byte == b'=')?;
            if &field[..at] == wanted.as_bytes() {
                return Some(&field[at + 1..]);
            }
        }
        None
    }

    fn word(&self, wanted: &str) -> Option<u32> {
        Some(u32::from_le_bytes(self.get(wanted)?.try_into().ok()?))
    }

    fn op(&self) -> Option<u8> {
        self.get("op")?.first().copied()
    }
}

/// The bytes behind a length, and the bytes behind them.
fn cut(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = bytes.split_first_chunk()?;
    rest.split_at_checked(usize::try_from(u32::from_le_bytes(*length)).ok()?)
}

/// A bag that is being read.
struct Reading<'a> {
    path: &'a Path,
    channels: BTreeMap<u32, Channel>,
    claims: &'a mut Budget,
    length: u64,
}

/// Calls `show` with every message and its channel, in the order of the file, until `show` breaks.
pub(super) fn each_message(
    path: &Path,
    progress: &ProgressBar,
    claims: &mut Budget,
    show: Show,
) -> Result<Vec<Channel>, Failure> {
    let mut file = source::open(path, progress)?;
    let (_, length) = regular_file::open(path)?;
    let damaged = |what: &str| damaged(path, what, REPAIR);
    let ends = || Place::file(path).failure("the bag ends in the middle", REPAIR);
    let mut magic = [0; MAGIC.len()];
    let read = file.read_exact(&mut magic);
    if read.is_err() || magic != *MAGIC {
        return Err(Place::file(path).failure("not a bag of ROS 1, version 2.0", "check the file"));
    }
    let mut position = MAGIC.len() as u64;
    let mut index = None;
    let mut reading = Reading {
        path,
        channels: BTreeMap::new(),
        claims,
        length,
    };
    // A record has a header and data, each behind its length.
    let mut part = |most: u64| -> Result<Option<Vec<u8>>, Failure> {
        let mut head = [0; 4];
        match file.read(&mut head[..1]) {
            Ok(0) => return Ok(None),
            Ok(_) => {}
            Err(error) => return Err(Place::file(path).io(&error)),
        }
        let io = |error: std::io::Error| match error.kind() {
            ErrorKind::UnexpectedEof => ends(),
            _ => Place::file(path).io(&error),
        };
        file.read_exact(&mut head[1..]).map_err(io)?;
        let claimed = u64::from(u32::from_le_bytes(head));
        position += 4 + claimed;
        if position > length {
            return Err(ends());
        }
        if claimed > most {
            return Err(damaged("a record is too long"));
        }
        let mut bytes = vec![0; claimed as usize];
        file.read_exact(&mut bytes).map_err(io)?;
        Ok(Some(bytes))
    };
    while let Some(header) = part(LONGEST_HEADER)? {
        let data = part(LONGEST_RECORD)?.ok_or_else(ends)?;
        let header = Fields(&header);
        match header.op() {
            Some(op::BAG) => {
                let at = header.get("index_pos").and_then(|at| at.try_into().ok());
                let at = u64::from_le_bytes(at.ok_or_else(|| damaged("the header has no index"))?);
                if at == 0 || at > length {
                    return Err(Place::file(path).failure("the bag was not closed", REPAIR));
                }
                index = Some(at);
            }
            Some(op::CHUNK) => {
                let flow = reading.chunk(&header, &data, show)?;
                if flow.is_break() {
                    return Ok(reading.channels.into_values().collect());
                }
            }
            Some(op) => {
                if reading.record(op, &header, &data, show)?.is_break() {
                    return Ok(reading.channels.into_values().collect());
                }
            }
            None => return Err(damaged("a record has no kind")),
        }
    }
    if index.is_none() {
        return Err(ends());
    }
    Ok(reading.channels.into_values().collect())
}

impl Reading<'_> {
    fn damaged(&self, what: &str) -> Failure {
        damaged(self.path, what, REPAIR)
    }

    /// Shows the messages of a chunk.
    fn chunk(
        &mut self,
        header: &Fields,
        data: &[u8],
        show: Show,
    ) -> Result<ControlFlow<()>, Failure> {
        let claimed = header.word("size").map(u64::from);
        let claimed = claimed.ok_or_else(|| self.damaged("a chunk has no size"))?;
        let most = budget(self.length, MOST_TIMES_AT_ONCE).min(LONGEST_RECORD);
        if claimed > most || self.claims.unpack(claimed).is_none() {
            return Err(self.damaged(UNPACKS_TOO_MUCH));
        }
        let mut unpacked = Vec::new();
        let limited = |reader: &mut dyn Read, unpacked: &mut Vec<u8>| {
            reader.take(claimed + 1).read_to_end(unpacked)
        };
        let read = match header.get("compression").unwrap_or_default() {
            b"none" => limited(&mut &*data, &mut unpacked),
            b"bz2" => limited(&mut BzDecoder::new(data), &mut unpacked),
            b"lz4" => {
                lz4::Decoder::new(data).and_then(|mut decoder| limited(&mut decoder, &mut unpacked))
            }
            other => {
                return Err(Place::file(self.path).failure(
                    format!(
                        "the chunks are compressed with {}, which is not supported",
                        quoted(other)
                    ),
                    "compress them with lz4, with `rosbag compress --lz4`",
                ));
            }
        };
        if read.is_err() || unpacked.len() as u64 != claimed {
            return Err(self.damaged("a chunk cannot be unpacked"));
        }
        let mut rest = unpacked.as_slice();
        while !rest.is_empty() {
            let record = cut(rest).and_then(|(header, rest)| Some((header, cut(rest)?)));
            let (header, (data, behind)) =
                record.ok_or_else(|| self.damaged("a record in a chunk is too short"))?;
            rest = behind;
            let header = Fields(header);
            let op = header
                .op()
                .ok_or_else(|| self.damaged("a record has no kind"))?;
            if self.record(op, &header, data, show)?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Takes a connection, or shows a message. Other records are left out.
    fn record(
        &mut self,
        op: u8,
        header: &Fields,
        data: &[u8],
        show: Show,
    ) -> Result<ControlFlow<()>, Failure> {
        let connection = || {
            header
                .word("conn")
                .ok_or_else(|| self.damaged("a record names no connection"))
        };
        match op {
            op::CONNECTION => {
                let connection = connection()?;
                let fields = Fields(data);
                let claims = &mut *self.claims;
                let names = [
                    claims.name(header.get("topic").unwrap_or_default()),
                    claims.name(fields.get("type").unwrap_or_default()),
                    claims.name(b"ros1"),
                ];
                let [Some(topic), Some(schema), Some(encoding)] = names else {
                    return Err(self.damaged(LONG_NAMES));
                };
                let definition = fields.get("message_definition").unwrap_or_default();
                let channel = Channel {
                    topic,
                    schema,
                    encoding,
                    definition: self.claims.definition(definition),
                };
                self.channels.insert(connection, channel);
                if self.channels.len() > MOST_CHANNELS {
                    return Err(self.damaged("the bag has too many connections"));
                }
                Ok(ControlFlow::Continue(()))
            }
            op::MESSAGE => {
                let connection = connection()?;
                let channel = self.channels.get(&connection);
                let channel =
                    channel.ok_or_else(|| self.damaged("a message names no connection"))?;
                show(channel, data)
            }
            _ => Ok(ControlFlow::Continue(())),
        }
    }
}
