//! The envelope around everything that is stored. It states the kind and the length of the content, and a
//! checksum shows whether the content is intact.
//!
//! | offset | bytes | content |
//! |---|---|---|
//! | 0 | 4 | magic, `ALNT` |
//! | 4 | 1 | kind: 1 is a snapshot, 2 a certificate |
//! | 5 | 1 | version of the payload's format |
//! | 6 | 2 | length `n` of the payload in bytes, little endian |
//! | 8 | n | payload, [postcard](https://postcard.jamesmunns.com) |
//! | 8 + n | 4 | CRC-32/ISO-HDLC (that of Ethernet and zip) of all bytes before it, little endian |
//!
//! The envelope is the same in every version. A CRC-32 detects every change within 32 consecutive bits,
//! and so every change of a single byte. Of all other changes it misses one in 2^32.

use super::error::Error;
use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use serde::{Deserialize, Serialize};

const MAGIC: [u8; 4] = *b"ALNT";
/// The number of bytes before the payload.
const HEAD: usize = 8;
/// The number of bytes after the payload.
const TAIL: usize = 4;

/// The number of bytes around a payload.
pub(crate) const OVERHEAD: usize = HEAD + TAIL;

/// The CRC computes without a table, because stored data are short and flash is scarce.
pub(crate) const CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The kind of a payload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Kind {
    Snapshot = 1,
    Certificate = 2,
}

/// An envelope that is being filled.
pub(crate) struct Writer<'b> {
    buffer: &'b mut [u8],
    length: usize,
    needed: usize,
}

impl<'b> Writer<'b> {
    /// Starts an envelope for a payload of up to `most` bytes.
    pub(crate) fn new(
        buffer: &'b mut [u8],
        kind: Kind,
        version: u8,
        most: usize,
    ) -> Result<Self, Error> {
        let needed = most + OVERHEAD;
        let head = buffer.first_chunk_mut::<HEAD>();
        let head = head.ok_or(Error::BufferTooSmall { needed })?;
        let [a, b, c, d] = MAGIC;
        *head = [a, b, c, d, kind as u8, version, 0, 0];
        Ok(Self {
            buffer,
            length: HEAD,
            needed,
        })
    }

    /// Appends a part of the payload.
    pub(crate) fn push(&mut self, part: &impl Serialize) -> Result<(), Error> {
        let too_small = Error::BufferTooSmall {
            needed: self.needed,
        };
        put(part, self.buffer, &mut self.length).ok_or(too_small)
    }

    /// Appends a part that writes itself. `write` returns the number of bytes, or `None` if the buffer is too
    /// small.
    pub(crate) fn push_with(
        &mut self,
        write: impl FnOnce(&mut [u8]) -> Option<usize>,
    ) -> Result<(), Error> {
        let rest = self.buffer.get_mut(self.length..);
        let written = rest.and_then(write).ok_or(Error::BufferTooSmall {
            needed: self.needed,
        })?;
        self.length = self.length.saturating_add(written);
        Ok(())
    }

    /// Closes the envelope.
    pub(crate) fn finish(self) -> Result<&'b [u8], Error> {
        let too_small = Error::BufferTooSmall {
            needed: self.needed,
        };
        let length = u16::try_from(self.length - HEAD).map_err(|_| too_small)?;
        let all = self.buffer.get_mut(..self.length + TAIL).ok_or(too_small)?;
        if let Some(place) = all.get_mut(HEAD - 2..HEAD) {
            place.copy_from_slice(&length.to_le_bytes());
        }
        if let Some((sealed, tail)) = all.split_last_chunk_mut::<TAIL>() {
            *tail = CRC.checksum(sealed).to_le_bytes();
        }
        Ok(all)
    }
}

/// Writes a part behind the first `length` bytes of a buffer, and adds the number of its bytes; `None` if the
/// buffer is too small.
pub(crate) fn put(part: &impl Serialize, buffer: &mut [u8], length: &mut usize) -> Option<()> {
    let rest = buffer.get_mut(*length..)?;
    let written = postcard::to_slice(part, rest).ok()?.len();
    *length = length.saturating_add(written);
    Some(())
}

/// Reads the next part of a payload.
pub(crate) fn take<'b, T: Deserialize<'b>>(rest: &mut &'b [u8]) -> Option<T> {
    let (part, after) = postcard::take_from_bytes(rest).ok()?;
    *rest = after;
    Some(part)
}

/// Returns the version and the payload of an intact envelope of this kind.
pub(crate) fn open_any(bytes: &[u8], kind: Kind) -> Result<(u8, &[u8]), Error> {
    let (head, _) = bytes.split_at(bytes.len().min(MAGIC.len()));
    if !MAGIC.starts_with(head) {
        return Err(Error::UnknownMagic);
    }
    let wrong_length = |stored| Error::WrongLength {
        found: bytes.len(),
        stored,
    };
    let (head, rest) = bytes
        .split_first_chunk::<HEAD>()
        .ok_or(wrong_length(OVERHEAD))?;
    let &[.., found, version, low, high] = head;
    let stored = OVERHEAD + usize::from(u16::from_le_bytes([low, high]));
    let (payload, tail) = match rest.split_last_chunk::<TAIL>() {
        Some(parts) if bytes.len() == stored => parts,
        _ => return Err(wrong_length(stored)),
    };
    let mut digest = CRC.digest();
    digest.update(head);
    digest.update(payload);
    if digest.finalize() != u32::from_le_bytes(*tail) {
        return Err(Error::Corrupt);
    }
    // The kind is checked after the checksum, so that a changed byte is reported as corruption.
    if found != kind as u8 {
        return Err(Error::WrongKind {
            found,
            wanted: kind as u8,
        });
    }
    Ok((version, payload))
}
