//! A simulated NOR flash: an erase takes a long time and sets bits, and a write of a word clears bits.

use super::BUFFER;

/// The number of bytes of a page, the smallest part that can be erased.
pub(super) const PAGE: usize = 4096;

/// The number of bytes before a snapshot: its length and its number.
pub(super) const HEADER: usize = 8;

/// The number of pages that hold a snapshot with its header.
pub(super) const PAGES: usize = (BUFFER + HEADER).div_ceil(PAGE);

/// How often an erase has to be polled until it is done.
const ERASE_POLLS: u32 = 5000;

/// A word of erased flash.
pub(super) const ERASED: u32 = u32::MAX;

const WORDS: usize = PAGE / 4;

/// A flash with room for two snapshots, of which one is written while the other stays.
pub struct Flash {
    slots: [[[u32; WORDS]; PAGES]; 2],
    /// The slot and the page of the erase in progress, and the number of polls until it is done.
    erase: Option<(usize, usize, u32)>,
    /// The number of operations since power was switched on.
    operations: u32,
}

impl Flash {
    /// A flash that was never written to.
    pub const ERASED: Self = Self {
        slots: [[[ERASED; WORDS]; PAGES]; 2],
        erase: None,
        operations: 0,
    };

    /// The number of operations since power was switched on: erases begun, polls and words written.
    pub const fn operations(&self) -> u32 {
        self.operations
    }

    /// Switches power on. An erase that a power cut interrupted has left the page half erased.
    pub(super) fn switch_on(&mut self) {
        self.erase = None;
        self.operations = 0;
    }

    /// Begins to erase a page. Half of it is erased at once, so that a cut leaves neither the old nor the new
    /// contents.
    pub(super) fn begin_erase(&mut self, slot: usize, page: usize) {
        self.operations += 1;
        self.slots[slot][page][..WORDS / 2].fill(ERASED);
        self.erase = Some((slot, page, ERASE_POLLS));
    }

    /// Asks whether an erase is still in progress.
    pub(super) fn is_busy(&mut self) -> bool {
        self.operations += 1;
        match &mut self.erase {
            None => false,
            Some((slot, page, 0)) => {
                self.slots[*slot][*page].fill(ERASED);
                self.erase = None;
                false
            }
            Some((.., polls)) => {
                *polls -= 1;
                true
            }
        }
    }

    /// Writes a word of a slot: bits can be cleared and not set.
    pub(super) fn write(&mut self, slot: usize, word: usize, value: u32) {
        self.operations += 1;
        self.slots[slot][word / WORDS][word % WORDS] &= value;
    }

    /// A word of a slot.
    pub(super) fn word(&self, slot: usize, word: usize) -> u32 {
        self.slots[slot][word / WORDS][word % WORDS]
    }
}
