use super::{
    Error, Loss, Reading, Temperature,
    frames::{Dialogue, Turn, carry_out},
};
#[cfg(feature = "async")]
use super::{Signal, frames::carry_out_async, wait::wait};
use crate::{Scale, numerics::real::Real};
use embedded_hal::{delay::DelayNs, spi::SpiDevice};

const NAME: &str = "ADIS16470";

/// The rate at which the sensor samples, before it averages.
const SAMPLES_PER_S: u16 = 2000;

const X_GYRO_LOW: u8 = 0x04;
const Y_GYRO_LOW: u8 = 0x08;
const Z_GYRO_LOW: u8 = 0x0C;
const DATA_CNTR: u8 = 0x22;
const FILT_CTRL: u8 = 0x5C;
const MSC_CTRL: u8 = 0x60;
const DEC_RATE: u8 = 0x64;
const GLOB_CMD: u8 = 0x68;
const PROD_ID: u8 = 0x72;

/// The bit of an address that marks a write.
const WRITE: u8 = 0x80;

/// 16470, and what the sensors of two robotics teams say.
const PRODUCTS: [u16; 2] = [0x4056, 0x4256];

/// MSC_CTRL: the compensation of acceleration and of the point of percussion, as after reset; data ready is active high.
const COMPENSATED: u8 = 0xC1;

/// GLOB_CMD: software reset. PX4 names 193 ms until the sensor answers again.
const RESET: u8 = 0x80;
const RESET_US: u32 = 250_000;

/// The time that a setting takes, in µs.
const SETTING_US: u32 = 250;

/// The flags of DIAG_STAT that make a sample worthless: the clock, the memory of the calibration, a sensor, the supply, and
/// an overrun of the data path. The others tell of a frame of another length and of an update of the flash.
const FAILURES: u16 = 0x00F2;

/// An Analog Devices ADIS16470 on an SPI bus, ±2000 °/s at 1 to 1000 Hz, as a source of samples with counts of 32 bits.
///
/// Its registers have 16 bits, and what a frame asks for arrives with the next one, so that no
/// [`Description`](super::Description) fits it. A sample takes a burst, which has a checksum and a counter of samples, and five
/// frames for the lower halves of the counts and the counter again. So every reading is whole, and the number of samples that
/// were lost before it is known, up to 65 535.
///
/// An error need not be recorded, because the next reading says how many samples are missing:
///
/// ```
/// use allanite::{Axes, sensor::{Adis16470, Error}};
/// use embedded_hal::{delay::DelayNs, spi::SpiDevice};
///
/// fn characterise<SPI: SpiDevice>(
///     spi: SPI, // mode 3, at most 1 MHz
///     delay: &mut impl DelayNs,
///     axes: &mut Axes<20>,
/// ) -> Result<(), Error<SPI::Error>> {
///     let mut imu = Adis16470::start(spi, 100, delay)?;
///     for _ in 0..1_000_000 {
///         delay.delay_ms(4); // better: wait for the data-ready pin
///         let outcome = imu.read(delay);
///         if outcome.is_ok() {
///             axes.record_outcome(&outcome, |_| []);
///         }
///     }
///     Ok(())
/// }
/// ```
///
/// Read at every signal of the data-ready pin, or twice per sample. More reads can make the sensor report an overrun of its
/// data path.
///
/// The sensor samples at 2000 Hz and sends the means of so many samples that the rate results. Means of samples that do not
/// overlap keep white noise white, so that no noise folds back and N is not raised. The filter before that stays off.
///
/// | register | value | public drivers |
/// |---|---|---|
/// | PROD_ID 0x72 | 0x4056 | the same: ArduPilot, Linux, PX4; 0x4256 as well: WPILib, frc971 |
/// | GLOB_CMD 0x68 | 0x0080, then 250 ms | the same: ArduPilot, PX4 |
/// | MSC_CTRL 0x60 | 0x00C1 | the same: ArduPilot, frc971 |
/// | FILT_CTRL 0x5C | 0x0000 | the same: ArduPilot, frc971 |
/// | DEC_RATE 0x64 | 2000 Hz / rate − 1 | the same: frc971, Linux |
/// | burst 0x6800 | 20 bytes | the same order and checksum: ArduPilot, Linux, PX4 |
/// | DATA_CNTR 0x22 | | the same: ArduPilot; the losses follow from it as in Analog Devices' no-OS |
/// | X_GYRO_LOW 0x04, Y_GYRO_LOW 0x08, Z_GYRO_LOW 0x0C | | the same: frc971, Linux |
///
/// A frame is followed by 16 µs of silence (frc971, Linux, PX4), and a burst runs at up to 1 MHz (Linux, PX4). The scale is 0.1
/// °/s in the upper half (ArduPilot, frc971, Linux).
///
/// Not verified: of the data sheet (revision C), only the first page was at hand, and of that of the sibling ADIS16467 the page on
/// the number of reads between two samples, which says that the lower halves are empty without decimation. The lower halves
/// have no checksum: a bit that flips in one of them changes a rate by less than 0.1 °/s. After 65 536 lost samples or a reset of
/// the sensor, the number of lost samples is wrong.
#[derive(Clone, Debug)]
pub struct Adis16470<SPI> {
    spi: SPI,
    rate_hz: u16,
    /// The counter of the last reading.
    last: Option<u16>,
}

impl<SPI> Adis16470<SPI> {
    /// The scale, in °/s per count.
    pub const SCALE_DPS: Real = 0.1 / 65_536.0;

    /// The scale of the temperature: 0.1 °C per count.
    pub const TEMPERATURE: Temperature = Temperature {
        register: 0x1C,
        at_zero_c: 0.0,
        counts_per_k: 10.0,
    };

    /// The scale that converts the counts of an accumulator to a curve in °/s.
    ///
    /// # Errors
    /// None occurs for a sensor that was started.
    pub fn scale(&self) -> Result<Scale, crate::Error> {
        Scale::new(Self::SCALE_DPS, self.rate_hz.into())
    }

    /// Returns the device. The sensor continues to sample.
    pub fn release(self) -> SPI {
        self.spi
    }

    /// Takes the sample of a dialogue that has ended.
    fn take(&mut self, read: &Read) -> Option<Reading> {
        let counter = read.counter.filter(|_| read.is_whole)?;
        let intervals = self.last.map_or(1, |last| counter.wrapping_sub(last));
        self.last = Some(counter);
        Some(Reading {
            gyro: read.gyro(),
            temperature: Some(i16::from_be_bytes([read.burst[16], read.burst[17]])),
            loss: Loss::of_intervals(intervals.into()),
            ticks: None,
        })
    }
}

impl<SPI: SpiDevice> Adis16470<SPI> {
    /// Checks that the sensor is an ADIS16470, resets it, sets it up, and waits until it has settled. The supply should have
    /// been up for 250 ms. `rate_hz` divides 2000 and is at most 1000.
    ///
    /// If this fails, the device is dropped. To keep it, lend it: `Adis16470::start(&mut spi, 100, delay)`.
    ///
    /// # Errors
    /// [`Error::Rate`], [`Error::WrongWord`], [`Error::Bus`].
    pub fn start(
        mut spi: SPI,
        rate_hz: u16,
        delay: &mut impl DelayNs,
    ) -> Result<Self, Error<SPI::Error>> {
        carry_out(&mut spi, delay, &mut Start::new(rate_hz)?)?;
        Ok(Self {
            spi,
            rate_hz,
            last: None,
        })
    }

    /// Reads the sample that is new; `None` if none is new.
    ///
    /// # Errors
    /// [`Error::Bus`], [`Error::Checksum`], [`Error::Failure`], or [`Error::Overtaken`] if the bus is too slow for the
    /// rate. The sensor stays usable: the caller only has to continue reading, and the next reading reports what was lost.
    pub fn read(&mut self, delay: &mut impl DelayNs) -> Result<Option<Reading>, Error<SPI::Error>> {
        let mut read = Read::new(self.last);
        carry_out(&mut self.spi, delay, &mut read)?;
        Ok(self.take(&read))
    }
}

#[cfg(feature = "async")]
impl<SPI: embedded_hal_async::spi::SpiDevice> Adis16470<SPI> {
    /// Does what [`Adis16470::start`] does, without blocking.
    ///
    /// # Errors
    /// Those of [`Adis16470::start`].
    pub async fn start_async(
        mut spi: SPI,
        rate_hz: u16,
        delay: &mut impl embedded_hal_async::delay::DelayNs,
    ) -> Result<Self, Error<SPI::Error>> {
        carry_out_async(&mut spi, delay, &mut Start::new(rate_hz)?).await?;
        Ok(Self {
            spi,
            rate_hz,
            last: None,
        })
    }

    /// Does what [`Adis16470::read`] does, without blocking.
    ///
    /// # Errors
    /// Those of [`Adis16470::read`].
    pub async fn read_async(
        &mut self,
        delay: &mut impl embedded_hal_async::delay::DelayNs,
    ) -> Result<Option<Reading>, Error<SPI::Error>> {
        let mut read = Read::new(self.last);
        carry_out_async(&mut self.spi, delay, &mut read).await?;
        Ok(self.take(&read))
    }

    /// Waits until the sensor's data-ready pin says that a sample is new.
    ///
    /// # Errors
    /// [`Error::Pin`].
    pub async fn wait<P: embedded_hal_async::digital::Wait>(
        &self,
        pin: &mut P,
    ) -> Result<(), Error<P::Error>> {
        wait(pin, NAME, Some(Signal::Rising)).await
    }
}

/// The start of the sensor.
struct Start {
    rate_hz: u16,
    step: u8,
    frame: [u8; 2],
}

impl Start {
    /// # Errors
    /// [`Error::Rate`] if the sensor has no such rate.
    const fn new<E>(rate_hz: u16) -> Result<Self, Error<E>> {
        if rate_hz == 0 || rate_hz > SAMPLES_PER_S / 2 || !SAMPLES_PER_S.is_multiple_of(rate_hz) {
            return Err(Error::Rate {
                sensor: NAME,
                rate_hz,
            });
        }
        Ok(Self {
            rate_hz,
            step: 0,
            frame: [0; 2],
        })
    }

    /// The number of samples that are averaged, less one.
    fn decimation(&self) -> u16 {
        (SAMPLES_PER_S / self.rate_hz.max(1)).saturating_sub(1)
    }

    /// Compares the word that has arrived with the only one expected.
    fn compare<E>(&self, register: u8, expected: u16) -> Result<(), Error<E>> {
        let found = u16::from_be_bytes(self.frame);
        if found == expected {
            return Ok(());
        }
        Err(Error::WrongWord {
            sensor: NAME,
            register,
            found,
            expected,
        })
    }
}

impl Dialogue for Start {
    fn turn<E>(&mut self) -> Result<Turn<'_>, Error<E>> {
        let step = self.step;
        self.step = step.saturating_add(1);
        let [low, high] = self.decimation().to_le_bytes();
        // A register is written byte by byte.
        let frame = match step {
            0 => [PROD_ID, 0],
            1 | 16 => [0, 0],
            2 => {
                let [product, other] = PRODUCTS;
                if u16::from_be_bytes(self.frame) != other {
                    self.compare(PROD_ID, product)?;
                }
                [WRITE | GLOB_CMD, RESET]
            }
            3 => [WRITE | (GLOB_CMD + 1), 0],
            4 => return Ok(Turn::Wait { us: RESET_US }),
            5 => [WRITE | MSC_CTRL, COMPENSATED],
            6 => [WRITE | (MSC_CTRL + 1), 0],
            7 | 10 | 13 => return Ok(Turn::Wait { us: SETTING_US }),
            8 => [WRITE | FILT_CTRL, 0],
            9 => [WRITE | (FILT_CTRL + 1), 0],
            11 => [WRITE | DEC_RATE, low],
            12 => [WRITE | (DEC_RATE + 1), high],
            // No acknowledgement tells that a write has arrived, and a wrong rate would shift the curve.
            14 => [FILT_CTRL, 0],
            15 => [DEC_RATE, 0],
            17 => {
                self.compare(DEC_RATE, self.decimation())?;
                // Two samples with the new settings, and the time that the reset may have left.
                let us = 100_000 + 2_000_000 / u32::from(self.rate_hz.max(1));
                return Ok(Turn::Wait { us });
            }
            _ => return Ok(Turn::Done),
        };
        if step == 16 {
            self.compare(FILT_CTRL, 0)?;
        }
        self.frame = frame;
        let [address, _] = frame;
        Ok(Turn::Exchange {
            register: address & !WRITE,
            bytes: &mut self.frame,
        })
    }
}

/// The number of bytes of a burst: the command, DIAG_STAT, three rates, three accelerations, TEMP_OUT, DATA_CNTR, checksum.
const BURST: usize = 22;

/// The read of a sample.
struct Read {
    /// The counter of the sample before.
    last: Option<u16>,
    step: u8,
    /// A newer sample came while the first one was read.
    is_second: bool,
    burst: [u8; BURST],
    frame: [u8; 2],
    low: [[u8; 2]; 3],
    /// The counter of the burst, if the burst is valid.
    counter: Option<u16>,
    /// All parts belong to one sample.
    is_whole: bool,
}

impl Read {
    const fn new(last: Option<u16>) -> Self {
        Self {
            last,
            step: 0,
            is_second: false,
            burst: [0; BURST],
            frame: [0; 2],
            low: [[0; 2]; 3],
            counter: None,
            is_whole: false,
        }
    }

    fn ask_for_burst(&mut self) -> Turn<'_> {
        self.burst = [0; BURST];
        self.burst[0] = GLOB_CMD;
        Turn::Exchange {
            register: GLOB_CMD,
            bytes: &mut self.burst,
        }
    }

    /// Checks the burst. It returns its counter.
    fn check<E>(&self) -> Result<u16, Error<E>> {
        let [_, _, content @ .., s1, s0] = &self.burst;
        let sum = content.iter().copied().map(u16::from).sum::<u16>();
        let found = u16::from_be_bytes([*s1, *s0]);
        // A burst of zeros is what a bus without a sensor may read, and its checksum is right.
        if found != sum || sum == 0 {
            let expected = sum;
            return Err(Error::Checksum { found, expected });
        }
        let [d1, d0, .., c1, c0] = *content;
        let flags = u16::from_be_bytes([d1, d0]);
        if flags & FAILURES != 0 {
            return Err(Error::Failure {
                sensor: NAME,
                flags,
            });
        }
        Ok(u16::from_be_bytes([c1, c0]))
    }

    fn gyro(&self) -> [i32; 3] {
        let [_, _, _, _, x1, x0, y1, y0, z1, z0, ..] = self.burst;
        let [x, y, z] = self.low;
        [([x1, x0], x), ([y1, y0], y), ([z1, z0], z)]
            .map(|([a, b], [c, d])| i32::from_be_bytes([a, b, c, d]))
    }
}

impl Dialogue for Read {
    fn turn<E>(&mut self) -> Result<Turn<'_>, Error<E>> {
        let step = self.step;
        self.step = step.saturating_add(1);
        // The answer to the frame before the last one.
        let arrived = self.frame;
        let [x, y, z] = &mut self.low;
        let register = match step {
            0 => return Ok(self.ask_for_burst()),
            1 => {
                let counter = self.check()?;
                if self.last == Some(counter) {
                    return Ok(Turn::Done);
                }
                self.counter = Some(counter);
                X_GYRO_LOW
            }
            2 => Y_GYRO_LOW,
            3 => {
                *x = arrived;
                Z_GYRO_LOW
            }
            4 => {
                *y = arrived;
                DATA_CNTR
            }
            5 => {
                *z = arrived;
                // Any register; its answer is not fetched.
                0
            }
            _ => {
                self.is_whole = self.counter == Some(u16::from_be_bytes(arrived));
                if self.is_whole {
                    return Ok(Turn::Done);
                }
                if self.is_second {
                    return Err(Error::Overtaken { sensor: NAME });
                }
                (self.is_second, self.step) = (true, 1);
                return Ok(self.ask_for_burst());
            }
        };
        self.frame = [register, 0];
        Ok(Turn::Exchange {
            register,
            bytes: &mut self.frame,
        })
    }
}
