use super::{
    ByteOrder, Configuration, ConfigurationError, Description, Fifo, Filter, Format, Interface,
    Signal, Status, Temperature, Write, Writes,
    configuration::{LowPass, Offer, checked},
};
use crate::numerics::real::Real;

/// The rates and ranges (14.37) with their codes, and the sensitivities (section 3.1, table 1). From 2 kHz on, the
/// anti-alias filter shapes the spectrum as well; at 12.5 Hz and below, no low pass is narrow enough.
const OFFER: Offer<6, 8> = Offer {
    sensor: "ICM-42688-P",
    rates: [
        (25, 0x0A),
        (50, 0x09),
        (100, 0x08),
        (200, 0x07),
        (500, 0x0F),
        (1000, 0x06),
    ],
    ranges: [
        (15, 7, 1.0 / 2097.2),
        (31, 6, 1.0 / 1048.6),
        (62, 5, 1.0 / 524.3),
        (125, 4, 1.0 / 262.0),
        (250, 3, 1.0 / 131.0),
        (500, 2, 1.0 / 65.5),
        (1000, 1, 1.0 / 32.8),
        (2000, 0, 1.0 / 16.4),
    ],
    // 12 of the 128 packets are left for the time until the host reads.
    most: 116,
};

/// The low pass of `GYRO_UI_FILT_BW` = `code` (14.40), at max(400 Hz, rate)/`divisor`. The ratio of its noise bandwidth
/// to this cut-off is taken from the table at 100 Hz for the divisor 8. A wider filter is at most as
/// wide as its cut-off says, and a narrower one at most as a Butterworth filter of third order, π/3.
const fn low_pass(rate_hz: u16, code: u8, divisor: u16) -> LowPass {
    let base_hz = if rate_hz > 400 { rate_hz } else { 400 };
    let ratio = match divisor {
        8 => 0.962,
        0..8 => 1.011,
        _ => 1.048,
    };
    LowPass {
        code,
        bandwidth_hz: base_hz / divisor,
        filter: Filter {
            noise_bandwidth_hz: ratio * base_hz as Real / divisor as Real,
            poles: 3,
        },
        is_tight: true,
    }
}

/// The description of an ICM-42688-P with another configuration than that of [`ICM_42688_P`], whose documentation
/// lists the registers.
///
/// * Rates: 25, 50, 100, 200, 500 and 1000 Hz, in low-noise mode.
/// * Ranges: 15 (15.625), 31 (31.25), 62 (62.5), 125, 250, 500, 1000 and 2000 °/s.
/// * Low passes: max(400 Hz, rate) divided by 4, 5, 8, 10, 16, 20 or 40.
/// * Watermark: 1 to 116 samples.
///
/// # Errors
/// [`ConfigurationError`] for all else, and for a low pass whose noise would fold back.
pub const fn icm_42688_p(wanted: Configuration) -> Result<Description, ConfigurationError> {
    let rate_hz = wanted.rate_hz();
    let low_passes = [
        low_pass(rate_hz, 1, 4),
        low_pass(rate_hz, 2, 5),
        low_pass(rate_hz, 3, 8),
        low_pass(rate_hz, 4, 10),
        low_pass(rate_hz, 5, 16),
        low_pass(rate_hz, 6, 20),
        low_pass(rate_hz, 7, 40),
    ];
    let chosen = match OFFER.choose(wanted, &low_passes) {
        Ok(chosen) => chosen,
        Err(refusal) => return Err(refusal),
    };
    let [watermark_low, watermark_high] = (chosen.watermark * 16).to_le_bytes();
    let fifo = Fifo {
        set_up: Writes::of([
            // TMST_CONFIG (14.42): TMST_RES (16 µs) and TMST_EN, without FSYNC and without differences; bit 5 is
            // reserved and 1 after reset.
            Write::new(0x54, 0x29),
            // FIFO_CONFIG1 (14.45): FIFO_WM_GT_TH, so that the pin signals at every sample beyond the watermark;
            // FIFO_TEMP_EN, FIFO_GYRO_EN and FIFO_ACCEL_EN, which make packet 3, the one with 16 bits and a time.
            Write::new(0x5F, 0x27),
            // FIFO_CONFIG2 and FIFO_CONFIG3 (14.46, 14.47): the watermark in bytes.
            Write::new(0x60, watermark_low),
            Write::new(0x61, watermark_high),
            // ACCEL_CONFIG0 (14.38): ±16 g at the rate of the gyro, so that every packet has both.
            Write::new(0x50, chosen.rate),
            // INT_SOURCE0 (14.51): FIFO_THS_INT1_EN instead of UI_DRDY_INT1_EN.
            Write::new(0x65, 0x04),
            // FIFO_CONFIG (14.4): FIFO_MODE 0b01, stream to FIFO.
            Write::new(0x16, 0x40),
        ]),
        turn_on: Writes::of([
            // PWR_MGMT0 (14.36): ACCEL_MODE 0b11 (low noise) as well; the accelerometer settles.
            Write::new(0x4E, 0x0F).wait_us(50_000),
        ]),
        flush: Writes::of([
            // SIGNAL_PATH_RESET (14.33): FIFO_FLUSH.
            Write::new(0x4B, 0x02),
        ]),
        // INT_STATUS (14.21), FIFO_COUNTH and FIFO_COUNTL, FIFO_DATA (14.22 to 14.24).
        count: 0x2D,
        data: 0x30,
        format: Format::Icm426xx,
        // Section 6: 2 kB.
        capacity: 128,
        time_bits: 16,
        // 16 µs · 32/30.
        tick_ps: 17_066_667,
        // 1 s / rate / (16 µs · 32/30) · 256.
        interval: 15_000_000 / chosen.rate_hz as u32,
        signal: Signal::Falling,
    };
    Ok(Description {
        name: "ICM-42688-P",
        // WHO_AM_I (section 14.58).
        identity: 0x75,
        identities: &[0x47],
        upload: None,
        start_up: Writes::of([
            // DEVICE_CONFIG (14.1): SOFT_RESET_CONFIG, done within 1 ms.
            Write::new(0x11, 0x01).wait_us(2_000),
            // INTF_CONFIG0 (14.34): UI_SIFS_CFG 0b11, no I²C; the rest as after reset, with big endian.
            Write::new(0x4C, 0x33).spi_only(),
            // DRIVE_CONFIG (14.2): I2C_SLEW_RATE 1 and SPI_SLEW_RATE 1, as section 12.3 demands for I²C.
            Write::new(0x13, 0x09).i2c_only(),
            // INTF_CONFIG6 (15.19) in bank 1: I3C_SDR_EN and I3C_DDR_EN 0, as section 12.3 demands for I²C.
            Write::new(0x76, 0x01).i2c_only(),
            Write::new(0x7C, 0x5C).i2c_only(),
            Write::new(0x76, 0x00).i2c_only(),
            // INTF_CONFIG1 (14.35): bits 7 and 6 from 0b10 to 0b01, the rest as after reset. This disables the
            // adaptive full-scale range, which repeats samples for 1 to 2 ms when the rate passes about 100 °/s.
            // The data sheet calls the bits reserved: see ArduPilot's pull request 25332 and Betaflight's 13132.
            Write::new(0x4D, 0x51),
            // GYRO_CONFIG0 (14.37): GYRO_FS_SEL, GYRO_ODR.
            Write::new(0x4F, chosen.range << 5 | chosen.rate),
            // GYRO_CONFIG1 (14.39): GYRO_UI_FILT_ORD 0b10 (third order), the rest as after reset.
            Write::new(0x51, 0x1A),
            // GYRO_ACCEL_CONFIG0 (14.40): GYRO_UI_FILT_BW, at 100 Hz 3, max(400 Hz, rate)/8. After reset it is 1, 100 Hz,
            // which is the output rate: then noise folds onto frequency zero and raises N by a third.
            Write::new(0x52, 0x10 | chosen.low_pass.code),
            // FSYNC_CONFIG (14.48): FSYNC_UI_SEL 0. After reset the flag replaces the temperature's lowest bit.
            Write::new(0x62, 0x00),
            // INT_CONFIG1 (14.50): INT_ASYNC_RESET 0, "for proper INT1 and INT2 pin operation" (12.6).
            Write::new(0x64, 0x00),
            // INT_SOURCE0 (14.51): UI_DRDY_INT1_EN, so that the data-ready flag is certain to be raised.
            Write::new(0x65, 0x08),
            // PWR_MGMT0 (14.36): GYRO_MODE 0b11 (low noise). The registers above are written while the gyro is
            // off (12.9). No write within 200 µs; the gyro settles.
            Write::new(0x4E, 0x0C).wait_us(100_000),
        ]),
        // The address with the AP_AD0 pin at ground (section 9.3).
        interface: Interface::usual(0x68),
        // INT_STATUS (14.21): DATA_RDY_INT, bit 3. Reading it clears it, reading the sample does not.
        status: Status {
            register: 0x2D,
            ready: 1 << 3,
            overrun: 0,
        },
        // INT_CONFIG (14.3) after reset: INT1 gives pulses, open drain and active low.
        signal: Some(Signal::Falling),
        // GYRO_DATA_X1 (14.13).
        gyro: 0x25,
        // TEMP_DATA1 (14.5); section 4.13: °C = TEMP_DATA / 132.48 + 25.
        temperature: Some(Temperature {
            register: 0x1D,
            at_zero_c: 25.0,
            counts_per_k: 132.48,
        }),
        // INTF_CONFIG0 (14.34): SENSOR_DATA_ENDIAN is 1 after reset.
        byte_order: ByteOrder::BigEndian,
        scale_dps: chosen.scale_dps,
        rate_hz: chosen.rate_hz as Real,
        // Section 5.5, tables of the third order at 100 Hz for GYRO_UI_FILT_BW 3: noise bandwidth 48.1 Hz, 47.6 Hz
        // at −3 dB. It runs at 400 Hz; folded noise raises N by 0.4 %.
        filter: chosen.low_pass.filter,
        fifo: Some(fifo),
    })
}

/// TDK InvenSense ICM-42688-P, ±250 °/s at 100 Hz in low-noise mode, behind a low pass of third order at
/// 47.6 Hz.
///
/// Source: data sheet DS-000347 (revision 1.5, 2021), by section; registers by the names they have there.
///
/// | register | value | data sheet | public drivers |
/// |---|---|---|---|
/// | DEVICE_CONFIG 0x11 | 0x01 | 14.1 | the same: Betaflight, Linux, Zephyr |
/// | INTF_CONFIG0 0x4C (SPI) | 0x33 | 14.34 | the same: Linux |
/// | DRIVE_CONFIG 0x13, INTF_CONFIG6 0x7C of bank 1 (I²C) | 0x09, 0x5C | 12.3, 14.2, 15.19 | the same: Linux |
/// | INTF_CONFIG1 0x4D | 0x51 | 14.35, where bits 7 and 6 are reserved | bits 7 and 6 the same: ArduPilot, Betaflight, PX4; Zephyr leaves them |
/// | GYRO_CONFIG0 0x4F | 0x68 | 14.37 | the same codes: Linux, Zephyr |
/// | GYRO_CONFIG1 0x51 | 0x1A | 14.39 | PX4 chooses first order; the others leave the second |
/// | GYRO_ACCEL_CONFIG0 0x52 | 0x13 | 5.5, 14.40 | Linux and PX4 choose half the rate, Betaflight low latency |
/// | FSYNC_CONFIG 0x62 | 0x00 | 14.48 | the same: Zephyr |
/// | INT_CONFIG1 0x64 | 0x00 | 12.6, 14.50 | bit 4 the same: Betaflight, Zephyr |
/// | INT_SOURCE0 0x65 | 0x08 | 14.51 | the same: Betaflight, Zephyr |
/// | PWR_MGMT0 0x4E | 0x0C, last | 12.9, 14.36 | low noise: Betaflight, PX4 |
///
/// The FIFO needs these as well, and the accelerometer on, because only packets with both have a time:
///
/// | register | value | data sheet | public drivers |
/// |---|---|---|---|
/// | TMST_CONFIG 0x54 | 0x29 | 14.42 | the same bits: PX4 |
/// | FIFO_CONFIG1 0x5F | 0x27 | 14.45 | the same bits: Linux, PX4; PX4 adds the extension to 20 bits |
/// | FIFO_CONFIG2 0x60, FIFO_CONFIG3 0x61 | 128, 0 | 14.46, 14.47 | in bytes too: Linux, PX4 |
/// | ACCEL_CONFIG0 0x50 | 0x08 | 14.38 | the same codes: Linux, PX4 |
/// | INT_SOURCE0 0x65 | 0x04 | 14.51 | the same: Linux, PX4 |
/// | FIFO_CONFIG 0x16 | 0x40 | 14.4 | the same: Linux; PX4 stops when full |
/// | PWR_MGMT0 0x4E | 0x0F, last | 14.36 | the same: Betaflight, PX4 |
/// | SIGNAL_PATH_RESET 0x4B | 0x02 empties it | 14.33 | the same: Linux, PX4 |
///
/// A packet has the header 0x68 and two bits, accelerometer, gyro, 8 bits of temperature and 16 bits of time (6.1,
/// "Packet 3"), as in Linux. The time counts 16 µs · 32/30 if no clock is given to the sensor, as in PX4.
///
/// These registers keep their reset values: the anti-alias filter (585 Hz) and the notch filter are on
/// (section 15.2), INT1 gives a pulse, open drain and active low (14.3), and the temperature has a
/// bandwidth of 4 kHz (14.39).
///
/// Not verified: the bits of register 0x4D are documented only by those who found them. The filter's
/// tables are the manufacturer's; nobody measured them here. The sections of the FIFO's registers follow from
/// the order of the registers. The factor 32/30 could not be compared with the data sheet; if it is another one, it
/// is learned from the stamps. Of the low passes' noise bandwidths, only that at 100 Hz was at hand.
pub static ICM_42688_P: Description = checked(icm_42688_p(Configuration::new(100, 250)));
