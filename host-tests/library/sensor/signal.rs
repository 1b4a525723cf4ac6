//! Waiting for the sensor's interrupt pin.

use super::chip::{KINDS, Kind};
use super::wire::{NoDelay, Wire};
use allanite::sensor::{BMI160, CATALOGUE, Error, FifoImu, Imu, L3GD20, Signal};
use embedded_hal::digital::{ErrorKind, ErrorType};
use embedded_hal_async::digital::Wait;
use pollster::block_on;

/// A pin that notes what it waits for.
#[derive(Default)]
struct Pin {
    waits: Vec<&'static str>,
    fails: bool,
}

impl Pin {
    fn wait(&mut self, what: &'static str) -> Result<(), ErrorKind> {
        self.waits.push(what);
        if self.fails {
            Err(ErrorKind::Other)
        } else {
            Ok(())
        }
    }
}

impl ErrorType for Pin {
    type Error = ErrorKind;
}

impl Wait for Pin {
    async fn wait_for_high(&mut self) -> Result<(), ErrorKind> {
        self.wait("high")
    }
    async fn wait_for_low(&mut self) -> Result<(), ErrorKind> {
        self.wait("low")
    }
    async fn wait_for_rising_edge(&mut self) -> Result<(), ErrorKind> {
        self.wait("rising")
    }
    async fn wait_for_falling_edge(&mut self) -> Result<(), ErrorKind> {
        self.wait("falling")
    }
    async fn wait_for_any_edge(&mut self) -> Result<(), ErrorKind> {
        self.wait("any")
    }
}

#[test]
fn every_sensor_waits_for_what_its_pin_does() {
    for kind in KINDS {
        let expected = match kind {
            // Pulses, active low: INT_CONFIG after reset.
            Kind::Icm42688P => "falling",
            // Pulses, active high: INT1_CONFIG2.
            Kind::Icm45686 => "rising",
            // A level until the data are read.
            Kind::Lsm6dso | Kind::Lsm6dsr | Kind::Lsm6dsv16x => "high",
        };
        let wire = Wire::new(kind);
        let mut pin = Pin::default();
        let imu = Imu::start(wire.spi(), kind.description(), &mut NoDelay).unwrap();
        block_on(imu.wait(&mut pin)).unwrap();
        let imu = FifoImu::start(wire.spi(), kind.description(), &mut NoDelay).unwrap();
        block_on(imu.wait(&mut pin)).unwrap();
        assert_eq!(pin.waits, [expected; 2], "{kind:?}");
        pin.fails = true;
        let error = ErrorKind::Other;
        assert_eq!(block_on(imu.wait(&mut pin)), Err(Error::Pin { error }));
    }
    let without: Vec<_> = CATALOGUE
        .into_iter()
        .filter(|description| description.signal.is_none())
        .collect();
    assert_eq!(without, [&BMI160, &L3GD20]);
    assert_eq!(KINDS[0].description().signal, Some(Signal::Falling));
}

#[test]
fn a_sensor_without_a_fifo_is_told_so() {
    let wire = Wire::new(Kind::Lsm6dso);
    let started = FifoImu::start(wire.spi(), &BMI160, &mut NoDelay);
    let error = started.err().unwrap();
    assert_eq!(error, Error::NoFifo { sensor: "BMI160" });
    assert_eq!(wire.transfers(), 0);
    assert!(error.to_string().contains("`Imu`"), "{error}");
}

#[test]
fn a_buffer_without_room_for_one_packet_is_refused() {
    for kind in KINDS {
        let wire = Wire::new(kind);
        let mut imu = FifoImu::start(wire.spi(), kind.description(), &mut NoDelay).unwrap();
        let needed = if kind.is_icm() { 16 } else { 7 };
        let transfers = wire.transfers();
        let error = imu.read(0, &mut vec![0; needed - 1]).unwrap_err();
        assert_eq!(error, Error::BufferTooSmall { needed });
        assert_eq!(wire.transfers(), transfers);
        assert!(imu.read(0, &mut vec![0; needed]).is_ok());
    }
}
