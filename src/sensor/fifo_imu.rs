#[cfg(feature = "async")]
use super::{AsyncRegisters, transfer::run_async, wait::wait};
use super::{
    Burst, Clock, Description, Error, Fifo, Registers,
    decoder::Decoder,
    fetch::Fetch,
    start::Start,
    transfer::{NoDelay, run},
};
use embedded_hal::delay::DelayNs;

/// A described sensor on its bus, as a source of bursts from its FIFO.
///
/// A burst takes one transaction for the number of samples and one for all of them. Every reading has the
/// sensor's own time, from which the number of lost samples before it follows, and the
/// [`Clock`] measures the sensor's rate against the host's clock.
///
/// | what fails | what is lost |
/// |---|---|
/// | the transaction of the count | nothing, or the one sample whose time the FIFO had not yet |
/// | the transaction of the content, or a future of it is dropped | what the FIFO holds at the next read, which empties it |
/// | a packet or word that makes no sense | the rest of the burst, and what the FIFO holds at the next read |
/// | the FIFO overflows | what it overwrote; the ICM's FIFO is emptied, too |
/// | the transaction that empties the FIFO | as before; the next read tries again |
///
/// In all cases the next reading says how many samples are missing. The stamps of the ICMs have 16 bits and come
/// round after 1.1 s. The host's time shows how often, after a silence of up to 8 s; after a longer one the number is
/// unknown. No sample comes twice, because a time that is not later than the last one is refused.
///
/// ```
/// use allanite::{Axes, sensor::{Error, FifoImu, LSM6DSO, SpiBus}};
/// use embedded_hal::{delay::DelayNs, spi::SpiDevice};
///
/// fn characterise<SPI: SpiDevice>(
///     spi: SPI,
///     delay: &mut impl DelayNs,
///     micros: impl Fn() -> u32,
///     axes: &mut Axes<20>,
/// ) -> Result<(), Error<SPI::Error>> {
///     let mut imu = FifoImu::start(SpiBus::new(spi), &LSM6DSO, delay)?;
///     let mut buffer = [0; 64 * 7]; // up to 64 words of seven bytes
///     for _ in 0..100_000 {
///         delay.delay_ms(100); // at 104 Hz, the FIFO is full after 2.5 s
///         if let Ok(burst) = imu.read(micros(), &mut buffer) {
///             axes.record_burst(burst, |_| []).ok(); // if it was malformed, the rest is a gap
///         }
///         if imu.clock().check().is_err() {
///             break; // not the rate that the curve would be drawn with
///         }
///     }
///     Ok(())
/// }
/// ```
#[derive(Clone, Debug)]
pub struct FifoImu<B> {
    bus: B,
    description: &'static Description,
    decoder: Decoder,
}

impl<B> FifoImu<B> {
    fn new<E>(bus: B, description: &'static Description) -> Result<Self, Error<E>> {
        let fifo = description.fifo.as_ref().ok_or(Error::NoFifo {
            sensor: description.name,
        })?;
        Ok(Self {
            bus,
            description,
            decoder: Decoder::new(description, fifo),
        })
    }

    /// The description that the sensor was started with.
    pub const fn description(&self) -> &'static Description {
        self.description
    }

    /// The FIFO that is read.
    pub const fn fifo(&self) -> &'static Fifo {
        self.decoder.fifo
    }

    /// The sensor's clock against the host's.
    pub const fn clock(&self) -> &Clock {
        &self.decoder.clock
    }

    /// Sets the tolerance of [`Clock::check`], in per cent.
    pub const fn set_tolerance(&mut self, tolerance_percent: u8) {
        self.decoder.clock.set_tolerance(tolerance_percent);
    }

    /// Returns the bus. The sensor continues to sample.
    pub fn release(self) -> B {
        self.bus
    }
}

impl<B: Registers> FifoImu<B> {
    /// Does what [`Imu::start`](super::Imu::start) does, and turns the FIFO on.
    ///
    /// # Errors
    /// [`Error::NoFifo`], [`Error::WrongIdentity`], [`Error::Bus`].
    pub fn start(
        bus: B,
        description: &'static Description,
        delay: &mut impl DelayNs,
    ) -> Result<Self, Error<B::Error>> {
        let mut imu = Self::new(bus, description)?;
        let mut start = Start::new(description, B::IS_SPI, true);
        run(&mut imu.bus, &description.interface, delay, &mut start)?;
        Ok(imu)
    }

    /// Reads what the FIFO holds, as far as it fits into `buffer`. `now_us` is the time, in µs of any free-running
    /// 32-bit counter of the host, which may wrap. It should be taken right before the call, and calls
    /// should not be more than an hour apart.
    ///
    /// # Errors
    /// [`Error::Bus`], after which the caller only has to continue reading; [`Error::BufferTooSmall`].
    pub fn read<'a>(
        &'a mut self,
        now_us: u32,
        buffer: &'a mut [u8],
    ) -> Result<Burst<'a>, Error<B::Error>> {
        let mut fetch = Fetch::new(&mut self.decoder, buffer)?;
        let interface = &self.description.interface;
        run(&mut self.bus, interface, &mut NoDelay, &mut fetch)?;
        Ok(fetch.into_burst(now_us))
    }
}

#[cfg(feature = "async")]
impl<B: AsyncRegisters> FifoImu<B> {
    /// Does what [`FifoImu::start`] does, without blocking.
    ///
    /// # Errors
    /// Those of [`FifoImu::start`].
    pub async fn start_async(
        bus: B,
        description: &'static Description,
        delay: &mut impl embedded_hal_async::delay::DelayNs,
    ) -> Result<Self, Error<B::Error>> {
        let mut imu = Self::new(bus, description)?;
        let mut start = Start::new(description, B::IS_SPI, true);
        run_async(&mut imu.bus, &description.interface, delay, &mut start).await?;
        Ok(imu)
    }

    /// Does what [`FifoImu::read`] does, without blocking. The future may be dropped at any time.
    ///
    /// # Errors
    /// Those of [`FifoImu::read`].
    pub async fn read_async<'a>(
        &'a mut self,
        now_us: u32,
        buffer: &'a mut [u8],
    ) -> Result<Burst<'a>, Error<B::Error>> {
        let mut fetch = Fetch::new(&mut self.decoder, buffer)?;
        let interface = &self.description.interface;
        run_async(&mut self.bus, interface, &mut NoDelay, &mut fetch).await?;
        Ok(fetch.into_burst(now_us))
    }

    /// Waits until the sensor's interrupt pin says that the FIFO has reached the watermark of its
    /// [`Configuration`](super::Configuration). Take the time after this.
    ///
    /// # Errors
    /// [`Error::Pin`].
    pub async fn wait<P: embedded_hal_async::digital::Wait>(
        &self,
        pin: &mut P,
    ) -> Result<(), Error<P::Error>> {
        wait(pin, self.description.name, Some(self.fifo().signal)).await
    }
}
