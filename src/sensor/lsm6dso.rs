use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Fifo, Filter, Format, Interface,
    Signal, Status, Temperature, Write, Writes,
    configuration::{LowPass, Offer, checked},
};
use crate::numerics::real::Real;

/// The rates and ranges (9.13) with their codes, and the table "Mechanical characteristics". At 833 Hz and above,
/// the cut-off of LPF2 is no longer 0.319 of the rate.
const OFFER: Offer<5, 5> = Offer {
    sensor: "",
    rates: [(26, 2), (52, 3), (104, 4), (208, 5), (416, 6)],
    // The code is that of FS_G and FS_125, bits 3 to 1.
    ranges: [
        (125, 1, 4.375e-3),
        (250, 0, 8.75e-3),
        (500, 2, 17.5e-3),
        (1000, 4, 35e-3),
        (2000, 6, 70e-3),
    ],
    // The watermark has 9 bits, and a sample takes two words and now and then a third.
    most: 240,
};

/// The description of an LSM6DSO with another configuration than that of [`LSM6DSO`], whose documentation lists the
/// registers.
///
/// * Rates: 26, 52, 104, 208 and 416 Hz, in high-performance mode.
/// * Ranges: 125, 250, 500, 1000 and 2000 °/s.
/// * Low passes: LPF2 alone, which follows the rate. No cut-off can be chosen.
/// * Watermark: 1 to 240 samples.
///
/// # Errors
/// [`ConfigurationError`] for all else.
pub const fn lsm6dso(wanted: Configuration) -> Result<Description, ConfigurationError> {
    // WHO_AM_I (9.11).
    family("LSM6DSO", &[0x6C], wanted)
}

/// The description of a sensor with these registers, by its name and its identities.
pub(super) const fn family(
    name: &'static str,
    identities: &'static [u8],
    wanted: Configuration,
) -> Result<Description, ConfigurationError> {
    let low_pass = LowPass {
        code: 0,
        bandwidth_hz: 0,
        // A third of the rate, as explained below.
        filter: Filter {
            noise_bandwidth_hz: wanted.rate_hz() as Real / 3.0,
            poles: 2,
        },
        is_tight: true,
    };
    let offer = Offer {
        sensor: name,
        ..OFFER
    };
    let chosen = match offer.choose(wanted, &[low_pass]) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    let [watermark_low, watermark_high] = (chosen.watermark * 2).to_le_bytes();
    let fifo = Fifo {
        set_up: Writes::of([
            // CTRL10_C (9.21): TIMESTAMP_EN.
            Write::new(0x19, 0x20),
            // FIFO_CTRL1 and FIFO_CTRL2 (9.3, 9.4): the watermark in words; no compression.
            Write::new(0x07, watermark_low),
            Write::new(0x08, watermark_high),
            // FIFO_CTRL3 (9.5): BDR_GY as the rate, no accelerometer.
            Write::new(0x09, chosen.rate << 4),
            // INT1_CTRL (9.9): INT1_FIFO_TH instead of INT1_DRDY_G.
            Write::new(0x0D, 0x08),
        ]),
        turn_on: Writes::NONE,
        flush: Writes::of([
            // FIFO_CTRL4 (9.6): DEC_TS_BATCH 0b01 (a time with every sample), ODR_T_BATCH 0b10 (temperature at
            // 12.5 Hz), FIFO_MODE 0b000 (bypass, which empties it) and then 0b110 (continuous).
            Write::new(0x0A, 0x60),
            Write::new(0x0A, 0x66),
        ]),
        // FIFO_STATUS1 and FIFO_STATUS2, FIFO_DATA_OUT_TAG. After 0x7E, the address returns to 0x78.
        count: 0x3A,
        data: 0x78,
        format: Format::Lsm6dso,
        // 3 kbyte: 512 words.
        capacity: 256,
        time_bits: 32,
        // 25 µs.
        tick_ps: 25_000_000,
        // 40 kHz and 6667 Hz come from one oscillator: 384 ticks at 104 Hz.
        interval: 384 * 104 * 256 / chosen.rate_hz as u32,
        signal: Signal::High,
    };
    Ok(Description {
        name,
        // WHO_AM_I (9.11).
        identity: 0x0F,
        identities,
        upload: None,
        start_up: Writes::of([
            // CTRL3_C (9.14): SW_RESET, which takes well below a millisecond.
            Write::new(0x12, 0x01).wait_us(10_000),
            // CTRL9_XL (9.20): I3C_disable, which is recommended where I3C is not used; the rest as after reset.
            Write::new(0x18, 0xE2),
            // CTRL4_C (9.15): I2C_disable; LPF1_SEL_G stays 0.
            Write::new(0x13, 0x04).spi_only(),
            // CTRL3_C (9.14): BDU (a sample does not change while it is read), IF_INC (addresses ascend).
            Write::new(0x12, 0x44),
            // INT1_CTRL (9.9): INT1_DRDY_G.
            Write::new(0x0D, 0x02),
            // CTRL2_G (9.13): ODR_G, FS_G and FS_125; the gyro settles.
            Write::new(0x11, chosen.rate << 4 | chosen.range << 1).wait_us(100_000),
        ]),
        // The address with the SDO/SA0 pin at ground.
        interface: Interface::usual(0x6A),
        // STATUS_REG (9.26): GDA, bit 1, is reset when a high byte is read.
        status: Status {
            register: 0x1E,
            ready: 1 << 1,
            overrun: 0,
        },
        // CTRL3_C (9.14): active high and push-pull; the flag lasts until the sample is read.
        signal: Some(Signal::High),
        // OUTX_L_G (9.28).
        gyro: 0x22,
        // OUT_TEMP_L (9.27); table "Temperature sensor characteristics": a count of 0 is 25 °C, 256 LSB/°C.
        temperature: Some(Temperature {
            register: 0x20,
            at_zero_c: 25.0,
            counts_per_k: 256.0,
        }),
        byte_order: ByteOrder::LittleEndian,
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        // Table "Gyroscope LPF2 bandwidth selection" (6.4.2): 33.0 Hz at −3 dB. The order is inferred: 0.319 of the
        // rate is the cut-off of a sinc², a running mean applied twice, whose noise bandwidth is a third of the
        // rate and which is zero at its multiples. Table "Gyroscope LPF1 bandwidth selection" (9.17) agrees: a
        // sinc² behind one pole at 12.5 or 25.1 Hz gives its cut-offs for FTYPE 0b111 and 0b110 within 2 %.
        filter: chosen.low_pass.filter,
        fifo: Some(fifo),
    })
}

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
/// | INT1_CTRL 0x0D | 0x02 | 9.9 | the same: Betaflight |
/// | CTRL2_G 0x11 | 0x40 | 9.13 | the same codes: ST's lsm6dso-pid |
///
/// The FIFO needs these as well:
///
/// | register | value | data sheet | public drivers |
/// |---|---|---|---|
/// | CTRL10_C 0x19 | 0x20 | 9.21 | the same bit: Linux, ST's lsm6dso-pid |
/// | FIFO_CTRL1 0x07, FIFO_CTRL2 0x08 | 16, 0 | 9.3, 9.4 | in words too: Linux, ST's lsm6dso-pid |
/// | FIFO_CTRL3 0x09 | 0x40 | 9.5 | the same codes: Linux, ST's lsm6dso-pid |
/// | FIFO_CTRL4 0x0A | 0x60, then 0x66 | 9.6 | the same codes: ST's lsm6dso-pid |
/// | INT1_CTRL 0x0D | 0x08 | 9.9 | the same bit: Linux, ST's lsm6dso-pid |
///
/// A word has a tag of sensor (bits 7 to 3), time slot (bits 2 and 1) and even parity, as in ST's lsm6dso-pid and
/// `st_fifo.c`: 1 is the gyro, 3 the temperature and 4 the time, whose 32 bits are the first four bytes, as in Linux.
///
/// These registers keep their reset values: LPF1 is off (CTRL4_C, 9.15), the high-pass filter is off and
/// the high-performance mode on (CTRL7_G, 9.18; ArduPilot writes the same).
///
/// Not verified: only some pages of DS12140 were at hand. The registers and the filter's cut-offs were read
/// in the data sheet of the sibling LSM6DSO32 (DocID032891, revision 1), whose section numbers agree where
/// both could be compared; the sections of the FIFO's registers follow from the order of the registers. Neither gives
/// the order of LPF2. A driver that runs after one which stayed in another register bank finds a wrong identity; a
/// power cycle mends that.
pub static LSM6DSO: Description = checked(lsm6dso(Configuration::new(104, 250)));
