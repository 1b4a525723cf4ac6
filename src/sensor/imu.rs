use super::{Description, Error, Registers, description::MAX_BLOCK};
use embedded_hal::delay::DelayNs;

/// One sample, in the sensor's counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    /// The rates about x, y and z, as [`Accumulator::push`](crate::Accumulator::push) takes them.
    /// One count is [`Description::scale_dps`] °/s.
    pub gyro: [i32; 3],
    /// The temperature count, which [`Temperature::celsius`](super::Temperature::celsius) converts;
    /// `None` if the sensor has no temperature.
    pub temperature: Option<i16>,
    /// Whether samples were lost before this one. Few sensors report this, so a caller that knows better
    /// may set it: see [`Pace`](super::Pace).
    pub overrun: bool,
}

/// A described sensor on its bus, as a source of samples.
///
/// It reads the sample's flag and, if the flag is set, the sample; it never waits for a sample. Most sensors
/// do not report a sample that was overwritten before it was read. Poll several times per sample, or
/// read when the data-ready pin signals, and let [`Pace`](super::Pace) check the timestamps.
#[derive(Clone, Debug)]
pub struct Imu<B> {
    bus: B,
    description: &'static Description,
}

impl<B: Registers> Imu<B> {
    /// Checks that the sensor is the described one, sets it up, waits until it has settled and
    /// discards the sample that is outdated by then. The supply should have been up for 100 ms.
    ///
    /// If this fails, the bus is dropped. To keep it, lend it: `SpiBus::new(&mut spi)`.
    ///
    /// # Errors
    /// [`Error::WrongIdentity`], [`Error::Bus`], or [`Error::TooWide`] for an unsuitable description.
    pub fn start(
        bus: B,
        description: &'static Description,
        delay: &mut impl DelayNs,
    ) -> Result<Self, Error<B::Error>> {
        let mut imu = Self { bus, description };
        imu.identify()?;
        for write in description.start_up {
            if !write.is_sent(B::IS_SPI) {
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

    /// Reads the sample that is ready; `None` if no sample is ready.
    ///
    /// # Errors
    /// [`Error::Bus`]. The sensor stays usable: the caller only has to continue reading, and
    /// [`Axes::record`](crate::Axes::record) turns the error into a gap.
    pub fn read(&mut self) -> Result<Option<Reading>, Error<B::Error>> {
        let status = self.description.status;
        let flags = self.register(status.register)?;
        if flags & status.ready == 0 {
            return Ok(None);
        }
        self.sample(flags & status.overrun != 0).map(Some)
    }

    /// The description that the sensor was started with.
    pub const fn description(&self) -> &'static Description {
        self.description
    }

    /// Returns the bus. The sensor continues to sample.
    pub fn release(self) -> B {
        self.bus
    }

    fn register(&mut self, register: u8) -> Result<u8, Error<B::Error>> {
        let mut byte = [0];
        self.read_block(register, &mut byte)?;
        let [byte] = byte;
        Ok(byte)
    }

    /// Reads gyro and temperature, whether they are new or not.
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
