//! Bags in MCAP files, of ROS 2 or of ROS 1 after `mcap convert`. The messages of one IMU topic
//! form the table.
//!
//! A bag is read from its beginning to its end, with one chunk in memory at a time. The checksum of
//! a chunk is verified before any message in it is used.

use super::{
    Options,
    columns::{AxisColumn, Columns, Look},
    imu_message::{COLUMNS, Encoding, ImuMessage},
    metadata::Metadata,
    source,
    table::{Ended, Stop, Table, Visitor},
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
use std::{
    collections::BTreeMap,
    io::Read,
    ops::ControlFlow,
    path::{Path, PathBuf},
};

/// The largest record or chunk that is accepted, in bytes. It limits the memory that a damaged length
/// can claim. Chosen by hand, as are the two limits below.
const LONGEST_RECORD: u64 = 1 << 28;

/// How many times the size of the file a record or an unpacked chunk may be long.
const MOST_TIMES_AT_ONCE: u64 = 8;

/// How many times the size of the file all its records may take. Messages of an IMU are packed to a
/// tenth of their size.
const MOST_TIMES_IN_ALL: u64 = 64;

const RECOVER: &str = "copy it again, or recover what there is with `mcap recover`";

/// The number of messages that decide what the columns look like. Chosen by hand.
const LOOKS: usize = 100;

/// A bag, and the topic in it that is read.
pub(super) struct Bag {
    path: PathBuf,
    topic: String,
    metadata: Metadata,
    columns: Columns,
}

/// The topic, message type and encoding of a channel.
struct Channel {
    topic: String,
    schema: String,
    encoding: String,
}

impl Channel {
    /// The encoding of the messages, or `None` if they are not those of an IMU.
    fn imu(&self) -> Option<Encoding> {
        Encoding::of(&self.schema, &self.encoding)
    }
}

/// The schemas and channels of a bag by their identifiers.
#[derive(Default)]
struct Channels {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
}

impl Bag {
    pub(super) fn open(
        path: &Path,
        options: &Options,
        progress: &ProgressBar,
    ) -> Result<Self, Failure> {
        let mut first: BTreeMap<String, Vec<ImuMessage>> = BTreeMap::new();
        let channels = each_message(path, progress, |channel, bytes| {
            if let Some(encoding) = channel.imu() {
                let first = first.entry(channel.topic.clone()).or_default();
                if first.len() < LOOKS {
                    first.extend(ImuMessage::read(bytes, encoding));
                }
            }
            Ok(ControlFlow::Continue(()))
        })?;
        let topic = choose(path, &channels, options.topic.as_deref())?;
        let first = first.remove(&topic).unwrap_or_default();
        let column = |column: usize| -> Vec<f64> {
            let value = |message: &ImuMessage| match column.checked_sub(1) {
                None => message.stamp_ns as f64,
                Some(value) => message.values[value],
            };
            first.iter().map(value).collect()
        };
        Ok(Self {
            path: path.to_owned(),
            topic,
            metadata: Metadata::default(),
            columns: Columns {
                names: Some(COLUMNS.map(String::from).to_vec()),
                looks: vec![Look::Number; COLUMNS.len()],
                heads: (0..COLUMNS.len()).map(column).collect(),
            },
        })
    }
}

impl Table for Bag {
    fn metadata(&self) -> &Metadata {
        &self.metadata
    }

    fn columns(&self) -> &Columns {
        &self.columns
    }

    fn pass<V: Visitor>(
        &self,
        axes: &[AxisColumn],
        visitor: &mut V,
        progress: &ProgressBar,
    ) -> Result<Ended, Failure> {
        let mut ended = Ended::AtTheLastRow;
        let mut row = 0;
        each_message(&self.path, progress, |channel, bytes| {
            let Some(encoding) = channel.imu().filter(|_| channel.topic == self.topic) else {
                return Ok(ControlFlow::Continue(()));
            };
            row += 1;
            let place = || Place::row(&self.path, row);
            let message = ImuMessage::read(bytes, encoding).map_err(|what| {
                place().failure(format!("{}: {what}", self.topic), "record the bag again")
            })?;
            for (i, axis) in axes.iter().enumerate() {
                match visit(&message, i, axis.column, visitor) {
                    Ok(()) => {}
                    Err(Stop::NotCounts) => {
                        ended = Ended::NotCounts;
                        return Ok(ControlFlow::Break(()));
                    }
                    Err(stop) => return Err(stop.failure(axis, place())),
                }
            }
            Ok(ControlFlow::Continue(()))
        })?;
        Ok(ended)
    }

    fn notes(&self) -> Vec<String> {
        vec![format!("topic {}", self.topic)]
    }
}

fn visit<V: Visitor>(
    message: &ImuMessage,
    axis: usize,
    column: usize,
    visitor: &mut V,
) -> Result<(), Stop> {
    match column.checked_sub(1) {
        None => visitor.visit(axis, message.stamp_ns),
        Some(value) => visitor.visit(axis, message.values[value]),
    }
}

/// The topic that is asked for, or else the only IMU topic of the bag.
fn choose(path: &Path, channels: &Channels, wanted: Option<&str>) -> Result<String, Failure> {
    let all = || channels.channels.values();
    let mut imus: Vec<&str> = all()
        .filter(|channel| channel.imu().is_some())
        .map(|channel| channel.topic.as_str())
        .collect();
    imus.sort_unstable();
    imus.dedup();
    let fail = |what: String, remedy: &str| Err(Place::file(path).failure(what, remedy));
    match (wanted, imus.as_slice()) {
        (None, [topic]) => Ok((*topic).to_owned()),
        (Some(wanted), imus) if imus.contains(&wanted) => Ok(wanted.to_owned()),
        (_, []) => {
            let kind = |channel: &Channel| {
                let Channel {
                    topic,
                    schema,
                    encoding,
                } = channel;
                format!("{topic} ({schema}, {encoding})")
            };
            let found = match all().map(kind).collect::<Vec<_>>() {
                found if found.is_empty() => "no topic at all".into(),
                found => format!("only {}", found.join(", ")),
            };
            fail(
                format!("no topic of sensor_msgs/msg/Imu: {found}"),
                "give a bag with an IMU",
            )
        }
        (Some(wanted), imus) => fail(
            format!("no IMU topic is named {}", quoted(wanted.as_bytes())),
            &format!("choose with --topic from {}", imus.join(", ")),
        ),
        (None, imus) => fail(
            format!("there are {} IMU topics: {}", imus.len(), imus.join(", ")),
            "choose one with --topic",
        ),
    }
}

/// Calls `show` with every message and its channel, in the order of the file, until `show` breaks.
fn each_message(
    path: &Path,
    progress: &ProgressBar,
    mut show: impl FnMut(&Channel, &[u8]) -> Result<ControlFlow<()>, Failure>,
) -> Result<Channels, Failure> {
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
    let damaged = |what: &str| Place::file(path).failure(format!("damaged: {what}"), RECOVER);
    let short = || damaged("a record is too short");
    let most = budget(length, MOST_TIMES_IN_ALL);
    let mut unpacked = 0;
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
        unpacked += 9 + data.len() as u64;
        if unpacked > most {
            return Err(damaged("the chunks unpack to too many times their size"));
        }
        let mut fields = Fields(data);
        match opcode {
            op::SCHEMA => {
                let id = fields.number().ok_or_else(short)?;
                let name = fields.text().ok_or_else(short)?;
                channels.schemas.insert(id, name);
            }
            op::CHANNEL => {
                let id = fields.number().ok_or_else(short)?;
                let schema: u16 = fields.number().ok_or_else(short)?;
                let channel_of = Channel {
                    topic: fields.text().ok_or_else(short)?,
                    schema: channels.schemas.get(&schema).cloned().unwrap_or_default(),
                    encoding: fields.text().ok_or_else(short)?,
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
    Ok(channels)
}

/// The fields of a record, one behind the other. The lengths in a damaged record are checked against the
/// bytes that it has before anything is allocated.
struct Fields<'a>(&'a [u8]);

impl Fields<'_> {
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

    /// A text without control characters.
    fn text(&mut self) -> Option<String> {
        let length = usize::try_from(self.word()?).ok()?;
        let (text, rest) = self.0.split_at_checked(length)?;
        self.0 = rest;
        Some(String::from_utf8_lossy(text).replace(char::is_control, " "))
    }
}

/// The bytes that a file of this length may claim or unpack to.
fn budget(length: u64, times: u64) -> u64 {
    (1 << 23) + times.saturating_mul(length)
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
