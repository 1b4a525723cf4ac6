//! Buses that answer nonsense: the library neither panics nor loops, and every burst ends.

use super::chip::{KINDS, Kind, number};
use super::wire::{NoDelay, Wire};
use allanite::Axes;
use allanite::sensor::{CATALOGUE, FifoImu, I2cBus, Imu, SpiBus};
use embedded_hal::{i2c, spi};
use proptest::prelude::*;
use std::convert::Infallible;

/// A bus that answers with given bytes, over and over, after the identity if that is asked for.
struct Nonsense {
    bytes: Vec<u8>,
    at: usize,
    identity: Option<u8>,
    transfers: usize,
}

impl Nonsense {
    fn new(bytes: Vec<u8>, identity: u8) -> Self {
        Self {
            bytes,
            at: 0,
            identity: Some(identity),
            transfers: 0,
        }
    }

    fn answer(&mut self, bytes: &mut [u8]) {
        for byte in bytes.iter_mut() {
            *byte = self.bytes[self.at % self.bytes.len()];
            self.at += 1;
        }
    }

    fn transfer(&mut self, register: u8, identity: u8, bytes: &mut [u8]) {
        self.transfers += 1;
        assert!(self.transfers < 10_000, "too many transfers");
        match (register & 0x3F == identity & 0x3F).then(|| self.identity.take()) {
            Some(Some(identity)) => bytes.fill(identity),
            _ => self.answer(bytes),
        }
    }
}

struct Bus<'a>(&'a mut Nonsense, u8);

impl spi::ErrorType for Bus<'_> {
    type Error = Infallible;
}

impl spi::SpiDevice for Bus<'_> {
    fn transaction(&mut self, operations: &mut [spi::Operation<'_, u8>]) -> Result<(), Infallible> {
        if let [spi::Operation::Write(header), spi::Operation::Read(bytes)] = operations {
            self.0.transfer(header[0], self.1, bytes);
        }
        Ok(())
    }
}

impl i2c::ErrorType for Bus<'_> {
    type Error = Infallible;
}

impl i2c::I2c for Bus<'_> {
    fn transaction(
        &mut self,
        _: u8,
        operations: &mut [i2c::Operation<'_>],
    ) -> Result<(), Infallible> {
        if let [i2c::Operation::Write(header), i2c::Operation::Read(bytes)] = operations {
            self.0.transfer(header[0], self.1, bytes);
        }
        Ok(())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn nonsense_is_read_without_panic_and_in_bounded_time(
        bytes in prop::collection::vec(any::<u8>(), 1..300),
        times in prop::collection::vec(any::<u32>(), 1..40),
        size in 0_usize..600,
        over_spi: bool,
    ) {
        for description in CATALOGUE {
            let (register, identity) = (description.identity, description.identities[0]);
            let mut nonsense = Nonsense::new(bytes.clone(), identity);
            let bus = Bus(&mut nonsense, register);
            let mut axes = Axes::<8, 1>::new();
            macro_rules! read {
                ($bus: expr) => {{
                    let mut imu = Imu::start($bus, description, &mut NoDelay).unwrap();
                    for _ in &times {
                        let outcome = imu.read();
                        axes.record_outcome(&outcome, |_| [0]);
                    }
                }};
            }
            if over_spi { read!(SpiBus::new(bus)) } else { read!(I2cBus::new(bus)) }
            if description.fifo.is_none() {
                continue;
            }
            let mut nonsense = Nonsense::new(bytes.clone(), identity);
            let bus = Bus(&mut nonsense, register);
            let mut buffer = vec![0; size];
            macro_rules! burst {
                ($bus: expr) => {{
                    let mut imu = FifoImu::start($bus, description, &mut NoDelay).unwrap();
                    for &now_us in &times {
                        let Ok(burst) = imu.read(now_us, &mut buffer) else {
                            prop_assert!(size < 16);
                            break;
                        };
                        axes.record_burst(burst, |_| [0]).ok();
                        let _ = imu.clock().check();
                        let _ = imu.clock().error_ppm();
                    }
                }};
            }
            if over_spi { burst!(SpiBus::new(bus)) } else { burst!(I2cBus::new(bus)) }
        }
    }

    /// A valid conversation with some damaged bytes and a host clock that jumps. Afterwards all is well again.
    #[test]
    fn a_conversation_recovers_from_damage_and_jumps_of_the_hosts_clock(
        kind in prop::sample::select(KINDS.to_vec()),
        rounds in prop::collection::vec((0_u64..300, 0_usize..100, any::<u8>(), any::<u32>()), 1..12),
        jumps: bool,
    ) {
        let wire = Wire::new(kind);
        let mut imu = FifoImu::start(wire.spi(), kind.description(), &mut NoDelay).unwrap();
        let mut buffer = [0; 4096];
        let mut now_us = 0_u32;
        let mut advance = |wire: &Wire, samples: u64| {
            wire.take(samples);
            let (rate_hz, _) = kind.rate_and_ticks();
            now_us = now_us.wrapping_add((samples as f64 / rate_hz * 1e6) as u32);
            now_us
        };
        for (samples, at, with, jump) in rounds {
            let now_us = advance(&wire, samples);
            wire.0.borrow_mut().damage = Some((at % 14, with));
            let jump = if jumps { jump } else { 0 };
            imu.read(now_us.wrapping_add(jump), &mut buffer).unwrap().for_each(drop);
        }
        wire.0.borrow_mut().damage = None;
        // At most: one burst to notice it, two more that are refused, and each time a flush; and with a jump of the
        // host's clock another round.
        let mut last = None;
        for _ in 0..12 {
            let now_us = advance(&wire, 20);
            for reading in imu.read(now_us, &mut buffer).unwrap() {
                last = reading.ok().map(|reading| number(reading.gyro));
            }
        }
        let newest = wire.taken() - 1 - u64::from(kind == Kind::Icm45686);
        prop_assert_eq!(last, Some(newest as u16));
    }
}
