//! Measures the noise of a gyro at rest for an hour, with snapshots that outlive a power cut, and logs the five terms of
//! IEEE Std 952 for each axis.
//!
//! After a reset with a complete record in flash, it logs the result again.

#![no_std]
#![no_main]

mod board;
mod record;
mod result;
mod store;

use allanite::Axes;
use board::Board;
use defmt::{error, info};
use defmt_rtt as _;
use embassy_executor::Spawner;
use panic_probe as _;
use static_cell::ConstStaticCell;
use store::Store;

/// Three axes of 20 octaves, from one sample to 2^19 samples, with a gate against shocks.
pub type Gyro = Axes<20>;

/// An empty record is all zero, so that it takes no flash.
static GYRO: ConstStaticCell<Gyro> = ConstStaticCell::new(Gyro::new());

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let gyro = GYRO.take();
    let mut board = Board::start();
    let mut store = match Store::new(board.flash) {
        Ok(store) => store,
        Err(error) => {
            return error!(
                "the range of the snapshots does not suit the flash: {}",
                error
            );
        }
    };
    store.restore(gyro).await;
    let recorded = record::record(&mut board.device, &mut board.signal, &mut store, gyro).await;
    let rate_hz = match recorded {
        Ok(rate_hz) => rate_hz,
        Err(error) => {
            return error!(
                "the record would be drawn with a wrong rate, check the sensor: {}",
                error
            );
        }
    };
    store.save(gyro).await;
    match result::certify(gyro, rate_hz) {
        Ok(certificate) => store.certify(&certificate).await,
        Err(failure) => error!("there is no result: {}", failure),
    }
    info!("done: erase the last 64 KiB of the flash for another record");
}
