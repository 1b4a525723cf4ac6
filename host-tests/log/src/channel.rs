//! What the kinds of bags have in common: channels of messages, and limits of what a damaged bag may claim.

use super::{imu_message::Encoding, message_layout::Layout};
use crate::failure::{Failure, Place, one_line};
use std::{
    collections::{BTreeMap, BTreeSet},
    ops::ControlFlow,
    path::Path,
    rc::Rc,
};

/// The largest record or chunk that is accepted, in bytes. It limits the memory that a damaged length
/// can claim. Chosen by hand, as are the limits below.
pub(super) const LONGEST_RECORD: u64 = 1 << 28;

/// How many times the size of the file a record or an unpacked chunk may be long.
pub(super) const MOST_TIMES_AT_ONCE: u64 = 8;

/// How many times the size of its files all records of a bag may take. Messages of an IMU are packed to a
/// tenth of their size.
const MOST_TIMES_IN_ALL: u64 = 64;

/// The most channels of a bag.
pub(super) const MOST_CHANNELS: usize = 1 << 12;

/// The longest name of a topic, a message type or an encoding, in bytes.
const LONGEST_NAME: usize = 1 << 12;

/// The longest definition of a message type, in bytes. A longer one is left out.
const LONGEST_DEFINITION: usize = 1 << 18;

/// The bytes that the names and definitions of a bag may take in memory, and the bytes that each of them takes beside
/// its text.
const MOST_TEXT: usize = 1 << 23;
const BESIDE_TEXT: usize = 64;

/// The bytes of definitions of which layouts are made.
const MOST_DEFINED: usize = 1 << 25;

/// The topic, message type and encoding of a channel. Channels share their texts.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Channel {
    pub(super) topic: Rc<str>,
    pub(super) schema: Rc<str>,
    pub(super) encoding: Rc<str>,
    /// The definition of the message type; empty if the bag has none.
    pub(super) definition: Rc<str>,
}

impl Channel {
    /// The encoding of the messages, or `None` if they are not those of an IMU.
    pub(super) fn imu(&self) -> Option<Encoding> {
        Encoding::of(&self.schema, &self.encoding)
    }
}

/// A message type and its definition.
type Defined = (Rc<str>, Rc<str>);

/// The layouts of channels, each of which is made once.
pub(super) struct Layouts {
    made: BTreeMap<Defined, Option<Rc<Layout>>>,
    left: usize,
}

impl Layouts {
    pub(super) const fn new() -> Self {
        Self {
            made: BTreeMap::new(),
            left: MOST_DEFINED,
        }
    }

    /// The fields of a channel's messages, and how they are serialised, if the bag tells.
    pub(super) fn of(&mut self, channel: &Channel) -> Option<(Rc<Layout>, Encoding)> {
        let encoding = match &*channel.encoding {
            "cdr" => Encoding::Cdr,
            "ros1" => Encoding::Ros1,
            _ => return None,
        };
        let Channel {
            schema, definition, ..
        } = channel;
        let layout = self
            .made
            .entry((schema.clone(), definition.clone()))
            .or_insert_with(|| {
                self.left = self.left.checked_sub(definition.len())?;
                Layout::of(schema, definition).map(Rc::new)
            });
        Some((layout.clone()?, encoding))
    }
}

/// What the files of a bag may still claim together, and the texts that they have claimed.
pub(super) struct Budget {
    unpacked: u64,
    text: usize,
    texts: BTreeSet<Rc<str>>,
}

impl Budget {
    /// The budget of files that are so many bytes long together.
    pub(super) const fn new(length: u64) -> Self {
        Self {
            unpacked: budget(length, MOST_TIMES_IN_ALL),
            text: MOST_TEXT,
            texts: BTreeSet::new(),
        }
    }

    /// Lets the records have what a further file of so many bytes may.
    pub(super) const fn add(&mut self, length: u64) {
        let more = MOST_TIMES_IN_ALL.saturating_mul(length);
        self.unpacked = self.unpacked.saturating_add(more);
    }

    /// Takes bytes that records have. `None` if they are too many.
    pub(super) fn unpack(&mut self, bytes: u64) -> Option<()> {
        self.unpacked = self.unpacked.checked_sub(bytes)?;
        Some(())
    }

    /// A name without control characters. `None` if it is too long, or the names are too many.
    pub(super) fn name(&mut self, bytes: &[u8]) -> Option<Rc<str>> {
        if bytes.len() > LONGEST_NAME {
            return None;
        }
        self.shared(&one_line(&String::from_utf8_lossy(bytes)))
    }

    /// A definition, of which nothing is shown to users but names that are made of letters. It is empty if it is too
    /// long, or the definitions are too many.
    pub(super) fn definition(&mut self, bytes: &[u8]) -> Rc<str> {
        let shared = (bytes.len() <= LONGEST_DEFINITION)
            .then(|| self.shared(&String::from_utf8_lossy(bytes)))
            .flatten();
        shared.unwrap_or_default()
    }

    fn shared(&mut self, text: &str) -> Option<Rc<str>> {
        if let Some(text) = self.texts.get(text) {
            return Some(text.clone());
        }
        self.text = self.text.checked_sub(text.len() + BESIDE_TEXT)?;
        let text: Rc<str> = text.into();
        self.texts.insert(text.clone());
        Some(text)
    }
}

/// What is done with a message of a channel. It may end the reading.
pub(super) type Show<'a> = &'a mut dyn FnMut(&Channel, &[u8]) -> Result<ControlFlow<()>, Failure>;

/// The bytes that a file of this length may claim or unpack to.
pub(super) const fn budget(length: u64, times: u64) -> u64 {
    (1 << 23) + times.saturating_mul(length)
}

pub(super) const UNPACKS_TOO_MUCH: &str = "the chunks unpack to too many times their size";
pub(super) const LONG_NAMES: &str = "the names of its channels are too long or too many";

/// The failure of a damaged bag.
pub(super) fn damaged(path: &Path, what: &str, remedy: &str) -> Failure {
    Place::file(path).failure(format!("damaged: {what}"), remedy)
}
