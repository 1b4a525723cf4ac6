use super::{ByteOrder, Description, Filter, Interface, Status, Temperature, Write};

/// ST LSM6DSO, ±250 °/s at 104 Hz in high-performance mode, behind the low pass LPF2 at 33 Hz.
///
/// Source: data sheet DS12140 (revision 2), by section; registers by the names they have there.
///
/// | register | value | data sheet | public drivers |
/// |---|---|---|---|
/// | CTRL3_C 0x12 | 0x01 | 9.14 | the same: Betaflight, Zephyr |
/// | CTRL9_XL 0x18 | 0xE2 | 9.20 | the same: ArduPilot; bit 1 the same: Betaflight, Zephyr |
/// | CTRL4_C 0x13 (SPI) | 0x04 | 9.15 | bit 2 the same: Betaflight, ST's lsm6dso-pid |
/// | CTRL3_C 0x12 | 0x44 | 9.14 | the same bits: Betaflight, Zephyr |
/// | CTRL2_G 0x11 | 0x40 | 9.13 | the same codes: ST's lsm6dso-pid |
///
/// These registers keep their reset values: LPF1 is off (CTRL4_C, 9.15), the high-pass filter is off and
/// the high-performance mode on (CTRL7_G, 9.18; ArduPilot writes the same), and the FIFO is bypassed.
///
/// Not verified: only some pages of DS12140 were at hand. The registers and the filter's cut-offs were read
/// in the data sheet of the sibling LSM6DSO32 (DocID032891, revision 1), whose section numbers agree where
/// both could be compared. Neither gives the order of LPF2. A driver that runs after one which stayed in
/// another register bank finds a wrong identity; a power cycle mends that.
pub static LSM6DSO: Description = Description {
    name: "LSM6DSO",
    // WHO_AM_I (9.11).
    identity: 0x0F,
    identities: &[0x6C],
    start_up: &[
        // CTRL3_C (9.14): SW_RESET, which takes well below a millisecond.
        Write::new(0x12, 0x01).wait_us(10_000),
        // CTRL9_XL (9.20): I3C_disable, which is recommended where I3C is not used; the rest as after reset.
        Write::new(0x18, 0xE2),
        // CTRL4_C (9.15): I2C_disable; LPF1_SEL_G stays 0.
        Write::new(0x13, 0x04).spi_only(),
        // CTRL3_C (9.14): BDU (a sample does not change while it is read), IF_INC (addresses ascend).
        Write::new(0x12, 0x44),
        // CTRL2_G (9.13): ODR_G 0b0100 (104 Hz), FS_G 0b00 (±250 °/s); the gyro settles.
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
    // STATUS_REG (9.26): GDA, bit 1, is reset when a high byte is read.
    status: Status {
        register: 0x1E,
        ready: 1 << 1,
        overrun: 0,
    },
    // OUTX_L_G (9.28).
    gyro: 0x22,
    // OUT_TEMP_L (9.27); table "Temperature sensor characteristics": a count of 0 is 25 °C, 256 LSB/°C.
    temperature: Some(Temperature {
        register: 0x20,
        at_zero_c: 25.0,
        counts_per_k: 256.0,
    }),
    byte_order: ByteOrder::LittleEndian,
    // Table "Mechanical characteristics": 8.75 mdps/LSB at FS = ±250 dps.
    scale_dps: 8.75e-3,
    rate_hz: 104.0,
    // Table "Gyroscope LPF2 bandwidth selection" (6.4.2): 33.0 Hz at −3 dB. The order is inferred: 0.319 of the
    // rate is the cut-off of a sinc², a running mean applied twice, whose noise bandwidth is a third of the
    // rate and which is zero at its multiples. Table "Gyroscope LPF1 bandwidth selection" (9.17) agrees: a
    // sinc² behind one pole at 12.5 or 25.1 Hz gives its cut-offs for FTYPE 0b111 and 0b110 within 2 %.
    filter: Filter {
        noise_bandwidth_hz: 34.7,
        poles: 2,
    },
};
