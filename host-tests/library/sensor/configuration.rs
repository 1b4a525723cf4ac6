//! Configurations: what follows from them, and what is refused.

use super::chip::{KINDS, Kind};
use super::wire::{NoDelay, Wire};
use crate::common::precision::double;
use allanite::Real;
use allanite::sensor::{
    CATALOGUE, Configuration, ConfigurationError, Description, FifoImu, Flaw, LSM6DSO, Writes,
    icm_20602, icm_42688_p, icm_45686, lsm6dso, lsm6dsr, lsm6dsv16x, mpu_6050, mpu_6500,
};
use std::f64::consts::FRAC_PI_2;

fn describe(kind: Kind, wanted: Configuration) -> Result<Description, ConfigurationError> {
    match kind {
        Kind::Icm42688P => icm_42688_p(wanted),
        Kind::Icm45686 => icm_45686(wanted),
        Kind::Lsm6dso => lsm6dso(wanted),
        Kind::Lsm6dsr => lsm6dsr(wanted),
        Kind::Lsm6dsv16x => lsm6dsv16x(wanted),
    }
}

const RANGES: [u16; 9] = [15, 31, 62, 125, 250, 500, 1000, 2000, 4000];

/// Rates, ranges and low passes by hand from drivers and data sheets.
fn offered(kind: Kind) -> (&'static [u16], &'static [u16]) {
    match kind {
        Kind::Icm42688P => (&[25, 50, 100, 200, 500, 1000], &RANGES[..8]),
        Kind::Icm45686 => (&[25, 50, 100, 200, 400, 800, 1600], &RANGES),
        Kind::Lsm6dso | Kind::Lsm6dsr => (&[26, 52, 104, 208, 416], &RANGES[3..8]),
        Kind::Lsm6dsv16x => (&[30, 60, 120, 240, 480], &RANGES[3..]),
    }
}

/// All rates up to 10 kHz are tried, with all ranges.
#[test]
fn exactly_the_rates_and_ranges_on_offer_are_accepted() {
    for kind in KINDS {
        let (rates, ranges) = offered(kind);
        for rate_hz in 0..10_000 {
            for range_dps in RANGES {
                let result = describe(kind, Configuration::new(rate_hz, range_dps));
                match result {
                    Ok(description) => {
                        assert!(rates.contains(&rate_hz) && ranges.contains(&range_dps));
                        let rate = f64::from(rate_hz);
                        assert_eq!(double(description.rate_hz), rate);
                        let full = description.scale_dps * 32768.0;
                        let range = f64::from(range_dps);
                        assert!(
                            (0.998 * range..1.16 * (range + 1.0)).contains(&double(full)),
                            "{kind:?} {full}"
                        );
                        assert!(double(description.filter.noise_bandwidth_hz) < rate / 2.0);
                    }
                    Err(ConfigurationError::Rate { .. }) => assert!(!rates.contains(&rate_hz)),
                    Err(ConfigurationError::Range { .. }) => {
                        assert!(!ranges.contains(&range_dps), "{kind:?} {range_dps}");
                    }
                    Err(error) => panic!("{kind:?}: {error}"),
                }
            }
        }
    }
}

#[test]
fn a_low_pass_that_would_let_noise_fold_back_is_refused() {
    let at = |rate_hz, bandwidth_hz| {
        icm_42688_p(Configuration::new(rate_hz, 250).bandwidth_hz(bandwidth_hz))
    };
    // At 100 Hz, max(400 Hz, rate) is divided by 4, 5, 8, 10, 16, 20 and 40.
    let sensor = "ICM-42688-P";
    for (bandwidth_hz, is_wide) in [
        (100, true),
        (80, true),
        (50, false),
        (40, false),
        (25, false),
        (20, false),
        (10, false),
    ] {
        let folding = ConfigurationError::Folding {
            sensor,
            bandwidth_hz,
            rate_hz: 100,
        };
        assert_eq!(at(100, bandwidth_hz).err(), is_wide.then_some(folding));
    }
    // The widest one that is allowed is the default.
    for (rate_hz, bandwidth_hz) in [
        (25, 10),
        (50, 20),
        (100, 50),
        (200, 80),
        (500, 125),
        (1000, 250),
    ] {
        let by_default = icm_42688_p(Configuration::new(rate_hz, 250)).unwrap();
        assert_eq!(at(rate_hz, bandwidth_hz), Ok(by_default));
    }
    let error = at(100, 99).unwrap_err();
    let expected = ConfigurationError::Bandwidth {
        sensor,
        bandwidth_hz: 99,
        rate_hz: 100,
    };
    assert_eq!(error, expected);
    assert_eq!(
        error.to_string(),
        "ICM-42688-P has no low pass of 99 Hz at a rate of 100 Hz"
    );
    // ST's low pass follows the rate.
    assert!(lsm6dso(Configuration::new(104, 250).bandwidth_hz(33)).is_err());
}

#[test]
fn a_watermark_beyond_the_fifo_is_refused() {
    for kind in KINDS {
        let (rates, _) = offered(kind);
        let wanted = Configuration::new(rates[1], 250);
        assert!(describe(kind, wanted.watermark(115)).is_ok());
        for samples in [0, 241, 512, u16::MAX] {
            let error = describe(kind, wanted.watermark(samples)).unwrap_err();
            assert!(
                matches!(error, ConfigurationError::Watermark { samples: told, .. } if told == samples)
            );
        }
    }
}

/// The registers that rate, range, low pass and watermark go to, by hand.
#[test]
fn registers_follow_from_the_configuration() {
    /// Register, shift, mask and value.
    type Field = (u8, u32, u8, u8);
    let cases: [(Kind, Configuration, &[Field]); 5] = [
        (
            Kind::Icm42688P,
            Configuration::new(1000, 2000)
                .bandwidth_hz(50)
                .watermark(100),
            &[
                (0x4F, 5, 0x07, 0),
                (0x4F, 0, 0x0F, 6),
                (0x50, 0, 0x0F, 6),
                (0x52, 0, 0x0F, 6),
                // 1600 bytes.
                (0x60, 0, 0xFF, 0x40),
                (0x61, 0, 0x0F, 0x06),
            ],
        ),
        (
            Kind::Icm42688P,
            Configuration::new(500, 15),
            &[(0x4F, 5, 0x07, 7), (0x4F, 0, 0x0F, 15), (0x52, 0, 0x0F, 1)],
        ),
        (
            Kind::Icm45686,
            Configuration::new(1600, 4000)
                .bandwidth_hz(400)
                .watermark(50),
            &[
                (0x1C, 4, 0x0F, 0),
                (0x1C, 0, 0x0F, 5),
                (0x1B, 0, 0x0F, 5),
                (0x1E, 0, 0xFF, 51),
            ],
        ),
        (
            Kind::Lsm6dso,
            Configuration::new(416, 125).watermark(240),
            &[
                (0x11, 4, 0x0F, 6),
                // FS_G and FS_125.
                (0x11, 1, 0x07, 1),
                (0x09, 4, 0x0F, 6),
                (0x07, 0, 0xFF, 0xE0),
                (0x08, 0, 0x01, 1),
            ],
        ),
        (
            Kind::Lsm6dsv16x,
            Configuration::new(480, 4000).watermark(20),
            &[
                (0x11, 0, 0x0F, 8),
                (0x15, 0, 0x0F, 0xC),
                (0x09, 4, 0x0F, 8),
                (0x07, 0, 0xFF, 40),
            ],
        ),
    ];
    for (kind, wanted, fields) in cases {
        let description: &'static Description =
            Box::leak(Box::new(describe(kind, wanted).unwrap()));
        let wire = Wire::new(kind);
        FifoImu::start(wire.spi(), description, &mut NoDelay).unwrap();
        let world = wire.0.borrow();
        for &(register, shift, mask, value) in fields {
            let last = world
                .chip
                .writes
                .iter()
                .rev()
                .find(|write| write.0 == register);
            let found = last.unwrap().1 >> shift & mask;
            assert_eq!(found, value, "{kind:?} {register:#04x}");
        }
    }
}

/// Bursts of another configuration are read like those of the default one.
#[test]
fn the_sample_interval_follows_from_the_rate() {
    for kind in KINDS {
        let (rates, _) = offered(kind);
        for &rate_hz in rates {
            let fifo = describe(kind, Configuration::new(rate_hz, 250))
                .unwrap()
                .fifo
                .unwrap();
            let ps = f64::from(fifo.interval) / 256.0 * f64::from(fifo.tick_ps);
            let off = ps * 1e-12 * f64::from(rate_hz) - 1.0;
            assert!(off.abs() < 2e-3, "{kind:?} {rate_hz}: {off}");
            // The rate of the LSM6DSO is 6667 Hz divided by a power of two.
            let is_rounded = matches!(kind, Kind::Lsm6dso | Kind::Lsm6dsr);
            assert!(is_rounded || off.abs() < 1e-6, "{kind:?} {rate_hz}: {off}");
        }
    }
}

/// The MPUs and their successor, whose gyro runs at 1 kHz before the divider.
#[test]
fn the_mpus_divide_their_rate_and_keep_the_low_pass_below_it() {
    type Function = fn(Configuration) -> Result<Description, ConfigurationError>;
    let cases: [(Function, [u16; 6]); 3] = [
        (icm_20602, [176, 92, 41, 20, 10, 5]),
        (mpu_6050, [188, 98, 42, 20, 10, 5]),
        (mpu_6500, [184, 92, 41, 20, 10, 5]),
    ];
    let value = |description: &Description, register| {
        let writes = description.start_up.as_slice();
        let last = writes.iter().rfind(|write| write.register == register);
        last.unwrap().value
    };
    for (describe, bandwidths_hz) in cases {
        let mut accepted = 0;
        for rate_hz in 0..2000 {
            for (code, range_dps) in [250, 500, 1000, 2000].into_iter().enumerate() {
                let Ok(description) = describe(Configuration::new(rate_hz, range_dps)) else {
                    continue;
                };
                accepted += 1;
                let divider = u16::from(value(&description, 0x19)) + 1;
                assert_eq!(rate_hz * divider, 1000);
                assert_eq!(usize::from(value(&description, 0x1B) >> 3), code);
                let full = description.scale_dps * 32768.0;
                assert!((double(full) / f64::from(range_dps) - 1.0).abs() < 2e-3);
            }
            for (code, bandwidth_hz) in (1..).zip(bandwidths_hz) {
                let wanted = Configuration::new(rate_hz, 250);
                match describe(wanted.bandwidth_hz(bandwidth_hz)) {
                    Ok(description) => {
                        assert_eq!(value(&description, 0x1A), code);
                        assert!(2.0 * FRAC_PI_2 * f64::from(bandwidth_hz) < f64::from(rate_hz));
                        // Without a wish, the widest one that is below a ninth of the rate.
                        let is_tight = rate_hz >= 9 * bandwidth_hz;
                        let by_default = describe(wanted).map(|it| value(&it, 0x1A));
                        assert!(!is_tight || by_default.unwrap() <= code);
                    }
                    Err(ConfigurationError::Folding { .. }) => {
                        assert!(2.0 * FRAC_PI_2 * f64::from(bandwidth_hz) > f64::from(rate_hz));
                    }
                    Err(error) => assert!(matches!(error, ConfigurationError::Rate { .. })),
                }
            }
        }
        // 25 and 40 Hz have no low pass below a ninth, so that one has to be asked for.
        assert_eq!(accepted, 7 * 4);
        let asked = describe(Configuration::new(25, 250).bandwidth_hz(5)).unwrap();
        assert_eq!(asked.filter.poles, 1);
    }
}

/// Each change of one field is found, and named by it.
#[test]
fn a_description_that_cannot_be_right_is_found() {
    type Change = fn(&mut Description);
    for description in CATALOGUE {
        assert_eq!(description.check(), Ok(()), "{}", description.name);
    }
    let changes: [(Flaw, Change); 16] = [
        (Flaw::Identity, |it| it.identities = &[]),
        (Flaw::Identity, |it| it.identities = &[0x47, 0xFF]),
        (Flaw::StartUp, |it| it.start_up = Writes::NONE),
        (Flaw::Interface, |it| it.interface.i2c_address = 0xD0),
        (Flaw::Interface, |it| it.interface.spi_dummies = 4),
        (Flaw::Status, |it| it.status.ready = 0),
        (Flaw::Block, |it| it.gyro = 0xFC),
        (Flaw::Block, |it| it.gyro = 0x70),
        (Flaw::Temperature, |it| {
            it.temperature.as_mut().unwrap().counts_per_k = 0.0;
        }),
        (Flaw::Scale, |it| it.scale_dps = 0.0),
        (Flaw::Scale, |it| it.scale_dps = Real::NAN),
        (Flaw::Rate, |it| it.rate_hz = Real::INFINITY),
        (Flaw::Filter, |it| it.filter.noise_bandwidth_hz = -1.0),
        (Flaw::Filter, |it| it.filter.poles = 0),
        (Flaw::Fifo, |it| it.fifo.as_mut().unwrap().capacity = 0),
        (Flaw::Fifo, |it| it.fifo.as_mut().unwrap().interval = 0),
    ];
    for (flaw, change) in changes {
        let mut description = LSM6DSO;
        change(&mut description);
        assert_eq!(description.check(), Err(flaw));
    }
}
