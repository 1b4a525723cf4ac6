//! Reads the sensor until the record is complete.

use crate::{Gyro, board::Device, store::Store};
use allanite::{
    Error, Real,
    sensor::{Configuration, Description, FifoImu, SpiBus, icm_42688_p},
    storage::SnapshotInterval,
};
use core::num::NonZeroU64;
use defmt::{error, info, warn};
use embassy_nrf::gpio::Input;
use embassy_time::{Delay, Duration, Instant, Timer, with_timeout};

/// 100 samples per second within ±250 °/s. The pin signals when 32 samples wait, so that the core sleeps for a third of a
/// second at a time.
pub static SENSOR: Description = match icm_42688_p(Configuration::new(100, 250).watermark(32)) {
    Ok(description) => description,
    Err(_) => panic!("the sensor does not offer this configuration"), // at compile time
};

/// The number of samples of the record: an hour.
pub const SAMPLES: u64 = 360_000;

/// The number of samples from one snapshot to the next: ten minutes. A power cut loses those since the last one.
const EVERY: NonZeroU64 = NonZeroU64::MIN.saturating_add(60_000 - 1);

/// A signal may be missed while a page of flash is erased. So the FIFO is read after this time at the latest, when it is
/// half full.
const PATIENCE: Duration = Duration::from_millis(600);

/// A sensor that has sent nothing for this time is started again.
const SILENCE: Duration = Duration::from_secs(5);

/// The bytes of a full FIFO.
const FULL: usize = 128 * 16;

/// Records until the record is complete. Returns the sensor's rate in samples per second by the clock of the board, or by its data sheet
/// if this was not measured: the oscillators of cheap sensors are off by some per cent.
///
/// # Errors
/// [`Error::RateContradicted`] if the sensor's rate is not the one that the curve would be drawn with.
pub async fn record(
    device: &mut Device,
    signal: &mut Input<'static>,
    store: &mut Store,
    gyro: &mut Gyro,
) -> Result<Real, Error> {
    let mut rate_hz = SENSOR.rate_hz;
    let mut interval = SnapshotInterval::new(EVERY, gyro.samples());
    while gyro.samples() < SAMPLES {
        let bus = SpiBus::new(&mut *device);
        match FifoImu::start_async(bus, &SENSOR, &mut Delay).await {
            Ok(mut imu) => {
                info!("{=str} records", SENSOR.name);
                read(&mut imu, signal, store, gyro, &mut interval).await?;
                rate_hz = imu.clock().measured_hz().unwrap_or(rate_hz);
                // What comes after another start does not follow what came before.
                gyro.gap();
            }
            Err(error) => {
                error!(
                    "the sensor does not start, check wiring and supply: {}",
                    error
                );
                Timer::after_secs(1).await;
            }
        }
    }
    Ok(rate_hz)
}

/// Reads until the record is complete or the sensor is silent.
async fn read(
    imu: &mut FifoImu<SpiBus<&mut Device>>,
    signal: &mut Input<'static>,
    store: &mut Store,
    gyro: &mut Gyro,
    interval: &mut SnapshotInterval,
) -> Result<(), Error> {
    let mut buffer = [0; FULL];
    let mut last = Instant::now();
    while gyro.samples() < SAMPLES {
        match with_timeout(PATIENCE, imu.wait(signal)).await {
            Ok(Ok(())) | Err(_) => {}
            Ok(Err(error)) => warn!("the interrupt pin failed: {}", error),
        }
        let now = Instant::now();
        // The time in µs may wrap.
        match imu.read_async(now.as_micros() as u32, &mut buffer).await {
            Ok(burst) => match gyro.record_burst(burst, |_| []) {
                Ok(0) => {}
                Ok(_) => last = now,
                Err(error) => warn!("the FIFO makes no sense, check clock and wiring: {}", error),
            },
            // The next burst says how many samples were lost.
            Err(error) => warn!("a read failed, check the wiring: {}", error),
        }
        if now - last > SILENCE {
            warn!("the sensor sends nothing and is started again");
            return Ok(());
        }
        imu.clock().check()?;
        if interval.is_due(gyro.samples()) {
            store.save(gyro).await;
        }
    }
    Ok(())
}
