//! A fault at every transfer of a start and of bursts, on either bus, blocking and asynchronous: the source stays
//! usable, the loss is told in number, and no sample comes twice.

use super::chip::{KINDS, Kind, gyro, number};
use super::wire::{Fault, NoDelay, Wire};
use allanite::Axes;
use allanite::sensor::{AsyncRegisters, Error, FifoImu, Loss, Malformed, Registers};
use pollster::block_on;
use std::{collections::BTreeSet, future::Future, pin::pin, task};

const FAULTS: [Fault; 2] = [Fault::Before, Fault::After];

/// Samples before every burst.
const SAMPLES: u64 = 9;

/// Bursts of a conversation.
const BURSTS: u64 = 12;

/// How the sensor is read.
#[derive(Clone, Copy, Debug)]
enum Way {
    Blocking,
    Asynchronous,
}

const WAYS: [Way; 2] = [Way::Blocking, Way::Asynchronous];

fn start<B>(way: Way, bus: B, kind: Kind) -> Result<FifoImu<B>, Error<Fault>>
where
    B: Registers<Error = Fault> + AsyncRegisters<Error = Fault>,
{
    match way {
        Way::Blocking => FifoImu::start(bus, kind.description(), &mut NoDelay),
        Way::Asynchronous => block_on(FifoImu::start_async(bus, kind.description(), &mut NoDelay)),
    }
}

/// What a conversation yields.
#[derive(Debug, Default, PartialEq)]
struct Outcome {
    /// The samples, and what was lost before each.
    samples: Vec<(u64, Loss)>,
    errors: Vec<Error<Fault>>,
    malformed: Vec<Malformed>,
    flushes: usize,
}

impl Outcome {
    /// The numbers of the samples. The losses told have to agree with them.
    fn numbers(&self) -> BTreeSet<u64> {
        let mut numbers = BTreeSet::new();
        let mut last = None;
        for &(n, loss) in &self.samples {
            if let Some(last) = last {
                assert!(n > last, "{n} after {last}");
                let lost = u32::try_from(n - last - 1).unwrap();
                let expected = match lost {
                    0 => Loss::Nothing,
                    _ => Loss::Samples(lost),
                };
                assert_eq!(loss, expected, "{n} after {last}");
            }
            numbers.insert(n);
            last = Some(n);
        }
        numbers
    }
}

/// Reads `BURSTS` bursts, and what is left.
fn converse<B>(way: Way, wire: &Wire, imu: &mut FifoImu<B>, kind: Kind) -> Outcome
where
    B: Registers<Error = Fault> + AsyncRegisters<Error = Fault>,
{
    let mut outcome = Outcome::default();
    let mut buffer = [0; 4096];
    for _ in 0..BURSTS {
        wire.take(SAMPLES);
        let (rate_hz, _) = kind.rate_and_ticks();
        let now_us = (wire.taken() as f64 / rate_hz * 1e6) as u32;
        let burst = match way {
            Way::Blocking => imu.read(now_us, &mut buffer),
            Way::Asynchronous => block_on(imu.read_async(now_us, &mut buffer)),
        };
        match burst {
            Ok(burst) => {
                outcome.flushes += usize::from(burst.is_flushed());
                for reading in burst {
                    match reading {
                        Ok(reading) => {
                            let n = u64::from(number(reading.gyro));
                            assert_eq!(reading.gyro, gyro(n));
                            outcome.samples.push((n, reading.loss));
                        }
                        Err(malformed) => outcome.malformed.push(malformed),
                    }
                }
            }
            Err(error) => outcome.errors.push(error),
        }
    }
    outcome
}

/// Every kind, bus and way, as a function of them.
fn everywhere(check: fn(Way, Kind, bool)) {
    for way in WAYS {
        for kind in KINDS {
            for over_spi in [false, true] {
                check(way, kind, over_spi);
            }
        }
    }
}

/// Starts and converses over a bus.
fn run(
    way: Way,
    kind: Kind,
    over_spi: bool,
    wire: &Wire,
    prepare: impl Fn(&Wire),
) -> Result<Outcome, Error<Fault>> {
    if over_spi {
        let mut imu = start(way, wire.spi(), kind)?;
        prepare(wire);
        Ok(converse(way, wire, &mut imu, kind))
    } else {
        let mut imu = start(way, wire.i2c(), kind)?;
        prepare(wire);
        Ok(converse(way, wire, &mut imu, kind))
    }
}

#[test]
fn a_fault_at_any_transfer_of_a_start_is_told_and_the_next_start_succeeds() {
    everywhere(|way, kind, over_spi| {
        let wire = Wire::new(kind);
        run(way, kind, over_spi, &wire, |_| {}).unwrap();
        let log = wire.0.borrow().log.clone();
        let transfers = log.iter().position(|&(_, read)| read > 16).unwrap();
        // The count of the first burst belongs to that burst.
        let counts = if kind == Kind::Icm45686 { 2 } else { 1 };
        let transfers = transfers - counts;
        assert!(transfers > 8, "{kind:?}: {transfers}");
        for fault in FAULTS {
            for (at, &(register, _)) in log.iter().enumerate().take(transfers) {
                let wire = Wire::new(kind);
                wire.fail(at, fault);
                let error = run(way, kind, over_spi, &wire, |_| {}).unwrap_err();
                let expected = Error::Bus {
                    register,
                    error: fault,
                };
                assert_eq!(error, expected, "{way:?} {kind:?} {at}");
                assert_eq!(wire.transfers(), at + 1, "nothing follows a fault");
                let outcome = run(way, kind, over_spi, &wire, |_| {}).unwrap();
                let samples = outcome.numbers().len() as u64;
                assert!(samples >= BURSTS * SAMPLES - 1, "{kind:?} {at}: {samples}");
            }
        }
    });
}

#[test]
fn a_fault_at_any_transfer_of_a_burst_loses_what_is_stated_and_nothing_twice() {
    everywhere(|way, kind, over_spi| {
        let wire = Wire::new(kind);
        let clean = run(way, kind, over_spi, &wire, |_| {}).unwrap();
        let all = clean.numbers();
        assert_eq!((clean.errors.len(), clean.flushes), (0, 0));
        let counts = if kind == Kind::Icm45686 { 2 } else { 1 };
        let transfers = BURSTS as usize * (counts + 1);
        for fault in FAULTS {
            for at in 0..transfers {
                let wire = Wire::new(kind);
                let fail = |wire: &Wire| wire.fail(at, fault);
                let outcome = run(way, kind, over_spi, &wire, fail).unwrap();
                let place = format!("{way:?} {kind:?} {over_spi} {fault:?} {at}");
                assert_eq!(outcome.errors.len(), 1, "{place}");
                assert_eq!(outcome.malformed, [], "{place}");
                let lost = all.difference(&outcome.numbers()).count() as u64;
                let in_count = at % (counts + 1) < counts;
                let in_last_burst = at / (counts + 1) == BURSTS as usize - 1;
                let most = if in_count {
                    // The samples stay in the FIFO until the next burst.
                    assert_eq!(outcome.flushes, 0, "{place}");
                    if in_last_burst { SAMPLES } else { 0 }
                } else {
                    // This burst, and what came before the next one, which empties the FIFO.
                    assert_eq!(outcome.flushes, usize::from(!in_last_burst), "{place}");
                    2 * SAMPLES + 1
                };
                assert!(lost <= most, "{place}: {lost} samples were lost");
                assert!(in_count || lost >= SAMPLES - 1, "{place}: {lost}");
            }
        }
    });
}

/// The flush after a fault fails as well, at any of its writes.
#[test]
fn a_fault_while_the_fifo_is_emptied_is_repeated_until_it_succeeds() {
    everywhere(|way, kind, over_spi| {
        let flush = kind.description().fifo.unwrap().flush.as_slice().len();
        let counts = if kind == Kind::Icm45686 { 2 } else { 1 };
        for write in 0..flush {
            let wire = Wire::new(kind);
            let prepare = |wire: &Wire| {
                let mut world = wire.0.borrow_mut();
                // The content of the second burst is damaged in its first header.
                world.skip = 1;
                world.damage = Some((0, 0x80));
                let at = world.transfers + 2 * (counts + 1) + write;
                world.fault = Some((at, Fault::Before));
            };
            let outcome = run(way, kind, over_spi, &wire, prepare).unwrap();
            assert_eq!(outcome.malformed.len(), 1, "{kind:?}");
            assert_eq!((outcome.errors.len(), outcome.flushes), (1, 1), "{kind:?}");
            let numbers = outcome.numbers();
            let expected = (BURSTS - 3) * SAMPLES;
            // One packet each was left in the FIFO when it was emptied, and at the end.
            let left = 2 * u64::from(kind == Kind::Icm45686);
            assert_eq!(numbers.len() as u64, expected - left, "{kind:?}");
        }
    });
}

/// Every bit of a burst is flipped once.
#[test]
fn a_flipped_bit_is_noticed_or_changes_one_sample() {
    for kind in KINDS {
        let unit = if kind.is_icm() { 16 } else { 7 };
        let (mut noticed, mut unnoticed) = (0, 0);
        for at in 0..5 * unit {
            for bit in 0..8 {
                let wire = Wire::new(kind);
                let mut imu = start(Way::Blocking, wire.spi(), kind).unwrap();
                let mut buffer = [0; 4096];
                let (mut last, mut wrong, mut malformed) = (None, 0, 0);
                for burst in 0..6_u64 {
                    wire.take(SAMPLES);
                    if burst == 2 {
                        wire.0.borrow_mut().damage = Some((at, 1 << bit));
                    }
                    let (rate_hz, _) = kind.rate_and_ticks();
                    let now_us = (wire.taken() as f64 / rate_hz * 1e6) as u32;
                    for reading in imu.read(now_us, &mut buffer).unwrap() {
                        let Ok(reading) = reading else {
                            malformed += 1;
                            continue;
                        };
                        let n = number(reading.gyro);
                        if reading.gyro == gyro(u64::from(n)) {
                            assert!(last.is_none_or(|last| n > last), "{kind:?} {at} {bit}");
                            // A damaged time is only believed if it is wrong by a few intervals.
                            if let (Loss::Samples(told), Some(last)) = (reading.loss, last) {
                                let lost = u32::from(n - last - 1);
                                assert!(told.abs_diff(lost) <= 8, "{kind:?} {at} {bit}: {told}");
                            }
                            last = Some(n);
                        } else {
                            wrong += 1;
                        }
                    }
                }
                assert!(wrong <= 1 && malformed <= 1, "{kind:?} {at} {bit}");
                // After the next burst at the latest, all is well.
                let newest = wire.taken() - 1 - u64::from(kind == Kind::Icm45686);
                assert_eq!(last.map(u64::from), Some(newest), "{kind:?} {at} {bit}");
                noticed += malformed;
                unnoticed += wrong;
            }
        }
        assert!(noticed >= 5 * 5, "{kind:?}: {noticed}");
        assert!(unnoticed >= 4 * 16, "{kind:?}: {unnoticed}");
    }
}

/// Half of a transfer is done when the future is dropped.
#[test]
fn a_future_dropped_at_any_transfer_loses_no_more_than_a_fault() {
    for kind in KINDS {
        let counts = if kind == Kind::Icm45686 { 2 } else { 1 };
        for at in 0..=counts {
            let wire = Wire::new(kind);
            let mut imu = start(Way::Asynchronous, wire.spi(), kind).unwrap();
            converse(Way::Asynchronous, &wire, &mut imu, kind);
            wire.take(SAMPLES);
            wire.stall(at);
            {
                let mut buffer = [0; 4096];
                let (rate_hz, _) = kind.rate_and_ticks();
                let now_us = (wire.taken() as f64 / rate_hz * 1e6) as u32;
                let mut reading = pin!(imu.read_async(now_us, &mut buffer));
                let mut context = task::Context::from_waker(task::Waker::noop());
                assert!(reading.as_mut().poll(&mut context).is_pending());
            }
            let outcome = converse(Way::Asynchronous, &wire, &mut imu, kind);
            assert_eq!(outcome.flushes, usize::from(at == counts), "{kind:?} {at}");
            // The losses told agree with the numbers, from the first sample on.
            outcome.numbers();
            let (first, loss) = outcome.samples[0];
            let held = u64::from(kind == Kind::Icm45686);
            let expected = match at == counts {
                true => Loss::Samples((2 * SAMPLES + held) as u32),
                false => Loss::Nothing,
            };
            assert_eq!(loss, expected, "{kind:?} {at}: sample {first}");
        }
    }
}

/// The samples that are recorded in spite of faults are those of a record with the same gaps.
#[test]
fn accumulators_after_faults_are_those_of_a_record_with_the_same_gaps() {
    for kind in KINDS {
        for at in 0..30 {
            let wire = Wire::new(kind);
            let mut imu = start(Way::Blocking, wire.spi(), kind).unwrap();
            let (mut axes, mut expected) =
                (Axes::<8, 0, (), ()>::new(), Axes::<8, 0, (), ()>::new());
            wire.fail(at, Fault::After);
            let mut buffer = [0; 4096];
            let mut numbers = BTreeSet::new();
            for _ in 0..BURSTS {
                wire.take(SAMPLES);
                let (rate_hz, _) = kind.rate_and_ticks();
                let now_us = (wire.taken() as f64 / rate_hz * 1e6) as u32;
                let before = axes.samples();
                if let Ok(burst) = imu.read(now_us, &mut buffer) {
                    let samples = axes.record_burst(burst, |_| []).unwrap();
                    assert_eq!(axes.samples() - before, u64::from(samples));
                }
            }
            let wire = Wire::new(kind);
            let mut imu = start(Way::Blocking, wire.spi(), kind).unwrap();
            wire.fail(at, Fault::After);
            for (n, _) in converse(Way::Blocking, &wire, &mut imu, kind).samples {
                numbers.insert(n);
            }
            let mut next = None;
            for n in numbers {
                expected.lost(next.map_or(0, |next| n - next));
                expected.push(gyro(n));
                next = Some(n + 1);
            }
            assert_eq!(axes, expected, "{kind:?} {at}");
        }
    }
}

#[test]
fn both_ways_make_the_same_transfers() {
    for kind in KINDS {
        for over_spi in [false, true] {
            let logs = WAYS.map(|way| {
                let wire = Wire::new(kind);
                let outcome = run(way, kind, over_spi, &wire, |_| {}).unwrap();
                let log = wire.0.borrow().log.clone();
                (outcome, log)
            });
            assert_eq!(logs[0], logs[1], "{kind:?}");
            assert!(logs[0].1.len() > 30);
        }
    }
}
