#[cfg(feature = "async")]
use super::{AsyncRegisters, transfer::run_async, wait::wait};
use super::{
    Description, Error, Reading, Registers,
    sample::Sample,
    start::Start,
    transfer::{NoDelay, run},
};
use embedded_hal::delay::DelayNs;

/// A described sensor on its bus, as a source of samples, one at a time.
///
/// It reads the sample's flag and, if the flag is set, the sample; it never waits for a sample. Most sensors
/// do not report a sample that was overwritten before it was read. Poll several times per sample, or
/// read when the data-ready pin signals, and let [`Pace`](super::Pace) check the timestamps. A
/// [`FifoImu`](super::FifoImu) reads many samples at once, each with the sensor's own time.
#[derive(Clone, Debug)]
pub struct Imu<B> {
    bus: B,
    description: &'static Description,
}

impl<B> Imu<B> {
    /// The description that the sensor was started with.
    pub const fn description(&self) -> &'static Description {
        self.description
    }

    /// Returns the bus. The sensor continues to sample.
    pub fn release(self) -> B {
        self.bus
    }
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
        mut bus: B,
        description: &'static Description,
        delay: &mut impl DelayNs,
    ) -> Result<Self, Error<B::Error>> {
        let mut start = Start::new(description, B::IS_SPI, false);
        run(&mut bus, &description.interface, delay, &mut start)?;
        Ok(Self { bus, description })
    }

    /// Reads the sample that is ready; `None` if no sample is ready.
    ///
    /// # Errors
    /// [`Error::Bus`]. The sensor stays usable: the caller only has to continue reading, and
    /// [`Axes::record`](crate::Axes::record) turns the error into a gap.
    pub fn read(&mut self) -> Result<Option<Reading>, Error<B::Error>> {
        let mut sample = Sample::new(self.description);
        let interface = &self.description.interface;
        run(&mut self.bus, interface, &mut NoDelay, &mut sample)?;
        sample.reading()
    }
}

#[cfg(feature = "async")]
impl<B: AsyncRegisters> Imu<B> {
    /// Does what [`Imu::start`] does, without blocking.
    ///
    /// # Errors
    /// Those of [`Imu::start`].
    pub async fn start_async(
        mut bus: B,
        description: &'static Description,
        delay: &mut impl embedded_hal_async::delay::DelayNs,
    ) -> Result<Self, Error<B::Error>> {
        let mut start = Start::new(description, B::IS_SPI, false);
        run_async(&mut bus, &description.interface, delay, &mut start).await?;
        Ok(Self { bus, description })
    }

    /// Does what [`Imu::read`] does, without blocking.
    ///
    /// # Errors
    /// Those of [`Imu::read`].
    pub async fn read_async(&mut self) -> Result<Option<Reading>, Error<B::Error>> {
        let mut sample = Sample::new(self.description);
        let interface = &self.description.interface;
        run_async(&mut self.bus, interface, &mut NoDelay, &mut sample).await?;
        sample.reading()
    }

    /// Waits until the sensor's interrupt pin says that a sample is ready.
    ///
    /// # Errors
    /// [`Error::NoSignal`] if the start-up writes do not use the pin; [`Error::Pin`].
    pub async fn wait<P: embedded_hal_async::digital::Wait>(
        &self,
        pin: &mut P,
    ) -> Result<(), Error<P::Error>> {
        wait(pin, self.description.name, self.description.signal).await
    }
}
