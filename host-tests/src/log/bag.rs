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
use crate::failure::{Failure, Place, quoted};
use indicatif::ProgressBar;
use mcap::{
    McapError,
    records::{Record, op},
    sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions},
};
use std::{
    collections::BTreeMap,
    io::Read,
    ops::ControlFlow,
    path::{Path, PathBuf},
};

/// The largest record or chunk that is accepted, in bytes. It limits the memory that a damaged length
/// can claim. Chosen by hand.
const LONGEST_RECORD: usize = 1 << 28;

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
    let mut reader = LinearReader::new_with_options(
        LinearReaderOptions::default()
            .with_prevalidate_chunk_crcs(true)
            .with_validate_data_section_crc(true)
            .with_validate_summary_section_crc(true)
            .with_record_length_limit(LONGEST_RECORD),
    );
    let mut channels = Channels::default();
    let mut messages = 0;
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
        if ![op::SCHEMA, op::CHANNEL, op::MESSAGE, op::STATISTICS].contains(&opcode) {
            continue;
        }
        match mcap::parse_record(opcode, data).map_err(fail)? {
            Record::Schema { header, .. } => {
                channels.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let schema = channels.schemas.get(&channel.schema_id);
                let channel_of = Channel {
                    topic: channel.topic,
                    schema: schema.cloned().unwrap_or_default(),
                    encoding: channel.message_encoding,
                };
                channels.channels.insert(channel.id, channel_of);
            }
            // A damaged chunk header looks like an unknown record, which the reader skips. The
            // count of messages reveals that.
            Record::Statistics(statistics) if statistics.message_count != messages => {
                return Err(Place::file(path).failure(
                    format!(
                        "the bag is damaged: only {messages} of {} messages can be read",
                        statistics.message_count
                    ),
                    RECOVER,
                ));
            }
            Record::Message { header, data } => {
                messages += 1;
                let Some(channel) = channels.channels.get(&header.channel_id) else {
                    return Err(fail(McapError::UnknownChannel(
                        header.sequence,
                        header.channel_id,
                    )));
                };
                if show(channel, &data)?.is_break() {
                    break;
                }
            }
            _ => {}
        }
    }
    Ok(channels)
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
