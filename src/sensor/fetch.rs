use super::{
    Burst, Error,
    decoder::Decoder,
    transfer::{Procedure, Step},
};

/// The read of a burst: its count, and its content in one transaction. If the FIFO has to be emptied, this is
/// done instead.
pub(super) struct Fetch<'a> {
    decoder: &'a mut Decoder,
    buffer: &'a mut [u8],
    stage: Stage,
    head: [u8; 3],
    /// The number of bytes of the burst.
    length: usize,
    /// The number of samples that the FIFO holds, and of those that it keeps.
    samples: (usize, usize),
    flushed: bool,
}

#[derive(Clone, Copy)]
enum Stage {
    /// The count is to be read. So many reads were made.
    Count(u8),
    /// The content was read.
    Content,
    /// The FIFO is emptied. So many writes were made.
    Flush(usize),
    /// Nothing is left to do.
    End,
}

impl<'a> Fetch<'a> {
    /// # Errors
    /// [`Error::BufferTooSmall`] if not even one unit fits.
    pub(super) fn new<E>(decoder: &'a mut Decoder, buffer: &'a mut [u8]) -> Result<Self, Error<E>> {
        let needed = decoder.fifo.format.unit();
        if buffer.len() < needed {
            return Err(Error::BufferTooSmall { needed });
        }
        if decoder.is_count_lost {
            decoder.forget_slot();
        }
        let stage = if decoder.must_flush {
            Stage::Flush(0)
        } else {
            Stage::Count(0)
        };
        Ok(Self {
            decoder,
            buffer,
            stage,
            head: [0; 3],
            length: 0,
            samples: (0, 0),
            flushed: false,
        })
    }

    /// The burst, after the procedure has ended.
    pub(super) fn into_burst(self, now_us: u32) -> Burst<'a> {
        let (held, kept) = self.samples;
        self.decoder.stamps.expect(now_us, held);
        let bytes: &'a [u8] = self.buffer;
        let bytes = bytes.get(..self.length).unwrap_or_default();
        Burst::new(self.decoder, bytes, now_us, kept, self.flushed)
    }

    /// Decides what follows from the count.
    fn plan(&mut self) {
        self.decoder.is_count_lost = false;
        let fifo = self.decoder.fifo;
        let format = fifo.format;
        let level = format.level(self.head, fifo.capacity);
        if level.full {
            self.decoder.forget_slot();
            if format.is_flushed_when_full() {
                self.stage = Stage::Flush(0);
                return;
            }
        }
        let unit = format.unit();
        let units = level.units.min(self.buffer.len() / unit);
        self.length = units * unit;
        let kept = level.samples.saturating_sub(format.samples(units));
        self.samples = (level.samples, kept);
        self.stage = if units == 0 {
            Stage::End
        } else {
            Stage::Content
        };
    }
}

impl Procedure for Fetch<'_> {
    fn step<E>(&mut self) -> Result<Step<'_>, Error<E>> {
        let fifo = self.decoder.fifo;
        if let Stage::Count(reads) = self.stage {
            if reads < fifo.format.count_reads() {
                // Reading the flag of an overrun clears it, even if the answer is lost.
                self.decoder.is_count_lost = true;
                self.stage = Stage::Count(reads.saturating_add(1));
                let bytes = self.head.get_mut(..fifo.format.head()).unwrap_or_default();
                return Ok(Step::Read {
                    register: fifo.count,
                    bytes,
                });
            }
            self.plan();
            if let Stage::Content = self.stage {
                self.stage = Stage::End;
                // If this fails or is cancelled, part of the content is gone.
                self.decoder.must_flush = true;
                let bytes = self.buffer.get_mut(..self.length).unwrap_or_default();
                return Ok(Step::Read {
                    register: fifo.data,
                    bytes,
                });
            }
        }
        if let Stage::Flush(writes) = self.stage {
            self.decoder.must_flush = true;
            self.decoder.forget_slot();
            if let Some(write) = fifo.flush.as_slice().get(writes) {
                self.stage = Stage::Flush(writes.saturating_add(1));
                return Ok(Step::Write {
                    register: write.register,
                    value: write.value,
                });
            }
            self.flushed = true;
            self.stage = Stage::End;
        }
        self.decoder.must_flush = false;
        Ok(Step::Done)
    }
}
