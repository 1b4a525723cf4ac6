use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Interface, Signal, Status,
    Temperature, Write, Writes, configuration::checked, mpu,
};
use crate::numerics::real::Real;

/// The description of an MPU-6050 with another configuration than that of [`MPU_6050`], whose documentation lists the
/// registers. The FIFO is not used, so that the watermark is of no consequence.
///
/// * Rates: 25, 40, 50, 100, 125, 200, 250, 500 and 1000 Hz.
/// * Ranges: 250, 500, 1000 and 2000 °/s.
/// * Low passes: 188, 98, 42, 20, 10 and 5 Hz. Those above a ninth of the rate have to be asked for, because
///   a filter of first order there would let folded noise raise N by 2 % or more.
///
/// # Errors
/// [`ConfigurationError`] for all else, and for a low pass whose noise would fold back.
pub const fn mpu_6050(wanted: Configuration) -> Result<Description, ConfigurationError> {
    // Register 26, DLPF_CFG 1 to 6.
    let chosen = match mpu::choose("MPU-6050", [188, 98, 42, 20, 10, 5], wanted) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    Ok(Description {
        name: "MPU-6050",
        // Register 117, WHO_AM_I.
        identity: 0x75,
        identities: &[0x68],
        upload: None,
        start_up: Writes::of([
            // Register 107, PWR_MGMT_1: DEVICE_RESET.
            Write::new(0x6B, 0x80).wait_us(100_000),
            // Register 104, SIGNAL_PATH_RESET: gyro, accelerometer and temperature, as SPI needs.
            Write::new(0x68, 0x07).wait_us(100_000).spi_only(),
            // Register 106, USER_CTRL: I2C_IF_DIS. This bit must stay zero in an MPU-6050.
            Write::new(0x6A, 0x10).spi_only(),
            // Register 107, PWR_MGMT_1: awake, with the clock of the x gyro.
            Write::new(0x6B, 0x01),
            // Register 26, CONFIG: DLPF_CFG, gyro at 1 kHz. The divider after it only leaves samples out, so that at
            // 100 Hz, the filter of 42 Hz could pass noise beyond Nyquist and raise N by 20 %.
            Write::new(0x1A, chosen.low_pass.code),
            // Register 25, SMPLRT_DIV: 1 kHz / (1 + SMPLRT_DIV).
            Write::new(0x19, chosen.rate),
            // Register 27, GYRO_CONFIG: FS_SEL.
            Write::new(0x1B, chosen.range << 3),
            // Register 55, INT_PIN_CFG: INT_RD_CLEAR, any read clears the flags.
            Write::new(0x37, 0x10),
            // Register 56, INT_ENABLE: DATA_RDY_EN; the gyro settles.
            Write::new(0x38, 0x01).wait_us(100_000),
        ]),
        interface: Interface {
            spi_read: 0x80,
            spi_dummies: 0,
            spi_wake: None,
            // The address with the AD0 pin at ground.
            i2c_address: 0x68,
            i2c_read: 0,
        },
        // Register 58, INT_STATUS: DATA_RDY_INT.
        status: Status {
            register: 0x3A,
            ready: 1,
            overrun: 0,
        },
        // INT is high for 50 µs, push-pull, as INT_PIN_CFG has it.
        signal: Some(Signal::Rising),
        // Section 4.19, registers 67 to 72: GYRO_XOUT_H.
        gyro: 0x43,
        // Section 4.18, registers 65 and 66, TEMP_OUT: °C = TEMP_OUT / 340 + 36.53.
        temperature: Some(Temperature {
            register: 0x41,
            at_zero_c: 36.53,
            counts_per_k: 340.0,
        }),
        byte_order: ByteOrder::BigEndian,
        // Section 4.19, page 31: 131 LSB/°/s for FS_SEL 0, and half as many for each further code.
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        filter: chosen.low_pass.filter,
        fifo: None,
    })
}

/// InvenSense MPU-6050, and MPU-6000, which is the same with SPI: ±250 °/s at 200 Hz behind a low
/// pass of 20 Hz.
///
/// Source: register map RM-MPU-6000A-00 (revision 4.2, 2013), chapter 4, by register number.
///
/// | register | value | register map | public drivers |
/// |---|---|---|---|
/// | PWR_MGMT_1 0x6B | 0x80, then 0x01 | 4.28 | the same: Linux; Betaflight takes the clock of the z gyro |
/// | SIGNAL_PATH_RESET 0x68 (SPI) | 0x07 | 4.26 | the same: Betaflight |
/// | USER_CTRL 0x6A (SPI) | 0x10 | 4.27 | the same: Betaflight |
/// | CONFIG 0x1A | 0x04 | 4.3 | the same: Linux |
/// | SMPLRT_DIV 0x19 | 0x04 | 4.2 | the same codes: Betaflight, Linux |
/// | GYRO_CONFIG 0x1B | 0x00 | 4.4 | the same codes: Betaflight, Linux |
/// | INT_PIN_CFG 0x37 | 0x10 | 4.14 | the same: Betaflight |
/// | INT_ENABLE 0x38 | 0x01 | 4.15 | the same: Betaflight |
///
/// The reset clears all other registers; PWR_MGMT_2 (4.29) then leaves every gyro on.
///
/// Not verified: the register map gives the bandwidth of the low pass, not its order. The largest noise
/// bandwidth, that of a first order, is stated. Then folded noise raises N by at most 1.6 %.
pub static MPU_6050: Description = checked(mpu_6050(Configuration::new(200, 250)));
