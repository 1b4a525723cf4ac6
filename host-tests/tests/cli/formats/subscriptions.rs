//! Topics of PX4 that are subscribed to more than once.

use super::{ROWS, assert_sums, counts, topic, try_read};
use allanite_log::{Log, Options};
use std::fs;
use tempfile::TempDir;

/// The size of a count, which is a power of two, so that every value is exact.
const GYRO: f64 = 1.0 / 1024.0;

fn message(kind: u8, content: &[u8]) -> Vec<u8> {
    [&(content.len() as u16).to_le_bytes()[..], &[kind], content].concat()
}

fn subscribed(identity: u16, instance: u8) -> Vec<u8> {
    let [low, high] = identity.to_le_bytes();
    message(
        b'A',
        &[&[instance, low, high], &b"sensor_gyro"[..]].concat(),
    )
}

/// The sample of a row at 200 Hz.
fn sample(identity: u16, row: usize) -> Vec<u8> {
    let stamp = 1_000_000 + 5000 * row as u64;
    let [x, y, z, ..] = counts()[row];
    let values = [x, y, z].map(|count| (f64::from(count) * GYRO) as f32);
    let values = values.map(f32::to_le_bytes).concat();
    let content = [&identity.to_le_bytes()[..], &stamp.to_le_bytes(), &values];
    message(b'D', &content.concat())
}

fn read(messages: &[Vec<u8>], options: &Options) -> Result<Log, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.ulg");
    let head = [&b"ULog\x01\x12\x35\x01"[..], &[0; 8]].concat();
    let format = message(
        b'F',
        b"sensor_gyro:uint64_t timestamp;float x;float y;float z;",
    );
    fs::write(&path, [head, format, messages.concat()].concat()).unwrap();
    try_read(&path, options)
}

/// The specification of ULog in PX4's user guide has a message R, which ends the subscription with a number. A new one of the same
/// topic and instance has another number.
#[test]
fn a_topic_that_is_subscribed_to_again_goes_on() {
    const END: usize = 30;
    let mut messages = vec![subscribed(3, 0)];
    messages.extend((0..END).map(|row| sample(3, row)));
    messages.push(message(b'R', &3_u16.to_le_bytes()));
    messages.push(subscribed(1, 0));
    messages.extend((END..ROWS).map(|row| sample(1, row)));
    for options in [
        Options::default(),
        topic("sensor_gyro"),
        topic("sensor_gyro:0"),
    ] {
        let log = read(&messages, &options).unwrap();
        assert_eq!(log.rate_hz, 200.0);
        assert_sums(&log, counts().iter(), 0, GYRO, "subscribed again");
        let note = format!("topic sensor_gyro:0 of {ROWS} messages");
        assert!(log.notes.contains(&note), "{:?}", log.notes);
    }
}

/// An instance is another sensor, whose samples are not mixed with those of the first.
#[test]
fn another_instance_stays_another_topic() {
    let mut messages = vec![subscribed(3, 0), subscribed(1, 1)];
    messages.extend((0..ROWS).flat_map(|row| [sample(3, row), sample(1, row)]));
    let line = read(&messages, &Options::default()).unwrap_err();
    assert!(
        line.contains("2 topics fit equally well: sensor_gyro:1, sensor_gyro:0"),
        "{line}"
    );
    let log = read(&messages, &topic("sensor_gyro:1")).unwrap();
    assert_sums(&log, counts().iter(), 0, GYRO, "instance 1");
}
