use super::{
    Description, Error, Write,
    sample::Sample,
    transfer::{Procedure, Step},
    upload::BLOCK,
    write::Access,
};

/// The pause after a read that wakes a sensor on SPI, in µs. The BMI270 needs 450 µs between accesses until its power save
/// is off.
const WAKE_US: u32 = 500;

/// The start of a sensor: its identity, its image if it needs one, its start-up writes, and the removal of what is outdated
/// by then.
pub(super) struct Start {
    description: &'static Description,
    over_spi: bool,
    /// Whether the FIFO is turned on as well.
    with_fifo: bool,
    stage: Stage,
    /// What was read last.
    byte: [u8; 1],
    /// A register and a block of bytes for it.
    frame: [u8; 1 + BLOCK],
    /// The outdated sample.
    sample: Sample,
}

#[derive(Clone, Copy)]
enum Stage {
    /// The sensor is to listen to the bus.
    Wake { is_reset: bool },
    /// The sensor was woken.
    Awake { is_reset: bool },
    /// The identity is to be read.
    Identify,
    /// The identity was read.
    Compare,
    /// The accesses of the write `index` of a list are being made; `access` is the next of them.
    Write {
        list: List,
        index: usize,
        access: usize,
    },
    /// Every block takes four steps, which are counted: its address, a pause, its bytes, and a pause.
    Upload { step: usize },
    /// All blocks were written, and the status is to be read.
    Status,
    /// The status was read.
    Accept,
    /// All writes were made.
    Discard,
}

/// A list of writes.
#[derive(Clone, Copy)]
enum List {
    /// The reset before an upload.
    Reset,
    /// The writes between that and the first block.
    Open,
    /// The write after the last block.
    Close,
    /// The start-up writes.
    StartUp,
}

impl Stage {
    /// The first write of a list is to be made.
    const fn first(list: List) -> Self {
        Self::Write {
            list,
            index: 0,
            access: 0,
        }
    }
}

/// What is to be done before the next stage. What is read goes to `byte`, and the frame was made.
enum Next {
    Read { register: u8 },
    Write { register: u8, value: u8 },
    Frame { bytes: usize },
    Wait { us: u32 },
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
            stage: Stage::Wake { is_reset: false },
            byte: [0],
            frame: [0; 1 + BLOCK],
            sample: Sample::new(description),
        }
    }

    /// The write at `index` of a list.
    fn write(&self, list: List, index: usize) -> Option<&'static Write> {
        let upload = self.description.upload.as_ref();
        match list {
            List::Reset => upload.map(|it| &it.reset).filter(|_| index == 0),
            List::Open => upload?.open.as_slice().get(index),
            List::Close => upload.map(|it| &it.close).filter(|_| index == 0),
            List::StartUp => self.start_up(index),
        }
    }

    /// The stage after the last write of a list.
    const fn after(list: List) -> Stage {
        match list {
            List::Reset => Stage::Wake { is_reset: true },
            List::Open => Stage::Upload { step: 0 },
            List::Close => Stage::Status,
            List::StartUp => Stage::Discard,
        }
    }

    /// The stage after the sensor was set to listen to the bus.
    const fn listening(is_reset: bool) -> Stage {
        match is_reset {
            true => Stage::first(List::Open),
            false => Stage::Identify,
        }
    }

    /// Compares the identity that was read.
    fn compare<E>(&self) -> Result<Stage, Error<E>> {
        let description = self.description;
        let [found] = self.byte;
        if !description.identities.contains(&found) {
            return Err(Error::WrongIdentity {
                sensor: description.name,
                register: description.identity,
                found,
                expected: description.identities,
            });
        }
        Ok(Stage::first(match description.upload {
            Some(_) => List::Reset,
            None => List::StartUp,
        }))
    }

    /// An access of a write, and the stage after it.
    fn access(&self, list: List, index: usize, access: usize) -> (Stage, Option<Next>) {
        let Some(write) = self.write(list, index) else {
            return (Self::after(list), None);
        };
        let next = write.accesses().get(access);
        let Some(next) = next.filter(|_| write.is_sent(self.over_spi)) else {
            let next = Stage::Write {
                list,
                index: index.saturating_add(1),
                access: 0,
            };
            return (next, None);
        };
        let after = Stage::Write {
            list,
            index,
            access: access.saturating_add(1),
        };
        let next = match next {
            Access::Page => Next::Write {
                register: Access::PAGE,
                value: write.page.unwrap_or(0),
            },
            Access::Low => Next::Write {
                register: Access::LOW,
                value: write.register,
            },
            Access::Value => Next::Write {
                register: write.target(),
                value: write.merged(self.byte[0]),
            },
            Access::Read => Next::Read {
                register: write.target(),
            },
            Access::Gap => Next::Wait { us: Access::GAP_US },
            Access::Pause if write.wait_us == 0 => return (after, None),
            Access::Pause => Next::Wait { us: write.wait_us },
        };
        (after, Some(next))
    }

    /// A step of the upload, and the stage after it.
    fn upload(&mut self, step: usize) -> (Stage, Option<Next>) {
        let at = step / 4 * BLOCK;
        let upload = self.description.upload.as_ref();
        let Some(upload) = upload.filter(|it| at < it.image.len()) else {
            return (Stage::first(List::Close), None);
        };
        let after = Stage::Upload {
            step: step.saturating_add(1),
        };
        let bytes = match step % 4 {
            0 => self.put(upload.address, &block_address(at)),
            2 => self.put(upload.data, upload.image.get(at..).unwrap_or_default()),
            _ if upload.wait_us == 0 => return (after, None),
            _ => return (after, Some(Next::Wait { us: upload.wait_us })),
        };
        (after, Some(Next::Frame { bytes }))
    }

    /// Compares the status after an upload.
    fn accept<E>(&self) -> Result<Stage, Error<E>> {
        if let Some(upload) = self.description.upload {
            let found = self.byte[0] & upload.mask;
            if found != upload.accepted {
                return Err(Error::Upload {
                    sensor: self.description.name,
                    register: upload.status,
                    found,
                    expected: upload.accepted,
                });
            }
        }
        Ok(Stage::first(List::StartUp))
    }

    /// Makes a frame of a register and at most a block of bytes for it. It returns the number of the bytes.
    fn put(&mut self, register: u8, bytes: &[u8]) -> usize {
        let [first, places @ ..] = &mut self.frame;
        *first = register;
        for (place, byte) in places.iter_mut().zip(bytes) {
            *place = *byte;
        }
        bytes.len().min(BLOCK)
    }

    /// The start-up write at `index`. The set-up of the FIFO comes before the last start-up write, because some sensors
    /// take it only while the gyro is off. The FIFO is turned on and emptied after that write.
    fn start_up(&self, index: usize) -> Option<&'static Write> {
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

/// The address of the block at byte `at`, in words: the lowest four bits, and the eight above.
const fn block_address(at: usize) -> [u8; 2] {
    let word = at / 2;
    [(word & 0x0F) as u8, (word >> 4) as u8]
}

impl Procedure for Start {
    fn step<E>(&mut self) -> Result<Step<'_>, Error<E>> {
        let description = self.description;
        loop {
            let (after, next) = match self.stage {
                Stage::Wake { is_reset } => match description.interface.spi_wake {
                    Some(register) if self.over_spi => {
                        (Stage::Awake { is_reset }, Some(Next::Read { register }))
                    }
                    _ => (Self::listening(is_reset), None),
                },
                Stage::Awake { is_reset } => {
                    (Self::listening(is_reset), Some(Next::Wait { us: WAKE_US }))
                }
                Stage::Identify => {
                    let register = description.identity;
                    (Stage::Compare, Some(Next::Read { register }))
                }
                Stage::Compare => (self.compare()?, None),
                Stage::Write {
                    list,
                    index,
                    access,
                } => self.access(list, index, access),
                Stage::Upload { step } => self.upload(step),
                Stage::Status => {
                    let register = description.upload.map_or(0, |it| it.status);
                    (Stage::Accept, Some(Next::Read { register }))
                }
                Stage::Accept => (self.accept()?, None),
                // The FIFO was emptied by its last write.
                Stage::Discard if self.with_fifo => return Ok(Step::Done),
                Stage::Discard => return self.sample.discard(),
            };
            self.stage = after;
            match next {
                Some(Next::Read { register }) => {
                    let bytes = &mut self.byte;
                    return Ok(Step::Read { register, bytes });
                }
                Some(Next::Write { register, value }) => {
                    return Ok(Step::Write { register, value });
                }
                Some(Next::Frame { bytes }) => {
                    let frame = self.frame.get(..=bytes).unwrap_or(&self.frame);
                    return Ok(Step::Frame { frame });
                }
                Some(Next::Wait { us }) => return Ok(Step::Wait { us }),
                None => {}
            }
        }
    }
}
