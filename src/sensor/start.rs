use super::{
    Description, Error, Write,
    sample::Sample,
    transfer::{Procedure, Step},
    write::Access,
};

/// The start of a sensor: its identity, its start-up writes, and the removal of what is outdated by then.
pub(super) struct Start {
    description: &'static Description,
    over_spi: bool,
    /// Whether the FIFO is turned on as well.
    with_fifo: bool,
    stage: Stage,
    /// What was read last.
    byte: [u8; 1],
    /// The outdated sample.
    sample: Sample,
}

#[derive(Clone, Copy)]
enum Stage {
    /// The sensor is to listen to the bus.
    Wake,
    /// The identity is to be read.
    Identify,
    /// The identity was read.
    Compare,
    /// The accesses of the write `index` are being made; `access` is the next of them.
    Write { index: usize, access: usize },
    /// All writes were made.
    Discard,
}

impl Start {
    pub(super) const fn new(
        description: &'static Description,
        over_spi: bool,
        with_fifo: bool,
    ) -> Self {
        Self {
            description,
            over_spi,
            with_fifo,
            stage: Stage::Wake,
            byte: [0],
            sample: Sample::new(description),
        }
    }

    /// The write at `index`. The set-up of the FIFO comes before the last start-up write, because some sensors
    /// take it only while the gyro is off. The FIFO is turned on and emptied after that write.
    fn write(&self, index: usize) -> Option<&'static Write> {
        let start_up = self.description.start_up.as_slice();
        let fifo = self.description.fifo.as_ref().filter(|_| self.with_fifo);
        let Some((fifo, (last, first))) = fifo.zip(start_up.split_last()) else {
            return start_up.get(index);
        };
        first
            .iter()
            .chain(fifo.set_up.as_slice())
            .chain(core::iter::once(last))
            .chain(fifo.turn_on.as_slice())
            .chain(fifo.flush.as_slice())
            .nth(index)
    }
}

impl Procedure for Start {
    fn step<E>(&mut self) -> Result<Step<'_>, Error<E>> {
        let description = self.description;
        loop {
            match self.stage {
                Stage::Wake => {
                    self.stage = Stage::Identify;
                    if let (true, Some(register)) = (self.over_spi, description.interface.spi_wake)
                    {
                        let bytes = &mut self.byte;
                        return Ok(Step::Read { register, bytes });
                    }
                }
                Stage::Identify => {
                    self.stage = Stage::Compare;
                    return Ok(Step::Read {
                        register: description.identity,
                        bytes: &mut self.byte,
                    });
                }
                Stage::Compare => {
                    let [found] = self.byte;
                    if !description.identities.contains(&found) {
                        return Err(Error::WrongIdentity {
                            sensor: description.name,
                            register: description.identity,
                            found,
                            expected: description.identities,
                        });
                    }
                    self.stage = Stage::Write {
                        index: 0,
                        access: 0,
                    };
                }
                Stage::Write { index, access } => {
                    let Some(write) = self.write(index) else {
                        self.stage = Stage::Discard;
                        continue;
                    };
                    let next = write.accesses().get(access);
                    let Some(next) = next.filter(|_| write.is_sent(self.over_spi)) else {
                        self.stage = Stage::Write {
                            index: index.saturating_add(1),
                            access: 0,
                        };
                        continue;
                    };
                    self.stage = Stage::Write {
                        index,
                        access: access.saturating_add(1),
                    };
                    let (register, value) = match next {
                        Access::Page => (Access::PAGE, write.page.unwrap_or(0)),
                        Access::Low => (Access::LOW, write.register),
                        Access::Value => (write.target(), write.merged(self.byte[0])),
                        Access::Read => {
                            return Ok(Step::Read {
                                register: write.target(),
                                bytes: &mut self.byte,
                            });
                        }
                        Access::Gap => return Ok(Step::Wait { us: Access::GAP_US }),
                        Access::Pause if write.wait_us == 0 => continue,
                        Access::Pause => return Ok(Step::Wait { us: write.wait_us }),
                    };
                    return Ok(Step::Write { register, value });
                }
                // The FIFO was emptied by its last write.
                Stage::Discard if self.with_fifo => return Ok(Step::Done),
                Stage::Discard => return self.sample.discard(),
            }
        }
    }
}
