//! A fault at every transfer of single samples, blocking and asynchronous.

use super::chip::KINDS;
use super::wire::{Fault, NoDelay, Wire};
use allanite::sensor::{Error, Imu};
use pollster::block_on;

#[test]
fn a_fault_at_any_transfer_of_single_samples_is_told_and_reading_goes_on() {
    for kind in KINDS {
        for is_async in [false, true] {
            for at in 0..20 {
                let wire = Wire::new(kind);
                let mut imu = match is_async {
                    false => Imu::start(wire.spi(), kind.description(), &mut NoDelay),
                    true => block_on(Imu::start_async(
                        wire.spi(),
                        kind.description(),
                        &mut NoDelay,
                    )),
                }
                .unwrap();
                wire.fail(at, Fault::Before);
                let status = kind.description().status;
                let (mut samples, mut errors) = (0, 0);
                for _ in 0..20 {
                    wire.0.borrow_mut().chip.set(status.register, status.ready);
                    let outcome = match is_async {
                        false => imu.read(),
                        true => block_on(imu.read_async()),
                    };
                    match outcome {
                        Ok(reading) => samples += usize::from(reading.is_some()),
                        Err(error) => {
                            let (register, _) = *wire.0.borrow().log.last().unwrap();
                            let error_before = Fault::Before;
                            let expected = Error::Bus {
                                register,
                                error: error_before,
                            };
                            assert_eq!(error, expected);
                            errors += 1;
                        }
                    }
                }
                assert_eq!((samples, errors), (19, 1), "{kind:?} {is_async} {at}");
            }
        }
    }
}
