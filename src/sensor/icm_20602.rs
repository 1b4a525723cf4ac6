use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Interface, Signal, Status,
    Temperature, Write, Writes, configuration::checked, mpu,
};
use crate::numerics::real::Real;

/// The description of an ICM-20602 with another configuration than that of [`ICM_20602`], whose documentation lists the
/// registers. The FIFO is not used, so that the watermark is of no consequence.
///
/// * Rates: 25, 40, 50, 100, 125, 200, 250, 500 and 1000 Hz.
/// * Ranges: 250, 500, 1000 and 2000 °/s.
/// * Low passes: 176, 92, 41, 20, 10 and 5 Hz. Those above a ninth of the rate have to be asked for, because
///   a filter of first order there would let folded noise raise N by 2 % or more.
///
/// # Errors
/// [`ConfigurationError`] for all else, and for a low pass whose noise would fold back.
pub const fn icm_20602(wanted: Configuration) -> Result<Description, ConfigurationError> {
    // DLPF_CFG 1 to 6.
    let chosen = match mpu::choose("ICM-20602", [176, 92, 41, 20, 10, 5], wanted) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    Ok(Description {
        name: "ICM-20602",
        // WHO_AM_I.
        identity: 0x75,
        identities: &[0x12],
        upload: None,
        start_up: Writes::of([
            // PWR_MGMT_1: DEVICE_RESET.
            Write::new(0x6B, 0x80).wait_us(100_000),
            // I2C_IF: I2C_IF_DIS, which the MPU-6500 has in USER_CTRL.
            Write::new(0x70, 0x40).spi_only(),
            // PWR_MGMT_1: awake, with CLKSEL 1, as the gyro's full performance demands.
            Write::new(0x6B, 0x01).wait_us(30_000),
            // CONFIG: DLPF_CFG, gyro at 1 kHz.
            Write::new(0x1A, chosen.low_pass.code),
            // SMPLRT_DIV: 1 kHz / (1 + SMPLRT_DIV).
            Write::new(0x19, chosen.rate),
            // GYRO_CONFIG: FS_SEL, FCHOICE_B 0 (low pass on).
            Write::new(0x1B, chosen.range << 3),
            // INT_PIN_CFG: INT_RD_CLEAR, any read clears the flags.
            Write::new(0x37, 0x10),
            // INT_ENABLE: DATA_RDY_INT_EN; the gyro settles.
            Write::new(0x38, 0x01).wait_us(100_000),
        ]),
        // The address with the SA0 pin at ground.
        interface: Interface::usual(0x68),
        // INT_STATUS: DATA_RDY_INT.
        status: Status {
            register: 0x3A,
            ready: 1,
            overrun: 0,
        },
        // INT is high for 50 µs, push-pull, as INT_PIN_CFG has it.
        signal: Some(Signal::Rising),
        // GYRO_XOUT_H.
        gyro: 0x43,
        // TEMP_OUT_H: zero at 25 °C, 326.8 LSB/°C.
        temperature: Some(Temperature {
            register: 0x41,
            at_zero_c: 25.0,
            counts_per_k: 326.8,
        }),
        byte_order: ByteOrder::BigEndian,
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        filter: chosen.low_pass.filter,
        fifo: None,
    })
}

/// TDK InvenSense ICM-20602, ±250 °/s at 200 Hz behind a low pass of 20 Hz.
///
/// | register | value | public drivers |
/// |---|---|---|
/// | WHO_AM_I 0x75 | 0x12 | the same: Betaflight, Linux, PX4 |
/// | PWR_MGMT_1 0x6B | 0x80, then 0x01 | the same: Betaflight, PX4 |
/// | I2C_IF 0x70 (SPI) | 0x40 | the same: Linux, PX4; Betaflight sets the bit of the MPU-6500 |
/// | CONFIG 0x1A | 0x04 | the same codes: Betaflight, Linux |
/// | SMPLRT_DIV 0x19 | 0x04 | the same codes: Betaflight, Linux |
/// | GYRO_CONFIG 0x1B | 0x00 | the same codes: Betaflight, PX4 |
/// | INT_PIN_CFG 0x37 | 0x10 | the same: Betaflight; the same bit: PX4 |
/// | INT_ENABLE 0x38 | 0x01 | the same: Betaflight; the same bit: PX4 |
///
/// TEMP_OUT has 326.8 counts per °C and is zero at 25 °C in Linux and in PX4. The reset clears all other registers.
///
/// Not verified: the data sheet was not at hand. One public driver, that of a hobbyist, and those of the siblings ICM-20608-G
/// and IAM-20380 name the cut-offs of the low pass; none names its order. The largest noise bandwidth, that of a first
/// order, is stated. Then folded noise raises N by at most 1.6 %. The FIFO holds no time, from which
/// lost samples could be counted.
pub static ICM_20602: Description = checked(icm_20602(Configuration::new(200, 250)));
