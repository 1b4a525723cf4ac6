//! What outlives the power: a snapshot of the record, and the certificate.

use crate::Gyro;
use allanite::storage::{Certificate, SnapshotStore, StoreError};
use core::ops::Range;
use defmt::{info, warn};
use embassy_embedded_hal::adapter::BlockingAsync;
use embassy_nrf::nvmc::{FLASH_SIZE, Nvmc};
use static_cell::ConstStaticCell;

/// The flash of the chip. Its driver waits in a loop, and the core stands still meanwhile anyway: for 85 ms while a page is
/// erased. The sensor's FIFO holds the samples of 1.3 s.
pub type Flash = BlockingAsync<Nvmc<'static>>;

/// The range of the flash, in bytes, which `memory.x` leaves free.
const SNAPSHOTS: Range<u32> = FLASH_SIZE as u32 - 64 * 1024..FLASH_SIZE as u32;

/// The numbers of what is stored.
const SNAPSHOT: u8 = 0;
const CERTIFICATE: u8 = 1;

/// The largest number of bytes of each of them.
const LONGEST: usize = {
    let snapshot = Gyro::snapshot_bytes(0);
    if snapshot > Certificate::MAX_BYTES {
        snapshot
    } else {
        Certificate::MAX_BYTES
    }
};

const BUFFER: usize = SnapshotStore::<Flash>::buffer(LONGEST);

const _: () = assert!(
    SnapshotStore::<Flash>::pages(LONGEST, 2) * 4096 <= (SNAPSHOTS.end - SNAPSHOTS.start) as usize,
    "the range has too few pages for the snapshot and the certificate"
);

static BYTES: ConstStaticCell<[u8; BUFFER]> = ConstStaticCell::new([0; BUFFER]);

/// The store, with the buffer that it needs. No error of it ends the record: it is logged, and the record goes on in memory.
pub struct Store {
    snapshots: SnapshotStore<Flash>,
    buffer: &'static mut [u8; BUFFER],
}

impl Store {
    /// The store in this flash. It is called once.
    ///
    /// # Errors
    /// [`StoreError::InvalidRange`], which the constants of this file exclude.
    pub fn new(flash: Flash) -> Result<Self, StoreError<embassy_nrf::nvmc::Error>> {
        Ok(Self {
            snapshots: SnapshotStore::new(flash, SNAPSHOTS)?,
            buffer: BYTES.take(),
        })
    }

    /// Restores the record that the power left.
    pub async fn restore(&mut self, gyro: &mut Gyro) {
        match self.snapshots.load_bytes(SNAPSHOT, self.buffer).await {
            Ok(None) => info!("no snapshot is stored: the record begins"),
            Ok(Some(bytes)) => match gyro.restore(&mut [], bytes) {
                Ok(()) => info!("the record goes on after {} samples", gyro.samples()),
                Err(error) => warn!(
                    "the snapshot is another program's, the record begins: {}",
                    error
                ),
            },
            Err(error) => warn!(
                "the stored snapshot cannot be read, the record begins: {}",
                error
            ),
        }
    }

    /// Stores a snapshot of the record.
    pub async fn save(&mut self, gyro: &Gyro) {
        let saved =
            self.snapshots
                .save_with(SNAPSHOT, |buffer| gyro.snapshot(&[], buffer), self.buffer);
        match saved.await {
            Ok(()) => info!("{} samples are stored", gyro.samples()),
            Err(error) => failed(error),
        }
    }

    /// Stores the certificate.
    pub async fn certify(&mut self, certificate: &Certificate) {
        let saved = self.snapshots.save_with(
            CERTIFICATE,
            |buffer| certificate.encode(buffer),
            self.buffer,
        );
        match saved.await {
            Ok(()) => info!("the certificate is stored"),
            Err(error) => failed(error),
        }
    }
}

/// The next save puts a damaged range in order by itself.
fn failed(error: StoreError<embassy_nrf::nvmc::Error>) {
    warn!("nothing was stored, check the flash: {}", error);
}
