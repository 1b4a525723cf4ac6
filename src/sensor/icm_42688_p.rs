use super::{ByteOrder, Description, Interface, Status, Temperature, Write};

/// TDK InvenSense ICM-42688-P, ±250 °/s at 100 Hz in low-noise mode.
///
/// Source: data sheet DS-000347 (revision 1.7), chapters "User bank 0 register map" and its
/// descriptions; registers by the names they have there.
pub static ICM_42688_P: Description = Description {
    name: "ICM-42688-P",
    // WHO_AM_I.
    identity: 0x75,
    identities: &[0x47],
    start_up: &[
        // DEVICE_CONFIG: SOFT_RESET_CONFIG, done within 1 ms.
        Write::new(0x11, 0x01).wait_us(2_000),
        // GYRO_CONFIG0: GYRO_FS_SEL 0b011 (±250 °/s), GYRO_ODR 0b1000 (100 Hz).
        Write::new(0x4F, 0x68),
        // INT_SOURCE0: UI_DRDY_INT1_EN, so that the data-ready flag is certain to be raised.
        Write::new(0x65, 0x08),
        // PWR_MGMT0: GYRO_MODE 0b11 (low noise). No write within 200 µs; the gyro settles.
        Write::new(0x4E, 0x0C).wait_us(100_000),
    ],
    interface: Interface {
        spi_read: 0x80,
        spi_dummies: 0,
        spi_wake: None,
        // The address with the AP_AD0 pin at ground.
        i2c_address: 0x68,
        i2c_read: 0,
    },
    // INT_STATUS: DATA_RDY_INT, bit 3. Reading it clears it, reading the sample does not.
    status: Status {
        register: 0x2D,
        ready: 1 << 3,
        overrun: 0,
    },
    // GYRO_DATA_X1.
    gyro: 0x25,
    // TEMP_DATA1; section 4.13: °C = TEMP_DATA / 132.48 + 25.
    temperature: Some(Temperature {
        register: 0x1D,
        at_zero_c: 25.0,
        counts_per_k: 132.48,
    }),
    // INTF_CONFIG0: SENSOR_DATA_ENDIAN is 1 after reset.
    byte_order: ByteOrder::BigEndian,
    // Table 1, gyroscope specifications: 131 LSB/(°/s) for ±250 °/s.
    scale_dps: 1.0 / 131.0,
    rate_hz: 100.0,
};
