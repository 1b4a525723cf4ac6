use super::{
    Configuration, ConfigurationError, Description, Temperature, configuration::checked, mpu,
};

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
        // Section 4.18, registers 65 and 66, TEMP_OUT: °C = TEMP_OUT / 340 + 36.53.
        temperature: Some(Temperature {
            register: 0x41,
            at_zero_c: 36.53,
            counts_per_k: 340.0,
        }),
        // The registers of the counts are in section 4.19; page 31: 131 LSB/°/s for FS_SEL 0, and half as many for each
        // further code.
        ..mpu::description(&chosen)
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
