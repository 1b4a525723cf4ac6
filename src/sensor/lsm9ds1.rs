use super::{
    ByteOrder, Description, Filter, Interface, Signal, Status, Temperature, Write, Writes,
};

/// ST LSM9DS1, ±245 °/s at 119 Hz, behind the low passes LPF1 at 38 Hz and LPF2 at 31 Hz.
///
/// Source: data sheet DocID025715 (revision 2, 2014), by section; registers by the names they have there.
///
/// | register | value | data sheet | public drivers |
/// |---|---|---|---|
/// | WHO_AM_I 0x0F | 0x68 | 7.11 | the same: Adafruit, SparkFun |
/// | CTRL_REG8 0x22 | 0x05, then 0x44 | 7.26 | the first the same: Adafruit; bit 6 the same: ST's lsm9ds1-pid |
/// | CTRL_REG9 0x23 (SPI) | 0x04 | 7.27 | not compared |
/// | CTRL_REG2_G 0x11 | 0x02 | 7.13 | the same code: ST's lsm9ds1-pid |
/// | CTRL_REG3_G 0x12 | 0x00 | 7.14 | the same: SparkFun |
/// | INT1_CTRL 0x0C | 0x02 | 7.9 | not compared |
/// | CTRL_REG1_G 0x10 | 0x61 | 7.12 | the same codes: Adafruit, SparkFun |
///
/// CTRL_REG1_G turns the accelerometer on as well, at the same rate (3.1). The axes are on after reset (CTRL_REG4).
///
/// LPF1 cannot be switched off. Alone at 38 Hz, it is not certain to keep the noise below Nyquist, because its order is
/// not documented. With LPF2 it is, and folded noise raises N by at most 0.6 %.
///
/// Not verified: the data sheet gives the cut-offs of both filters and the order of neither, and its figure 28 was
/// not legible, so that the code of the path through LPF2 is that of ST's driver alone. It does not say what clears GDA,
/// which is taken to be the read of a sample, as in ST's later sensors. The temperature is zero at 25 °C in
/// Zephyr; the data sheet gives its scale. The magnetometer has its own address and is left alone. The FIFO holds no
/// time, from which lost samples could be counted.
pub static LSM9DS1: Description = Description {
    name: "LSM9DS1",
    // WHO_AM_I (7.11).
    identity: 0x0F,
    identities: &[0x68],
    upload: None,
    start_up: Writes::of([
        // CTRL_REG8 (7.26): SW_RESET; IF_ADD_INC as after reset.
        Write::new(0x22, 0x05).wait_us(10_000),
        // CTRL_REG9 (7.27): I2C_DISABLE.
        Write::new(0x23, 0x04).spi_only(),
        // CTRL_REG8 (7.26): BDU (a sample does not change while it is read), IF_ADD_INC (addresses ascend).
        Write::new(0x22, 0x44),
        // CTRL_REG2_G (7.13): OUT_SEL 0b10, the samples come from LPF2.
        Write::new(0x11, 0x02),
        // CTRL_REG3_G (7.14): neither low power nor high-pass filter.
        Write::new(0x12, 0x00),
        // INT1_CTRL (7.9): INT1_DRDY_G.
        Write::new(0x0C, 0x02),
        // CTRL_REG1_G (7.12): ODR_G 0b011 (119 Hz), FS_G 0b00 (±245 °/s), BW_G 0b01 (LPF2 at 31 Hz); the gyro settles.
        Write::new(0x10, 0x61).wait_us(300_000),
    ]),
    // The address with the SDO_A/G pin at ground.
    interface: Interface::usual(0x6A),
    // STATUS_REG (7.18): GDA, bit 1.
    status: Status {
        register: 0x17,
        ready: 1 << 1,
        overrun: 0,
    },
    // CTRL_REG8 (7.26): active high and push-pull.
    signal: Some(Signal::High),
    // OUT_X_L_G (7.19).
    gyro: 0x18,
    // OUT_TEMP_L (7.17), right-justified; table 5: 16 LSB/°C.
    temperature: Some(Temperature {
        register: 0x15,
        at_zero_c: 25.0,
        counts_per_k: 16.0,
    }),
    byte_order: ByteOrder::LittleEndian,
    // Table 3: 8.75 mdps/LSB at ±245 °/s.
    scale_dps: 8.75e-3,
    rate_hz: 119.0,
    // Tables 46 and 47: one pole at 38 Hz (LPF1) and one at 31 Hz (LPF2), the smallest number: π/2 · 38·31/(38 + 31).
    filter: Filter {
        noise_bandwidth_hz: 26.8,
        poles: 2,
    },
    fifo: None,
};
