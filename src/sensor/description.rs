use super::{Fifo, Signal, Upload, Writes};
use crate::{
    Error, Scale, Term,
    numerics::real::{
        Real, by_precision,
        consts::{FRAC_PI_2, FRAC_PI_3, PI},
        real,
    },
    theory::effect::LowPass,
};

/// The largest number of registers that are read in one transaction.
pub(super) const MAX_BLOCK: usize = 24;

/// The largest number of writes of a start-up sequence.
pub(super) const MAX_START_UP: usize = 20;

/// The number of bytes of a gyro reading: three counts of 16 bits.
const GYRO_BYTES: u8 = 6;

/// The number of bytes of a temperature.
const TEMPERATURE_BYTES: u8 = 2;

/// The order of the two bytes of a 16-bit count in consecutive registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum ByteOrder {
    /// The low byte is in the lower register.
    LittleEndian,
    /// The high byte is in the lower register.
    BigEndian,
}

/// How register addresses are sent over the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interface {
    /// The bits that are set in the address of a read over SPI.
    pub spi_read: u8,
    /// The number of dummy bytes between the address and the data of a read over SPI, at most three.
    pub spi_dummies: u8,
    /// The register to read first, for a sensor that starts on I²C and changes to SPI at the first edge of
    /// its chip select.
    pub spi_wake: Option<u8>,
    /// The 7-bit I²C address when the address pin is at ground.
    pub i2c_address: u8,
    /// The bits that are set in the address of a read over I²C.
    pub i2c_read: u8,
}

impl Interface {
    /// The interface of most sensors, at this 7-bit I²C address: bit 7 of the address marks a read over SPI, and nothing
    /// else is needed.
    pub const fn usual(i2c_address: u8) -> Self {
        Self {
            spi_read: 0x80,
            spi_dummies: 0,
            spi_wake: None,
            i2c_address,
            i2c_read: 0,
        }
    }
}

/// The register and the bits that show whether a sample is ready.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Status {
    /// The address of the status register.
    pub register: u8,
    /// The bits of which one is set when a gyro sample is ready. The best choice is a bit that is cleared
    /// when the sample is read. A bit that is cleared only when the status is read offers a sample twice to
    /// a reader that is a whole interval late.
    pub ready: u8,
    /// The bits of which one is set when a sample was overwritten before it was read; 0 if the sensor has
    /// no such bit.
    pub overrun: u8,
}

/// The registers and the scale of a sensor's temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Temperature {
    /// The lower of the two registers.
    pub register: u8,
    /// The temperature of a count of zero, in °C.
    pub at_zero_c: Real,
    /// The scale in counts per kelvin.
    pub counts_per_k: Real,
}

impl Temperature {
    /// The temperature of `count`, in °C.
    pub fn celsius(&self, count: i16) -> Real {
        self.at_zero_c + real(count) / self.counts_per_k
    }
}

/// The low pass before the samples of a gyro, as set up by the start-up writes.
///
/// White noise of the one-sided spectral density `2N²` leaves a low pass of the power response `|H(f)|²` with
/// the variance `2N² B`. The noise bandwidth `B = ∫₀^∞ |H(f)|² df`, for `|H(0)| = 1`, is what a rectangular
/// low pass of that variance would have. If `B` is at half the output rate or beyond, noise folds back on
/// sampling, and N comes out too high.
///
/// Where no source gives the order, the smallest number of poles and the largest noise bandwidth are stated:
/// for one pole, π/2 times the cut-off at −3 dB.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Filter {
    /// The noise bandwidth, in Hz.
    pub noise_bandwidth_hz: Real,
    /// The order of the low pass, which is the number of its poles.
    pub poles: u8,
}

/// The noise bandwidth of a Butterworth low pass of one to four poles, relative to its cut-off: `(π/2n)/sin(π/2n)`.
const NOISE_BANDWIDTHS: [Real; 4] = [
    FRAC_PI_2,
    by_precision(1.110_720_734_539_591_6, 1.110_720_8),
    FRAC_PI_3,
    by_precision(1.026_172_152_977_031, 1.026_172_2),
];

impl Filter {
    /// The low pass as an effect of known shape: the Butterworth filter of the same order and noise bandwidth, of one to
    /// four poles. Put into a model, it belongs to it from the start, and a diagnosis does not discover it.
    ///
    /// A shape that is wrong makes a model inadequate. So this is for a filter whose order is documented, such as that of
    /// the [`ICM_42688_P`](super::ICM_42688_P).
    ///
    /// ```
    /// use allanite::{Model, sensor::ICM_42688_P};
    ///
    /// let mut model = Model::ieee_952();
    /// model.put(ICM_42688_P.filter.term())?;
    /// assert_eq!(model.position("low_pass"), Some(1));
    /// # Ok::<(), allanite::Error>(())
    /// ```
    pub fn term(&self) -> Term {
        let poles = self.poles.clamp(1, 4);
        let ratio = NOISE_BANDWIDTHS.get(usize::from(poles).wrapping_sub(1));
        let ratio = ratio.copied().unwrap_or(1.0);
        let time_constant_s = ratio / (2.0 * PI * self.noise_bandwidth_hz);
        Term::known(&LowPass, [time_constant_s, Real::from(poles)])
    }
}

/// Everything that [`Imu`](super::Imu) needs to know about a sensor. A new sensor needs only a new value.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Description {
    /// The name on the package.
    pub name: &'static str,
    /// The register that identifies the sensor.
    pub identity: u8,
    /// The values that the identity register may have.
    pub identities: &'static [u8],
    /// What is uploaded before the start-up writes; `None` for a sensor that needs no upload.
    pub upload: Option<Upload>,
    /// The writes before the first sample, in this order. The last one turns the gyro on and waits until it has
    /// settled.
    pub start_up: Writes<MAX_START_UP>,
    /// The addresses and how they are sent.
    pub interface: Interface,
    /// The status register, which shows whether a sample is ready.
    pub status: Status,
    /// How the interrupt pin announces a sample; `None` if the start-up writes do not use the pin.
    pub signal: Option<Signal>,
    /// The first of the six consecutive registers of the gyro: x, y and z, in two's complement.
    pub gyro: u8,
    /// The temperature; `None` if the sensor has no temperature of 16 bits.
    pub temperature: Option<Temperature>,
    /// The byte order of gyro and temperature.
    pub byte_order: ByteOrder,
    /// The nominal scale after the start-up writes, in °/s per count.
    pub scale_dps: Real,
    /// The nominal rate after the start-up writes, in samples per second. The true rate is set by the
    /// sensor's own oscillator and differs by a few per cent: see [`Pace`](super::Pace).
    pub rate_hz: Real,
    /// The low pass at that rate.
    pub filter: Filter,
    /// The FIFO; `None` if the description has none. [`Imu`](super::Imu) leaves it off, and
    /// [`FifoImu`](super::FifoImu) reads it.
    pub fifo: Option<Fifo>,
}

/// What is wrong with a description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Flaw {
    /// There is no identity, or one is 0x00 or 0xFF, which a bus without a sensor reads as well.
    Identity,
    /// The image to upload is empty, odd in length or longer than 8192 bytes, or it cannot be accepted.
    Upload,
    /// Nothing is written before the first sample, so that the gyro stays off.
    StartUp,
    /// The address over I²C has more than 7 bits or is reserved, or SPI has more than three dummy bytes.
    Interface,
    /// No bit of the status shows that a sample is ready.
    Status,
    /// Gyro and temperature lie too far apart to be read in one transaction of 24 bytes.
    Block,
    /// The temperature has no scale.
    Temperature,
    /// The scale is not a positive, finite number.
    Scale,
    /// The rate is not a positive, finite number.
    Rate,
    /// The noise bandwidth is not a positive, finite number, or the low pass has no pole.
    Filter,
    /// The FIFO holds no sample, or a sample takes no time.
    Fifo,
}

impl Description {
    /// Checks what can be checked without a sensor. In a constant, it refuses a description at compile time.
    ///
    /// # Errors
    /// The first [`Flaw`] in the order of the fields.
    pub const fn check(&self) -> Result<(), Flaw> {
        let mut left = self.identities;
        if left.is_empty() {
            return Err(Flaw::Identity);
        }
        while let [first, rest @ ..] = left {
            if matches!(first, 0x00 | 0xFF) {
                return Err(Flaw::Identity);
            }
            left = rest;
        }
        if let Some(upload) = &self.upload
            && !upload.is_possible()
        {
            return Err(Flaw::Upload);
        }
        if self.start_up.as_slice().is_empty() {
            return Err(Flaw::StartUp);
        }
        if !matches!(self.interface.i2c_address, 0x08..=0x77) || self.interface.spi_dummies > 3 {
            return Err(Flaw::Interface);
        }
        if self.status.ready == 0 {
            return Err(Flaw::Status);
        }
        let (first, last) = (self.gyro as u16, self.gyro as u16 + GYRO_BYTES as u16);
        let (mut lowest, mut behind) = (first, last);
        if let Some(temperature) = self.temperature {
            let first = temperature.register as u16;
            let last = first + TEMPERATURE_BYTES as u16;
            lowest = if first < lowest { first } else { lowest };
            behind = if last > behind { last } else { behind };
            if !(temperature.counts_per_k.is_finite() && temperature.counts_per_k != 0.0) {
                return Err(Flaw::Temperature);
            }
        }
        if behind - lowest > MAX_BLOCK as u16 || behind > 0x100 {
            return Err(Flaw::Block);
        }
        if !(self.scale_dps.is_finite() && self.scale_dps > 0.0) {
            return Err(Flaw::Scale);
        }
        if !(self.rate_hz.is_finite() && self.rate_hz > 0.0) {
            return Err(Flaw::Rate);
        }
        let bandwidth_hz = self.filter.noise_bandwidth_hz;
        if !(bandwidth_hz.is_finite() && bandwidth_hz > 0.0) || self.filter.poles == 0 {
            return Err(Flaw::Filter);
        }
        if let Some(fifo) = self.fifo
            && (fifo.capacity == 0
                || fifo.tick_ps == 0
                || fifo.interval == 0
                || !fifo.format.is_possible())
        {
            return Err(Flaw::Fifo);
        }
        Ok(())
    }

    /// The scale that converts the counts of an accumulator to a curve in °/s.
    ///
    /// # Errors
    /// [`Error::InvalidScale`], [`Error::InvalidRate`]; neither occurs for the descriptions of this crate.
    pub fn scale(&self) -> Result<Scale, Error> {
        Scale::new(self.scale_dps, self.rate_hz)
    }

    /// The first of the registers that hold gyro and temperature, and their number.
    pub(super) fn block(&self) -> (u8, usize) {
        let (mut first, mut last) = (self.gyro, self.gyro.saturating_add(GYRO_BYTES - 1));
        if let Some(temperature) = self.temperature {
            let register = temperature.register;
            first = first.min(register);
            last = last.max(register.saturating_add(TEMPERATURE_BYTES - 1));
        }
        (first, usize::from(last - first) + 1)
    }

    /// The count at `register`, taken from a block that begins at `first`.
    pub(super) fn count(&self, block: &[u8], first: u8, register: u8) -> Option<i16> {
        let start = usize::from(register.checked_sub(first)?);
        let bytes = block.get(start..)?.first_chunk::<2>()?;
        Some(match self.byte_order {
            ByteOrder::LittleEndian => i16::from_le_bytes(*bytes),
            ByteOrder::BigEndian => i16::from_be_bytes(*bytes),
        })
    }
}
