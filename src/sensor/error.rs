use super::description::MAX_BLOCK;
use core::fmt;

/// The reason why a sensor did not start or a read failed. `E` is the error of its bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Error<E> {
    /// The bus failed.
    Bus {
        /// The first register of the transaction.
        register: u8,
        /// The error of the bus.
        error: E,
    },
    /// Another sensor answered, or no sensor did.
    WrongIdentity {
        /// The name of the expected sensor.
        sensor: &'static str,
        /// The address of its identity register.
        register: u8,
        /// The value found in that register.
        found: u8,
        /// The values expected in that register.
        expected: &'static [u8],
    },
    /// The sensor did not accept what was uploaded.
    Upload {
        /// The name of the sensor.
        sensor: &'static str,
        /// The address of its status register.
        register: u8,
        /// The bits found in that register.
        found: u8,
        /// The bits expected in that register.
        expected: u8,
    },
    /// A register of 16 bits does not hold what it should: another sensor answered, no sensor did, or a setting did not arrive.
    WrongWord {
        /// The name of the expected sensor.
        sensor: &'static str,
        /// The address of the register.
        register: u8,
        /// The value found in that register.
        found: u16,
        /// The value expected in that register.
        expected: u16,
    },
    /// The sensor has no such rate.
    Rate {
        /// The name of the sensor.
        sensor: &'static str,
        /// The rate, in samples per second.
        rate_hz: u16,
    },
    /// The checksum of a burst is wrong, or the burst holds nothing but zeros.
    Checksum {
        /// The checksum found.
        found: u16,
        /// The checksum of what was found before it.
        expected: u16,
    },
    /// The sensor reports that it has failed.
    Failure {
        /// The name of the sensor.
        sensor: &'static str,
        /// The flags of its diagnostic register.
        flags: u16,
    },
    /// The sensor took the next sample before all parts of one were read, twice.
    Overtaken {
        /// The name of the sensor.
        sensor: &'static str,
    },
    /// The registers of gyro and temperature in a description lie too far apart to be read at once.
    TooWide {
        /// The name of the described sensor.
        sensor: &'static str,
        /// The number of registers from the first to the last.
        registers: usize,
    },
    /// The description of the sensor has no FIFO.
    NoFifo {
        /// The name of the sensor.
        sensor: &'static str,
    },
    /// The buffer for a burst does not hold one packet or word of the FIFO.
    BufferTooSmall {
        /// The number of bytes of a packet or word.
        needed: usize,
    },
    /// The description of the sensor does not say how the interrupt pin announces a sample.
    NoSignal {
        /// The name of the sensor.
        sensor: &'static str,
    },
    /// The interrupt pin failed. `E` is the error of the pin.
    Pin {
        /// The error of the pin.
        error: E,
    },
}

impl<E: fmt::Debug> fmt::Display for Error<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bus { register, error } => write!(
                f,
                "the bus failed at register {register:#04x} ({error:?}): check wiring, clock and \
                 address, then read again"
            ),
            Self::WrongIdentity {
                sensor,
                register,
                found,
                expected,
            } => {
                write!(
                    f,
                    "the identity register {register:#04x} says {found:#04x} instead of"
                )?;
                for (k, value) in expected.iter().enumerate() {
                    let or = if k == 0 { "" } else { " or" };
                    write!(f, "{or} {value:#04x}")?;
                }
                write!(
                    f,
                    ", so this is no {sensor}; 0x00 and 0xff mean that nobody answered: check chip \
                     select, SPI mode and supply"
                )
            }
            Self::Upload {
                sensor,
                register,
                found,
                expected,
            } => write!(
                f,
                "{sensor} did not accept the image: its register {register:#04x} says {found:#04x} instead of \
                 {expected:#04x}; check that the image is complete and that it belongs to this sensor"
            ),
            Self::WrongWord {
                sensor,
                register,
                found,
                expected,
            } => write!(
                f,
                "the register {register:#04x} of {sensor} says {found:#06x} instead of {expected:#06x}; 0x0000 and \
                 0xffff mean that nobody answered: check chip select, SPI mode and supply"
            ),
            Self::Rate { sensor, rate_hz } => {
                write!(f, "{sensor} is not described at a rate of {rate_hz} Hz")
            }
            Self::Checksum { found, expected } => write!(
                f,
                "the checksum of a burst is {found:#06x} instead of {expected:#06x}; both 0x0000 mean that nobody \
                 answered: check clock and wiring of the bus, then read again"
            ),
            Self::Failure { sensor, flags } => write!(
                f,
                "{sensor} reports a failure by the flags {flags:#06x}: check its supply, then start it again"
            ),
            Self::Overtaken { sensor } => write!(
                f,
                "{sensor} took a sample before the one before it was read: choose a lower rate or a faster bus"
            ),
            Self::TooWide { sensor, registers } => write!(
                f,
                "gyro and temperature of {sensor} span {registers} registers, but only {MAX_BLOCK} can be \
                 read at once: leave the temperature out of the description"
            ),
            Self::NoFifo { sensor } => write!(
                f,
                "the description of {sensor} has no FIFO: read single samples with `Imu`"
            ),
            Self::BufferTooSmall { needed } => write!(
                f,
                "the buffer for a burst is too small: give at least {needed} bytes"
            ),
            Self::NoSignal { sensor } => write!(
                f,
                "the description of {sensor} does not use the interrupt pin: poll instead"
            ),
            Self::Pin { error } => write!(f, "the interrupt pin failed ({error:?})"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for Error<E> {}
