//! Reads the messages of an MCAP file, from its beginning to its end, with one chunk in memory at a time. The checksum
//! of a chunk is verified before any message in it is used.

use super::{
    channel::{
        Budget, Channel, LONG_NAMES, LONGEST_RECORD, MOST_TIMES_AT_ONCE, Show, UNPACKS_TOO_MUCH,
        budget, damaged,
    },
    source,
};
use crate::{
    failure::{Failure, Place, quoted},
    regular_file,
};
use indicatif::ProgressBar;
use mcap::{
    McapError,
    records::op,
    sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions},
};
use std::{collections::BTreeMap, io::Read, path::Path, rc::Rc};

const RECOVER: &str = "copy it again, or recover what there is with `mcap recover`";

/// The schemas and channels of a bag by their identifiers.
#[derive(Default)]
struct Channels {
    schemas: BTreeMap<u16, (Rc<str>, Rc<str>)>,
    channels: BTreeMap<u16, Channel>,
}

/// Calls `show` with every message and its channel, in the order of the file, until `show` breaks.
pub(super) fn each_message(
    path: &Path,
    progress: &ProgressBar,
    claims: &mut Budget,
    show: Show,
) -> Result<Vec<Channel>, Failure> {
    let fail = |error: McapError| failure(path, &error);
    let mut file = source::open(path, progress)?;
    let (_, length) = regular_file::open(path)?;
    let longest = budget(length, MOST_TIMES_AT_ONCE).min(LONGEST_RECORD);
    let mut reader = LinearReader::new_with_options(
        LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_record_length_limit(longest as usize),
    );
    let mut channels = Channels::default();
    let mut messages = 0;
    let damaged = |what: &str| damaged(path, what, RECOVER);
    let short = || damaged("a record is too short");
    let long_names = || damaged(LONG_NAMES);
    while let Some(event) = reader.next_event() {
        let (opcode, data) = match event.map_err(fail)? {
            LinearReadEvent::ReadRequest(need) => {
                let read = file
                    .read(reader.insert(need))
                    .map_err(|error| Place::file(path).io(&error))?;
                reader.notify_read(read);
                continue;
            }
            LinearReadEvent::Record { opcode, data } => (opcode, data),
        };
        let unpacked = claims.unpack(9 + data.len() as u64);
        unpacked.ok_or_else(|| damaged(UNPACKS_TOO_MUCH))?;
        let mut fields = Fields(data);
        match opcode {
            op::SCHEMA => {
                let id = fields.number().ok_or_else(short)?;
                let name = fields.bytes().ok_or_else(short)?;
                let name = claims.name(name).ok_or_else(long_names)?;
                // The name of the definition's language lies between.
                let _ = fields.bytes().ok_or_else(short)?;
                let definition = claims.definition(fields.bytes().ok_or_else(short)?);
                channels.schemas.insert(id, (name, definition));
            }
            op::CHANNEL => {
                let id = fields.number().ok_or_else(short)?;
                let schema: u16 = fields.number().ok_or_else(short)?;
                let (schema, definition) =
                    channels.schemas.get(&schema).cloned().unwrap_or_default();
                let mut name = || {
                    let name = fields.bytes().ok_or_else(short)?;
                    claims.name(name).ok_or_else(long_names)
                };
                let channel_of = Channel {
                    topic: name()?,
                    schema,
                    encoding: name()?,
                    definition,
                };
                channels.channels.insert(id, channel_of);
            }
            op::STATISTICS => {
                // A damaged chunk header looks like an unknown record, which the reader skips. The
                // count of messages reveals that.
                let [low, high] = [fields.word(), fields.word()];
                let (low, high) = low.zip(high).ok_or_else(short)?;
                let count = u64::from(high) << 32 | u64::from(low);
                if count != messages {
                    return Err(damaged(&format!(
                        "only {messages} of {count} messages can be read"
                    )));
                }
            }
            op::MESSAGE => {
                messages += 1;
                let id: u16 = fields.number().ok_or_else(short)?;
                let sequence = fields.word().ok_or_else(short)?;
                // The times of logging and of publishing follow.
                let content = fields.0.get(16..).ok_or_else(short)?;
                let Some(channel) = channels.channels.get(&id) else {
                    return Err(fail(McapError::UnknownChannel(sequence, id)));
                };
                if show(channel, content)?.is_break() {
                    break;
                }
            }
            _ => {}
        }
    }
    Ok(channels.channels.into_values().collect())
}

/// The fields of a record, one behind the other. The lengths in a damaged record are checked against the
/// bytes that it has before anything is allocated.
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn number(&mut self) -> Option<u16> {
        let (number, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u16::from_le_bytes(*number))
    }

    fn word(&mut self) -> Option<u32> {
        let (word, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(u32::from_le_bytes(*word))
    }

    fn bytes(&mut self) -> Option<&'a [u8]> {
        let length = usize::try_from(self.word()?).ok()?;
        let (bytes, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(bytes)
    }
}

fn failure(path: &Path, error: &McapError) -> Failure {
    let place = Place::file(path);
    match error {
        McapError::BadMagic => place.failure("not an MCAP file", "check the file"),
        McapError::UnexpectedEof => place.failure("the bag ends in the middle", RECOVER),
        McapError::Io(error) => place.io(error),
        McapError::UnsupportedCompression(name) => place.failure(
            format!(
                "the chunks are compressed with {}, which is not supported",
                quoted(name.as_bytes())
            ),
            "compress them with zstd or lz4, with `mcap compress`",
        ),
        error => place.failure(format!("the bag is damaged: {error}"), RECOVER),
    }
}
