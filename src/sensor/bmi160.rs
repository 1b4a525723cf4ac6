use super::{ByteOrder, Description, Filter, Interface, Status, Temperature, Write, Writes};

/// Bosch BMI160, ±250 °/s at 200 Hz with fourfold oversampling, behind a low pass of 20 Hz.
///
/// Source: data sheet BST-BMI160-DS000-07 (revision 0.8, 2015), chapter 2.11 "Register description"
/// and chapter 3 "Digital interfaces"; registers by the names they have there.
///
/// | register | value | data sheet | public drivers |
/// |---|---|---|---|
/// | CMD 0x7E | 0x15, then 80 ms | 2.11 | the same: ArduPilot, Betaflight, Bosch's SensorAPI, Linux |
/// | GYR_RANGE 0x43 | 0x03 | 2.11 | the same code: Bosch's SensorAPI, Linux |
/// | GYR_CONF 0x42 | 0x09 | 2.11, 2.4.2 | the same codes: Betaflight, Bosch's SensorAPI, Linux |
///
/// All other registers keep what they have: the accelerometer is off after a power cycle, and the FIFO, the
/// interrupts and the accelerometer do not touch the gyro's samples.
///
/// Not verified: only extracts of the data sheet were at hand. They give 5.06 Hz at 50 Hz with fourfold
/// oversampling, hence 20.2 Hz here, and not the order of the filter. The largest noise bandwidth, that of a
/// first order, is stated. Then folded noise raises N by at most 1.7 %.
pub static BMI160: Description = Description {
    name: "BMI160",
    // Register (0x00) CHIPID.
    identity: 0x00,
    identities: &[0xD1],
    upload: None,
    // There is no soft reset, because it would return the interface to I²C. It is not needed: every register
    // that matters is written, and the offsets that a reset clears are constants, which cancel.
    start_up: Writes::of([
        // Register (0x7E) CMD: gyr_set_pmu_mode normal; the pause is longer than a start from suspend takes.
        Write::new(0x7E, 0x15).wait_us(100_000),
        // Register (0x43) GYR_RANGE: 0b011, ±250 °/s. 450 µs between writes is enough in any mode
        // (chapter 3, t_IDLE_wacc_sum).
        Write::new(0x43, 0x03).wait_us(450),
        // Register (0x42) GYR_CONF: gyr_bwp 0b00 (OSR4), gyr_odr 0b1001 (200 Hz); the gyro settles. In normal
        // mode the cut-off is 0.4 of the rate, and the noise is not certain to stay below Nyquist.
        Write::new(0x42, 0x09).wait_us(100_000),
    ]),
    interface: Interface {
        // Chapter 3: the first bit of an SPI access is 1 for a read; the data follow without dummy bytes.
        spi_read: 0x80,
        spi_dummies: 0,
        // "Protocol selection": an initial read of 0x7F makes the rising edge that selects SPI.
        spi_wake: Some(0x7F),
        // The address with the SDO pin at ground.
        i2c_address: 0x68,
        i2c_read: 0,
    },
    // Register (0x1B) STATUS: drdy_gyr, bit 6, reset when the data are read.
    status: Status {
        register: 0x1B,
        ready: 1 << 6,
        overrun: 0,
    },
    signal: None,
    // Register (0x04-0x17) DATA: GYR_X<7:0>.
    gyro: 0x0C,
    // Register (0x20-0x21) TEMPERATURE: a count of 0 is 23 °C, and one count is 2⁻⁹ K.
    temperature: Some(Temperature {
        register: 0x20,
        at_zero_c: 23.0,
        counts_per_k: 512.0,
    }),
    byte_order: ByteOrder::LittleEndian,
    // Register (0x43) GYR_RANGE: 131.2 LSB/°/s.
    scale_dps: 1.0 / 131.2,
    rate_hz: 200.0,
    // Chapter 2.4.2: 20.2 Hz, with one pole π/2 · 20.2 Hz.
    filter: Filter {
        noise_bandwidth_hz: 31.8,
        poles: 1,
    },
    fifo: None,
};
