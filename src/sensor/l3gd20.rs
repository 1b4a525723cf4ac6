use super::{ByteOrder, Description, Interface, Status, Write};

/// ST L3GD20, a gyro without accelerometer, ±250 °/s at 95 Hz, filters off. It reports overwritten samples.
///
/// Source: data sheet DocID022116 (revision 2, 2013), chapters "Register mapping" and "Register
/// description"; registers by the names they have there.
pub static L3GD20: Description = Description {
    name: "L3GD20",
    // WHO_AM_I.
    identity: 0x0F,
    identities: &[0xD4],
    start_up: &[
        // CTRL_REG2, CTRL_REG5: no high-pass, no FIFO; only a power cycle clears either register.
        Write::new(0x21, 0x00),
        Write::new(0x24, 0x00),
        // CTRL_REG4: BDU (a sample does not change while it is read), BLE 0, FS 0b00 (±250 °/s).
        Write::new(0x23, 0x80),
        // CTRL_REG1: DR 0b00 (95 Hz), BW 0b00, PD and all axes on; the gyro settles.
        Write::new(0x20, 0x0F).wait_us(300_000),
    ],
    interface: Interface {
        // "SPI bus interface": bit 0 (RW), and bit 1 (M/S), which makes addresses ascend.
        spi_read: 0xC0,
        spi_dummies: 0,
        spi_wake: None,
        // The address with the SDO pin at ground.
        i2c_address: 0x6A,
        // "I²C operation": the highest bit of the sub-address makes addresses ascend.
        i2c_read: 0x80,
    },
    // STATUS_REG: ZYXDA, bit 3, and ZYXOR, bit 7.
    status: Status {
        register: 0x27,
        ready: 1 << 3,
        overrun: 1 << 7,
    },
    // OUT_X_L.
    gyro: 0x28,
    // OUT_TEMP has only 8 bits.
    temperature: None,
    byte_order: ByteOrder::LittleEndian,
    // Table "Mechanical characteristics": 8.75 mdps/digit at FS = 250 dps.
    scale_dps: 8.75e-3,
    rate_hz: 95.0,
};
