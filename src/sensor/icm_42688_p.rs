use super::{ByteOrder, Description, Filter, Interface, Status, Temperature, Write};

/// TDK InvenSense ICM-42688-P, ±250 °/s at 100 Hz in low-noise mode, behind a low pass of third order at
/// 47.6 Hz.
///
/// Source: data sheet DS-000347 (revision 1.5, 2021), by section; registers by the names they have there.
///
/// | register | value | data sheet | public drivers |
/// |---|---|---|---|
/// | DEVICE_CONFIG 0x11 | 0x01 | 14.1 | the same: Betaflight, Linux, Zephyr |
/// | INTF_CONFIG0 0x4C (SPI) | 0x33 | 14.34 | the same: Linux |
/// | DRIVE_CONFIG 0x13, INTF_CONFIG6 0x7C of bank 1 (I²C) | 0x09, 0x5C | 12.3, 14.2, 15.19 | the same: Linux |
/// | INTF_CONFIG1 0x4D | 0x51 | 14.35, where bits 7 and 6 are reserved | bits 7 and 6 the same: ArduPilot, Betaflight, PX4; Zephyr leaves them |
/// | GYRO_CONFIG0 0x4F | 0x68 | 14.37 | the same codes: Linux, Zephyr |
/// | GYRO_CONFIG1 0x51 | 0x1A | 14.39 | PX4 chooses first order; the others leave the second |
/// | GYRO_ACCEL_CONFIG0 0x52 | 0x13 | 5.5, 14.40 | Linux and PX4 choose half the rate, Betaflight low latency |
/// | FSYNC_CONFIG 0x62 | 0x00 | 14.48 | the same: Zephyr |
/// | INT_CONFIG1 0x64 | 0x00 | 12.6, 14.50 | bit 4 the same: Betaflight, Zephyr |
/// | INT_SOURCE0 0x65 | 0x08 | 14.51 | the same: Betaflight, Zephyr |
/// | PWR_MGMT0 0x4E | 0x0C, last | 12.9, 14.36 | low noise: Betaflight, PX4 |
///
/// These registers keep their reset values: the anti-alias filter (585 Hz) and the notch filter are on
/// (section 15.2), INT1 gives a pulse, open drain and active low (14.3), and the temperature has a
/// bandwidth of 4 kHz (14.39).
///
/// Not verified: the bits of register 0x4D are documented only by those who found them. The filter's
/// tables are the manufacturer's; nobody measured them here.
pub static ICM_42688_P: Description = Description {
    name: "ICM-42688-P",
    // WHO_AM_I (section 14.58).
    identity: 0x75,
    identities: &[0x47],
    start_up: &[
        // DEVICE_CONFIG (14.1): SOFT_RESET_CONFIG, done within 1 ms.
        Write::new(0x11, 0x01).wait_us(2_000),
        // INTF_CONFIG0 (14.34): UI_SIFS_CFG 0b11, no I²C; the rest as after reset, with big endian.
        Write::new(0x4C, 0x33).spi_only(),
        // DRIVE_CONFIG (14.2): I2C_SLEW_RATE 1 and SPI_SLEW_RATE 1, as section 12.3 demands for I²C.
        Write::new(0x13, 0x09).i2c_only(),
        // INTF_CONFIG6 (15.19) in bank 1: I3C_SDR_EN and I3C_DDR_EN 0, as section 12.3 demands for I²C.
        Write::new(0x76, 0x01).i2c_only(),
        Write::new(0x7C, 0x5C).i2c_only(),
        Write::new(0x76, 0x00).i2c_only(),
        // INTF_CONFIG1 (14.35): bits 7 and 6 from 0b10 to 0b01, the rest as after reset. This disables the
        // adaptive full-scale range, which repeats samples for 1 to 2 ms when the rate passes about 100 °/s.
        // The data sheet calls the bits reserved: see ArduPilot's pull request 25332 and Betaflight's 13132.
        Write::new(0x4D, 0x51),
        // GYRO_CONFIG0 (14.37): GYRO_FS_SEL 0b011 (±250 °/s), GYRO_ODR 0b1000 (100 Hz).
        Write::new(0x4F, 0x68),
        // GYRO_CONFIG1 (14.39): GYRO_UI_FILT_ORD 0b10 (third order), the rest as after reset.
        Write::new(0x51, 0x1A),
        // GYRO_ACCEL_CONFIG0 (14.40): GYRO_UI_FILT_BW 3, max(400 Hz, rate)/8. After reset it is 1, 100 Hz,
        // which is the output rate: then noise folds onto frequency zero and raises N by a third.
        Write::new(0x52, 0x13),
        // FSYNC_CONFIG (14.48): FSYNC_UI_SEL 0. After reset the flag replaces the temperature's lowest bit.
        Write::new(0x62, 0x00),
        // INT_CONFIG1 (14.50): INT_ASYNC_RESET 0, "for proper INT1 and INT2 pin operation" (12.6).
        Write::new(0x64, 0x00),
        // INT_SOURCE0 (14.51): UI_DRDY_INT1_EN, so that the data-ready flag is certain to be raised.
        Write::new(0x65, 0x08),
        // PWR_MGMT0 (14.36): GYRO_MODE 0b11 (low noise). The registers above are written while the gyro is
        // off (12.9). No write within 200 µs; the gyro settles.
        Write::new(0x4E, 0x0C).wait_us(100_000),
    ],
    interface: Interface {
        spi_read: 0x80,
        spi_dummies: 0,
        spi_wake: None,
        // The address with the AP_AD0 pin at ground (section 9.3).
        i2c_address: 0x68,
        i2c_read: 0,
    },
    // INT_STATUS (14.21): DATA_RDY_INT, bit 3. Reading it clears it, reading the sample does not.
    status: Status {
        register: 0x2D,
        ready: 1 << 3,
        overrun: 0,
    },
    // GYRO_DATA_X1 (14.13).
    gyro: 0x25,
    // TEMP_DATA1 (14.5); section 4.13: °C = TEMP_DATA / 132.48 + 25.
    temperature: Some(Temperature {
        register: 0x1D,
        at_zero_c: 25.0,
        counts_per_k: 132.48,
    }),
    // INTF_CONFIG0 (14.34): SENSOR_DATA_ENDIAN is 1 after reset.
    byte_order: ByteOrder::BigEndian,
    // Section 3.1, table 1: 131 LSB/(°/s) for ±250 °/s.
    scale_dps: 1.0 / 131.0,
    rate_hz: 100.0,
    // Section 5.5, tables of the third order at 100 Hz for GYRO_UI_FILT_BW 3: noise bandwidth 48.1 Hz, 47.6 Hz
    // at −3 dB. It runs at 400 Hz; folded noise raises N by 0.4 %.
    filter: Filter {
        noise_bandwidth_hz: 48.1,
        poles: 3,
    },
};
