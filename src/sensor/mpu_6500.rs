use super::{
    Configuration, ConfigurationError, Description, Temperature, configuration::checked, mpu,
};

/// The description of an MPU-6500 with another configuration than that of [`MPU_6500`], whose documentation lists the
/// registers. The FIFO is not used, so that the watermark is of no consequence.
///
/// * Rates: 25, 40, 50, 100, 125, 200, 250, 500 and 1000 Hz.
/// * Ranges: 250, 500, 1000 and 2000 °/s.
/// * Low passes: 184, 92, 41, 20, 10 and 5 Hz. Those above a ninth of the rate have to be asked for, because
///   a filter of first order there would let folded noise raise N by 2 % or more.
///
/// # Errors
/// [`ConfigurationError`] for all else, and for a low pass whose noise would fold back.
pub const fn mpu_6500(wanted: Configuration) -> Result<Description, ConfigurationError> {
    // Register 26, DLPF_CFG 1 to 6.
    let chosen = match mpu::choose("MPU-6500", [184, 92, 41, 20, 10, 5], wanted) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    Ok(Description {
        name: "MPU-6500",
        // Register 117, WHO_AM_I; 0x71 is the MPU-9250's (RM-MPU-9250A-00).
        identity: 0x75,
        identities: &[0x70, 0x71],
        // Registers 65 and 66, TEMP_OUT, and the product specification's sensitivity: zero at 21 °C,
        // 333.87 LSB/°C.
        temperature: Some(Temperature {
            register: 0x41,
            at_zero_c: 21.0,
            counts_per_k: 333.87,
        }),
        // Product specification, table "Gyroscope specifications": 131 LSB/(°/s) for FS_SEL 0, and half as
        // many for each further code.
        ..mpu::description(&chosen)
    })
}

/// InvenSense MPU-6500, and MPU-9250, whose gyro has the same registers: ±250 °/s at 200 Hz behind
/// a low pass of 20 Hz.
///
/// Source: register map RM-MPU-6500A-00 (revision 2.1, 2013), chapter 4, by register number;
/// product specification PS-MPU-6500A-01 (revision 1.1, 2014). The sections are those of the MPU-9250's
/// register map RM-MPU-9250A-00 (revision 1.4, 2013).
///
/// | register | value | MPU-9250 | public drivers |
/// |---|---|---|---|
/// | PWR_MGMT_1 0x6B | 0x80, then 0x01 | 4.34 | the same: Betaflight, Linux |
/// | SIGNAL_PATH_RESET 0x68 (SPI) | 0x07 | 4.31 | the same: Betaflight |
/// | USER_CTRL 0x6A (SPI) | 0x10 | 4.33 | the same: Betaflight |
/// | CONFIG 0x1A | 0x04 | 4.5 | the same: Linux |
/// | SMPLRT_DIV 0x19 | 0x04 | 4.4 | the same codes: Betaflight, Linux |
/// | GYRO_CONFIG 0x1B | 0x00 | 4.6 | the same codes: Betaflight, Linux |
/// | INT_PIN_CFG 0x37 | 0x10 | 4.19 | the same: Betaflight |
/// | INT_ENABLE 0x38 | 0x01 | 4.20 | the same: Betaflight |
///
/// The reset clears all other registers; PWR_MGMT_2 then leaves every gyro on.
///
/// Not verified: only the documents of the MPU-9250 were at hand. Its register map gives the bandwidth and
/// the delay of the low pass, not its order: the six delays are those of a first order, 1/(2π·bandwidth),
/// and 1.7 to 2.2 ms. With a first order, folded noise raises N by at most 1.6 %.
pub static MPU_6500: Description = checked(mpu_6500(Configuration::new(200, 250)));
