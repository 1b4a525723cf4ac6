//! Starts sensors over either bus, from the identity to the first sample, and checks why a start
//! may fail.

use super::sheet::{SHEETS, Sheet, start};
use allanite::sensor::{
    BMI160, ByteOrder, CATALOGUE, Description, Error, Filter, I2cBus, ICM_42688_P, Imu, Interface,
    LSM6DSO, MPU_6500, SpiBus, Status, Temperature, Writes,
};
use embedded_hal::i2c::ErrorKind;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::Mock as I2cMock;
use embedded_hal_mock::eh1::spi::{Mock as SpiMock, Transaction as SpiTurn};

/// A negative count, a positive one and the most negative one, so that swapped bytes or axes are
/// noticed.
const GYRO: [i16; 3] = [-2, 0x1234, i16::MIN];

#[test]
fn every_sensor_description_has_a_data_sheet() {
    let names: Vec<_> = SHEETS.iter().map(|sheet| sheet.description.name).collect();
    assert_eq!(names, CATALOGUE.map(|description| description.name));
}

#[test]
fn every_sensor_starts_and_reads_over_i2c() {
    for sheet in &SHEETS {
        let (mut imu, mut mock) = start(sheet, sheet.i2c_sample(sheet.ready, GYRO));
        assert_eq!(
            imu.read(),
            Ok(Some(sheet.reading(GYRO, false))),
            "{}",
            sheet.description.name
        );
        assert_eq!(imu.description(), sheet.description);
        imu.release().release();
        mock.done();
    }
}

#[test]
fn every_sensor_starts_and_reads_over_spi() {
    for sheet in &SHEETS {
        let mut turns = sheet.spi_start();
        turns.extend(sheet.spi_sample(sheet.ready, GYRO));
        let mut mock = SpiMock::new(&turns);
        // The device is lent to the source and can be used afterwards.
        let bus = SpiBus::new(&mut mock);
        let mut imu = Imu::start(bus, sheet.description, &mut NoopDelay).unwrap();
        assert_eq!(
            imu.read(),
            Ok(Some(sheet.reading(GYRO, false))),
            "{}",
            sheet.description.name
        );
        imu.release().release();
        mock.done();
    }
}

#[test]
fn start_up_waits_after_the_writes_that_need_it() {
    #[derive(Default)]
    struct Waits(Vec<u32>);
    impl embedded_hal::delay::DelayNs for Waits {
        fn delay_ns(&mut self, _: u32) {
            unreachable!("microseconds are enough")
        }
        fn delay_us(&mut self, us: u32) {
            self.0.push(us);
        }
    }
    let sheet = Sheet::of(&BMI160);
    let (mut waits, mut mock) = (Waits::default(), I2cMock::new(&sheet.i2c_start()));
    Imu::start(I2cBus::new(mock.clone()), &BMI160, &mut waits).unwrap();
    mock.done();
    assert_eq!(waits.0, [100_000, 450, 100_000]);
}

#[test]
fn another_address_is_used_throughout() {
    let sheet = Sheet {
        bus: (0x69, 0x80, 0),
        ..*Sheet::of(&ICM_42688_P)
    };
    let mut mock = I2cMock::new(&sheet.i2c_start());
    Imu::start(I2cBus::at(mock.clone(), 0x69), &ICM_42688_P, &mut NoopDelay).unwrap();
    mock.done();
}

#[test]
fn an_unknown_identity_ends_the_start() {
    let sheet = Sheet::of(&ICM_42688_P);
    let mut mock = I2cMock::new(&[sheet.i2c_read(0x75, vec![0x68])]);
    let error = Imu::start(I2cBus::new(mock.clone()), &ICM_42688_P, &mut NoopDelay).unwrap_err();
    mock.done();
    assert_eq!(
        error,
        Error::WrongIdentity {
            sensor: "ICM-42688-P",
            register: 0x75,
            found: 0x68,
            expected: &[0x47]
        }
    );
    let text = error.to_string();
    assert!(
        text.contains("0x68") && text.contains("0x47") && !text.contains('\n'),
        "{text}"
    );
}

#[test]
fn a_sibling_is_accepted_by_any_of_its_identities() {
    let sheet = Sheet {
        identity: (0x75, 0x71),
        ..*Sheet::of(&MPU_6500)
    };
    start(&sheet, []).1.done();
}

#[test]
fn a_failed_write_names_its_register_and_keeps_the_bus_error() {
    let sheet = Sheet::of(&LSM6DSO);
    let mut turns = sheet.i2c_start();
    turns.truncate(6);
    let last = turns.pop().unwrap();
    turns.push(last.with_error(ErrorKind::ArbitrationLoss));
    let mut mock = I2cMock::new(&turns);
    let error = Imu::start(I2cBus::new(mock.clone()), &LSM6DSO, &mut NoopDelay).unwrap_err();
    mock.done();
    let expected = Error::Bus {
        register: 0x11,
        error: ErrorKind::ArbitrationLoss,
    };
    assert_eq!(error, expected);
    assert!(
        error.to_string().contains("0x11 (ArbitrationLoss)"),
        "{error}"
    );
}

#[test]
fn a_description_too_wide_for_one_read_is_refused() {
    static WIDE: Description = Description {
        gyro: 0x60,
        ..BMI160_COPY
    };
    const BMI160_COPY: Description = Description {
        name: "wide",
        identity: 0,
        identities: &[0xD1],
        upload: None,
        start_up: Writes::NONE,
        interface: Interface {
            spi_read: 0x80,
            spi_dummies: 1,
            spi_wake: None,
            i2c_address: 0x68,
            i2c_read: 0,
        },
        status: Status {
            register: 0x1B,
            ready: 1,
            overrun: 0,
        },
        signal: None,
        gyro: 0,
        temperature: Some(Temperature {
            register: 0x20,
            at_zero_c: 0.0,
            counts_per_k: 1.0,
        }),
        byte_order: ByteOrder::LittleEndian,
        scale_dps: 1.0,
        rate_hz: 1.0,
        filter: Filter {
            noise_bandwidth_hz: 0.4,
            poles: 1,
        },
        fifo: None,
    };
    // A dummy byte follows the address.
    let read = |register: u8, answer| {
        [
            SpiTurn::transaction_start(),
            SpiTurn::write_vec(vec![register | 0x80, 0]),
            SpiTurn::read_vec(vec![answer]),
            SpiTurn::transaction_end(),
        ]
    };
    let mut mock = SpiMock::new(read(0, 0xD1).iter().chain(&read(0x1B, 0)));
    let error = Imu::start(SpiBus::new(&mut mock), &WIDE, &mut NoopDelay).unwrap_err();
    mock.done();
    let expected = Error::TooWide {
        sensor: "wide",
        registers: 0x66 - 0x20,
    };
    assert_eq!(error, expected);
}
