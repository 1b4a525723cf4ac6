use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Fifo, Filter, Format, Interface,
    Signal, Status, Temperature, Write, Writes,
    configuration::{LowPass, Offer, checked},
};
use crate::numerics::real::Real;

/// The rates (CTRL2) and ranges (CTRL6) with their codes, and the sensitivities. At 960 Hz and above, nothing is known
/// of LPF2.
const OFFER: Offer<5, 6> = Offer {
    sensor: "LSM6DSV16X",
    rates: [(30, 4), (60, 5), (120, 6), (240, 7), (480, 8)],
    ranges: [
        (125, 0x0, 4.375e-3),
        (250, 0x1, 8.75e-3),
        (500, 0x2, 17.5e-3),
        (1000, 0x3, 35e-3),
        (2000, 0x4, 70e-3),
        (4000, 0xC, 140e-3),
    ],
    // The watermark has 8 bits, and a sample takes two words and now and then a third.
    most: 115,
};

/// The description of an LSM6DSV16X with another configuration than that of [`LSM6DSV16X`], whose documentation
/// lists the registers.
///
/// * Rates: 30, 60, 120, 240 and 480 Hz, in high-performance mode.
/// * Ranges: 125, 250, 500, 1000, 2000 and 4000 °/s.
/// * Low passes: LPF2 alone, which follows the rate. No cut-off can be chosen.
/// * Watermark: 1 to 115 samples.
///
/// # Errors
/// [`ConfigurationError`] for all else.
pub const fn lsm6dsv16x(wanted: Configuration) -> Result<Description, ConfigurationError> {
    let low_pass = LowPass {
        code: 0,
        bandwidth_hz: 0,
        // A third of the rate, as that of the LSM6DSO.
        filter: Filter {
            noise_bandwidth_hz: wanted.rate_hz() as Real / 3.0,
            poles: 2,
        },
        is_tight: true,
    };
    let chosen = match OFFER.choose(wanted, &[low_pass]) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    let [watermark, _] = (chosen.watermark * 2).to_le_bytes();
    let fifo = Fifo {
        set_up: Writes::of([
            // FUNCTIONS_ENABLE: TIMESTAMP_EN.
            Write::new(0x50, 0x40),
            // FIFO_CTRL1 and FIFO_CTRL2: the watermark in words; no compression.
            Write::new(0x07, watermark),
            Write::new(0x08, 0x00),
            // FIFO_CTRL3: BDR_GY as the rate, no accelerometer.
            Write::new(0x09, chosen.rate << 4),
            // INT1_CTRL: INT1_FIFO_TH instead of INT1_DRDY_G.
            Write::new(0x0D, 0x08),
        ]),
        turn_on: Writes::NONE,
        flush: Writes::of([
            // FIFO_CTRL4: DEC_TS_BATCH 0b01 (a time with every sample), ODR_T_BATCH 0b10 (temperature at 15 Hz),
            // FIFO_MODE 0b000 (bypass, which empties it) and then 0b110 (continuous).
            Write::new(0x0A, 0x60),
            Write::new(0x0A, 0x66),
        ]),
        // FIFO_STATUS1 and FIFO_STATUS2, FIFO_DATA_OUT_TAG. After 0x7E, the address returns to 0x78.
        count: 0x1B,
        data: 0x78,
        format: Format::Lsm6dsv,
        // 1.5 kbyte without compression: 256 words.
        capacity: 128,
        time_bits: 32,
        // 1 s / 46 080.
        tick_ps: 21_701_389,
        // 46.08 kHz and 7.68 kHz come from one oscillator: 384 ticks at 120 Hz.
        interval: 384 * 120 * 256 / chosen.rate_hz as u32,
        signal: Signal::High,
    };
    Ok(Description {
        name: "LSM6DSV16X",
        // WHO_AM_I.
        identity: 0x0F,
        identities: &[0x70],
        upload: None,
        start_up: Writes::of([
            // CTRL3: SW_RESET.
            Write::new(0x12, 0x01).wait_us(10_000),
            // IF_CFG: I2C_I3C_disable; active high and push-pull.
            Write::new(0x03, 0x01).spi_only(),
            // CTRL3: BDU (a sample does not change while it is read), IF_INC (addresses ascend).
            Write::new(0x12, 0x44),
            // CTRL6: LPF1_G_BW 0, FS_G. LPF1 stays off (CTRL7).
            Write::new(0x15, chosen.range),
            // INT1_CTRL: INT1_DRDY_G.
            Write::new(0x0D, 0x02),
            // CTRL2: OP_MODE_G 0b000 (high performance), ODR_G; the gyro settles.
            Write::new(0x11, chosen.rate).wait_us(100_000),
        ]),
        // The address with the SDO/SA0 pin at ground.
        interface: Interface::usual(0x6A),
        // STATUS_REG: GDA, bit 1, is reset when a high byte is read.
        status: Status {
            register: 0x1E,
            ready: 1 << 1,
            overrun: 0,
        },
        // IF_CFG after reset: active high and push-pull; the flag lasts until the sample is read.
        signal: Some(Signal::High),
        // OUTX_L_G.
        gyro: 0x22,
        // OUT_TEMP_L: a count of 0 is 25 °C, 256 LSB/°C.
        temperature: Some(Temperature {
            register: 0x20,
            at_zero_c: 25.0,
            counts_per_k: 256.0,
        }),
        byte_order: ByteOrder::LittleEndian,
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        filter: chosen.low_pass.filter,
        fifo: Some(fifo),
    })
}

/// ST LSM6DSV16X, ±250 °/s at 120 Hz in high-performance mode, behind the low pass LPF2 at about 38 Hz.
///
/// Source: ST's driver lsm6dsv16x-pid, which the names of registers and bits are from, and Betaflight's driver,
/// compared with each other. Both quote the data sheet DS13510.
///
/// | register | value | public drivers |
/// |---|---|---|
/// | CTRL3 0x12 | 0x01 | the same: Betaflight, ST's lsm6dsv16x-pid |
/// | IF_CFG 0x03 (SPI) | 0x01 | the same bit: Betaflight, ST's lsm6dsv16x-pid; neither sets it |
/// | CTRL3 0x12 | 0x44 | the same: Betaflight |
/// | CTRL6 0x15 | 0x01 | the same codes: Betaflight, ST's lsm6dsv16x-pid |
/// | INT1_CTRL 0x0D | 0x02 | the same: Betaflight |
/// | CTRL2 0x11 | 0x06 | the same codes: Betaflight, ST's lsm6dsv16x-pid |
///
/// The FIFO needs these as well:
///
/// | register | value | public drivers |
/// |---|---|---|
/// | FUNCTIONS_ENABLE 0x50 | 0x40 | the same bit: ST's example lsm6dsv16x_fifo.c |
/// | FIFO_CTRL1 0x07, FIFO_CTRL2 0x08 | 16, 0 | in words too: ST's example |
/// | FIFO_CTRL3 0x09 | 0x60 | the same codes: Betaflight (unused), ST's lsm6dsv16x-pid |
/// | FIFO_CTRL4 0x0A | 0x60, then 0x66 | the same codes: Betaflight (unused), ST's lsm6dsv16x-pid |
/// | INT1_CTRL 0x0D | 0x08 | the same bit: Betaflight (unused), ST's lsm6dsv16x-pid |
///
/// The words of the FIFO are those of the [`LSM6DSO`](super::LSM6DSO); the tag's lowest bit is unused.
///
/// Not verified: the data sheet was not at hand. The low pass is inferred: Betaflight quotes cut-offs of LPF1 at
/// 14.4 and 28.8 Hz, which are those of the LSM6DSO, 12.5 and 25.1 Hz, times 7680/6667. So the filters seem to be the
/// same ones with a faster clock, and LPF2 to pass a third of the rate, as in the LSM6DSO. The duration of a
/// tick is 1/46080 s, a sixth of that of the highest rate; ST's driver gives 21.75 µs, 0.2 % more.
pub static LSM6DSV16X: Description = checked(lsm6dsv16x(Configuration::new(120, 250)));
