//! A clock beside stamps whose losses and delays are known.

use super::{super::names::TimeUnit, *};

fn clock(stamps: &[i64], unit: TimeUnit) -> Clock {
    let first: Vec<f64> = stamps.iter().take(100).map(|&stamp| stamp as f64).collect();
    Clock::new(Pace::of(&first, unit).unwrap(), &[])
}

fn run(stamps: &[i64]) -> (Clock, Vec<Tick>) {
    let mut clock = clock(stamps, TimeUnit::Us);
    let tick = |&stamp: &i64| clock.tick(Stamp::Whole(stamp)).unwrap();
    let ticks = stamps.iter().map(tick).collect();
    (clock, ticks)
}

#[test]
fn regular_stamps_give_the_rate_to_nine_digits() {
    let stamps: Vec<i64> = (0..1000).map(|i| 7_000_000 + 5000 * i).collect();
    let (clock, ticks) = run(&stamps);
    assert!(ticks.iter().all(|&tick| tick == Tick::Next));
    assert_eq!(clock.rate_hz().unwrap(), 200.0);
    assert_eq!(
        clock.report(),
        "time stamps 5ms apart, jitter 0s rms, 0s at most"
    );
}

#[test]
fn missing_and_repeated_rows_are_counted_and_do_not_change_the_rate() {
    let mut stamps: Vec<i64> = (0..1000).map(|i| 5000 * i).collect();
    stamps.drain(500..520);
    stamps.insert(300, stamps[299]);
    let (clock, ticks) = run(&stamps);
    assert_eq!((ticks[300], ticks[501]), (Tick::Repeated, Tick::Gap(20)));
    assert_eq!(ticks.iter().filter(|&&tick| tick != Tick::Next).count(), 2);
    assert_eq!(clock.rate_hz().unwrap(), 200.0);
    assert!(
        clock.report().ends_with(
            "; 1 gap, the longest 105ms, about 20 samples lost; \
             1 row with a repeated stamp left out"
        ),
        "{}",
        clock.report()
    );
}

#[test]
fn jitter_of_half_a_step_is_no_gap() {
    // The stamps follow a fixed sequence that deviates by up to half a step from the regular
    // one.
    let stamps: Vec<i64> = (0..2000)
        .map(|i| 5000 * i + (i * i * 7919) % 2500)
        .collect();
    let (clock, ticks) = run(&stamps);
    assert!(ticks.iter().all(|&tick| tick == Tick::Next));
    assert!((clock.rate_hz().unwrap() / 200.0 - 1.0).abs() < 1e-3);
}

#[test]
fn stamps_that_go_back_and_two_rates_are_refused() {
    let fast = |n: i64| (0..n).map(|i| 5000 * i).collect::<Vec<_>>();
    let refusal = |stamps: Vec<i64>| {
        let mut clock = clock(&stamps, TimeUnit::Us);
        let mut ticks = stamps.iter().map(|&stamp| clock.tick(Stamp::Whole(stamp)));
        ticks.find_map(Result::err).unwrap().what
    };
    let mut back = fast(500);
    back[400] = 3;
    assert_eq!(refusal(back), "time stamps go back from 1995000 to 3");
    let mut slower = fast(2000);
    slower.extend((1..1000).map(|i| 5000 * 1999 + 10_000 * i));
    assert!(refusal(slower).starts_with("two rates in one log: time stamps are 10ms apart"));
    let mut faster = fast(2000);
    faster.extend((1..2000).map(|i| 5000 * 1999 + 2500 * i));
    assert!(refusal(faster).contains("and were 5ms apart"));
}

#[test]
fn a_late_stamp_is_no_gap_and_a_lost_sample_is_one() {
    // Every twentieth stamp is 4 ms late, one of them with two more behind it, and a sample is lost.
    let mut stamps: Vec<i64> = (0..1000).map(|i| 5000 * i).collect();
    for i in (19..1000).step_by(20) {
        stamps[i] += 4000;
    }
    stamps[400] += 9000;
    stamps[401] += 4500;
    stamps.remove(705);
    let (first, _) = run(&stamps);
    assert_eq!(
        first.found_late().len(),
        51,
        "the last row too: {:?}",
        first.found_late()
    );
    let pace = Pace::of(&[0.0, 5000.0, 10_000.0, 15_000.0], TimeUnit::Us).unwrap();
    let mut clock = Clock::new(pace, &first.found_late());
    let tick = |&stamp: &i64| clock.tick(Stamp::Whole(stamp)).unwrap();
    let ticks: Vec<Tick> = stamps.iter().map(tick).collect();
    let gaps: Vec<usize> = (0..997)
        .filter(|&i| matches!(ticks[i], Tick::Gap(_)))
        .collect();
    assert_eq!(gaps, [705]);
    assert!((clock.rate_hz().unwrap() / 200.0 - 1.0).abs() < 2e-3);
    let report = clock.report();
    assert!(
        report.contains("; 51 late stamps, by 5ms at most"),
        "{report}"
    );
}

#[test]
fn a_sample_lost_before_a_late_stamp_is_one_loss() {
    let mut stamps: Vec<i64> = (0..1000).map(|i| 5000 * i).collect();
    stamps[400] += 9000;
    stamps[401] += 4500;
    stamps.remove(399);
    let (first, ticks) = run(&stamps);
    assert_eq!(ticks[399], Tick::Gap(3));
    let pace = Pace::of(&[0.0, 5000.0, 10_000.0, 15_000.0], TimeUnit::Us).unwrap();
    let mut clock = Clock::new(pace, &first.found_late());
    let tick = |&stamp: &i64| clock.tick(Stamp::Whole(stamp)).unwrap();
    let ticks: Vec<Tick> = stamps.iter().map(tick).collect();
    assert_eq!(ticks[399], Tick::Gap(1));
    assert_eq!(ticks.iter().filter(|&&tick| tick != Tick::Next).count(), 1);
    assert_eq!(clock.rate_hz().unwrap(), 200.0);
}

#[test]
fn stamps_rounded_to_a_third_of_a_step_tell_each_loss() {
    for step in [2.5_f64, 2.74, 3.1, 3.5, 4.6, 5.755] {
        let rows = (0..2000).filter(|i| i % 97 != 96);
        let stamps: Vec<i64> = rows.map(|i| (step * f64::from(i)) as i64).collect();
        let (first, ticks) = run(&stamps);
        let gaps = ticks.iter().filter(|&&tick| tick == Tick::Gap(1)).count();
        assert_eq!((gaps, first.found_late()), (20, Vec::new()), "{step}");
        let rate = first.rate_hz().unwrap() * step / 1e6;
        assert!((rate - 1.0).abs() < 1e-3, "{step}: {rate}");
    }
}

#[test]
fn rows_that_share_a_stamp_give_the_rate_of_rows() {
    let shared: Vec<i64> = (0..1000).map(|i| i / 4 * 10_000).collect();
    let (clock, ticks) = run(&shared);
    assert!(ticks.iter().all(|&tick| tick == Tick::Next));
    assert_eq!(clock.rate_hz().unwrap(), 400.0);
    let report = clock.report();
    assert!(
        report.ends_with("; about 4.0 rows share a stamp"),
        "{report}"
    );
    // A burst is lost, and another one comes later.
    let stamps: Vec<i64> = (0..1000)
        .filter(|i| i / 4 != 70)
        .map(|i| i / 4 * 10_000)
        .collect();
    let (clock, ticks) = run(&stamps);
    assert_eq!(
        ticks
            .iter()
            .filter(|tick| matches!(tick, Tick::Gap(_)))
            .count(),
        1
    );
    assert_eq!(clock.rate_hz().unwrap(), 400.0);
}

/// Records of 100 Hz from which rows are missing at random are read with few losses, and refused
/// with more, however many.
#[test]
fn missing_rows_are_refused_by_one_monotonic_rule() {
    let mut state = 7_u64;
    let mut share = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as f64 / 2f64.powi(31)
    };
    for percent in (0..=60).map(f64::from) {
        for _ in 0..10 {
            let jittered = |i: i64| 10_000 * i + (i * i * 7919) % 1000;
            let rows = (0..5000).filter(|_| share() >= 0.01 * percent);
            let stamps: Vec<i64> = rows.map(jittered).collect();
            let mut clock = clock(&stamps, TimeUnit::Us);
            let ticks = stamps.iter().map(|&stamp| clock.tick(Stamp::Whole(stamp)));
            let ticked = ticks.collect::<Result<Vec<_>, _>>();
            match ticked.and_then(|_| clock.rate_hz()) {
                Ok(rate_hz) => {
                    assert!(percent <= 22.0, "{percent} % missing gave {rate_hz} Hz");
                    assert!((rate_hz / 100.0 - 1.0).abs() < 1e-2, "{rate_hz} Hz");
                }
                Err(flaw) => assert!(percent >= 18.0, "{percent} % missing: {flaw:?}"),
            }
        }
    }
    for pattern in [3, 4, 5] {
        let rows = (0..5000).filter(|i| i % pattern != 0);
        let stamps: Vec<i64> = rows.map(|i| 10_000 * i).collect();
        let mut clock = clock(&stamps, TimeUnit::Us);
        for &stamp in &stamps {
            let _ = clock.tick(Stamp::Whole(stamp));
        }
        assert!(clock.rate_hz().is_err(), "every row {pattern} missing");
    }
}
