//! A flash in RAM whose power can fail during an operation.

use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

pub(crate) const PAGE: usize = 1024;
pub(crate) const WORD: usize = 4;

/// When the power fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PowerCut {
    /// The number of writes and erasures before the power fails.
    pub(crate) after: usize,
    /// The number of bytes that the interrupted operation still changes.
    pub(crate) torn: usize,
}

/// A flash that reads 0xFF where it is erased. A write clears bits, and an erasure sets all bits of
/// a page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RamFlash<const PAGE: usize = { self::PAGE }> {
    pub(crate) bytes: Vec<u8>,
    /// The number of bytes that each write and erasure was asked to change.
    pub(crate) operations: Vec<usize>,
    pub(crate) erasures: usize,
    pub(crate) power_cut: Option<PowerCut>,
    /// Whether a word that is not erased is overwritten without an error.
    pub(crate) overwrites: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RamError {
    NoPower,
    Misaligned,
    /// A word was written before and is now overwritten with something other than zeros.
    NotErased,
}

impl NorFlashError for RamError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl<const PAGE: usize> RamFlash<PAGE> {
    pub(crate) fn new(pages: usize) -> Self {
        Self {
            bytes: vec![0xFF; pages * PAGE],
            operations: Vec::new(),
            erasures: 0,
            power_cut: None,
            overwrites: false,
        }
    }

    /// The number of bytes of the next operation that are changed before the power fails.
    fn begin(&mut self, length: usize) -> Result<usize, RamError> {
        let lasts = match self.power_cut {
            Some(cut) if self.operations.len() > cut.after => return Err(RamError::NoPower),
            Some(cut) if self.operations.len() == cut.after => cut.torn.min(length),
            _ => length,
        };
        self.operations.push(length);
        Ok(lasts)
    }

    fn end(&self) -> Result<(), RamError> {
        let dead = self
            .power_cut
            .is_some_and(|cut| self.operations.len() > cut.after);
        if dead { Err(RamError::NoPower) } else { Ok(()) }
    }
}

impl<const PAGE: usize> ErrorType for RamFlash<PAGE> {
    type Error = RamError;
}

impl<const PAGE: usize> ReadNorFlash for RamFlash<PAGE> {
    const READ_SIZE: usize = 1;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), RamError> {
        self.end()?;
        let offset = offset as usize;
        bytes.copy_from_slice(&self.bytes[offset..offset + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl<const PAGE: usize> NorFlash for RamFlash<PAGE> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = PAGE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), RamError> {
        let range = from as usize..to as usize;
        if !range.start.is_multiple_of(PAGE) || !range.end.is_multiple_of(PAGE) {
            return Err(RamError::Misaligned);
        }
        let lasts = self.begin(range.len())?;
        self.erasures += 1;
        self.bytes[range][..lasts].fill(0xFF);
        self.end()
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), RamError> {
        let offset = offset as usize;
        if !offset.is_multiple_of(WORD) || !bytes.len().is_multiple_of(WORD) {
            return Err(RamError::Misaligned);
        }
        let place = offset..offset + bytes.len();
        // Zeros may overwrite anything, even in a flash with error correction.
        let writable = |(&cell, &byte): (&u8, &u8)| cell == 0xFF || byte == 0;
        if !self.overwrites && !self.bytes[place.clone()].iter().zip(bytes).all(writable) {
            return Err(RamError::NotErased);
        }
        let lasts = self.begin(bytes.len())?;
        for (cell, &byte) in self.bytes[place].iter_mut().zip(bytes).take(lasts) {
            *cell &= byte;
        }
        self.end()
    }
}
