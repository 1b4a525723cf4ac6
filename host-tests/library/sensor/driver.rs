//! The set-ups of published drivers, register by register, beside those of this library for the same rate and
//! range. What differs is named with its reason, and a difference that is not named fails.

use super::chip::Kind;
use super::wire::{NoDelay, Wire};
use allanite::sensor::{
    Configuration, Description, FifoImu, Imu, icm_42688_p, icm_45686, lsm6dso, lsm6dsv16x,
};
use std::collections::BTreeMap;

/// The last value of every register; indirect registers by their 16-bit address.
type Registers = BTreeMap<u16, u8>;

/// A register, the bits that are compared, and the driver's value.
type Setting = (u16, u8, u8);

/// A register that is set otherwise here, or by only one of the two, and why.
type Difference = (u16, &'static str);

struct Driver {
    name: &'static str,
    kind: Kind,
    description: Description,
    with_fifo: bool,
    settings: &'static [Setting],
    differences: &'static [Difference],
}

const fn described(
    result: Result<Description, allanite::sensor::ConfigurationError>,
) -> Description {
    match result {
        Ok(description) => description,
        Err(_) => panic!("refused"),
    }
}

/// Betaflight's `accgyro_spi_lsm6dsv16x.c`, function `lsm6dsv16xGyroInit`, at 2000 °/s.
const BETAFLIGHT_LSM6DSV16X: Driver = Driver {
    name: "Betaflight, LSM6DSV16X",
    kind: Kind::Lsm6dsv16x,
    description: described(lsm6dsv16x(Configuration::new(480, 2000))),
    with_fifo: false,
    settings: &[
        // BDU and IF_INC, after SW_RESET.
        (0x12, 0xFF, 0x44),
        (0x62, 0x03, 0x01),
        (0x10, 0xFF, 0x09),
        // ODR_G for 8 kHz.
        (0x11, 0xFF, 0x0C),
        (0x17, 0xFF, 0x03),
        // FS_G 2000 °/s; LPF1_G_BW 0.
        (0x15, 0xFF, 0x04),
        (0x16, 0xFF, 0x01),
        (0x13, 0xFF, 0x02),
        (0x0D, 0xFF, 0x02),
    ],
    differences: &[
        (
            0x62,
            "HAODR_CFG: the rates of the high-accuracy mode are not described",
        ),
        (0x10, "CTRL1: the accelerometer stays off"),
        (
            0x11,
            "CTRL2: another rate, because LPF2 is not documented at 8 kHz",
        ),
        (0x17, "CTRL8: the accelerometer's range"),
        (0x16, "CTRL7: LPF1 stays off, because LPF2 suffices"),
        (
            0x13,
            "CTRL4: the data-ready pin is a level, which cannot be missed",
        ),
        (
            0x03,
            "IF_CFG: I²C is off on SPI, so that noise on the bus does not wake it",
        ),
    ],
};

/// ST's example `lsm6dsv16x_fifo.c` of STMems_Standard_C_drivers, at 2000 °/s and 15 Hz.
const ST_LSM6DSV16X: Driver = Driver {
    name: "ST's example, LSM6DSV16X",
    kind: Kind::Lsm6dsv16x,
    description: described(lsm6dsv16x(Configuration::new(30, 2000).watermark(32))),
    with_fifo: true,
    settings: &[
        // BDU; IF_INC is set after reset.
        (0x12, 0x40, 0x40),
        // FS_G 2000 °/s.
        (0x15, 0x0F, 0x04),
        // The watermark is 64 words.
        (0x07, 0xFF, 64),
        // BDR_GY for 15 Hz, BDR_XL for 60 Hz.
        (0x09, 0xFF, 0x35),
        // Stream mode, a time with every eighth sample, no temperature.
        (0x0A, 0x07, 0x06),
        (0x0A, 0xC0, 0x80),
        (0x11, 0x0F, 0x03),
        (0x10, 0x0F, 0x05),
        // TIMESTAMP_EN.
        (0x50, 0x40, 0x40),
    ],
    differences: &[
        (0x09, "FIFO_CTRL3: another rate, and no accelerometer"),
        (
            0x0A,
            "FIFO_CTRL4: a time with every sample, and the temperature",
        ),
        (0x10, "CTRL1: the accelerometer stays off"),
        (0x11, "CTRL2: another rate"),
        (0x03, "IF_CFG: I²C is off on SPI"),
        (0x08, "FIFO_CTRL2: the value after reset"),
        (0x0D, "INT1_CTRL: the example polls"),
    ],
};

/// Betaflight's `accgyro_spi_icm426xx.c`, function `icm426xxGyroInit`, at 1 kHz and 2000 °/s.
const BETAFLIGHT_ICM_42688_P: Driver = Driver {
    name: "Betaflight, ICM-42688-P",
    kind: Kind::Icm42688P,
    description: described(icm_42688_p(Configuration::new(1000, 2000))),
    with_fifo: true,
    settings: &[
        // Soft reset.
        (0x11, 0xFF, 0x01),
        // Both sensors in low-noise mode.
        (0x4E, 0xFF, 0x0F),
        // Low latency for both.
        (0x52, 0xFF, 0xFF),
        // Pulses, push-pull, active high.
        (0x14, 0xFF, 0x03),
        (0x63, 0xFF, 0x00),
        (0x65, 0xFF, 0x08),
        // INT_ASYNC_RESET off; longer pulses.
        (0x64, 0x10, 0x00),
        // The adaptive full-scale range off.
        (0x4D, 0xC0, 0x40),
        (0x4F, 0xFF, 0x06),
        (0x50, 0xFF, 0x06),
    ],
    differences: &[
        (
            0x52,
            "GYRO_ACCEL_CONFIG0: a low pass against folding, not low latency",
        ),
        (0x14, "INT_CONFIG: the values after reset"),
        (0x63, "INT_CONFIG0: the value after reset"),
        (0x65, "INT_SOURCE0: the pin signals the FIFO's watermark"),
        (0x4C, "INTF_CONFIG0: I²C is off on SPI"),
        (0x51, "GYRO_CONFIG1: third order"),
        (0x62, "FSYNC_CONFIG: no flag in the temperature"),
        (0x54, "TMST_CONFIG: Betaflight has no FIFO"),
        (0x5F, "FIFO_CONFIG1: Betaflight has no FIFO"),
        (0x60, "FIFO_CONFIG2: Betaflight has no FIFO"),
        (0x61, "FIFO_CONFIG3: Betaflight has no FIFO"),
        (0x16, "FIFO_CONFIG: Betaflight has no FIFO"),
        (0x4B, "SIGNAL_PATH_RESET: Betaflight has no FIFO"),
    ],
};

/// PX4's `ICM42688P.hpp`, `_register_bank0_cfg`, of the first version, at 8 kHz and 2000 °/s; and its
/// `FIFOReset`.
const PX4_ICM_42688_P: Driver = Driver {
    name: "PX4, ICM-42688-P",
    kind: Kind::Icm42688P,
    description: described(icm_42688_p(Configuration::new(1000, 2000))),
    with_fifo: true,
    settings: &[
        (0x11, 0xFF, 0x01),
        // Latched, push-pull, active low.
        (0x14, 0x07, 0x06),
        (0x16, 0xC0, 0xC0),
        (0x4E, 0x0F, 0x0F),
        (0x4F, 0xEF, 0x03),
        (0x50, 0xEF, 0x03),
        // FIFO_WM_GT_TH, FIFO_GYRO_EN, FIFO_ACCEL_EN.
        (0x5F, 0x23, 0x23),
        (0x63, 0x08, 0x08),
        (0x65, 0x04, 0x04),
        // FIFO_FLUSH.
        (0x4B, 0x02, 0x02),
    ],
    differences: &[
        (0x14, "INT_CONFIG: pulses, as after reset"),
        (0x16, "FIFO_CONFIG: the newest samples stay, not the oldest"),
        (0x4F, "GYRO_CONFIG0: another rate"),
        (0x50, "ACCEL_CONFIG0: another rate"),
        (
            0x63,
            "INT_CONFIG0: the value after reset; pulses need no clearing",
        ),
        (0x4C, "INTF_CONFIG0: I²C is off on SPI"),
        (
            0x4D,
            "INTF_CONFIG1: the adaptive full-scale range off, as later versions do",
        ),
        (0x51, "GYRO_CONFIG1: third order"),
        (0x52, "GYRO_ACCEL_CONFIG0: a low pass against folding"),
        (0x62, "FSYNC_CONFIG: no flag in the temperature"),
        (0x64, "INT_CONFIG1: as the data sheet demands"),
        (
            0x54,
            "TMST_CONFIG: steps of 16 µs, so that the time wraps later",
        ),
        (0x60, "FIFO_CONFIG2: the watermark is set at run time"),
        (0x61, "FIFO_CONFIG3: the watermark is set at run time"),
    ],
};

/// Betaflight's `accgyro_spi_icm456xx.c`, functions `icm456xxGyroInit` and `icm456xxSpiDetect`.
const BETAFLIGHT_ICM_45686: Driver = Driver {
    name: "Betaflight, ICM-45686",
    kind: Kind::Icm45686,
    description: described(icm_45686(Configuration::new(1600, 2000))),
    with_fifo: false,
    settings: &[
        (0x7F, 0xFF, 0x02),
        (0x10, 0xFF, 0x0F),
        (0x1B, 0xFF, 0x15),
        // The bits 1 and 0, where TDK's driver has 6 and 5.
        (0xA4A6, 0x03, 0x03),
        // A sixteenth of the rate.
        (0xA4AC, 0x07, 0x03),
        // 6.4 kHz.
        (0x1C, 0xFF, 0x13),
        (0x18, 0xFF, 0x01),
        (0x16, 0xFF, 0x04),
    ],
    differences: &[
        (0x10, "PWR_MGMT0: the accelerometer stays off"),
        (0x1B, "ACCEL_CONFIG0: the accelerometer stays off"),
        (0xA4A6, "IPREG_SYS1_REG_166: the bits of TDK's driver"),
        (0x1C, "GYRO_CONFIG0: another rate"),
    ],
};

/// TDK's motion.mcu.icm45686.driver, function `inv_imu_set_fifo_config`, for gyro and accelerometer and the
/// depth that is left beside its processor, with a watermark of 9 packets.
const TDK_ICM_45686: Driver = Driver {
    name: "TDK, ICM-45686",
    kind: Kind::Icm45686,
    description: described(icm_45686(Configuration::new(100, 250).watermark(8))),
    with_fifo: true,
    settings: &[
        // REG_MISC2: soft_rst.
        (0x7F, 0x02, 0x02),
        // FIFO_CONFIG0: stream, FIFO_CONFIG0_FIFO_DEPTH_APEX.
        (0x1D, 0xFF, 0x47),
        (0x1E, 0xFF, 9),
        (0x1F, 0xFF, 0),
        // FIFO_CONFIG2_FIFO_WR_WM_EQ_OR_GT_TH.
        (0x20, 0x08, 0x08),
        // fifo_if_en, fifo_accel_en, fifo_gyro_en; no fifo_hires_en.
        (0x21, 0x0F, 0x07),
        // fifo_tmst_fsync_en; no fifo_comp_en.
        (0x22, 0x06, 0x02),
        // tmst_en.
        (0xA258, 0x01, 0x01),
    ],
    differences: &[
        (0x10, "PWR_MGMT0: of other functions"),
        (0x16, "INT1_CONFIG0: of other functions"),
        (0x18, "INT1_CONFIG2: of other functions"),
        (0x1B, "ACCEL_CONFIG0: of other functions"),
        (0x1C, "GYRO_CONFIG0: of other functions"),
        (
            0x23,
            "TMST_WOM_CONFIG: steps of 16 µs, so that the time wraps later",
        ),
        (0xA4A6, "IPREG_SYS1_REG_166: of other functions"),
        (0xA4AC, "IPREG_SYS1_REG_172: of other functions"),
    ],
};

/// Betaflight's `accgyro_spi_lsm6dso_init.c`, function `lsm6dsoConfig`.
const BETAFLIGHT_LSM6DSO: Driver = Driver {
    name: "Betaflight, LSM6DSO",
    kind: Kind::Lsm6dso,
    description: described(lsm6dso(Configuration::new(416, 2000))),
    with_fifo: false,
    settings: &[
        (0x0D, 0xFF, 0x02),
        (0x0E, 0xFF, 0x02),
        (0x10, 0xFF, 0x74),
        // ODR_G 6.66 kHz, FS_G 2000 °/s.
        (0x11, 0xFF, 0xAC),
        (0x12, 0x7C, 0x44),
        (0x13, 0x06, 0x06),
        (0x15, 0x17, 0x00),
        (0x18, 0x02, 0x02),
    ],
    differences: &[
        (0x0E, "INT2_CTRL: one pin suffices"),
        (0x10, "CTRL1_XL: the accelerometer stays off"),
        (0x11, "CTRL2_G: another rate"),
        (0x13, "CTRL4_C: LPF1 stays off, because LPF2 suffices"),
        (0x15, "CTRL6_C: the value after reset"),
    ],
};

/// The last value of every register after a start over SPI.
fn started(driver: &Driver) -> Registers {
    let description: &'static Description = Box::leak(Box::new(driver.description));
    let wire = Wire::new(driver.kind);
    if driver.with_fifo {
        FifoImu::start(wire.spi(), description, &mut NoDelay).unwrap();
    } else {
        Imu::start(wire.spi(), description, &mut NoDelay).unwrap();
    }
    let (mut registers, mut page, mut low) = (Registers::new(), 0, 0);
    for &(register, value) in &wire.0.borrow().chip.writes {
        match (driver.kind, register) {
            (Kind::Icm45686, 0x7C) => page = value,
            (Kind::Icm45686, 0x7D) => low = value,
            (Kind::Icm45686, 0x7E) => {
                registers.insert(u16::from_be_bytes([page, low]), value);
            }
            _ => {
                registers.insert(register.into(), value);
            }
        }
    }
    registers
}

#[test]
fn set_ups_differ_from_published_drivers_only_where_it_is_stated() {
    for driver in [
        BETAFLIGHT_LSM6DSV16X,
        ST_LSM6DSV16X,
        BETAFLIGHT_ICM_42688_P,
        PX4_ICM_42688_P,
        BETAFLIGHT_ICM_45686,
        TDK_ICM_45686,
        BETAFLIGHT_LSM6DSO,
    ] {
        let name = driver.name;
        let here = started(&driver);
        let mut differing: Vec<u16> = Vec::new();
        let mut agreeing = 0;
        for &(register, mask, value) in driver.settings {
            match here.get(&register) {
                Some(here) if here & mask == value & mask => agreeing += 1,
                _ => differing.push(register),
            }
        }
        for &register in here.keys() {
            if driver.settings.iter().all(|setting| setting.0 != register) {
                differing.push(register);
            }
        }
        differing.sort_unstable();
        differing.dedup();
        let mut stated: Vec<u16> = driver.differences.iter().map(|it| it.0).collect();
        stated.sort_unstable();
        assert_eq!(differing, stated, "{name}: {here:02x?}");
        assert!(agreeing >= 3, "{name}: {agreeing}");
    }
}

/// The order matters where the data sheet or the driver says so.
#[test]
fn writes_come_in_the_order_that_drivers_keep() {
    let place = |kind: Kind, write: (u8, u8)| {
        let wire = Wire::new(kind);
        FifoImu::start(wire.spi(), kind.description(), &mut NoDelay).unwrap();
        let world = wire.0.borrow();
        let writes = &world.chip.writes;
        writes.iter().rposition(|&it| it == write).unwrap()
    };
    // DS-000347, 12.9: registers are written while the sensors are off, except for their modes.
    let kind = Kind::Icm42688P;
    for write in [(0x54, 0x29), (0x5F, 0x27), (0x16, 0x40), (0x65, 0x04)] {
        assert!(
            place(kind, write) < place(kind, (0x4E, 0x0C)),
            "{write:02x?}"
        );
    }
    assert!(place(kind, (0x4E, 0x0F)) < place(kind, (0x4B, 0x02)));
    // TDK's driver: first the mode, then fifo_if_en.
    let kind = Kind::Icm45686;
    assert!(place(kind, (0x21, 0x06)) < place(kind, (0x1D, 0x47)));
    assert!(place(kind, (0x1D, 0x47)) < place(kind, (0x21, 0x07)));
    // The FIFO is emptied after the gyro has settled.
    for (kind, settled) in [
        (Kind::Lsm6dso, (0x11, 0x40)),
        (Kind::Lsm6dsv16x, (0x11, 0x06)),
    ] {
        assert!(place(kind, settled) < place(kind, (0x0A, 0x60)));
        assert!(place(kind, (0x0A, 0x60)) < place(kind, (0x0A, 0x66)));
    }
}
