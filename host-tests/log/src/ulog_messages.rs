//! Reads the messages of a ULog file one after the other: PX4's format, version 1.
//!
//! No library is used, because the official one, px4-ulog 0.6, panics on short messages.

use std::{
    collections::BTreeMap,
    io::{self, BufRead, ErrorKind, Read},
};

use super::ulog_format::Formats;
use crate::failure::one_line;

const MAGIC: [u8; 7] = *b"ULog\x01\x12\x35";

/// The longest name of a topic, in bytes.
const LONGEST_TOPIC: usize = 256;

/// The topic and instance that a subscription number stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Subscription {
    pub(super) topic: String,
    pub(super) instance: u8,
}

/// A data message, or the end of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Message<'a> {
    /// The data of the subscription with this number.
    Data(u16, &'a [u8]),
    /// The file ends within a message.
    Cut,
    /// The file ends.
    End,
}

/// The reason why messages cannot be read.
#[derive(Debug)]
pub(super) enum Error {
    Io(io::Error),
    /// What is wrong, and the offset at which it was found, in bytes.
    Wrong(String, u64),
}

/// Reads a file and keeps the definitions in it.
pub(super) struct Messages<R> {
    reader: R,
    position: u64,
    /// The offsets of data that PX4 appended after a crash. A message that would reach beyond such
    /// an offset is cut off there.
    appended: Vec<u64>,
    bytes: Vec<u8>,
    pub(super) formats: Formats,
    pub(super) subscriptions: BTreeMap<u16, Subscription>,
}

impl<R: BufRead> Messages<R> {
    pub(super) fn open(mut reader: R) -> Result<Self, Error> {
        let mut header = [0; 16];
        reader
            .read_exact(&mut header)
            .map_err(|error| match error.kind() {
                ErrorKind::UnexpectedEof => {
                    Error::Wrong("the file ends within its header".into(), 0)
                }
                _ => Error::Io(error),
            })?;
        if !header.starts_with(&MAGIC) {
            return Err(Error::Wrong("this is not a ULog file".into(), 0));
        }
        Ok(Self {
            reader,
            position: header.len() as u64,
            appended: Vec::new(),
            bytes: Vec::new(),
            formats: Formats::default(),
            subscriptions: BTreeMap::new(),
        })
    }

    /// Reads on to the next data message.
    pub(super) fn next(&mut self) -> Result<Message<'_>, Error> {
        loop {
            let mut head = [0; 3];
            // PX4 appends at the end of the file, wherever a crash has cut off the last message.
            if let Some(&next) = self.appended.first()
                && next < self.position + head.len() as u64
            {
                self.appended.remove(0);
                if !self.skip_to(next)? {
                    return Ok(Message::Cut);
                }
                continue;
            }
            match self.fill(&mut head)? {
                0 => return Ok(Message::End),
                3 => {}
                _ => return Ok(Message::Cut),
            }
            let length = usize::from(u16::from_le_bytes([head[0], head[1]]));
            let start = self.position;
            let end = start + 3 + length as u64;
            if let Some(next) = self.appended.first().copied().filter(|&next| end > next) {
                self.appended.remove(0);
                self.position += head.len() as u64;
                if !self.skip_to(next)? {
                    return Ok(Message::Cut);
                }
                continue;
            }
            let mut bytes = std::mem::take(&mut self.bytes);
            bytes.resize(length, 0);
            let read = self.fill(&mut bytes)?;
            self.bytes = bytes;
            if read < length {
                return Ok(Message::Cut);
            }
            if head[2] == b'D' {
                let Some((identity, _)) = self.bytes.split_first_chunk() else {
                    return Err(self.wrong("a data message has no subscription number".into()));
                };
                let identity = u16::from_le_bytes(*identity);
                self.position = end;
                return Ok(Message::Data(identity, &self.bytes[2..]));
            }
            self.define(head[2]).map_err(|what| self.wrong(what))?;
            self.position = end;
        }
    }

    /// Skips what is left of a message that was cut off at an offset. Returns false if the file ends before it.
    fn skip_to(&mut self, offset: u64) -> Result<bool, Error> {
        let skip = offset.saturating_sub(self.position);
        let mut rest = self.reader.by_ref().take(skip);
        let skipped = io::copy(&mut rest, &mut io::sink()).map_err(Error::Io)?;
        self.position += skipped;
        Ok(skipped == skip)
    }

    fn define(&mut self, kind: u8) -> Result<(), String> {
        match kind {
            b'F' => self.formats.define(&self.bytes),
            b'A' => {
                let [instance, low, high, topic @ ..] = self.bytes.as_slice() else {
                    return Err("a subscription names no topic".into());
                };
                if topic.len() > LONGEST_TOPIC {
                    return Err("a subscription names a topic of more than 256 bytes".into());
                }
                let subscription = Subscription {
                    topic: one_line(&String::from_utf8_lossy(topic)),
                    instance: *instance,
                };
                let identity = u16::from_le_bytes([*low, *high]);
                self.subscriptions.insert(identity, subscription);
                Ok(())
            }
            b'B' => self.flags(),
            _ => Ok(()),
        }
    }

    fn flags(&mut self) -> Result<(), String> {
        let Some((flags, offsets)) = self.bytes.split_at_checked(16) else {
            return Err("the message of flags is too short".into());
        };
        let incompatible = &flags[8..];
        if incompatible[0] > 1 || incompatible[1..].iter().any(|&flag| flag != 0) {
            return Err("the log needs a newer version of ULog".into());
        }
        let offsets = offsets.chunks_exact(8).take(3);
        let offsets = offsets.map(|bytes| u64::from_le_bytes(bytes.try_into().unwrap_or_default()));
        self.appended = offsets.filter(|&offset| offset > 0).collect();
        self.appended.sort_unstable();
        Ok(())
    }

    /// Fills the buffer as far as the file allows, and returns the number of bytes.
    fn fill(&mut self, buffer: &mut [u8]) -> Result<usize, Error> {
        let mut filled = 0;
        while filled < buffer.len() {
            match self.reader.read(&mut buffer[filled..]) {
                Ok(0) => break,
                Ok(read) => filled += read,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(Error::Io(error)),
            }
        }
        Ok(filled)
    }

    fn wrong(&self, what: String) -> Error {
        Error::Wrong(what, self.position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn message(kind: u8, data: &[u8]) -> Vec<u8> {
        let length = (data.len() as u16).to_le_bytes();
        [&length[..], &[kind], data].concat()
    }

    fn file(messages: &[Vec<u8>]) -> Vec<u8> {
        [&MAGIC[..], &[1; 9], &messages.concat()].concat()
    }

    /// The data messages of a file, and whether the file is cut off after them.
    fn read(bytes: &[u8]) -> Result<(Vec<Vec<u8>>, bool), Error> {
        let mut messages = Messages::open(bytes)?;
        let mut data = Vec::new();
        loop {
            match messages.next()? {
                Message::Data(_, bytes) => data.push(bytes.to_vec()),
                Message::Cut => return Ok((data, true)),
                Message::End => return Ok((data, false)),
            }
        }
    }

    #[test]
    fn data_appended_after_a_crash_follows_what_was_cut_off() {
        let whole = [message(b'D', &[1, 0, 10]), message(b'D', &[1, 0, 11])];
        let flags = |offset: u64| {
            let offset = offset.to_le_bytes();
            message(
                b'B',
                &[&[0; 8][..], &[1, 0, 0, 0, 0, 0, 0, 0], &offset, &[0; 16]].concat(),
            )
        };
        let cut = message(b'D', &[1, 0, 99]);
        // The crash may have cut the head of the message, or nothing at all.
        for cut in (0..cut.len()).map(|length| &cut[..length]) {
            let first = file(&[flags(0), whole[0].clone()]);
            let offset = (first.len() + cut.len()) as u64;
            let first = file(&[flags(offset), whole[0].clone()]);
            let bytes = [&first[..], cut, &whole[1]].concat();
            assert_eq!(
                read(&bytes).unwrap(),
                (vec![vec![10], vec![11]], false),
                "{}",
                cut.len()
            );
        }
    }

    #[test]
    fn newer_kinds_and_other_files_are_refused() {
        let newer = message(b'B', &[&[0; 8][..], &[2; 8], &[0; 24]].concat());
        for bytes in [
            &b"ULog"[..],
            &[7; 20],
            &file(&[newer]),
            &file(&[message(b'D', &[1])]),
        ] {
            assert!(matches!(read(bytes), Err(Error::Wrong(..))));
        }
    }

    proptest! {
        #[test]
        fn any_messages_are_read_or_refused(
            messages in prop::collection::vec(
                (prop::sample::select(&b"BFADIX"[..]), prop::collection::vec(any::<u8>(), 0..60)),
                0..12,
            ),
            cut: prop::sample::Index,
        ) {
            let messages: Vec<_> = messages.iter().map(|(kind, data)| message(*kind, data)).collect();
            let bytes = file(&messages);
            let _ = read(&bytes);
            let _ = read(&bytes[..cut.index(bytes.len())]);
        }
    }
}
