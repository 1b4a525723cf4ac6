//! A flash in memory that loses power in the middle.

use embedded_storage_async::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};

pub(crate) const PAGE: usize = 1024;
pub(crate) const WORD: usize = 4;

/// What is left of the power.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PowerCut {
    /// Writes and erasures until it goes.
    pub(crate) after: usize,
    /// Bytes that the last of them still changes.
    pub(crate) torn: usize,
}

/// Erased flash reads 0xFF; a write clears bits, an erasure sets those of a page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RamFlash {
    pub(crate) bytes: Vec<u8>,
    /// How many bytes each write and erasure was asked to change.
    pub(crate) operations: Vec<usize>,
    pub(crate) erasures: usize,
    pub(crate) power_cut: Option<PowerCut>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RamError {
    NoPower,
    Misaligned,
    /// A word that was written already, and not with zeros now.
    NotErased,
}

impl NorFlashError for RamError {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

impl RamFlash {
    pub(crate) fn new(pages: usize) -> Self {
        Self {
            bytes: vec![0xFF; pages * PAGE],
            operations: Vec::new(),
            erasures: 0,
            power_cut: None,
        }
    }

    /// How many bytes of the next operation the power lasts for.
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

impl ErrorType for RamFlash {
    type Error = RamError;
}

impl ReadNorFlash for RamFlash {
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

impl NorFlash for RamFlash {
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
        // Zeros may be written over anything, in flash with error correction too.
        let writable = |(&cell, &byte): (&u8, &u8)| cell == 0xFF || byte == 0;
        if !self.bytes[place.clone()].iter().zip(bytes).all(writable) {
            return Err(RamError::NotErased);
        }
        let lasts = self.begin(bytes.len())?;
        for (cell, &byte) in self.bytes[place].iter_mut().zip(bytes).take(lasts) {
            *cell &= byte;
        }
        self.end()
    }
}
