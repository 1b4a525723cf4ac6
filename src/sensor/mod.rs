//! Samples from an IMU on an SPI or I²C bus, through embedded-hal 1.0 or embedded-hal-async 1.0.
//!
//! Most IMUs look alike: an identity register, a flag that says when a sample is ready, three
//! consecutive counts of 16 bits, and a temperature. Therefore a sensor is described by a value, a
//! [`Description`]. [`CATALOGUE`] holds some descriptions, and a program can add its own.
//!
//! * An [`Imu`] reads one sample at a time. [`Pace`] detects lost samples that the sensor does not report, and a
//!   configured rate that differs from the true one, from the times at which the host reads.
//! * A [`FifoImu`] reads bursts from the sensor's FIFO. Every sample has the sensor's own time, from which lost samples
//!   are counted, and a [`Clock`] measures the sensor's rate.
//! * An [`Adis16470`] is read by a driver of its own, because it has frames of 16 bits and counts of 32 bits. Its counter of
//!   samples gives the number of lost ones.
//!
//! [`Axes`](crate::Axes) turns what was lost into gaps.
//!
//! ```
//! use allanite::{Axes, sensor::{Error, ICM_42688_P, Imu, Loss, Pace, SpiBus}};
//! use embedded_hal::{delay::DelayNs, spi::SpiDevice};
//!
//! fn characterise<SPI: SpiDevice>(
//!     spi: SPI,
//!     delay: &mut impl DelayNs,
//!     micros: impl Fn() -> u32,
//!     axes: &mut Axes<20>,
//! ) -> Result<(), Error<SPI::Error>> {
//!     let mut imu = Imu::start(SpiBus::new(spi), &ICM_42688_P, delay)?;
//!     let Ok(mut pace) = Pace::new(ICM_42688_P.rate_hz) else { return Ok(()) };
//!     for _ in 0..1_000_000 {
//!         let mut outcome = imu.read();
//!         if let Ok(Some(reading)) = &mut outcome {
//!             reading.loss = reading.loss.or(Loss::of_intervals(pace.stamp(micros())));
//!         }
//!         axes.record_outcome(&outcome, |_| []); // a sample, or a gap if the bus failed
//!         if pace.check().is_err() {
//!             break; // not the rate that the curve would be drawn with
//!         }
//!     }
//!     Ok(())
//! }
//! ```
//!
//! # Sensors
//!
//! The start-up writes choose a range of ±250 °/s and a low pass whose noise bandwidth is below half the rate,
//! so that noise does not fold back and raise N:
//!
//! | sensor | rate, Hz | cut-off, Hz | noise bandwidth, Hz | poles | source of the order | FIFO |
//! |---|---|---|---|---|---|---|
//! | [`BMI160`] | 200 | 20.2 | ≤ 31.8 | ≥ 1 | not documented | no |
//! | [`bmi270`] | 200 | ≤ 22 | ≤ 34.6 | ≥ 1 | not documented | no |
//! | [`ICM_20602`] | 200 | 20 | ≤ 31.4 | ≥ 1 | not documented | no |
//! | [`ICM_20948`] | 225 | 23.9 | ≤ 37.7 | ≥ 1 | inferred from the noise bandwidth | no |
//! | [`ICM_42688_P`] | 100 | 47.6 | 48.1 | 3 | data sheet | 128 samples |
//! | [`ICM_45686`] | 100 | 6.25 | ≤ 9.8 | ≥ 1 | not documented | 128 samples |
//! | [`L3GD20`] | 95 | 32 and 25 | ≤ 22.1 | ≥ 2 | not documented | no |
//! | [`LSM6DSO`] | 104 | 33.0 | 34.7 | 2 | inferred from the data sheet's cut-offs | 256 samples |
//! | [`LSM6DSR`] | 104 | 33.0 | 34.7 | 2 | that of the LSM6DSO | 256 samples |
//! | [`LSM6DSV16X`] | 120 | 38 | 40 | 2 | inferred from the LSM6DSO | 128 samples |
//! | [`LSM9DS1`] | 119 | 38 and 31 | ≤ 26.8 | ≥ 2 | not documented | no |
//! | [`MPU_6050`] | 200 | 20 | ≤ 31.4 | ≥ 1 | not documented | no |
//! | [`MPU_6500`] | 200 | 20 | 31.4 | 1 | inferred from the data sheet's delays | no |
//!
//! The low pass shows in the first octaves of a curve, where the variance is below that of white noise. The
//! documentation of each sensor lists its registers, with the data sheet's sections, the public drivers that
//! they were compared with, and what could not be verified. None of it was measured on a sensor.
//!
//! The sensors without a FIFO here have one in silicon. The FIFOs of the BMI160 and the BMI270 hold a time only at the
//! end of their content, and the others hold none; lost samples could not be counted. These sensors are read one sample at a time.
//!
//! The [`Adis16470`] has a range of ±2000 °/s and rates up to 1000 Hz. It averages the samples that it leaves out, so that no noise
//! folds back either.
//!
//! # Another configuration
//!
//! The functions [`icm_20602`], [`icm_20948`], [`icm_42688_p`], [`icm_45686`], [`lsm6dso`], [`lsm6dsr`], [`lsm6dsv16x`],
//! [`mpu_6050`] and [`mpu_6500`] make a description for another rate, range, low pass and watermark of the FIFO. They refuse what the sensor does not offer,
//! in constants at compile time: see [`Configuration`]. The BMI160, the BMI270, the L3GD20 and the LSM9DS1 have the one
//! configuration of the table. The bandwidths of the first three are not documented for others.
//!
//! # A sensor of your own
//!
//! A sensor that is not in the list needs a value of [`Description`], in the program that uses it. The compiler
//! [checks](Description::check) what can be checked without the sensor:
//!
//! ```
//! use allanite::sensor::{ByteOrder, Description, Filter, Interface, Status, Temperature, Write, Writes};
//!
//! /// ±250 °/s at 200 Hz behind 20 Hz: the registers of the ICM-20602, with an identity of its own.
//! const MINE: Description = Description {
//!     name: "ICM-20689",
//!     identity: 0x75,
//!     identities: &[0x98],
//!     upload: None,
//!     start_up: Writes::of([
//!         Write::new(0x6B, 0x80).wait_us(100_000), // reset
//!         Write::new(0x70, 0x40).spi_only(),       // no I²C
//!         Write::new(0x6B, 0x01),                  // awake
//!         Write::new(0x1A, 0x04),                  // low pass
//!         Write::new(0x19, 0x04),                  // 1 kHz / 5
//!         Write::new(0x1B, 0x00),                  // ±250 °/s
//!         Write::new(0x37, 0x10),                  // a read clears the flags
//!         Write::new(0x38, 0x01).wait_us(100_000), // data ready; the gyro settles
//!     ]),
//!     interface: Interface { spi_read: 0x80, spi_dummies: 0, spi_wake: None, i2c_address: 0x68, i2c_read: 0 },
//!     status: Status { register: 0x3A, ready: 1, overrun: 0 },
//!     signal: None,
//!     gyro: 0x43,
//!     temperature: Some(Temperature { register: 0x41, at_zero_c: 25.0, counts_per_k: 326.8 }),
//!     byte_order: ByteOrder::BigEndian,
//!     scale_dps: 1.0 / 131.0,
//!     rate_hz: 200.0,
//!     // The largest that a cut-off of 20 Hz can have, because its order is not known.
//!     filter: Filter { noise_bandwidth_hz: 31.4, poles: 1 },
//!     fifo: None,
//! };
//! const _: () = assert!(MINE.check().is_ok());
//! ```
//!
//! Registers in banks are reached by writes that choose the bank, as those of the [`ICM_20948`]. An image that a sensor needs at
//! every start is an [`Upload`], and a FIFO with packets of its own is described by [`Packets`]. What no description says: frames of 16 bits, and counts of 32 bits. Such a sensor is
//! read by a driver of its own, as the [`Adis16470`] is. The counts of any driver go to [`Axes::push`](crate::Axes::push), or as
//! a [`Reading`] to [`Axes::record_outcome`](crate::Axes::record_outcome).
//!
//! # Waiting
//!
//! Both sources can be polled: without a new sample they return none. With the feature `async`, [`Imu`] and
//! [`FifoImu`] have a second set of methods for `embedded-hal-async`, such as `read_async`, and `wait`, which waits
//! for the sensor's interrupt pin. Both sets make the same transfers, because the decisions are made apart from
//! the bus.
//!
//! ```
//! # #[cfg(feature = "async")]
//! # mod example {
//! use allanite::{Axes, sensor::{Error, FifoImu, I2cBus, LSM6DSV16X}};
//! use embedded_hal_async::{delay::DelayNs, digital::Wait, i2c::I2c};
//!
//! async fn characterise<I2C: I2c>(
//!     i2c: I2C,
//!     pin: &mut impl Wait, // INT1
//!     delay: &mut impl DelayNs,
//!     micros: impl Fn() -> u32,
//!     axes: &mut Axes<20>,
//! ) -> Result<(), Error<I2C::Error>> {
//!     let mut imu = FifoImu::start_async(I2cBus::new(i2c), &LSM6DSV16X, delay).await?;
//!     let mut buffer = [0; 48 * 7];
//!     while imu.wait(pin).await.is_ok() && imu.clock().check().is_ok() {
//!         if let Ok(burst) = imu.read_async(micros(), &mut buffer).await {
//!             axes.record_burst(burst, |_| []).ok(); // if it was malformed, the rest is a gap
//!         }
//!     }
//!     Ok(())
//! }
//! # }
//! ```
//!
//! This module is not a driver for all functions of a sensor. The samples of any other driver can be given
//! to [`Axes::push`](crate::Axes::push).

mod adis16470;
#[cfg(feature = "async")]
mod async_bus;
mod bmi160;
mod bmi270;
mod burst;
mod bus;
mod clock;
mod configuration;
mod decoder;
mod description;
mod error;
mod fetch;
mod fifo;
mod fifo_imu;
mod frames;
mod icm_20602;
mod icm_20948;
mod icm_42688_p;
mod icm_45686;
mod imu;
mod l3gd20;
mod lsm6dso;
mod lsm6dsr;
mod lsm6dsv16x;
mod lsm9ds1;
mod malformed;
mod mpu;
mod mpu_6050;
mod mpu_6500;
mod pace;
mod packets;
mod reading;
mod record;
mod sample;
mod signal;
mod stamps;
mod start;
mod transfer;
mod upload;
#[cfg(feature = "async")]
mod wait;
mod write;

pub use adis16470::Adis16470;
#[cfg(feature = "async")]
pub use async_bus::AsyncRegisters;
pub use bmi160::BMI160;
pub use bmi270::bmi270;
pub use burst::Burst;
pub use bus::{I2cBus, Registers, SpiBus};
pub use clock::Clock;
pub use configuration::{Configuration, ConfigurationError};
pub use description::{ByteOrder, Description, Filter, Flaw, Interface, Status, Temperature};
pub use error::Error;
pub use fifo::{Fifo, Format};
pub use fifo_imu::FifoImu;
pub use icm_20602::{ICM_20602, icm_20602};
pub use icm_20948::{ICM_20948, icm_20948};
pub use icm_42688_p::{ICM_42688_P, icm_42688_p};
pub use icm_45686::{ICM_45686, icm_45686};
pub use imu::Imu;
pub use l3gd20::L3GD20;
pub use lsm6dso::{LSM6DSO, lsm6dso};
pub use lsm6dsr::{LSM6DSR, lsm6dsr};
pub use lsm6dsv16x::{LSM6DSV16X, lsm6dsv16x};
pub use lsm9ds1::LSM9DS1;
pub use malformed::Malformed;
pub use mpu_6050::{MPU_6050, mpu_6050};
pub use mpu_6500::{MPU_6500, mpu_6500};
pub use pace::Pace;
pub use packets::{Packet, PacketCount, PacketFormat, Packets};
pub use reading::{Loss, Reading};
pub use signal::Signal;
pub use upload::Upload;
pub use write::{Bus, Write, Writes};

/// All descriptions of this module. That of the BMI270 is made by [`bmi270`], because it needs an image.
pub static CATALOGUE: [&Description; 12] = [
    &BMI160,
    &ICM_20602,
    &ICM_20948,
    &ICM_42688_P,
    &ICM_45686,
    &L3GD20,
    &LSM6DSO,
    &LSM6DSR,
    &LSM6DSV16X,
    &LSM9DS1,
    &MPU_6050,
    &MPU_6500,
];
