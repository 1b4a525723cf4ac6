//! Bags of ROS 2 and ROS 1. The messages of one IMU topic form the table.

use super::{
    Options, bag_mcap, bag_ros1, bag_sqlite,
    channel::{Budget, Channel, Layouts, MOST_CHANNELS, Show},
    columns::{AxisColumn, Columns, Look},
    converted::{Converted, Text},
    imu_message::{COLUMNS, Encoding, ImuMessage, frame_of},
    message_layout::{Layout, Value},
    metadata::Metadata,
    table::{Ended, Stop, Table, Visitor, after_stop},
};
use crate::failure::{Failure, Place, quoted};
use indicatif::ProgressBar;
use std::{
    collections::{BTreeMap, BTreeSet},
    io::Write as _,
    ops::ControlFlow,
    path::{Path, PathBuf},
    rc::Rc,
};

/// The number of messages that decide what the columns look like. Chosen by hand.
const LOOKS: usize = 100;

/// A bag, and the topic in it that is read.
pub(super) struct Bag {
    container: Container,
    /// The files in the order of their messages.
    files: Vec<PathBuf>,
    topic: String,
    /// Whether all messages say that there is no estimate of the rates, and of the accelerations.
    unmeasured: [bool; 2],
    metadata: Metadata,
    columns: Columns,
}

/// How messages are stored in the files of a bag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Container {
    /// MCAP, of ROS 2, or of ROS 1 after `mcap convert`.
    Mcap,
    /// The bags of ROS 1.
    Ros1,
    /// SQLite, of ROS 2 up to Humble.
    Sqlite,
}

impl Bag {
    pub(super) fn open(
        path: &Path,
        (container, files): (Container, Vec<PathBuf>),
        options: &Options,
        progress: &ProgressBar,
    ) -> Result<Self, Failure> {
        let wanted = options.topic.as_deref();
        // The first messages of the topic that is read, which is the first one if it is the only one.
        let mut first: Option<(Rc<str>, Vec<ImuMessage>)> = None;
        let mut frames = BTreeSet::new();
        let mut unmeasured = [true; 2];
        let channels = each_message(container, &files, progress, &mut |channel, bytes| {
            if wanted.is_some_and(|wanted| *channel.topic != *wanted) {
                return Ok(ControlFlow::Continue(()));
            }
            if let Some(encoding) = channel.imu() {
                let (topic, first) =
                    first.get_or_insert_with(|| (channel.topic.clone(), Vec::new()));
                if *topic != channel.topic {
                    return Ok(ControlFlow::Continue(()));
                }
                if first.len() < LOOKS {
                    first.extend(ImuMessage::read(bytes, encoding));
                    frames.extend(frame_of(bytes, encoding));
                }
                // One message with an estimate is enough.
                if unmeasured.contains(&true)
                    && let Ok(message) = ImuMessage::read(bytes, encoding)
                {
                    for (all, this) in unmeasured.iter_mut().zip(message.unmeasured) {
                        *all &= this;
                    }
                }
            }
            Ok(ControlFlow::Continue(()))
        })?;
        let topic = choose(path, &channels, wanted)?;
        if frames.len() > 1 && first.as_ref().is_some_and(|(of, _)| **of == *topic) {
            let shown: Vec<String> = frames.iter().map(|one| quoted(one.as_bytes())).collect();
            return Err(Place::file(path).failure(
                format!(
                    "the messages of topic {topic} are those of {} sensors, by their frame: {}",
                    frames.len(),
                    shown.join(", ")
                ),
                "give each sensor a topic of its own, or keep the messages of one frame",
            ));
        }
        let (_, first) = first.filter(|(of, _)| **of == *topic).unwrap_or_default();
        let column = |column: usize| -> Vec<f64> {
            let value = |message: &ImuMessage| match column.checked_sub(1) {
                None => message.stamp_ns as f64,
                Some(value) => message.values[value],
            };
            first.iter().map(value).collect()
        };
        let unmeasured = unmeasured.map(|all| all && !first.is_empty());
        Ok(Self {
            container,
            unmeasured,
            files,
            topic,
            metadata: Metadata::default(),
            columns: Columns {
                names: Some(COLUMNS.map(String::from).to_vec()),
                looks: vec![Look::Number; COLUMNS.len()],
                heads: (0..COLUMNS.len()).map(column).collect(),
                longer: Vec::new(),
                tags: Vec::new(),
                defined: Vec::new(),
                said: String::new(),
            },
        })
    }
}

impl Bag {
    /// Refuses axes of a sensor of which there is no estimate.
    fn check(&self, axes: &[AxisColumn]) -> Result<(), Failure> {
        let sensors = [
            (1..4, "angular velocity", "accelerometer", "accel"),
            (4..7, "linear acceleration", "gyro", "gyro"),
        ];
        for (sensor, (columns, quantity, other, option)) in sensors.into_iter().enumerate() {
            let is_asked = axes.iter().any(|axis| columns.contains(&axis.column));
            if !is_asked || !self.unmeasured[sensor] {
                continue;
            }
            let what = format!(
                "the messages of topic {} say that there is no estimate of the {quantity}: the first element of its covariance is -1",
                self.topic
            );
            let driver =
                "record with a driver that measures it, or export it as text if this driver does";
            let remedy = match self.unmeasured[1 - sensor] {
                true => driver.to_owned(),
                false => format!("read the {other} with --sensor {option}, or {driver}"),
            };
            let file = self.files.first().map_or(Path::new(""), PathBuf::as_path);
            return Err(Place::file(file).failure(what, remedy));
        }
        Ok(())
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
        self.check(axes)?;
        let mut ended = Ended::AtTheLastRow;
        let mut row = 0;
        each_message(
            self.container,
            &self.files,
            progress,
            &mut |channel, bytes| {
                let Some(encoding) = channel.imu().filter(|_| *channel.topic == *self.topic) else {
                    return Ok(ControlFlow::Continue(()));
                };
                row += 1;
                let file = self.files.first().map_or(Path::new(""), PathBuf::as_path);
                let place = || Place::row(file, row);
                let message = ImuMessage::read(bytes, encoding).map_err(|what| {
                    place().failure(format!("{}: {what}", self.topic), "record the bag again")
                })?;
                for (i, axis) in axes.iter().enumerate() {
                    if let Err(stop) = visit(&message, i, axis.column, visitor) {
                        if after_stop(visitor, (i, &stop), axes, place)? {
                            break;
                        }
                        ended = Ended::NotCounts;
                        return Ok(ControlFlow::Break(()));
                    }
                }
                Ok(ControlFlow::Continue(()))
            },
        )?;
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
fn choose(path: &Path, channels: &[Channel], wanted: Option<&str>) -> Result<String, Failure> {
    let all = || channels.iter();
    let mut imus: Vec<&str> = all()
        .filter(|channel| channel.imu().is_some())
        .map(|channel| &*channel.topic)
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
                    ..
                } = channel;
                let [topic, schema, encoding] = [topic, schema, encoding].map(|name| brief(name));
                format!("{topic} ({schema}, {encoding})")
            };
            let found = match channels {
                [] => "no topic at all".into(),
                found => format!("only {}", listed(found.iter().map(kind))),
            };
            fail(
                format!("no topic of sensor_msgs/msg/Imu: {found}"),
                "give a bag with an IMU, or name a topic of other messages with rates with --topic",
            )
        }
        (Some(wanted), imus) => fail(
            format!("no IMU topic is named {}", quoted(wanted.as_bytes())),
            &format!(
                "choose with --topic from {}",
                listed(imus.iter().map(|topic| brief(topic)))
            ),
        ),
        (None, imus) => fail(
            format!(
                "there are {} IMU topics: {}",
                imus.len(),
                listed(imus.iter().map(|topic| brief(topic)))
            ),
            "choose one with --topic",
        ),
    }
}

/// The most names in a message, and the most characters of each. Chosen by hand.
const MOST_NAMES: usize = 10;
const LONGEST_NAME: usize = 60;

/// The beginning of a name.
fn brief(name: &str) -> String {
    let mut shown: String = name.chars().take(LONGEST_NAME).collect();
    if shown.len() < name.len() {
        shown.push('…');
    }
    shown
}

/// The first of several names, and how many follow.
fn listed(names: impl ExactSizeIterator<Item = String>) -> String {
    let more = names.len().saturating_sub(MOST_NAMES);
    let mut shown: Vec<String> = names.take(MOST_NAMES).collect();
    if more > 0 {
        shown.push(format!("and {more} more"));
    }
    shown.join(", ")
}

/// The messages of another type that is asked for, or of the only type with rates among its fields, as text: one that
/// contains `sensor_msgs/Imu`, or rates by themselves. `None` if the bag has an IMU topic, or no such type.
pub(super) fn other_messages(
    path: &Path,
    (container, files): (Container, &[PathBuf]),
    options: &Options,
    progress: &ProgressBar,
) -> Result<Option<Converted>, Failure> {
    let wanted = options.topic.as_deref();
    let is_wanted = |channel: &&Channel| wanted.is_none_or(|wanted| *channel.topic == *wanted);
    let channels = each_message(container, files, progress, &mut |channel, _| {
        let is_imu = is_wanted(&channel) && channel.imu().is_some();
        Ok(if is_imu {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        })
    })?;
    if channels
        .iter()
        .filter(is_wanted)
        .any(|channel| channel.imu().is_some())
    {
        return Ok(None);
    }
    let has_rates = |layout: &Layout| {
        let names = layout.columns();
        let words = [
            "angular_velocity",
            "gyr",
            "angular_rate",
            "body_rate",
            "omega",
        ];
        let is_rate = |name: &&String| words.iter().any(|word| name.to_lowercase().contains(word));
        names.iter().filter(is_rate).count() >= 3
    };
    let mut found: BTreeMap<&str, (Rc<Layout>, Encoding)> = BTreeMap::new();
    let mut layouts = Layouts::new();
    for channel in channels.iter().filter(is_wanted) {
        let layout = layouts.of(channel);
        let layout = layout.filter(|(layout, _)| match wanted {
            Some(_) => !layout.columns().is_empty(),
            None => has_rates(layout),
        });
        found.extend(layout.map(|layout| (&*channel.topic, layout)));
    }
    let mut found = found.into_iter();
    let (Some((topic, (layout, encoding))), None) = (found.next(), found.next()) else {
        return Ok(None);
    };
    let (mut text, file) = Text::new(path, length(files))?;
    text.names(layout.columns())
        .map_err(|error| text.failure(&error))?;
    each_message(container, files, progress, &mut |channel, bytes| {
        if *channel.topic == *topic {
            let values = layout.read(bytes, encoding).ok_or_else(|| {
                let what = format!("{topic}: a message is not as its definition says");
                Place::file(path).failure(what, "record the bag again")
            })?;
            let mut separator = "";
            for value in values {
                let written = match value {
                    Value::Integer(value) => write!(text, "{separator}{value}"),
                    Value::Float(value) => write!(text, "{separator}{value}"),
                };
                written.map_err(|error| text.failure(&error))?;
                separator = ",";
            }
            writeln!(text).map_err(|error| text.failure(&error))?;
        }
        Ok(ControlFlow::Continue(()))
    })?;
    text.finish()?;
    Ok(Some(Converted {
        text: file,
        #[cfg(feature = "tables")]
        numbers: None,
        note: Some(format!("topic {topic}")),
    }))
}

/// The bytes that files have together.
fn length(files: &[PathBuf]) -> u64 {
    let files = files.iter().filter_map(|file| file.metadata().ok());
    files.map(|file| file.len()).sum()
}

/// Calls `show` with every message and its channel, file after file, until `show` breaks. Returns the channels, each of
/// them once.
fn each_message(
    container: Container,
    files: &[PathBuf],
    progress: &ProgressBar,
    show: Show,
) -> Result<Vec<Channel>, Failure> {
    let mut budget = Budget::new(length(files));
    let mut channels = Vec::new();
    let mut known = BTreeSet::new();
    let mut is_over = false;
    let mut show = |channel: &Channel, bytes: &[u8]| {
        if is_over {
            return Ok(ControlFlow::Break(()));
        }
        let flow = show(channel, bytes)?;
        is_over |= flow.is_break();
        Ok(flow)
    };
    for file in files {
        let read = match container {
            Container::Mcap => bag_mcap::each_message,
            Container::Ros1 => bag_ros1::each_message,
            Container::Sqlite => bag_sqlite::each_message,
        };
        for channel in read(file, progress, &mut budget, &mut show)? {
            if known.insert(channel.clone()) {
                channels.push(channel);
            }
        }
        if channels.len() > MOST_CHANNELS {
            return Err(Place::file(file).failure(
                format!("damaged: more than {MOST_CHANNELS} channels"),
                "check what it holds, and copy it again",
            ));
        }
    }
    Ok(channels)
}
