use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Fifo, Filter, Format, Interface,
    Signal, Status, Temperature, Write, Writes,
    configuration::{LowPass, Offer, checked},
};
use crate::numerics::real::{Real, consts::FRAC_PI_2};

/// The rates and ranges (GYRO_CONFIG0) with their codes, and the sensitivities.
const OFFER: Offer<7, 9> = Offer {
    sensor: "ICM-45686",
    rates: [
        (25, 0x0B),
        (50, 0x0A),
        (100, 0x09),
        (200, 0x08),
        (400, 0x07),
        (800, 0x06),
        (1600, 0x05),
    ],
    ranges: [
        (15, 8, 1.0 / 2097.2),
        (31, 7, 1.0 / 1048.6),
        (62, 6, 1.0 / 524.3),
        (125, 5, 1.0 / 262.0),
        (250, 4, 1.0 / 131.0),
        (500, 3, 1.0 / 65.5),
        (1000, 2, 1.0 / 32.8),
        (2000, 1, 1.0 / 16.4),
        (4000, 0, 1.0 / 8.2),
    ],
    most: 115,
};

/// The low pass of `gyro_ui_lpfbw_sel` = `code`, at rate/`divisor`. Its order is not known, and the bandwidth is at
/// most that of a first order.
const fn low_pass(rate_hz: u16, code: u8, divisor: u16) -> LowPass {
    LowPass {
        code,
        bandwidth_hz: rate_hz / divisor,
        filter: Filter {
            noise_bandwidth_hz: FRAC_PI_2 * rate_hz as Real / divisor as Real,
            poles: 1,
        },
        // One pole at an eighth of the rate would raise N by 2.5 %.
        is_tight: divisor >= 16,
    }
}

/// The description of an ICM-45686 with another configuration than that of [`ICM_45686`], whose documentation lists
/// the registers.
///
/// * Rates: 25, 50, 100, 200, 400, 800 and 1600 Hz, in low-noise mode.
/// * Ranges: 15 (15.625), 31 (31.25), 62 (62.5), 125, 250, 500, 1000, 2000 and 4000 °/s.
/// * Low passes: the rate divided by 4, 8, 16, 32, 64 or 128. The first two have to be asked for, because a filter of
///   first order there would let folded noise raise N by up to 10 %.
/// * Watermark: 1 to 115 samples.
///
/// # Errors
/// [`ConfigurationError`] for all else.
pub const fn icm_45686(wanted: Configuration) -> Result<Description, ConfigurationError> {
    let rate_hz = wanted.rate_hz();
    let low_passes = [
        low_pass(rate_hz, 1, 4),
        low_pass(rate_hz, 2, 8),
        low_pass(rate_hz, 3, 16),
        low_pass(rate_hz, 4, 32),
        low_pass(rate_hz, 5, 64),
        low_pass(rate_hz, 6, 128),
    ];
    let chosen = match OFFER.choose(wanted, &low_passes) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    // One more, because the newest packet must be left.
    let [watermark_low, watermark_high] = (chosen.watermark + 1).to_le_bytes();
    let fifo = Fifo {
        set_up: Writes::of([
            // FIFO_CONFIG0: bypass; fifo_depth 7, 2 kB.
            Write::new(0x1D, 0x07),
            // FIFO_CONFIG1_0 and FIFO_CONFIG1_1: the watermark in packets.
            Write::new(0x1E, watermark_low),
            Write::new(0x1F, watermark_high),
            // FIFO_CONFIG2: fifo_wr_wm_gt_th, so that the pin signals at every sample beyond the watermark.
            Write::new(0x20, 0x08),
            // FIFO_CONFIG4: fifo_tmst_fsync_en, no compression.
            Write::new(0x22, 0x02),
            // TMST_WOM_CONFIG: tmst_resol (16 µs), no differences.
            Write::new(0x23, 0x20).keeping(0x9F),
            // SMC_CONTROL_0: tmst_en.
            Write::indirect(0xA258, 0x01).keeping(0xFE),
            // ACCEL_CONFIG0: ±16 g at the rate of the gyro, so that every packet has both.
            Write::new(0x1B, 0x10 | chosen.rate),
            // INT1_CONFIG0: int1_status_en_fifo_ths instead of int1_status_en_drdy.
            Write::new(0x16, 0x02),
            // FIFO_CONFIG3: fifo_gyro_en and fifo_accel_en, which make packets of 16 bytes with a time.
            Write::new(0x21, 0x06),
            // FIFO_CONFIG0: stream.
            Write::new(0x1D, 0x47),
            // FIFO_CONFIG3: fifo_if_en as well, after the mode.
            Write::new(0x21, 0x07),
        ]),
        turn_on: Writes::of([
            // PWR_MGMT0: accel_mode 0b11 (low noise) as well; the accelerometer settles.
            Write::new(0x10, 0x0F).wait_us(60_000),
        ]),
        flush: Writes::of([
            // FIFO_CONFIG2: fifo_flush, and fifo_wr_wm_gt_th as before.
            Write::new(0x20, 0x88),
        ]),
        // FIFO_COUNT_0 and FIFO_COUNT_1, FIFO_DATA.
        count: 0x12,
        data: 0x14,
        format: Format::Icm456xx,
        capacity: 128,
        time_bits: 16,
        // 16 µs · 32/30.
        tick_ps: 17_066_667,
        // 1 s / rate / (16 µs · 32/30) · 256.
        interval: 15_000_000 / chosen.rate_hz as u32,
        signal: Signal::Rising,
    };
    Ok(Description {
        name: "ICM-45686",
        // WHO_AM_I.
        identity: 0x72,
        identities: &[0xE9],
        upload: None,
        start_up: Writes::of([
            // REG_MISC2: soft_rst, done within 1 ms.
            Write::new(0x7F, 0x02).wait_us(2_000),
            // INT1_CONFIG2: active high, pulses, push-pull.
            Write::new(0x18, 0x01),
            // INT1_CONFIG0: int1_status_en_drdy, so that the flag is certain to be raised.
            Write::new(0x16, 0x04),
            // IPREG_SYS1_REG_166: gyro_src_ctrl 0b10, interpolator and anti-alias filter on.
            Write::indirect(0xA4A6, 0x40).keeping(0x9F),
            // IPREG_SYS1_REG_172: gyro_ui_lpfbw_sel.
            Write::indirect(0xA4AC, chosen.low_pass.code).keeping(0xF8),
            // GYRO_CONFIG0: gyro_ui_fs_sel, gyro_odr.
            Write::new(0x1C, chosen.range << 4 | chosen.rate),
            // PWR_MGMT0: gyro_mode 0b11 (low noise); the gyro settles.
            Write::new(0x10, 0x0C).wait_us(100_000),
        ]),
        // The address with the AP_AD0 pin at ground.
        interface: Interface::usual(0x68),
        // INT1_STATUS0: int1_status_drdy, bit 2. Reading it clears it, reading the sample does not.
        status: Status {
            register: 0x19,
            ready: 1 << 2,
            overrun: 0,
        },
        signal: Some(Signal::Rising),
        // GYRO_DATA_X1_UI.
        gyro: 0x06,
        // TEMP_DATA1_UI: a count of 0 is 25 °C, 128 LSB/°C.
        temperature: Some(Temperature {
            register: 0x0C,
            at_zero_c: 25.0,
            counts_per_k: 128.0,
        }),
        // SREG_CTRL: sreg_data_endian_sel is 0 after reset.
        byte_order: ByteOrder::LittleEndian,
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        filter: chosen.low_pass.filter,
        fifo: Some(fifo),
    })
}

/// TDK InvenSense ICM-45686, ±250 °/s at 100 Hz in low-noise mode, behind a low pass at 6.25 Hz, a sixteenth of
/// the rate.
///
/// Source: TDK's driver motion.mcu.icm45686.driver, which the names of registers and bits are from, compared with
/// the drivers of Betaflight, Linux and Zephyr. They quote the data sheet DS-000577 and the errata AN-000364.
///
/// | register | value | public drivers |
/// |---|---|---|
/// | REG_MISC2 0x7F | 0x02 | the same: Betaflight, Linux, TDK |
/// | INT1_CONFIG2 0x18 | 0x01 | the same: Betaflight |
/// | INT1_CONFIG0 0x16 | 0x04 | the same: Betaflight |
/// | IPREG_SYS1_REG_166 0xA4A6 | 0x40 of 0x60 | the same bits: TDK; Betaflight writes bits 1 and 0 |
/// | IPREG_SYS1_REG_172 0xA4AC | 0x03 of 0x07 | the same codes: Betaflight, TDK, Zephyr |
/// | GYRO_CONFIG0 0x1C | 0x49 | the same codes: Betaflight, Linux, TDK |
/// | PWR_MGMT0 0x10 | 0x0C, last | low noise: Betaflight, Linux, TDK |
///
/// The FIFO needs these as well, and the accelerometer on, because only packets with both have a time:
///
/// | register | value | public drivers |
/// |---|---|---|
/// | FIFO_CONFIG0 0x1D | 0x07, then 0x47 | the same depth: TDK (with its processor in use), Zephyr; the same mode: Linux |
/// | FIFO_CONFIG1 0x1E, 0x1F | 9, 0 | in packets too: Linux, TDK; one more, too: Zephyr |
/// | FIFO_CONFIG2 0x20 | 0x08; 0x88 empties it | the same: Linux, TDK, Zephyr |
/// | FIFO_CONFIG4 0x22 | 0x02 | the same: Linux, TDK |
/// | TMST_WOM_CONFIG 0x23 | 0x20 of 0x60 | the same bits: TDK |
/// | SMC_CONTROL_0 0xA258 | 0x01 of 0x01 | the same: Linux, TDK |
/// | ACCEL_CONFIG0 0x1B | 0x19 | the same codes: Betaflight, Linux, TDK |
/// | INT1_CONFIG0 0x16 | 0x02 | the same bit: Linux, TDK, Zephyr |
/// | FIFO_CONFIG3 0x21 | 0x06, then 0x07 | the same bits and order: Linux, TDK |
/// | PWR_MGMT0 0x10 | 0x0F, last | the same: Betaflight |
///
/// The packets are those of the [`ICM_42688_P`](super::ICM_42688_P) in little endian, as in Linux. The FIFO's count is
/// read twice, and its newest packet is left, as the errata demand.
///
/// Not verified: data sheet and errata were not at hand. The order of the low pass is not known; the largest noise
/// bandwidth, that of a first order, is stated, and the default low pass is narrow enough for it. The sensitivities
/// are those of the ICM-42688-P for the same range. Whether the adaptive full-scale range is off after reset (IPREG_SYS1_REG_166, bits 4 and 3) is not
/// known. The tick of 16 µs · 32/30 is PX4's; if it is another one, it is learned from the stamps.
pub static ICM_45686: Description = checked(icm_45686(Configuration::new(100, 250)));
