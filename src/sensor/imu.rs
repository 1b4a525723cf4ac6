use super::{Description, Error, Registers, description::MAX_BLOCK};
use embedded_hal::delay::DelayNs;

/// One sample, in the sensor's counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// x, y and z, as [`Accumulator::push`](crate::Accumulator::push) takes them;
    /// [`Description::scale_dps`] °/s each.
    pub gyro: [i32; 3],
    /// To be understood by [`Temperature::celsius`](super::Temperature::celsius); `None` of a
    /// sensor without.
    pub temperature: Option<i16>,
    /// Samples were lost before this one. Few sensors tell, so a caller who knows better may set
    /// it: see [`Pace`](super::Pace).
    pub overrun: bool,
}

/// A described sensor on its bus: a source of samples.
///
/// Asks for the sample's flag and then for the sample: it never waits for one. A sample that is
/// overwritten unread is lost without a word on most sensors: poll several times a sample, or on
/// the data-ready pin, and let [`Pace`](super::Pace) watch the time.
#[derive(Clone, Debug)]
pub struct Imu<B> {
    bus: B,
    description: &'static Description,
}

impl<B: Registers> Imu<B> {
    /// Makes sure that the sensor is the described one, sets it up, waits until it has settled and
    /// drops the sample that grew old meanwhile. The supply should have been up for 100 ms.
    ///
    /// The bus is lost with an error; one that was lent (`SpiBus::new(&mut spi)`) is not.
    ///
    /// # Errors
    /// [`Error::WrongIdentity`], [`Error::Bus`], or [`Error::TooWide`] of a description.
    pub fn start(
        bus: B,
        description: &'static Description,
        delay: &mut impl DelayNs,
    ) -> Result<Self, Error<B::Error>> {
        let mut imu = Self { bus, description };
        imu.identify()?;
        for write in description.start_up {
            if write.spi_only && !B::IS_SPI {
                continue;
            }
            imu.bus
                .write(&description.interface, write.register, write.value)
                .map_err(|error| Error::Bus {
                    register: write.register,
                    error,
                })?;
            if write.wait_us > 0 {
                delay.delay_us(write.wait_us);
            }
        }
        imu.register(description.status.register)?;
        imu.sample(false)?;
        Ok(imu)
    }

    fn identify(&mut self) -> Result<(), Error<B::Error>> {
        let Description {
            name,
            identity,
            identities,
            interface,
            ..
        } = self.description;
        self.bus.wake(interface).map_err(|error| Error::Bus {
            register: interface.spi_wake.unwrap_or(*identity),
            error,
        })?;
        let found = self.register(*identity)?;
        if identities.contains(&found) {
            Ok(())
        } else {
            Err(Error::WrongIdentity {
                sensor: name,
                register: *identity,
                found,
                expected: identities,
            })
        }
    }

    /// The sample that waits; `None` if none does.
    ///
    /// # Errors
    /// [`Error::Bus`]. The sensor stays usable: reading on is all that is needed, and
    /// [`Axes::record`](crate::Axes::record) makes it a gap.
    pub fn read(&mut self) -> Result<Option<Reading>, Error<B::Error>> {
        let status = self.description.status;
        let flags = self.register(status.register)?;
        if flags & status.ready == 0 {
            return Ok(None);
        }
        self.sample(flags & status.overrun != 0).map(Some)
    }

    /// The description that it was started with.
    pub const fn description(&self) -> &'static Description {
        self.description
    }

    /// Gives the bus back; the sensor goes on sampling.
    pub fn release(self) -> B {
        self.bus
    }

    fn register(&mut self, register: u8) -> Result<u8, Error<B::Error>> {
        let mut byte = [0];
        self.read_block(register, &mut byte)?;
        let [byte] = byte;
        Ok(byte)
    }

    /// Gyro and temperature, whether new or not.
    fn sample(&mut self, overrun: bool) -> Result<Reading, Error<B::Error>> {
        let description = self.description;
        let (first, registers) = description.block();
        let too_wide = Error::TooWide {
            sensor: description.name,
            registers,
        };
        let mut bytes = [0; MAX_BLOCK];
        let Some(block) = bytes.get_mut(..registers) else {
            return Err(too_wide);
        };
        self.read_block(first, block)?;
        let count = |register: u8| description.count(block, first, register);
        let axis = |k: u8| Some(i32::from(count(description.gyro.checked_add(2 * k)?)?));
        let (Some(x), Some(y), Some(z)) = (axis(0), axis(1), axis(2)) else {
            return Err(too_wide);
        };
        Ok(Reading {
            gyro: [x, y, z],
            temperature: description.temperature.and_then(|t| count(t.register)),
            overrun,
        })
    }

    fn read_block(&mut self, register: u8, bytes: &mut [u8]) -> Result<(), Error<B::Error>> {
        self.bus
            .read(&self.description.interface, register, bytes)
            .map_err(|error| Error::Bus { register, error })
    }
}
