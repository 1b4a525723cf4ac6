//! Samples from an IMU on an SPI or I²C bus, through embedded-hal 1.0.
//!
//! Most IMUs look alike: an identity register, a flag that says when a sample is ready, three
//! consecutive counts of 16 bits, and a temperature. Therefore a sensor is described by a value, a
//! [`Description`]. [`CATALOGUE`] holds some descriptions, and a program can add its own. An [`Imu`] reads
//! the sensor, and [`Axes`](crate::Axes) turns every lost sample into a gap. [`Pace`] detects lost samples
//! that the sensor does not report, and a configured rate that differs from the true one.
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
//!         axes.record(&outcome, |_| []); // a sample, or a gap if the bus failed
//!         if pace.check().is_err() {
//!             break; // not the rate that the curve would be drawn with
//!         }
//!     }
//!     Ok(())
//! }
//! ```
//!
//! The start-up writes choose a range of ±250 °/s and a low pass whose noise bandwidth is below half the rate,
//! so that noise does not fold back and raise N:
//!
//! | sensor | rate, Hz | cut-off, Hz | noise bandwidth, Hz | poles | source of the order |
//! |---|---|---|---|---|---|
//! | [`BMI160`] | 200 | 20.2 | ≤ 31.8 | ≥ 1 | not documented |
//! | [`ICM_42688_P`] | 100 | 47.6 | 48.1 | 3 | data sheet |
//! | [`L3GD20`] | 95 | 32 and 25 | ≤ 22.1 | ≥ 2 | not documented |
//! | [`LSM6DSO`] | 104 | 33.0 | 34.7 | 2 | inferred from the data sheet's cut-offs |
//! | [`MPU_6050`] | 200 | 20 | ≤ 31.4 | ≥ 1 | not documented |
//! | [`MPU_6500`] | 200 | 20 | 31.4 | 1 | inferred from the data sheet's delays |
//!
//! The low pass shows in the first octaves of a curve, where the variance is below that of white noise. The
//! documentation of each sensor lists its registers, with the data sheet's sections, the public drivers that
//! they were compared with, and what could not be verified. None of it was measured on a sensor.
//!
//! This module is not a driver for all functions of a sensor. The samples of any other driver can be given
//! to [`Axes::push`](crate::Axes::push).

#[cfg(feature = "async")]
mod async_bus;
mod bmi160;
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
mod icm_42688_p;
mod icm_45686;
mod imu;
mod l3gd20;
mod lsm6dso;
mod lsm6dsv16x;
mod malformed;
mod mpu_6050;
mod mpu_6500;
mod pace;
mod reading;
mod record;
mod sample;
#[cfg(feature = "async")]
mod signal;
mod stamps;
mod start;
mod transfer;
mod write;

#[cfg(feature = "async")]
pub use async_bus::AsyncRegisters;
pub use bmi160::BMI160;
pub use burst::Burst;
pub use bus::{I2cBus, Registers, SpiBus};
pub use clock::Clock;
pub use configuration::{Configuration, ConfigurationError};
pub use description::{ByteOrder, Description, Filter, Interface, Signal, Status, Temperature};
pub use error::Error;
pub use fifo::{Fifo, Format};
pub use fifo_imu::FifoImu;
pub use icm_42688_p::{ICM_42688_P, icm_42688_p};
pub use icm_45686::{ICM_45686, icm_45686};
pub use imu::Imu;
pub use l3gd20::L3GD20;
pub use lsm6dso::{LSM6DSO, lsm6dso};
pub use lsm6dsv16x::{LSM6DSV16X, lsm6dsv16x};
pub use malformed::Malformed;
pub use mpu_6050::MPU_6050;
pub use mpu_6500::MPU_6500;
pub use pace::Pace;
pub use reading::{Loss, Reading};
pub use write::{Bus, Write, Writes};

/// All descriptions of this module.
pub static CATALOGUE: [&Description; 8] = [
    &BMI160,
    &ICM_42688_P,
    &ICM_45686,
    &L3GD20,
    &LSM6DSO,
    &LSM6DSV16X,
    &MPU_6050,
    &MPU_6500,
];
