//! What the kinds of bags have in common: channels of messages, and limits of what a damaged bag may claim.

use super::{imu_message::Encoding, message_layout::Layout};
use crate::failure::{Failure, Place};
use std::{ops::ControlFlow, path::Path, rc::Rc};

/// The largest record or chunk that is accepted, in bytes. It limits the memory that a damaged length
/// can claim. Chosen by hand, as are the two limits below.
pub(super) const LONGEST_RECORD: u64 = 1 << 28;

/// How many times the size of the file a record or an unpacked chunk may be long.
pub(super) const MOST_TIMES_AT_ONCE: u64 = 8;

/// How many times the size of the file all its records may take. Messages of an IMU are packed to a
/// tenth of their size.
pub(super) const MOST_TIMES_IN_ALL: u64 = 64;

/// The topic, message type and encoding of a channel.
#[derive(Clone, Debug, Default)]
pub(super) struct Channel {
    pub(super) topic: String,
    pub(super) schema: String,
    pub(super) encoding: String,
    /// The definition of the message type; empty if the bag has none.
    pub(super) definition: Rc<str>,
}

impl Channel {
    /// The encoding of the messages, or `None` if they are not those of an IMU.
    pub(super) fn imu(&self) -> Option<Encoding> {
        Encoding::of(&self.schema, &self.encoding)
    }

    /// The fields of its messages, and how they are serialised, if the bag tells.
    pub(super) fn layout(&self) -> Option<(Layout, Encoding)> {
        let encoding = match self.encoding.as_str() {
            "cdr" => Encoding::Cdr,
            "ros1" => Encoding::Ros1,
            _ => return None,
        };
        Some((Layout::of(&self.schema, &self.definition)?, encoding))
    }
}

/// What is done with a message of a channel. It may end the reading.
pub(super) type Show<'a> = &'a mut dyn FnMut(&Channel, &[u8]) -> Result<ControlFlow<()>, Failure>;

/// The bytes that a file of this length may claim or unpack to.
pub(super) fn budget(length: u64, times: u64) -> u64 {
    (1 << 23) + times.saturating_mul(length)
}

/// The failure of a damaged bag.
pub(super) fn damaged(path: &Path, what: &str, remedy: &str) -> Failure {
    Place::file(path).failure(format!("damaged: {what}"), remedy)
}

/// Text of a bag without control characters.
pub(super) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).replace(char::is_control, " ")
}
