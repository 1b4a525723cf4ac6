use super::{
    ByteOrder, Description, Filter, Interface, Signal, Status, Temperature, Upload, Write, Writes,
};

/// The description of a Bosch BMI270 with its configuration file: ±250 °/s at 200 Hz with fourfold oversampling, behind a low
/// pass of at most 22 Hz.
///
/// The sensor measures nothing before it has been given the configuration file of 8192 bytes, which Bosch publishes
/// under the BSD-3-Clause licence in its BMI270_SensorAPI (`bmi270_config_file` in `bmi270.c`). The shorter
/// `bmi270_maximum_fifo_config_file` of 328 bytes, which Betaflight and ArduPilot upload, can be given instead. A start with
/// 8192 bytes takes about half a second over I²C at 400 kHz.
///
/// ```
/// use allanite::sensor::{Description, bmi270};
///
/// # const CONFIGURATION_FILE: &[u8] = &[0; 8192];
/// static GYRO: Description = bmi270(CONFIGURATION_FILE);
/// const _: () = assert!(bmi270(CONFIGURATION_FILE).check().is_ok());
/// # assert_eq!(GYRO.rate_hz, 200.0);
/// ```
///
/// | register | value | public drivers |
/// |---|---|---|
/// | CHIP_ID 0x00 | 0x24 | the same: Betaflight, Bosch's SensorAPI, Linux |
/// | CMD 0x7E | 0xB6, then 10 ms | the same: Betaflight; Bosch's SensorAPI waits for 2 ms |
/// | PWR_CONF 0x7C | 0x00, then 1 ms | the same: Betaflight, Bosch's SensorAPI, Linux |
/// | INIT_CTRL 0x59 | 0x00, the file, 0x01 | the same: Betaflight, Bosch's SensorAPI, Linux |
/// | INIT_ADDR_0 0x5B, INIT_ADDR_1 0x5C | in words | the same: Bosch's SensorAPI, Zephyr |
/// | INIT_DATA 0x5E | blocks | the same: Bosch's SensorAPI, Zephyr; the whole file at once: Betaflight, Linux |
/// | INTERNAL_STATUS 0x21 | bits 3 to 0 are 1 after 150 ms | the same: Bosch's SensorAPI after 20 ms, Linux after 140 ms |
/// | GYR_RANGE 0x43 | 0x03 | the same code: Bosch's SensorAPI, Linux |
/// | GYR_CONF 0x42 | 0xC9 | the same codes: Betaflight, Bosch's SensorAPI, Linux |
/// | INT1_IO_CTRL 0x53 | 0x0A | the same: Betaflight; the same bits: Bosch's SensorAPI |
/// | INT_MAP_DATA 0x58 | 0x04 | the same: Betaflight; the same bit: Bosch's SensorAPI |
/// | PWR_CTRL 0x7D | 0x0A | the same bits: Betaflight, Bosch's SensorAPI, Linux |
///
/// A read over SPI has a dummy byte (Betaflight, Bosch's SensorAPI), and the first one after power-up and reset only selects SPI
/// (Betaflight, Bosch's SensorAPI). Advanced power save stays off, so that all registers can be reached. The
/// temperature is that of Linux and Zephyr.
///
/// Not verified: only the first page of data sheet BST-BMI270-DS000-05 (revision 1.3, 2020) was at hand. It gives low passes from
/// 11 to 751 Hz, and ArduPilot names 751 Hz at 3200 Hz and a quarter of the cut-off for fourfold oversampling. So 11 Hz belong to 25
/// Hz, and the cut-off here, a quarter of 0.23 to 0.44 times the rate, is at most 22 Hz. The order of the filter is not
/// known. The largest noise bandwidth, that of a first order at 22 Hz, is stated; then folded noise raises N by at
/// most 2.0 %. That the flag of a sample is cleared by its read follows from the BMI160. Bosch's correction of x for a motion
/// about z (`GYR_CAS`), at most an eighth of a rate that is near zero here, is left out.
pub const fn bmi270(configuration_file: &'static [u8]) -> Description {
    Description {
        name: "BMI270",
        // CHIP_ID.
        identity: 0x00,
        identities: &[0x24],
        upload: Some(Upload {
            image: configuration_file,
            // CMD: softreset.
            reset: Write::new(0x7E, 0xB6).wait_us(10_000),
            open: Writes::of([
                // PWR_CONF: adv_power_save 0. Further accesses have to wait for 450 µs.
                Write::new(0x7C, 0x00).wait_us(1000),
                // INIT_CTRL: init_ctrl 0.
                Write::new(0x59, 0x00).wait_us(IDLE_US),
            ]),
            // INIT_ADDR_0 and INIT_ADDR_1, INIT_DATA.
            address: 0x5B,
            data: 0x5E,
            wait_us: IDLE_US,
            // INIT_CTRL: init_ctrl 1.
            close: Write::new(0x59, 0x01).wait_us(150_000),
            // INTERNAL_STATUS: message 1, init_ok.
            status: 0x21,
            mask: 0x0F,
            accepted: 0x01,
        }),
        start_up: Writes::of([
            // GYR_RANGE: gyr_range 0b011, ±250 °/s.
            Write::new(0x43, 0x03).wait_us(IDLE_US),
            // GYR_CONF: gyr_filter_perf and gyr_noise_perf 1, gyr_bwp 0b00 (OSR4), gyr_odr 0b1001 (200 Hz).
            Write::new(0x42, 0xC9).wait_us(IDLE_US),
            // INT1_IO_CTRL: output_en, push-pull, active high.
            Write::new(0x53, 0x0A).wait_us(IDLE_US),
            // INT_MAP_DATA: drdy_int1.
            Write::new(0x58, 0x04).wait_us(IDLE_US),
            // PWR_CTRL: gyr_en and temp_en; the gyro settles.
            Write::new(0x7D, 0x0A).wait_us(100_000),
        ]),
        interface: Interface {
            spi_read: 0x80,
            spi_dummies: 1,
            // CHIP_ID; its answer is not used.
            spi_wake: Some(0x00),
            // The address with the SDO pin at ground.
            i2c_address: 0x68,
            i2c_read: 0,
        },
        // STATUS: drdy_gyr, bit 6.
        status: Status {
            register: 0x03,
            ready: 1 << 6,
            overrun: 0,
        },
        // INT_LATCH keeps its reset value, so that INT1 makes pulses.
        signal: Some(Signal::Rising),
        // DATA_14: GYR_X<7:0>.
        gyro: 0x12,
        // TEMPERATURE_0: a count of 0 is 23 °C, and one count is 2⁻⁹ K.
        temperature: Some(Temperature {
            register: 0x22,
            at_zero_c: 23.0,
            counts_per_k: 512.0,
        }),
        byte_order: ByteOrder::LittleEndian,
        // 131.2 LSB/°/s, as the BMI160.
        scale_dps: 1.0 / 131.2,
        rate_hz: 200.0,
        filter: Filter {
            noise_bandwidth_hz: 34.6,
            poles: 1,
        },
        fifo: None,
    }
}

/// The pause between two accesses in normal mode, in µs. Bosch's SensorAPI waits for 2 µs.
const IDLE_US: u32 = 2;
