//! Bags whose messages say that a sensor is not measured.

use super::{ACCELEROMETER, GYRO, assert_sums, counts, of, try_read};
use allanite_log::{Options, unit::Sensor};
use std::{fs, path::Path};
use tempfile::TempDir;

/// Puts −1 into the first element of the covariance behind each vector of a sensor in a bag that is not packed, but in the first
/// messages. The vectors of a sensor begin at a place in the rows of the generator.
fn mark(bytes: &mut [u8], first: usize, scale: f64, spared: usize) {
    for row in counts().iter().skip(spared) {
        let vector: Vec<u8> = (first..first + 3)
            .flat_map(|axis| (f64::from(row[axis]) * scale).to_le_bytes())
            .collect();
        let found = bytes.windows(vector.len()).position(|part| part == vector);
        let Some(place) = found else {
            continue;
        };
        bytes[place + 24..][..8].copy_from_slice(&(-1.0_f64).to_le_bytes());
    }
}

/// The definition of `sensor_msgs/Imu`, of ROS 1 and of ROS 2, says: if there is no estimate of one of the data elements, element 0
/// of its covariance matrix is −1.
#[test]
fn a_quantity_without_an_estimate_is_refused_and_the_other_read() {
    let origins = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures/origins");
    let folder = TempDir::new().unwrap();
    let gyro = (
        0,
        GYRO,
        "angular velocity",
        "accelerometer with --sensor accel",
    );
    let forces = (
        3,
        ACCELEROMETER,
        "linear acceleration",
        "gyro with --sensor gyro",
    );
    for name in ["humble.db3", "ros1.bag"] {
        let good = fs::read(origins.join(name)).unwrap();
        let path = folder.path().join(name);
        for (first, scale, quantity, other) in [gyro, forces] {
            let mut marked = good.clone();
            mark(&mut marked, first, scale, 0);
            fs::write(&path, &marked).unwrap();
            let (this, rest) = match first {
                0 => (Sensor::Gyro, Sensor::Accelerometer),
                _ => (Sensor::Accelerometer, Sensor::Gyro),
            };
            let line = try_read(&path, &of(this)).unwrap_err();
            let (what, remedy) = line.split_once("; ").unwrap();
            let expected = format!(
                "say that there is no estimate of the {quantity}: the first element of its covariance is -1"
            );
            assert!(what.ends_with(&expected), "{line}");
            let expected = format!(
                "read the {other}, or record with a driver that measures it, or export it as text if this driver does"
            );
            assert_eq!(remedy, expected);
            let log = try_read(&path, &of(rest)).unwrap();
            let samples = log.axes[0].accumulator.samples() as usize;
            let rows = counts();
            let (first, scale, _, _) = if first == 0 { forces } else { gyro };
            assert_sums(&log, rows[..samples].iter(), first, scale, name);

            // One message with an estimate is enough.
            let mut marked = good.clone();
            let (first, scale, _, _) = if this == Sensor::Gyro { gyro } else { forces };
            mark(&mut marked, first, scale, 1);
            fs::write(&path, &marked).unwrap();
            let log = try_read(&path, &of(this)).unwrap();
            assert_sums(&log, rows[..samples].iter(), first, scale, name);
        }
        // With neither, there is nothing to read.
        let mut marked = good.clone();
        for (first, scale, _, _) in [gyro, forces] {
            mark(&mut marked, first, scale, 0);
        }
        fs::write(&path, &marked).unwrap();
        let line = try_read(&path, &Options::default()).unwrap_err();
        assert!(
            line.ends_with(
                "; record with a driver that measures it, or export it as text if this driver does"
            ),
            "{line}"
        );
    }
}
