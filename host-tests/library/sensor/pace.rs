//! Timestamps reveal skipped samples, and a rate that differs from the configured one.

use super::sheet::{Sheet, start};
use crate::common::precision::double;
use allanite::sensor::{ICM_42688_P, Loss, Pace};
use allanite::{Axes, Error, Real};

/// The number of samples before there is a verdict. It is one more than the number of intervals.
const WINDOW: u32 = 257;

/// The timestamps of samples at `rate_hz`, with jitter. The counter is about to wrap.
fn stamps(rate_hz: f64, number: u32) -> impl Iterator<Item = u32> {
    (0..number).map(move |n| {
        let jitter_us = n.wrapping_mul(2_654_435_761) >> 21;
        let elapsed_us = (f64::from(n) * 1e6 / rate_hz) as u32 + jitter_us;
        (u32::MAX - 700_000).wrapping_add(elapsed_us)
    })
}

#[test]
fn a_rate_within_the_tolerance_is_accepted() {
    for rate_hz in [95.5, 97.0, 100.0, 104.0, 104.5] {
        let mut pace = Pace::new(100.0).unwrap();
        for stamp in stamps(rate_hz, WINDOW) {
            assert_eq!(pace.stamp(stamp), 1, "{rate_hz} Hz");
        }
        let measured_hz = pace.measured_hz().unwrap();
        assert!(
            (double(measured_hz) / rate_hz - 1.0).abs() < 1e-3,
            "{measured_hz} Hz"
        );
        assert_eq!(pace.check(), Ok(()), "{rate_hz} Hz");
    }
}

#[test]
fn a_rate_beyond_the_tolerance_is_an_error_with_both_rates() {
    for rate_hz in [10.0, 50.0, 94.5, 105.5, 200.0, 1000.0] {
        let mut pace = Pace::new(100.0).unwrap();
        for stamp in stamps(rate_hz, WINDOW) {
            assert_eq!(pace.check(), Ok(()), "too early to tell");
            pace.stamp(stamp);
        }
        let error = pace.check().unwrap_err();
        let Error::RateContradicted {
            configured_hz,
            measured_hz,
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!(configured_hz, 100.0);
        assert!(
            (double(measured_hz) / rate_hz - 1.0).abs() < 0.01,
            "{measured_hz} for {rate_hz} Hz"
        );
        assert!(
            error.to_string().contains("100.00 Hz are configured"),
            "{error}"
        );
    }
}

#[test]
fn the_tolerance_can_be_chosen() {
    let verdict = |tolerance| {
        let mut pace = Pace::new(100.0).unwrap().with_tolerance(tolerance);
        stamps(98.0, WINDOW).for_each(|stamp| _ = pace.stamp(stamp));
        pace.check()
    };
    assert!(verdict(1).is_err());
    assert_eq!(verdict(3), Ok(()));
}

#[test]
fn a_change_of_rate_is_detected_one_window_later() {
    let mut pace = Pace::new(100.0).unwrap();
    let good: Vec<u32> = stamps(100.0, WINDOW).collect();
    for &stamp in &good {
        pace.stamp(stamp);
    }
    assert_eq!(pace.check(), Ok(()));
    let last = *good.last().unwrap();
    for n in 1..WINDOW {
        assert_eq!(pace.stamp(last.wrapping_add(n * 8_000)), 1);
    }
    assert!(pace.check().is_err());
}

#[test]
fn a_pause_is_neither_a_loss_nor_part_of_the_rate() {
    let mut pace = Pace::new(100.0).unwrap();
    for n in 0..100 {
        pace.stamp(n * 10_000);
    }
    pace.restart();
    for n in 0..WINDOW {
        assert_eq!(pace.stamp(60_000_000 + n * 10_000), 1);
    }
    assert_eq!(pace.measured_hz(), Some(100.0));
}

#[test]
fn a_clock_that_stands_still_is_reported() {
    let mut pace = Pace::new(100.0).unwrap();
    assert_eq!(pace.stamp(5), 1);
    for _ in 1..WINDOW {
        assert_eq!(pace.stamp(5), 0);
    }
    assert!(pace.check().is_err());
}

#[test]
fn impossible_rates_are_refused() {
    for rate_hz in [0.0, -100.0, 1e10, 1e-12, Real::INFINITY, Real::NAN] {
        let error = Pace::new(rate_hz).unwrap_err();
        assert!(matches!(error, Error::InvalidRate(_)), "{error}");
    }
}

/// Most sensors do not report that a sample was overwritten. The timestamps reveal it.
#[test]
fn samples_that_were_read_too_late_become_a_gap() {
    let sheet = Sheet::of(&ICM_42688_P);
    let late = |n: u32| if n < 20 { n } else { n + 2 };
    let turns = (0..40).flat_map(|n| sheet.i2c_sample(sheet.ready, [late(n) as i16; 3]));
    let (mut imu, mut mock) = start(sheet, turns);
    let mut pace = Pace::new(imu.description().rate_hz).unwrap();
    let mut axes = Axes::<8, 0, (), ()>::new();
    for n in 0..40 {
        let mut outcome = imu.read();
        if let Ok(Some(reading)) = &mut outcome {
            reading.loss = Loss::of_intervals(pace.stamp(late(n) * 10_000));
        }
        axes.record_outcome(&outcome, |_| []);
    }
    mock.done();
    let [x, _, _] = axes.accumulators();
    assert_eq!((axes.losses(), x.gaps(), x.samples()), (1, 1, 40));
    // The counts are a ramp of one count per sample on both sides of the gap.
    assert_eq!(x.octave(0).unwrap().differences, 38);
    assert_eq!(x.octave(0).unwrap().sum, {
        let mut ramp = allanite::Accumulator::<8>::new();
        (0..39).for_each(|n| ramp.push(n));
        ramp.octave(0).unwrap().sum
    });
}
