//! What the MPU-6050, the MPU-6500, the ICM-20602 and the ICM-20948 offer in common.

use super::{
    Configuration, ConfigurationError, Filter,
    configuration::{Chosen, LowPass, Offer},
};
use crate::numerics::real::{Real, consts::FRAC_PI_2};

/// Folded noise raises N by less than 2 % if the cut-off of a first order is below this fraction of the rate.
const TIGHT: u16 = 9;

/// The ranges, with their codes.
pub(super) const RANGES: [(u16, u8, Real); 4] = [
    (250, 0, 1.0 / 131.0),
    (500, 1, 1.0 / 65.5),
    (1000, 2, 1.0 / 32.8),
    (2000, 3, 1.0 / 16.4),
];

/// Looks a configuration up. `bandwidths_hz` are those of `DLPF_CFG` 1 to 6. The rate is 1 kHz divided by 1 plus the
/// code, because the gyro runs at 1 kHz behind these filters.
pub(super) const fn choose(
    sensor: &'static str,
    bandwidths_hz: [u16; 6],
    wanted: Configuration,
) -> Result<Chosen, ConfigurationError> {
    let offer = Offer {
        sensor,
        rates: [
            (25, 39),
            (40, 24),
            (50, 19),
            (100, 9),
            (125, 7),
            (200, 4),
            (250, 3),
            (500, 1),
            (1000, 0),
        ],
        ranges: RANGES,
        // The FIFO is not used.
        most: u16::MAX,
    };
    let rate_hz = wanted.rate_hz();
    let [a, b, c, d, e, f] = bandwidths_hz;
    let low_passes = [
        low_pass(1, a, rate_hz),
        low_pass(2, b, rate_hz),
        low_pass(3, c, rate_hz),
        low_pass(4, d, rate_hz),
        low_pass(5, e, rate_hz),
        low_pass(6, f, rate_hz),
    ];
    offer.choose(wanted, &low_passes)
}

/// The largest noise bandwidth, that of a first order.
pub(super) const fn low_pass(code: u8, bandwidth_hz: u16, rate_hz: u16) -> LowPass {
    LowPass {
        code,
        bandwidth_hz,
        filter: Filter {
            noise_bandwidth_hz: FRAC_PI_2 * bandwidth_hz as Real,
            poles: 1,
        },
        is_tight: rate_hz / TIGHT >= bandwidth_hz,
    }
}
