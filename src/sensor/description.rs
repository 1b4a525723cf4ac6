use crate::{
    Error, Scale,
    real::{Real, real},
};

/// Registers that are read at once, at most.
pub(super) const MAX_BLOCK: usize = 24;

/// Bytes of a gyro reading: three counts of 16 bits.
const GYRO_BYTES: u8 = 6;

/// Bytes of a temperature.
const TEMPERATURE_BYTES: u8 = 2;

/// How a count of 16 bits lies in two consecutive registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ByteOrder {
    /// Low byte in the lower register.
    LittleEndian,
    /// High byte in the lower register.
    BigEndian,
}

/// One write of a start-up sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Write {
    /// Where.
    pub register: u8,
    /// What.
    pub value: u8,
    /// Pause before anything else is said, in µs.
    pub wait_us: u32,
    /// Left out over I²C.
    pub spi_only: bool,
}

impl Write {
    /// Writes `value`, over either bus, without a pause.
    pub const fn new(register: u8, value: u8) -> Self {
        Self {
            register,
            value,
            wait_us: 0,
            spi_only: false,
        }
    }

    /// And then pauses, for `wait_us` µs.
    pub const fn wait_us(self, wait_us: u32) -> Self {
        Self { wait_us, ..self }
    }

    /// Over SPI alone.
    pub const fn spi_only(self) -> Self {
        Self {
            spi_only: true,
            ..self
        }
    }
}

/// How register addresses go over the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interface {
    /// Bits added to the address of a read over SPI.
    pub spi_read: u8,
    /// Bytes between the address and the data of a read over SPI, three at most.
    pub spi_dummies: u8,
    /// A register to read first, for a sensor that wakes up on I²C and takes SPI from the first
    /// edge of its chip select.
    pub spi_wake: Option<u8>,
    /// 7-bit I²C address, with the address pin at ground.
    pub i2c_address: u8,
    /// Bits added to the address of a read over I²C.
    pub i2c_read: u8,
}

/// Where a sensor says that a sample waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Status {
    /// The status register.
    pub register: u8,
    /// Bits of which one is set when a gyro sample waits, best one that reading the sample clears:
    /// one that only its own reading clears offers a sample twice to a reader who is a whole
    /// interval late.
    pub ready: u8,
    /// Bits of which one is set when a sample was overwritten unread; 0 if the sensor has none.
    pub overrun: u8,
}

/// Where and how a sensor gives its temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Temperature {
    /// The lower of its two registers.
    pub register: u8,
    /// What a count of zero means, in °C.
    pub at_zero_c: Real,
    /// Counts per kelvin.
    pub counts_per_k: Real,
}

impl Temperature {
    /// The temperature that `count` stands for, in °C.
    pub fn celsius(&self, count: i16) -> Real {
        self.at_zero_c + real(count) / self.counts_per_k
    }
}

/// All that [`Imu`](super::Imu) has to know of a sensor: another sensor is another such value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Description {
    /// As on the package.
    pub name: &'static str,
    /// The register that tells which sensor this is.
    pub identity: u8,
    /// What that register may say.
    pub identities: &'static [u8],
    /// What to write before the first sample, in this order.
    pub start_up: &'static [Write],
    /// Addresses and how they are sent.
    pub interface: Interface,
    /// Whether a sample waits.
    pub status: Status,
    /// First of the six consecutive registers of the gyro: x, y and z, in two's complement.
    pub gyro: u8,
    /// The temperature, unless the sensor has none of 16 bits.
    pub temperature: Option<Temperature>,
    /// How gyro and temperature lie in their registers.
    pub byte_order: ByteOrder,
    /// °/s per count, nominal, after the start-up writes.
    pub scale_dps: Real,
    /// Samples per second, nominal, after the start-up writes. An oscillator of its own sets the
    /// true rate, a few per cent off: see [`Pace`](super::Pace).
    pub rate_hz: Real,
}

impl Description {
    /// What makes an accumulator's counts a curve in °/s.
    ///
    /// # Errors
    /// [`Error::InvalidScale`], [`Error::InvalidRate`]: never for the descriptions of this crate.
    pub fn scale(&self) -> Result<Scale, Error> {
        Scale::new(self.scale_dps, self.rate_hz)
    }

    /// The registers that hold gyro and temperature: the first, and how many.
    pub(super) fn block(&self) -> (u8, usize) {
        let (mut first, mut last) = (self.gyro, self.gyro.saturating_add(GYRO_BYTES - 1));
        if let Some(temperature) = self.temperature {
            let register = temperature.register;
            first = first.min(register);
            last = last.max(register.saturating_add(TEMPERATURE_BYTES - 1));
        }
        (first, usize::from(last - first) + 1)
    }

    /// The count at `register`, out of a block that begins at `first`.
    pub(super) fn count(&self, block: &[u8], first: u8, register: u8) -> Option<i16> {
        let start = usize::from(register.checked_sub(first)?);
        let bytes = block.get(start..)?.first_chunk::<2>()?;
        Some(match self.byte_order {
            ByteOrder::LittleEndian => i16::from_le_bytes(*bytes),
            ByteOrder::BigEndian => i16::from_be_bytes(*bytes),
        })
    }
}
