//! Bad logs of PX4.

use super::case::{Case, refused};
use std::{fs, path::Path};

fn message(kind: u8, content: &[u8]) -> Vec<u8> {
    [&(content.len() as u16).to_le_bytes()[..], &[kind], content].concat()
}

/// A log of these messages.
fn log(messages: &[Vec<u8>]) -> Vec<u8> {
    [&b"ULog\x01\x12\x35\x01"[..], &[0; 8], &messages.concat()].concat()
}

fn format(text: &str) -> Vec<u8> {
    message(b'F', text.as_bytes())
}

fn subscription(identity: u16, topic: &str) -> Vec<u8> {
    let identity = identity.to_le_bytes();
    message(b'A', &[&[0], &identity[..], topic.as_bytes()].concat())
}

fn data(identity: u16) -> Vec<u8> {
    message(b'D', &[&identity.to_le_bytes()[..], &[0; 20]].concat())
}

pub(crate) fn cases() -> Vec<Case> {
    let gyro = "sensor_gyro:uint64_t timestamp;float x;float y;float z;";
    // Each of thousands of topics has a format of thousands of fields.
    let many = (0..7000).flat_map(|i| [subscription(i, "wide"), data(i)]);
    let many: Vec<_> = [format("wide:float[4000] x;")]
        .into_iter()
        .chain(many)
        .collect();
    let raw = (0..7000).flat_map(|i| [subscription(i, "sensor_gyro"), data(i)]);
    let raw: Vec<_> = [format("sensor_gyro:float[4000] x;")]
        .into_iter()
        .chain(raw)
        .collect();
    let declared: Vec<_> = (0..16)
        .map(|i| format(&format!("f{i}:{}", "b x;".repeat(16_000))))
        .collect();
    let nested: Vec<_> = (0..8)
        .map(|i| format(&format!("n{i}:n{}[8] {};", i + 1, "x".repeat(200))))
        .chain([format("n8:float x;"), subscription(0, "n0"), data(0)])
        .collect();
    let newer = message(b'B', &[&[0; 8][..], &[2; 8], &[0; 24]].concat());
    let logs: Vec<(Vec<u8>, &str)> = table! {
        Vec::new() => "the file ends within its header";
        b"ULog".to_vec() => "the file ends within its header";
        vec![7; 200] => "this is not a ULog file";
        log(&[]) => "there are no messages at all";
        log(&[newer]) => "the log needs a newer version of ULog";
        log(&[message(b'B', &[0; 3])]) => "the message of flags is too short";
        log(&[format("no colon")]) => "a format has no name";
        log(&[format("f:float[x] y;")]) => "a field is malformed";
        log(&[format("f:float")]) => "a field is malformed";
        log(&[message(b'A', &[1])]) => "a subscription names no topic";
        log(&[subscription(0, &"x".repeat(300))]) => "a topic of more than 256 bytes";
        log(&[format(&format!("f:float {};", "x".repeat(300)))]) => "more than 256 bytes";
        log(&[message(b'D', &[1])]) => "no subscription number";
        log(&[subscription(0, "sensor_gyro"), data(0)]) => "is not defined";
        log(&[format(gyro), subscription(0, "sensor_gyro")]) => "there are no messages at all";
        log(&[format("other:float x;"), subscription(0, "other"), data(0)]) => "there are other:0";
        log(&[format("a\u{1b}[2J:float x;"), subscription(0, "a\u{1b}[2J"), data(0)]) => "there are a";
        log(&[format("sensor_gyro:empty[4294967295] x;"), format("empty:"), subscription(0, "sensor_gyro"), data(0)])
            => "format sensor_gyro is too long";
        log(&[format("sensor_gyro:sensor_gyro x;"), subscription(0, "sensor_gyro"), data(0)])
            => "format sensor_gyro is too long";
        log(&many) => "no topic of";
        log(&raw) => "a.ulg: ";
        log(&declared) => "the formats have more than 65536 fields";
        log(&nested) => "no topic of";
        log(&[format(gyro), subscription(0, "sensor_gyro"), data(0), data(0)]) => "a.ulg: ";
        log(&[format(gyro), vec![0xff, 0xff, b'D', 0, 0]]) => "ends before its first data message";
    };
    let case = |(bytes, expected)| refused("a.ulg", bytes, "fit a.ulg", expected);
    let mut cases: Vec<Case> = logs.into_iter().map(case).collect();
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    let good = |name: &str| fs::read(folder.join(name)).unwrap();
    let (two, none) = (good("two-gyros.ulg"), good("no-gyro.ulg"));
    cases.push(refused("a.ulg", none, "fit a.ulg", "no topic of"));
    cases.push(refused(
        "a.ulg",
        two,
        "fit a.ulg --topic none",
        "no topic \"none\" has messages",
    ));
    cases
}
