use super::{ByteOrder, Description, Filter, Interface, Status, Write, Writes};

/// ST L3GD20, a gyro without accelerometer, ±250 °/s at 95 Hz, behind the low passes LPF1 at 32 Hz and LPF2
/// at 25 Hz. It reports overwritten samples.
///
/// Source: data sheet DocID022116 (revision 2, 2013), chapters "Register mapping" and "Register
/// description"; registers by the names they have there. The filters: application note AN4505 (2014),
/// table 11.
///
/// | register | value | public drivers |
/// |---|---|---|
/// | CTRL_REG2 0x21 | 0x00 | the same: ArduPilot, RIOT |
/// | CTRL_REG5 0x24 | 0x02 | the same bits for LPF2: AdaCore, RIOT |
/// | FIFO_CTRL_REG 0x2E | 0x00 | the same: RIOT |
/// | CTRL_REG4 0x23 | 0x80 | the same: ArduPilot, RIOT |
/// | CTRL_REG1 0x20 | 0x1F | the same: ArduPilot; the same codes: AdaCore, RIOT |
///
/// LPF1 cannot be switched off. Alone, it is not certain to keep the noise below Nyquist, because its order
/// is not documented. With LPF2 it is.
///
/// Not verified: neither document was at hand; what they say was taken from the drivers, which quote them.
/// The cut-off of LPF1 is quoted by RIOT, for the L3GD20H at 100 Hz. The order of either filter is unknown.
pub static L3GD20: Description = Description {
    name: "L3GD20",
    // WHO_AM_I.
    identity: 0x0F,
    identities: &[0xD4],
    upload: None,
    start_up: Writes::of([
        // There is no reset: only a power cycle clears these registers.
        // CTRL_REG2: no high-pass.
        Write::new(0x21, 0x00),
        // CTRL_REG5: Out_Sel 0b10 (the samples come from LPF2), HPen 0, FIFO_EN 0.
        Write::new(0x24, 0x02),
        // FIFO_CTRL_REG: bypass mode.
        Write::new(0x2E, 0x00),
        // CTRL_REG4: BDU (a sample does not change while it is read), BLE 0, FS 0b00 (±250 °/s).
        Write::new(0x23, 0x80),
        // CTRL_REG1: DR 0b00 (95 Hz), BW 0b01 (LPF2 at 25 Hz), PD and all axes on; the gyro settles.
        Write::new(0x20, 0x1F).wait_us(300_000),
    ]),
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
    signal: None,
    // OUT_X_L.
    gyro: 0x28,
    // OUT_TEMP has only 8 bits.
    temperature: None,
    byte_order: ByteOrder::LittleEndian,
    // Table "Mechanical characteristics": 8.75 mdps/digit at FS = 250 dps.
    scale_dps: 8.75e-3,
    rate_hz: 95.0,
    // One pole at 32 Hz (LPF1) and one at 25 Hz (LPF2), the smallest number: π/2 · 32·25/(32 + 25).
    filter: Filter {
        noise_bandwidth_hz: 22.1,
        poles: 2,
    },
    fifo: None,
};
