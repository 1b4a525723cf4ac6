use super::{ByteOrder, Description, Interface, Status, Temperature, Write};

/// ST LSM6DSO, ±250 °/s at 104 Hz in high-performance mode.
///
/// Source: data sheet DS12140 (revision 2), chapter 8 "Register mapping" and chapter 9 "Register
/// description"; registers by the names they have there.
pub static LSM6DSO: Description = Description {
    name: "LSM6DSO",
    // WHO_AM_I.
    identity: 0x0F,
    identities: &[0x6C],
    start_up: &[
        // CTRL3_C: SW_RESET, which takes well below a millisecond.
        Write::new(0x12, 0x01).wait_us(10_000),
        // CTRL3_C: BDU (a sample does not change while it is read), IF_INC (addresses ascend).
        Write::new(0x12, 0x44),
        // CTRL2_G: ODR_G 0b0100 (104 Hz), FS_G 0b00 (±250 °/s); the gyro settles.
        Write::new(0x11, 0x40).wait_us(100_000),
    ],
    interface: Interface {
        spi_read: 0x80,
        spi_dummies: 0,
        spi_wake: None,
        // The address with the SDO/SA0 pin at ground.
        i2c_address: 0x6A,
        i2c_read: 0,
    },
    // STATUS_REG: GDA, bit 1, is reset when a high byte is read.
    status: Status {
        register: 0x1E,
        ready: 1 << 1,
        overrun: 0,
    },
    // OUTX_L_G.
    gyro: 0x22,
    // OUT_TEMP_L; table "Temperature sensor characteristics": a count of 0 is 25 °C, 256 LSB/°C.
    temperature: Some(Temperature {
        register: 0x20,
        at_zero_c: 25.0,
        counts_per_k: 256.0,
    }),
    byte_order: ByteOrder::LittleEndian,
    // Table "Mechanical characteristics": 8.75 mdps/LSB at FS = ±250 dps.
    scale_dps: 8.75e-3,
    rate_hz: 104.0,
};
