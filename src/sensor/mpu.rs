//! What the MPU-6050, the MPU-6500, the ICM-20602 and the ICM-20948 offer in common.

use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Filter, Interface, Signal, Status,
    Write, Writes,
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

/// What the MPU-6050 and the MPU-6500 have in common, with the numbers of the registers in both register maps: a
/// description without name, identities and temperature.
pub(super) const fn description(chosen: &Chosen) -> Description {
    Description {
        name: "",
        // Register 117, WHO_AM_I.
        identity: 0x75,
        identities: &[],
        upload: None,
        start_up: Writes::of([
            // Register 107, PWR_MGMT_1: DEVICE_RESET.
            Write::new(0x6B, 0x80).wait_us(100_000),
            // Register 104, SIGNAL_PATH_RESET: gyro, accelerometer and temperature, as SPI needs.
            Write::new(0x68, 0x07).wait_us(100_000).spi_only(),
            // Register 106, USER_CTRL: I2C_IF_DIS. This bit must stay zero in an MPU-6050, which has no SPI.
            Write::new(0x6A, 0x10).spi_only(),
            // Register 107, PWR_MGMT_1: awake, with the clock of the x gyro, or the best one available.
            Write::new(0x6B, 0x01),
            // Register 26, CONFIG: DLPF_CFG, gyro at 1 kHz. The divider after it only leaves samples out, so that at
            // 100 Hz, the filter of 42 Hz could pass noise beyond Nyquist and raise N by 20 %.
            Write::new(0x1A, chosen.low_pass.code),
            // Register 25, SMPLRT_DIV: 1 kHz / (1 + SMPLRT_DIV).
            Write::new(0x19, chosen.rate),
            // Register 27, GYRO_CONFIG: FS_SEL, and in the MPU-6500 FCHOICE_B 0 (low pass on).
            Write::new(0x1B, chosen.range << 3),
            // Register 55, INT_PIN_CFG: any read clears the flags.
            Write::new(0x37, 0x10),
            // Register 56, INT_ENABLE: data ready; the gyro settles.
            Write::new(0x38, 0x01).wait_us(100_000),
        ]),
        // The address with the AD0 pin at ground.
        interface: Interface::usual(0x68),
        // Register 58, INT_STATUS: data ready.
        status: Status {
            register: 0x3A,
            ready: 1,
            overrun: 0,
        },
        // INT is high for 50 µs, push-pull, as INT_PIN_CFG has it.
        signal: Some(Signal::Rising),
        // Registers 67 to 72: GYRO_XOUT_H.
        gyro: 0x43,
        temperature: None,
        byte_order: ByteOrder::BigEndian,
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        filter: chosen.low_pass.filter,
        fifo: None,
    }
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
