use super::{Malformed, Reading, decoder::Decoder};

/// The readings of a burst from a FIFO, from the oldest to the newest.
///
/// A burst need not be read to its end: what is left out is lost, and the next reading says how many samples
/// are missing. [`Axes::record_burst`](crate::Axes::record_burst) reads it to its end.
#[derive(Debug)]
pub struct Burst<'a> {
    decoder: &'a mut Decoder,
    bytes: &'a [u8],
    /// The host's time of the burst.
    now_us: u32,
    /// The number of samples that the FIFO kept.
    kept: usize,
    flushed: bool,
    /// Whether a reading was returned since the last end.
    returned: bool,
}

impl<'a> Burst<'a> {
    pub(super) const fn new(
        decoder: &'a mut Decoder,
        bytes: &'a [u8],
        now_us: u32,
        kept: usize,
        flushed: bool,
    ) -> Self {
        Self {
            decoder,
            bytes,
            now_us,
            kept,
            flushed,
            returned: false,
        }
    }

    /// Whether the FIFO was emptied instead of read: it was full, or a transfer or a packet before was damaged. The
    /// next reading says how many samples are missing.
    pub const fn is_flushed(&self) -> bool {
        self.flushed
    }

    /// About the number of samples that the FIFO kept because the buffer was too small for them.
    pub const fn kept(&self) -> usize {
        self.kept
    }

    /// Tells the clock when the newest reading was taken.
    fn end(&mut self) {
        if core::mem::take(&mut self.returned) {
            let Decoder { stamps, clock, .. } = &mut *self.decoder;
            if let Some(ticks) = stamps.settle(self.now_us, self.kept) {
                clock.note(self.now_us, ticks, stamps.interval());
            }
        }
    }
}

impl Iterator for Burst<'_> {
    type Item = Result<Reading, Malformed>;

    fn next(&mut self) -> Option<Self::Item> {
        let unit = self.decoder.fifo.format.unit();
        while let Some((first, rest)) = self.bytes.split_at_checked(unit) {
            self.bytes = rest;
            match self.decoder.decode(first) {
                Ok(None) => {}
                Ok(Some(reading)) => {
                    self.returned = true;
                    return Some(Ok(reading));
                }
                Err(malformed) => {
                    self.bytes = &[];
                    self.returned = false;
                    self.decoder.must_flush = true;
                    return Some(Err(malformed));
                }
            }
        }
        self.end();
        None
    }
}

impl core::iter::FusedIterator for Burst<'_> {}
