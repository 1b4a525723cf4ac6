//! Writes snapshots to flash, one operation at a time, and reads the last complete one.
//!
//! A slot holds the length of the snapshot, the snapshot's number, and the snapshot, rounded up to whole words.
//! The number is written last. A cut before that leaves no number, and the other slot has the snapshot before.

use super::flash::{ERASED, Flash, HEADER, PAGE, PAGES};

/// Where a snapshot's number stands.
const NUMBER: usize = 1;

/// The next operation.
#[derive(Clone, Copy)]
enum Next {
    Nothing,
    Erase { page: usize },
    Wait { page: usize },
    Write { word: usize },
    Length,
    Number,
}

/// Writes a snapshot that lies in a buffer. Nothing else of the product is borrowed meanwhile.
pub(super) struct Saver {
    /// The number of the next snapshot.
    number: u32,
    length: usize,
    next: Next,
}

impl Saver {
    pub(super) const fn new(number: u32) -> Self {
        Self {
            number,
            length: 0,
            next: Next::Nothing,
        }
    }

    pub(super) const fn is_busy(&self) -> bool {
        !matches!(self.next, Next::Nothing)
    }

    /// Whether a page is being erased.
    pub(super) const fn is_erasing(&self) -> bool {
        matches!(self.next, Next::Wait { .. })
    }

    /// Begins to write the first `length` bytes of the buffer.
    pub(super) fn begin(&mut self, length: usize) {
        self.length = length;
        self.next = Next::Erase { page: 0 };
    }

    /// Does one operation, and returns whether there is more to do.
    pub(super) fn advance(&mut self, flash: &mut Flash, buffer: &[u8]) -> bool {
        let slot = self.number as usize % 2;
        let pages = (self.length + HEADER).div_ceil(PAGE).min(PAGES);
        self.next = match self.next {
            Next::Nothing => Next::Nothing,
            Next::Erase { page } => {
                flash.begin_erase(slot, page);
                Next::Wait { page }
            }
            Next::Wait { page } if flash.is_busy() => Next::Wait { page },
            Next::Wait { page } if page + 1 < pages => Next::Erase { page: page + 1 },
            Next::Wait { .. } => Next::Write { word: 0 },
            Next::Write { word } => match buffer[..self.length].chunks(4).nth(word) {
                Some(bytes) => {
                    let mut value = [0xff; 4];
                    value[..bytes.len()].copy_from_slice(bytes);
                    flash.write(slot, HEADER / 4 + word, u32::from_le_bytes(value));
                    Next::Write { word: word + 1 }
                }
                None => Next::Length,
            },
            Next::Length => {
                flash.write(slot, 0, self.length as u32);
                Next::Number
            }
            Next::Number => {
                flash.write(slot, NUMBER, self.number);
                self.number += 1;
                Next::Nothing
            }
        };
        self.is_busy()
    }
}

/// Reads the complete snapshots into the buffer, the newest first, until one is accepted. Returns its number.
pub(super) fn load(
    flash: &Flash,
    buffer: &mut [u8],
    mut accept: impl FnMut(&[u8]) -> bool,
) -> Option<u32> {
    let [first, second] = [0, 1].map(|slot| flash.word(slot, NUMBER));
    let age = |number: u32| number.wrapping_add(1);
    let order = if age(first) > age(second) {
        [(0, first), (1, second)]
    } else {
        [(1, second), (0, first)]
    };
    for (slot, number) in order {
        let length = flash.word(slot, 0) as usize;
        if number == ERASED || length > buffer.len() {
            continue;
        }
        for (word, bytes) in buffer[..length].chunks_mut(4).enumerate() {
            let value = flash.word(slot, HEADER / 4 + word).to_le_bytes();
            bytes.copy_from_slice(&value[..bytes.len()]);
        }
        if accept(&buffer[..length]) {
            return Some(number);
        }
    }
    None
}
