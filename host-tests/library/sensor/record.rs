//! Samples on their way to accumulators: flags, overruns, failing buses, and other drivers.

use super::sheet::{Sheet, start};
use allanite::sensor::{BMI160, Error, L3GD20, MPU_6050};
use allanite::{Accumulator, Axes};
use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource};
use embedded_hal_mock::eh1::i2c::Mock as I2cMock;

/// Three axes without other parts.
type Three = Axes<8, 0, (), ()>;

#[test]
fn no_sample_is_read_before_the_flag_is_up() {
    let sheet = Sheet::of(&BMI160);
    // All other flags are set.
    let turn = sheet.i2c_read(sheet.status, vec![!sheet.ready]);
    let (mut imu, mut mock) = start(sheet, [turn]);
    let outcome = imu.read();
    assert_eq!(outcome, Ok(None));
    let mut axes = Three::new();
    assert!(!axes.record_outcome(&outcome, |_| []));
    assert_eq!(axes, Three::new());
    mock.done();
}

#[test]
fn an_overrun_is_a_gap_before_the_sample() {
    let sheet = Sheet::of(&L3GD20);
    let samples = [(0x08, 5), (0x08, 7), (0x88, 100), (0x08, 101)];
    let turns = samples.map(|(flags, count)| sheet.i2c_sample(flags, [count; 3]));
    let (mut imu, mut mock) = start(sheet, turns.into_iter().flatten());
    let (mut axes, mut expected) = (Three::new(), Accumulator::<8>::new());
    for (flags, count) in samples {
        assert!(axes.record_outcome(&imu.read(), |_| []));
        if flags & 0x80 != 0 {
            expected.gap();
        }
        expected.push(count.into());
    }
    mock.done();
    assert_eq!(axes.losses(), 1);
    // No difference spans the gap, so the sums are (7 − 5)² + (101 − 100)².
    assert_eq!(expected.octave(0).unwrap().differences, 2);
    assert_eq!(axes.accumulators(), [(); 3].map(|()| &expected));
}

#[test]
fn a_bus_error_within_a_record_only_causes_a_gap() {
    let sheet = Sheet::of(&MPU_6050);
    let count = |n: i16| [n * n, -3 * n, 7];
    let nack = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);
    let mut turns = Vec::new();
    for n in 0..60 {
        let [status, block] = sheet.i2c_sample(sheet.ready, count(n));
        match n {
            // Without an answer there is no flag, so that no sample is read.
            20 => turns.push(status.with_error(nack)),
            40 | 41 => turns.extend([status, block.with_error(ErrorKind::Bus)]),
            _ => turns.extend([status, block]),
        }
    }
    let (mut imu, mut mock) = start(sheet, turns);
    let mut axes = Three::new();
    let mut expected = [(); 3].map(|()| Accumulator::<8>::new());
    for n in 0..60 {
        let before = axes.accumulators().map(Clone::clone);
        let outcome = imu.read();
        let failed = match n {
            20 => Some((0x3A, nack)),
            40 | 41 => Some((0x41, ErrorKind::Bus)),
            _ => None,
        };
        assert_eq!(axes.record_outcome(&outcome, |_| []), failed.is_none());
        if let Some((register, error)) = failed {
            assert_eq!(outcome, Err(Error::Bus { register, error }));
            for (now, before) in axes.accumulators().into_iter().zip(&before) {
                assert!(now.octaves().eq(before.octaves()), "what was summed stays");
                assert_eq!(now.samples(), before.samples());
            }
        }
        for (accumulator, count) in expected.iter_mut().zip(count(n)) {
            match failed {
                Some(_) => accumulator.gap(),
                None => accumulator.push(count.into()),
            }
        }
    }
    mock.done();
    assert_eq!(axes.accumulators(), expected.each_ref());
    assert_eq!(axes.losses(), 3);
    let [x, _, _] = axes.accumulators();
    assert_eq!((x.samples(), x.gaps()), (57, 2));
}

#[test]
fn samples_of_another_driver_are_pushed_by_hand() {
    use bmi160::{Bmi160, SensorSelector, SlaveAddr};
    let sheet = Sheet::of(&BMI160);
    let counts = |n: i16| [n, -n * n, 3];
    let bytes = |n| sheet.block(counts(n))[..6].to_vec();
    let turns: Vec<_> = (0..50).map(|n| sheet.i2c_read(0x0C, bytes(n))).collect();
    let mut driver = Bmi160::new_with_i2c(I2cMock::new(&turns), SlaveAddr::default());

    let (mut x, mut axes) = (Accumulator::<8>::new(), Three::new());
    for _ in 0..50 {
        let gyro = driver
            .data(SensorSelector::new().gyro())
            .unwrap()
            .gyro
            .unwrap();
        x.push(gyro.x.into());
        axes.push([gyro.x, gyro.y, gyro.z].map(i32::from));
    }
    driver.destroy().done();

    let mut expected = [(); 3].map(|()| Accumulator::<8>::new());
    for n in 0..50 {
        for (accumulator, count) in expected.iter_mut().zip(counts(n)) {
            accumulator.push(count.into());
        }
    }
    assert_eq!(x, expected[0]);
    assert_eq!(axes.accumulators(), expected.each_ref());
}
