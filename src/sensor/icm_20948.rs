use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Interface, Signal, Status,
    Temperature, Write, Writes,
    configuration::{Offer, checked},
    mpu::{RANGES, low_pass},
};
use crate::numerics::real::Real;

/// REG_BANK_SEL, which every bank has, and its values for the banks that are written.
const REG_BANK_SEL: u8 = 0x7F;
const BANK_0: u8 = 0x00;
const BANK_2: u8 = 0x20;

/// The description of an ICM-20948 with another configuration than that of [`ICM_20948`], whose documentation lists the
/// registers. The FIFO is not used, so that the watermark is of no consequence.
///
/// * Rates: 45, 75, 125, 225, 375 and 1125 Hz.
/// * Ranges: 250, 500, 1000 and 2000 °/s.
/// * Low passes: 120, 52, 24, 12 and 6 Hz. Those above a ninth of the rate have to be asked for, because a filter of first
///   order there would let folded noise raise N by 2 % or more.
///
/// # Errors
/// [`ConfigurationError`] for all else, and for a low pass whose noise would fold back.
pub const fn icm_20948(wanted: Configuration) -> Result<Description, ConfigurationError> {
    let rate_hz = wanted.rate_hz();
    let offer = Offer {
        sensor: "ICM-20948",
        // The gyro runs at 1125 Hz behind these filters, and the rate is that divided by 1 plus the code.
        rates: [(45, 24), (75, 14), (125, 8), (225, 4), (375, 2), (1125, 0)],
        ranges: RANGES,
        most: u16::MAX,
    };
    // GYRO_DLPFCFG 2 to 6: 119.5, 51.2, 23.9, 11.6 and 5.7 Hz, rounded up.
    let low_passes = [
        low_pass(2, 120, rate_hz),
        low_pass(3, 52, rate_hz),
        low_pass(4, 24, rate_hz),
        low_pass(5, 12, rate_hz),
        low_pass(6, 6, rate_hz),
    ];
    let chosen = match offer.choose(wanted, &low_passes) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    Ok(Description {
        name: "ICM-20948",
        // WHO_AM_I of bank 0.
        identity: 0x00,
        identities: &[0xEA],
        upload: None,
        start_up: Writes::of([
            // PWR_MGMT_1: DEVICE_RESET.
            Write::new(0x06, 0x80).wait_us(100_000),
            // USER_CTRL: I2C_IF_DIS.
            Write::new(0x03, 0x10).spi_only(),
            // PWR_MGMT_1: awake, with the best clock available.
            Write::new(0x06, 0x01).wait_us(30_000),
            Write::new(REG_BANK_SEL, BANK_2),
            // GYRO_SMPLRT_DIV: 1125 Hz / (1 + GYRO_SMPLRT_DIV).
            Write::new(0x00, chosen.rate),
            // GYRO_CONFIG_1: GYRO_DLPFCFG, GYRO_FS_SEL, GYRO_FCHOICE (low pass on).
            Write::new(0x01, chosen.low_pass.code << 3 | chosen.range << 1 | 1),
            Write::new(REG_BANK_SEL, BANK_0),
            // INT_PIN_CFG: INT_ANYRD_2CLEAR, any read clears the flags.
            Write::new(0x0F, 0x10),
            // INT_ENABLE_1: RAW_DATA_0_RDY_EN; the gyro settles.
            Write::new(0x11, 0x01).wait_us(100_000),
        ]),
        // The address with the AD0 pin at ground.
        interface: Interface::usual(0x68),
        // INT_STATUS_1: RAW_DATA_0_RDY_INT.
        status: Status {
            register: 0x1A,
            ready: 1,
            overrun: 0,
        },
        // INT1 is high for 50 µs, push-pull, as INT_PIN_CFG has it.
        signal: Some(Signal::Rising),
        // GYRO_XOUT_H.
        gyro: 0x33,
        // TEMP_OUT_H: zero at 21 °C, 333.87 LSB/°C.
        temperature: Some(Temperature {
            register: 0x39,
            at_zero_c: 21.0,
            counts_per_k: 333.87,
        }),
        byte_order: ByteOrder::BigEndian,
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        filter: chosen.low_pass.filter,
        fifo: None,
    })
}

/// TDK InvenSense ICM-20948, ±250 °/s at 225 Hz behind a low pass of 23.9 Hz.
///
/// Its registers lie in banks; the start-up writes choose bank 2 for the gyro, and leave bank 0, which has the samples.
///
/// | register | bank | value | public drivers |
/// |---|---|---|---|
/// | WHO_AM_I 0x00 | 0 | 0xEA | the same: PX4, SparkFun |
/// | PWR_MGMT_1 0x06 | 0 | 0x80, then 0x01 | the same bits: PX4, SparkFun |
/// | USER_CTRL 0x03 (SPI) | 0 | 0x10 | the same bit: PX4, SparkFun |
/// | REG_BANK_SEL 0x7F | all | 0x20, then 0x00 | the same: PX4, SparkFun |
/// | GYRO_SMPLRT_DIV 0x00 | 2 | 0x04 | the same: SparkFun |
/// | GYRO_CONFIG_1 0x01 | 2 | 0x21 | the same codes: SparkFun |
/// | INT_PIN_CFG 0x0F | 0 | 0x10 | the same bit: SparkFun |
/// | INT_ENABLE_1 0x11 | 0 | 0x01 | the same bit: PX4, SparkFun |
///
/// SparkFun's names of the filters give cut-offs and noise bandwidths: 23.9 and 35.9 Hz for GYRO_DLPFCFG 4, whose ratio is
/// nearly that of a first order, 1.571. The larger bandwidth of a first order is stated.
///
/// Not verified: the data sheet was not at hand. The 4 KiB of the FIFO hold no time, from which lost samples could be counted.
pub static ICM_20948: Description = checked(icm_20948(Configuration::new(225, 250)));
