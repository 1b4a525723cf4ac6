//! Bursts from the FIFOs of simulated sensors: every sample once, losses known in number, and clocks that disagree.

use super::chip::{KINDS, Kind, gyro, number};
use super::wire::{Fault, NoDelay, Wire};
use crate::common::precision::double;
use allanite::sensor::{FifoImu, Loss, SpiBus};
use allanite::{Accumulator, Axes, Error};
use std::collections::BTreeSet;

/// Three axes without other parts.
type Three = Axes<10, 0, (), ()>;

/// A buffer for everything that a FIFO holds.
const LARGE: usize = 4096;

/// The host's µs, from a counter that wraps soon. The sensor's clock is `off` too fast.
fn host_us(kind: Kind, samples: u64, off: f64) -> u32 {
    let (rate_hz, _) = kind.rate_and_ticks();
    let us = samples as f64 / (rate_hz * (1.0 + off)) * 1e6;
    (u32::MAX - 2_000_000).wrapping_add(us as u32)
}

/// A started sensor and its simulation.
fn started(kind: Kind) -> (Wire, FifoImu<SpiBus<Wire>>) {
    let wire = Wire::new(kind);
    let imu = FifoImu::start(wire.spi(), kind.description(), &mut NoDelay).unwrap();
    (wire, imu)
}

/// What was read so far: every sample, and that no loss went unnoticed.
#[derive(Default)]
struct Ledger {
    /// The number of the next sample if none is lost.
    next: Option<u64>,
    seen: BTreeSet<u64>,
    unknown: usize,
}

impl Ledger {
    /// Enters a burst. The sample numbers, which the counts carry, have to agree with the losses told.
    fn enter(&mut self, imu: &mut FifoImu<SpiBus<Wire>>, now_us: u32, size: usize) -> usize {
        let mut buffer = vec![0; size];
        let mut entered = 0;
        let Ok(burst) = imu.read(now_us, &mut buffer) else {
            return 0;
        };
        for reading in burst {
            let Ok(reading) = reading else { break };
            let low = u64::from(number(reading.gyro));
            let n = match (self.next, reading.loss) {
                (None, _) => low,
                (Some(next), Loss::Nothing) => next,
                (Some(next), Loss::Samples(lost)) => next + u64::from(lost),
                (Some(next), _) => {
                    self.unknown += 1;
                    next + u64::from((low as u16).wrapping_sub(next as u16))
                }
            };
            assert_eq!(reading.gyro, gyro(n), "sample {n} after {:?}", self.next);
            assert!(self.seen.insert(n), "sample {n} came twice");
            self.next = Some(n + 1);
            entered += 1;
        }
        entered
    }
}

#[test]
fn bursts_hold_every_sample_once_whatever_the_size_of_the_buffer() {
    for kind in KINDS {
        for time_first in [false, true] {
            for size in [16, 40, 200, LARGE] {
                let (wire, mut imu) = started(kind);
                wire.0.borrow_mut().chip.time_first = time_first;
                let (mut ledger, first) = (Ledger::default(), wire.taken());
                for burst in 0..200 {
                    wire.take([3, 1, 0, 7, 2][burst % 5]);
                    let now_us = host_us(kind, wire.taken(), 0.0);
                    // A small buffer needs several reads, and an erratum keeps the newest packet.
                    while ledger.enter(&mut imu, now_us, size) > 0 {}
                }
                let held = u64::from(kind == Kind::Icm45686);
                let expected: BTreeSet<u64> = (first..wire.taken() - held).collect();
                assert_eq!(ledger.seen, expected, "{kind:?} {size}");
                assert_eq!(ledger.unknown, 0);
            }
        }
    }
}

#[test]
fn a_burst_takes_one_transaction_besides_its_count() {
    for kind in KINDS {
        let (wire, mut imu) = started(kind);
        wire.take(20);
        let before = wire.transfers();
        Ledger::default().enter(&mut imu, 0, LARGE);
        // An erratum demands that the count is read twice.
        let counts = if kind == Kind::Icm45686 { 2 } else { 1 };
        assert_eq!(wire.transfers() - before, counts + 1, "{kind:?}");
        let expected = match kind {
            Kind::Icm42688P => (0x30, 20 * 16),
            Kind::Icm45686 => (0x14, 19 * 16),
            // Every eighth sample, the first included, comes with a temperature.
            Kind::Lsm6dso | Kind::Lsm6dsr | Kind::Lsm6dsv16x => (0x78, 43 * 7),
        };
        assert_eq!(wire.0.borrow().log.last(), Some(&expected), "{kind:?}");
    }
}

#[test]
fn temperatures_come_in_the_steps_of_the_registers() {
    for kind in KINDS {
        let (wire, mut imu) = started(kind);
        wire.take(20);
        let mut buffer = [0; LARGE];
        let last = imu.read(0, &mut buffer).unwrap().last().unwrap().unwrap();
        let celsius = kind
            .description()
            .temperature
            .unwrap()
            .celsius(last.temperature.unwrap());
        let expected = match kind {
            // −10 in steps of 1/2.07 K or 1/2 K.
            Kind::Icm42688P => 25.0 - 10.0 / 2.07,
            Kind::Icm45686 => 20.0,
            Kind::Lsm6dso | Kind::Lsm6dsr | Kind::Lsm6dsv16x => 22.5,
        };
        assert!((celsius - expected).abs() < 1e-9, "{kind:?}: {celsius}");
    }
}

/// The accumulators of bursts, some of which are lost, are those of the samples one by one, to the bit.
#[test]
fn bursts_give_the_bits_of_single_samples_with_known_gaps() {
    for kind in KINDS {
        let (wire, mut imu) = started(kind);
        let (mut axes, mut expected) = (Three::new(), Three::new());
        let mut buffer = [0; LARGE];
        for burst in 0..100_u64 {
            // Some silences let the FIFO overflow.
            let silent = burst % 10 == 7;
            let samples = if silent { 400 } else { 5 + burst % 20 };
            wire.take(samples);
            let now_us = host_us(kind, wire.taken(), 0.0);
            if let Ok(burst) = imu.read(now_us, &mut buffer) {
                axes.record_burst(burst, |_| []).unwrap();
            }
        }
        let mut next = None;
        // What was lost is known from the counts of another, independent pass over the same samples.
        let (wire, mut imu) = started(kind);
        let mut ledger = Ledger::default();
        for burst in 0..100_u64 {
            wire.take(if burst % 10 == 7 { 400 } else { 5 + burst % 20 });
            ledger.enter(&mut imu, host_us(kind, wire.taken(), 0.0), LARGE);
        }
        for &n in &ledger.seen {
            let lost = next.map_or(0, |next| n - next);
            expected.lost(lost);
            expected.push(gyro(n));
            next = Some(n + 1);
        }
        assert_eq!(axes, expected, "{kind:?}");
        assert_eq!(axes.losses(), 10, "{kind:?}");
        assert_eq!(ledger.unknown, 0);
        let [x, _, _] = axes.accumulators();
        assert_eq!(x.samples() as usize, ledger.seen.len());
    }
}

#[test]
fn an_overflow_becomes_a_gap_of_known_length() {
    for kind in KINDS {
        for extra in [1, 2, 3, 50, 500] {
            let (wire, mut imu) = started(kind);
            let mut ledger = Ledger::default();
            wire.take(10);
            ledger.enter(&mut imu, host_us(kind, wire.taken(), 0.0), LARGE);
            wire.take(kind.capacity() as u64 + extra);
            ledger.enter(&mut imu, host_us(kind, wire.taken(), 0.0), LARGE);
            wire.take(10);
            ledger.enter(&mut imu, host_us(kind, wire.taken(), 0.0), LARGE);
            // The ledger has checked the number. The newest samples are there.
            let held = u64::from(kind == Kind::Icm45686);
            assert!(ledger.seen.contains(&(wire.taken() - 1 - held)), "{kind:?}");
            let lost = wire.taken() - held - ledger.seen.len() as u64 - 1;
            assert!(lost >= extra, "{kind:?}: {lost} of {extra}");
            assert_eq!(ledger.unknown, 0, "{kind:?}");
        }
    }
}

/// The 16 bits of an ICM's time wrap after 1.1 s. The host's time tells how often, unless the clocks may
/// disagree by more than that.
#[test]
fn a_long_silence_is_counted_as_long_as_the_clocks_allow() {
    for kind in KINDS {
        for off in [-0.02, 0.0, 0.02] {
            for seconds in [1.0, 1.2, 2.0, 3.3, 7.0, 30.0, 300.0] {
                let (wire, mut imu) = started(kind);
                let mut ledger = Ledger::default();
                let (rate_hz, _) = kind.rate_and_ticks();
                for samples in [10, 10, (seconds * rate_hz) as u64, 10, 10] {
                    wire.take(samples);
                    ledger.enter(&mut imu, host_us(kind, wire.taken(), off), LARGE);
                }
                let is_unknown = kind.is_icm() && seconds > 8.0;
                assert_eq!(
                    ledger.unknown,
                    usize::from(is_unknown),
                    "{kind:?} {seconds} s"
                );
            }
        }
    }
}

#[test]
fn the_sensors_clock_is_measured_against_the_hosts() {
    for kind in KINDS {
        for off in [-0.041, -0.0113, 0.0, 0.000_1, 0.023] {
            let (wire, mut imu) = started(kind);
            let mut ledger = Ledger::default();
            assert_eq!(imu.clock().measured_hz(), None);
            for burst in 0..500 {
                wire.take(15 + burst % 11);
                // The host reads up to half an interval after the newest sample.
                let late_us = (burst * 2_654_435_761 % 4000) as u32;
                let now_us = host_us(kind, wire.taken(), off).wrapping_add(late_us);
                ledger.enter(&mut imu, now_us, LARGE);
            }
            let clock = imu.clock();
            let (rate_hz, _) = kind.rate_and_ticks();
            let error = double(clock.error_ppm().unwrap());
            let most = double(clock.uncertainty_ppm().unwrap());
            // The nominal tick of the LSM6DSV16X is rounded to a ps.
            let true_ppm = 1e6 * off;
            assert!(
                (error - true_ppm).abs() < most,
                "{kind:?} {off}: {error} ± {most} ppm"
            );
            assert!(most < 120.0, "{most}");
            let measured_hz = double(clock.measured_hz().unwrap());
            let true_hz = rate_hz * (1.0 + off);
            // The learned interval is rounded to 1/256 tick.
            let tolerance = 1e-6 * most + 1e-5;
            assert!(
                (measured_hz / true_hz - 1.0).abs() < tolerance,
                "{kind:?}: {measured_hz}"
            );
            assert_eq!(clock.check(), Ok(()));
        }
    }
}

#[test]
fn a_clock_beyond_the_tolerance_contradicts_the_rate() {
    let kind = Kind::Lsm6dso;
    let (wire, mut imu) = started(kind);
    for _ in 0..40 {
        wire.take(20);
        Ledger::default().enter(&mut imu, host_us(kind, wire.taken(), 0.08), LARGE);
    }
    assert!(matches!(
        imu.clock().check(),
        Err(Error::RateContradicted { .. })
    ));
    imu.set_tolerance(10);
    assert_eq!(imu.clock().check(), Ok(()));
}

/// The factor 32/30 of the ICM's ticks is not in every document. Without it, the interval is learned.
#[test]
fn another_number_of_ticks_is_learned() {
    let wire = Wire::new(Kind::Icm42688P);
    // Ticks of 16 µs: the interval has 625 instead of 585.9 ticks, as from a rate of 93.75 Hz.
    let mut imu = FifoImu::start(wire.spi(), &allanite::sensor::ICM_42688_P, &mut NoDelay).unwrap();
    wire.0.borrow_mut().chip.ticks = 625.0;
    let mut ledger = Ledger::default();
    for _ in 0..60 {
        wire.take(10);
        ledger.enter(&mut imu, 10_000 * wire.taken() as u32, LARGE);
    }
    wire.take(1);
    wire.0.borrow_mut().fault = None;
    wire.fail(1, Fault::After);
    ledger.enter(&mut imu, 10_000 * wire.taken() as u32, LARGE);
    for _ in 0..3 {
        wire.take(20);
        ledger.enter(&mut imu, 10_000 * wire.taken() as u32, LARGE);
    }
    // The loss of 21 samples is 13 125 ticks: with the nominal interval it would be 22.4 samples.
    assert_eq!(ledger.unknown, 0);
    assert!((imu.clock().measured_hz().unwrap() - 100.0).abs() < 0.2);
}

#[test]
fn a_burst_that_is_not_read_to_its_end_loses_the_rest() {
    for kind in KINDS {
        let (wire, mut imu) = started(kind);
        let mut buffer = [0; LARGE];
        wire.take(20);
        let first = imu.read(0, &mut buffer).unwrap().next().unwrap().unwrap();
        wire.take(20);
        let next = imu
            .read(400_000, &mut buffer)
            .unwrap()
            .next()
            .unwrap()
            .unwrap();
        let lost = number(next.gyro) - number(first.gyro) - 1;
        assert_eq!(next.loss, Loss::Samples(lost.into()), "{kind:?}");
        assert!(lost >= 18);
    }
}

#[test]
fn accumulators_do_not_depend_on_how_samples_fall_into_bursts() {
    let mut all = Vec::new();
    for sizes in [[1, 1, 1], [5, 1, 30], [100, 7, 0]] {
        let (wire, mut imu) = started(Kind::Lsm6dso);
        let mut axes = Three::new();
        let mut buffer = [0; LARGE];
        let mut taken = 0;
        for k in 0.. {
            let size = sizes[k % 3].min(2000 - taken);
            wire.take(size);
            taken += size;
            let burst = imu
                .read(host_us(Kind::Lsm6dso, taken, 0.0), &mut buffer)
                .unwrap();
            axes.record_burst(burst, |_| []).unwrap();
            if taken == 2000 {
                break;
            }
        }
        all.push(axes);
    }
    assert_eq!(all[0], all[1]);
    assert_eq!(all[0], all[2]);
    let mut expected = Accumulator::<10>::new();
    (0..2000).for_each(|n| expected.push(gyro(n)[1]));
    assert_eq!(all[0].accumulators()[1], &expected);
}
