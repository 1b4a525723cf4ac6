use super::{
    Description, Error, Loss, Reading,
    description::MAX_BLOCK,
    transfer::{Procedure, Step},
};

/// The read of one sample from the sensor's registers, if its flag says that it is ready.
pub(super) struct Sample {
    description: &'static Description,
    stage: Stage,
    flags: [u8; 1],
    bytes: [u8; MAX_BLOCK],
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// The flags are to be read.
    Flags,
    /// The flags were read.
    Block,
    /// The sample was read.
    Read,
}

impl Sample {
    pub(super) const fn new(description: &'static Description) -> Self {
        Self {
            description,
            stage: Stage::Flags,
            flags: [0],
            bytes: [0; MAX_BLOCK],
        }
    }

    /// The next step of reading flags and sample, whether the sample is new or not.
    pub(super) fn discard<E>(&mut self) -> Result<Step<'_>, Error<E>> {
        let status = self.description.status;
        match self.stage {
            Stage::Flags => {
                self.stage = Stage::Block;
                Ok(Step::Read {
                    register: status.register,
                    bytes: &mut self.flags,
                })
            }
            Stage::Block => {
                self.stage = Stage::Read;
                let description = self.description;
                let (register, registers) = description.block();
                match self.bytes.get_mut(..registers) {
                    Some(bytes) => Ok(Step::Read { register, bytes }),
                    None => Err(too_wide(description, registers)),
                }
            }
            Stage::Read => Ok(Step::Done),
        }
    }

    /// The sample that was read; `None` if none was ready.
    ///
    /// # Errors
    /// [`Error::TooWide`] if the registers of the gyro lie beyond the last register.
    pub(super) fn reading<E>(&self) -> Result<Option<Reading>, Error<E>> {
        if self.stage != Stage::Read {
            return Ok(None);
        }
        let description = self.description;
        let (first, registers) = description.block();
        let count = |register: u8| description.count(&self.bytes, first, register);
        let axis = |k: u8| Some(i32::from(count(description.gyro.checked_add(2 * k)?)?));
        let (Some(x), Some(y), Some(z)) = (axis(0), axis(1), axis(2)) else {
            return Err(too_wide(description, registers));
        };
        let [flags] = self.flags;
        let overrun = flags & description.status.overrun != 0;
        Ok(Some(Reading {
            gyro: [x, y, z],
            temperature: description.temperature.and_then(|t| count(t.register)),
            loss: if overrun {
                Loss::Unknown
            } else {
                Loss::Nothing
            },
            ticks: None,
        }))
    }
}

fn too_wide<E>(description: &Description, registers: usize) -> Error<E> {
    Error::TooWide {
        sensor: description.name,
        registers,
    }
}

impl Procedure for Sample {
    fn step<E>(&mut self) -> Result<Step<'_>, Error<E>> {
        let [flags] = self.flags;
        if self.stage == Stage::Block && flags & self.description.status.ready == 0 {
            return Ok(Step::Done);
        }
        self.discard()
    }
}
