//! Reads logs of PX4. The messages of one instance of a topic form the table, whichever of its subscriptions they are of: each
//! subscription has a number of its own, and a logger may end one and begin another.

use super::{
    Options,
    columns::{AxisColumn, Columns, Look},
    metadata::Metadata,
    scaling, source,
    table::{Ended, Table, Visitor, after_stop},
    ulog_format::Value,
    ulog_messages::{Error, Message, Messages, Subscription},
    ulog_topics::{RAW, Source, columns, defined},
};
use crate::{
    failure::{Failure, Place, plural, quoted},
    unit::Sensor,
};
use indicatif::ProgressBar;
use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
};

/// The number of messages that decide what the columns look like. Chosen by hand.
const LOOKS: usize = 100;

/// A log, and the topic in it that is read.
pub(super) struct Ulog {
    path: PathBuf,
    identities: BTreeSet<u16>,
    sources: Vec<Source>,
    metadata: Metadata,
    columns: Columns,
    notes: Vec<String>,
}

/// An instance of a topic in a log.
struct Found {
    subscription: Subscription,
    /// The numbers of its subscriptions.
    identities: BTreeSet<u16>,
    messages: u64,
}

impl Found {
    fn name(&self) -> String {
        format!("{}:{}", self.subscription.topic, self.subscription.instance)
    }
}

impl Ulog {
    pub(super) fn open(
        path: &Path,
        options: &Options,
        progress: &ProgressBar,
    ) -> Result<Self, Failure> {
        let fail = |error| failure(path, &error);
        let file = source::open(path, progress)?;
        let mut log = Messages::open(file).map_err(fail)?;
        let mut counts: BTreeMap<u16, u64> = BTreeMap::new();
        let mut notes = Vec::new();
        loop {
            match log.next().map_err(fail)? {
                Message::Data(identity, _) => *counts.entry(identity).or_default() += 1,
                Message::Cut => {
                    notes
                        .push("the file ends within a message: the record is cut off there".into());
                    break;
                }
                Message::End => break,
            }
        }
        if counts.is_empty() && !notes.is_empty() {
            return Err(
                Place::file(path).failure("the file ends before its first data message", COPY)
            );
        }
        let found = instances(std::mem::take(&mut log.subscriptions), &counts);
        // Formats can be long. Only those of raw topics, of which there are few, and that of the chosen
        // topic are expanded.
        let expanded = |topic: &str| {
            let fields = log.formats.fields(topic);
            let fields = fields.map_err(|what| Place::file(path).failure(what, COPY))?;
            Ok::<_, Failure>(columns(topic, &fields))
        };
        let mut raw = BTreeMap::new();
        for topic in RAW {
            if found.iter().any(|one| one.subscription.topic == topic) {
                let columns = expanded(topic)?;
                let names: Vec<String> = columns.into_iter().map(|(name, _)| name).collect();
                let defined = defined(topic, &names);
                let has = |sensor| defined.iter().any(|(_, of)| *of == sensor);
                raw.insert(topic, (has(Sensor::Gyro), has(Sensor::Accelerometer)));
            }
        }
        let has = |topic: &str, sensor: Sensor| {
            raw.get(topic)
                .is_some_and(|(gyro, accelerometer)| match sensor {
                    Sensor::Gyro => *gyro,
                    Sensor::Accelerometer => *accelerometer,
                })
        };
        let chosen = choose(path, &found, options, has)?;
        let others: Vec<String> = found
            .iter()
            .filter(|one| one.identities != chosen.identities && is_raw(one))
            .map(|one| format!("{} ({})", one.name(), plural(one.messages, "message")))
            .collect();
        let mut note = format!(
            "topic {} of {}",
            chosen.name(),
            plural(chosen.messages, "message")
        );
        if !others.is_empty() {
            note += &format!("; others: {} (choose with --topic)", few(&others));
        }
        notes.insert(0, note);

        let (names, sources): (Vec<_>, Vec<_>) =
            expanded(&chosen.subscription.topic)?.into_iter().unzip();
        drop(log);
        let mut log = Self {
            path: path.to_owned(),
            identities: chosen.identities.clone(),
            metadata: Metadata::default(),
            columns: Columns {
                looks: vec![Look::Number; names.len()],
                heads: vec![Vec::new(); names.len()],
                longer: Vec::new(),
                tags: Vec::new(),
                defined: defined(&chosen.subscription.topic, &names),
                said: String::new(),
                names: Some(names),
            },
            sources,
            notes,
        };
        log.columns.heads = log.heads()?;
        Ok(log)
    }

    /// The first values of every column.
    fn heads(&self) -> Result<Vec<Vec<f64>>, Failure> {
        let mut heads = vec![Vec::new(); self.sources.len()];
        let mut rows = 0;
        self.each_row(&ProgressBar::hidden(), |_, bytes| {
            for (head, source) in heads.iter_mut().zip(&self.sources) {
                head.extend(source.value(bytes).map(Value::to_f64));
            }
            rows += 1;
            Ok(rows < LOOKS)
        })?;
        Ok(heads)
    }

    /// Shows the topic's messages, with their numbers counted from 1, for as long as more are
    /// wanted.
    fn each_row(
        &self,
        progress: &ProgressBar,
        mut show: impl FnMut(u64, &[u8]) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let fail = |error| failure(&self.path, &error);
        let file = source::open(&self.path, progress)?;
        let mut log = Messages::open(file).map_err(fail)?;
        let mut row = 0;
        while let Message::Data(identity, bytes) = log.next().map_err(fail)? {
            if self.identities.contains(&identity) {
                row += 1;
                if !show(row, bytes)? {
                    break;
                }
            }
        }
        Ok(())
    }
}

impl Table for Ulog {
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
        self.each_row(progress, |row, bytes| {
            let place = || Place::row(&self.path, row);
            for (i, axis) in axes.iter().enumerate() {
                let Some(value) = self.sources[axis.column].value(bytes) else {
                    return Err(place().failure("a message is shorter than its format", COPY));
                };
                let visited = match value {
                    Value::Signed(value) => visitor.visit(i, value),
                    Value::Unsigned(value) => visitor.visit(i, value),
                    Value::Float(value) => visitor.visit(i, value),
                };
                if let Err(stop) = visited {
                    let goes_on = after_stop(visitor, (i, &stop), axes, place)?;
                    if !goes_on {
                        ended = Ended::NotCounts;
                    }
                    return Ok(goes_on);
                }
            }
            Ok(true)
        })?;
        Ok(ended)
    }

    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }
}

const COPY: &str = "copy or record the log again";

/// The first names of a list, and how many others there are.
fn few(names: &[String]) -> String {
    const FEW: usize = 30;
    match names.len().checked_sub(FEW) {
        None | Some(0) => names.join(", "),
        Some(more) => format!("{} and {more} more", names[..FEW].join(", ")),
    }
}

fn is_raw(found: &Found) -> bool {
    RAW.contains(&found.subscription.topic.as_str())
}

/// The instances of topics with messages, in the order of the numbers of their subscriptions.
fn instances(
    subscriptions: BTreeMap<u16, Subscription>,
    counts: &BTreeMap<u16, u64>,
) -> Vec<Found> {
    let mut found: Vec<Found> = Vec::new();
    let mut places: BTreeMap<(String, u8), usize> = BTreeMap::new();
    for (identity, subscription) in subscriptions {
        let Some(&messages) = counts.get(&identity) else {
            continue;
        };
        let name = (subscription.topic.clone(), subscription.instance);
        let place = *places.entry(name).or_insert(found.len());
        if place == found.len() {
            found.push(Found {
                subscription,
                identities: BTreeSet::new(),
                messages: 0,
            });
        }
        found[place].identities.insert(identity);
        found[place].messages += messages;
    }
    found
}

/// The topic that is asked for by its name or as `TOPIC:INSTANCE`. Without a request, it is the
/// topic of raw samples of the sensor with the most messages, provided that only one instance has
/// that many.
fn choose<'a>(
    path: &Path,
    found: &'a [Found],
    options: &Options,
    has: impl Fn(&str, Sensor) -> bool,
) -> Result<&'a Found, Failure> {
    let fail = |what: String, remedy: &str| Err(Place::file(path).failure(what, remedy));
    let list = |found: &[&Found]| {
        let names: Vec<String> = found.iter().map(|one| one.name()).collect();
        few(&names)
    };
    let all: Vec<&Found> = found.iter().collect();
    let candidates: Vec<&Found> = if let Some(wanted) = &options.topic {
        let is = |one: &&Found| one.subscription.topic == *wanted || one.name() == *wanted;
        let candidates: Vec<_> = all.iter().copied().filter(is).collect();
        if candidates.is_empty() {
            let what = format!("no topic {} has messages", quoted(wanted.as_bytes()));
            return fail(what, &format!("choose with --topic from {}", list(&all)));
        }
        if wanted.contains("_fifo") {
            return fail(
                format!("{wanted} packs several samples into a message"),
                "log and choose a topic with one sample a message, such as sensor_gyro",
            );
        }
        candidates
    } else {
        let of = |sensor: Sensor| -> Vec<_> {
            let is = |one: &&Found| is_raw(one) && has(&one.subscription.topic, sensor);
            all.iter().copied().filter(is).collect()
        };
        let candidates = match scaling::wanted_sensor(options)? {
            Some(sensor) => of(sensor),
            None => [of(Sensor::Gyro), of(Sensor::Accelerometer)]
                .into_iter()
                .find(|candidates| !candidates.is_empty())
                .unwrap_or_default(),
        };
        let most = candidates.iter().map(|one| one.messages).max();
        let Some(most) = most else {
            let there = match list(&all) {
                there if there.is_empty() => "there are no messages at all".into(),
                there => format!("there are {there}"),
            };
            return fail(
                format!("no topic of {} with messages: {there}", RAW.join(", ")),
                "log one of these, or choose with --topic and --columns",
            );
        };
        let is = |one: &&Found| one.messages == most;
        candidates.into_iter().filter(is).collect()
    };
    match candidates.as_slice() {
        [one] => Ok(one),
        several => fail(
            format!(
                "{} topics fit equally well: {}",
                several.len(),
                list(several)
            ),
            "choose one with --topic",
        ),
    }
}

fn failure(path: &Path, error: &Error) -> Failure {
    match error {
        Error::Io(error) => Place::file(path).io(error),
        Error::Wrong(what, 0) => Place::file(path).failure(what, COPY),
        Error::Wrong(what, byte) => {
            Place::file(path).failure(format!("{what}, {byte} bytes from the beginning"), COPY)
        }
    }
}
