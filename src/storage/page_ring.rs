//! The pages of a store in flash, and their repair after damage.

use core::ops::Range;
use crc::{Algorithm, Crc, NoTable};
use embedded_storage_async::nor_flash::NorFlash;

/// The checksum of an item's length.
const LENGTH: Crc<u16, NoTable> = Crc::<u16, NoTable>::new(&Algorithm {
    width: 16,
    poly: 0x7458,
    init: 0xFFFF,
    refin: true,
    refout: true,
    xorout: 0xFFFF,
    check: 0xFB2B,
    residue: 0,
});

/// The largest word of a flash that `sequential_storage` supports, in bytes.
const LARGEST_WORD: usize = 32;

/// Bytes that every driver accepts, also one that copies whole words of four bytes.
#[repr(align(4))]
struct Word([u8; LARGEST_WORD]);

/// What the markers at both ends of a page say. A marker is a word of zeros, and it is set if four bits of the part that is
/// read at once are zero.
#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    /// No marker: the page is erased.
    Open,
    /// The first marker: snapshots are being added to the page.
    Partial,
    /// Both markers: the page is full.
    Closed,
    /// Only the last marker: an erasure was interrupted, or the first marker was damaged.
    Broken,
}

/// The pages of a store in the format of `sequential_storage` 8. They form a ring: full pages from the oldest to the newest,
/// the page that is being filled, and at least one that is erased.
///
/// `sequential_storage` repairs what an interruption leaves, and takes damage for one. What damage leaves is therefore
/// brought into a state that an interruption can leave before `sequential_storage` sees it.
pub(super) struct PageRing<'a, F> {
    flash: &'a mut F,
    range: Range<u32>,
}

impl<'a, F: NorFlash> PageRing<'a, F> {
    const WORD: usize = if F::WRITE_SIZE > F::READ_SIZE {
        F::WRITE_SIZE
    } else {
        F::READ_SIZE
    };
    /// The bytes of which a page is read to see whether it is erased.
    const AT_ONCE: usize =
        if F::ERASE_SIZE.is_multiple_of(LARGEST_WORD) && LARGEST_WORD.is_multiple_of(Self::WORD) {
            LARGEST_WORD
        } else {
            Self::WORD
        };
    /// The header of an item, which begins with the checksum of the item, its length, and the checksum of the length.
    const HEADER: usize = 8_usize.next_multiple_of(Self::WORD);

    pub(super) const fn new(flash: &'a mut F, range: Range<u32>) -> Self {
        Self { flash, range }
    }

    /// The number of pages.
    const fn count(&self) -> u32 {
        self.range.end.saturating_sub(self.range.start) / F::ERASE_SIZE as u32
    }

    /// The page that is `offset` pages behind a page in the ring.
    const fn behind(&self, page: u32, offset: u32) -> u32 {
        match page.saturating_add(offset).checked_rem(self.count()) {
            Some(page) => page,
            None => 0,
        }
    }

    /// Where a page begins and ends.
    const fn place(&self, page: u32) -> Range<u32> {
        let size = F::ERASE_SIZE as u32;
        let start = self.range.start.saturating_add(page.saturating_mul(size));
        start..start.saturating_add(size)
    }

    async fn state(&mut self, page: u32) -> Result<State, F::Error> {
        let Range { start, end } = self.place(page);
        let first = self.is_marked(start).await?;
        let last = self
            .is_marked(end.saturating_sub(F::READ_SIZE as u32))
            .await?;
        Ok(match (first, last) {
            (false, false) => State::Open,
            (true, false) => State::Partial,
            (true, true) => State::Closed,
            (false, true) => State::Broken,
        })
    }

    async fn is_marked(&mut self, address: u32) -> Result<bool, F::Error> {
        let mut word = Word([0xFF; LARGEST_WORD]);
        let (marker, _) = word.0.split_at_mut(F::READ_SIZE.min(LARGEST_WORD));
        self.flash.read(address, marker).await?;
        Ok(marker.iter().map(|byte| byte.count_zeros()).sum::<u32>() >= 4)
    }

    /// Sets the first marker of a page, or the last one. Zeros may overwrite anything.
    async fn mark(&mut self, page: u32, is_first: bool) -> Result<(), F::Error> {
        let Range { start, end } = self.place(page);
        let last = end.saturating_sub(Self::WORD as u32);
        let word = Word([0; LARGEST_WORD]);
        let (zeros, _) = word.0.split_at(Self::WORD.min(LARGEST_WORD));
        self.flash
            .write(if is_first { start } else { last }, zeros)
            .await
    }

    async fn erase(&mut self, page: u32) -> Result<(), F::Error> {
        let Range { start, end } = self.place(page);
        self.flash.erase(start, end).await
    }

    /// Whether a page is erased to the last bit.
    async fn is_blank(&mut self, page: u32) -> Result<bool, F::Error> {
        let Range { mut start, end } = self.place(page);
        let mut words = Word([0; LARGEST_WORD]);
        let (words, _) = words.0.split_at_mut(Self::AT_ONCE.min(LARGEST_WORD));
        while start < end {
            self.flash.read(start, words).await?;
            if words.iter().any(|&byte| byte != 0xFF) {
                return Ok(false);
            }
            start = start.saturating_add(Self::AT_ONCE as u32);
        }
        Ok(true)
    }

    /// Whether a page has an item that `sequential_storage` would find there.
    async fn has_items(&mut self, page: u32) -> Result<bool, F::Error> {
        let Range { start, end } = self.place(page);
        let (mut address, end) = (
            start.saturating_add(Self::WORD as u32),
            end.saturating_sub(Self::WORD as u32),
        );
        let mut header = Word([0; LARGEST_WORD]);
        let (header, _) = header.0.split_at_mut(Self::HEADER.min(LARGEST_WORD));
        while address.saturating_add(Self::HEADER as u32) <= end {
            self.flash.read(address, header).await?;
            if header.iter().all(|&byte| byte == 0xFF) {
                return Ok(false);
            }
            if let &mut [_, _, _, _, a, b, c, d, ..] = header {
                let length = u32::from(u16::from_le_bytes([a, b]));
                let behind = address.saturating_add(Self::HEADER as u32);
                let fits = behind.saturating_add(length) <= end;
                if fits && LENGTH.checksum(&[a, b]) == u16::from_le_bytes([c, d]) {
                    return Ok(true);
                }
            }
            address = address.saturating_add(Self::WORD as u32);
        }
        Ok(false)
    }

    /// Whether the page behind another can be the erased page: nothing in it can be read.
    async fn is_free(&mut self, page: u32) -> Result<bool, F::Error> {
        Ok(self.state(page).await? == State::Open || !self.has_items(page).await?)
    }

    /// The page that is being filled, or the one that is to be filled next; `None` if the store is empty.
    async fn find_filling(&mut self) -> Result<Option<u32>, F::Error> {
        let (mut partial, mut next, mut unmarked, mut useless, mut is_empty) =
            (None, None, None, None, true);
        for page in 0..self.count() {
            let before = self.behind(page, self.count().saturating_sub(1));
            match self.state(page).await? {
                // Of several, the one before an erased page.
                State::Partial => {
                    if partial.is_none() || self.is_free(self.behind(page, 1)).await? {
                        partial = Some(page);
                    }
                }
                State::Open => {
                    if self.has_items(page).await? {
                        unmarked = Some(page);
                    }
                    if self.state(before).await? == State::Closed {
                        next = Some(page);
                    }
                    continue;
                }
                State::Closed => {
                    if !self.has_items(page).await? {
                        useless = Some(page);
                    }
                }
                State::Broken => {}
            }
            is_empty = false;
        }
        if partial.is_some() {
            return Ok(partial);
        }
        // Items without a marker before them were being added. Otherwise the page was just found full.
        let found = match unmarked.or(next) {
            Some(page) => page,
            None if is_empty => return Ok(None),
            None => {
                // There is no erased page.
                let page = useless.unwrap_or(0);
                self.erase(page).await?;
                page
            }
        };
        if unmarked.is_none() && !self.is_blank(found).await? {
            self.erase(found).await?;
        }
        self.mark(found, true).await?;
        Ok(Some(found))
    }

    /// Brings the pages into a state that an interruption can leave, and keeps all that can be read. Reads only the ends of
    /// the pages if there is nothing to do.
    pub(super) async fn order(&mut self) -> Result<(), F::Error> {
        for page in 0..self.count() {
            if self.state(page).await? == State::Broken {
                let before = self.behind(page, self.count().saturating_sub(1));
                if self.state(before).await? == State::Partial || !self.has_items(page).await? {
                    // The erasure of the oldest page, whose snapshots were copied.
                    self.erase(page).await?;
                } else {
                    self.mark(page, true).await?;
                }
            }
        }
        let Some(filling) = self.find_filling().await? else {
            return Ok(());
        };
        let next = self.behind(filling, 1);
        if self.state(next).await? != State::Open && !self.has_items(next).await? {
            self.erase(next).await?;
        }
        let mut has_older = false;
        for offset in 2..self.count() {
            let page = self.behind(filling, offset);
            match self.state(page).await? {
                State::Closed => has_older = true,
                State::Partial => {
                    self.mark(page, false).await?;
                    has_older = true;
                }
                // The search for a snapshot ends at an erased page.
                State::Open if has_older => {
                    self.mark(page, true).await?;
                    self.mark(page, false).await?;
                }
                State::Open | State::Broken => {}
            }
        }
        Ok(())
    }

    /// Also makes sure that the next page is erased to the last bit, because what is copied to it is erased where it was.
    pub(super) async fn prepare(&mut self) -> Result<(), F::Error> {
        self.order().await?;
        if let Some(filling) = self.find_filling().await? {
            self.erase_rest(self.behind(filling, 1)).await?;
        }
        Ok(())
    }

    /// Erases a page that only looks erased.
    async fn erase_rest(&mut self, page: u32) -> Result<(), F::Error> {
        if self.state(page).await? == State::Open && !self.is_blank(page).await? {
            self.erase(page).await?;
        }
        Ok(())
    }

    /// Goes on to the next page, because the rest of the page that is being filled is not erased, and erases every page
    /// that only looks erased.
    pub(super) async fn turn(&mut self) -> Result<(), F::Error> {
        self.order().await?;
        let Some(filling) = self.find_filling().await? else {
            return Ok(());
        };
        for offset in 1..self.count() {
            self.erase_rest(self.behind(filling, offset)).await?;
        }
        let next = self.behind(filling, 1);
        if self.state(next).await? == State::Open {
            self.mark(filling, false).await?;
            self.mark(next, true).await?;
        }
        Ok(())
    }
}
