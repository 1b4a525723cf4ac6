//! Bad bags in MCAP files.

use super::case::{Case, refused};
use std::{fs, path::Path};

fn fixture(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    fs::read(folder.join(name)).unwrap()
}

const MAGIC: &[u8] = b"\x89MCAP0\r\n";

fn record(opcode: u8, content: &[u8]) -> Vec<u8> {
    long(opcode, content.len() as u64, content)
}

/// A record that claims a length.
fn long(opcode: u8, length: u64, content: &[u8]) -> Vec<u8> {
    [&[opcode], &length.to_le_bytes()[..], content].concat()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

/// A bag of these records.
fn bag(records: &[Vec<u8>]) -> Vec<u8> {
    [MAGIC, &records.concat()].concat()
}

fn header() -> Vec<u8> {
    record(1, &[text(""), text("")].concat())
}

fn schema(name: &[u8]) -> Vec<u8> {
    record(3, &[&[1, 0], name, &text("ros2msg"), &text("")].concat())
}

fn channel(topic: &[u8]) -> Vec<u8> {
    record(4, &[&[1, 0, 1, 0], topic, &text("cdr"), &text("")].concat())
}

fn message(channel: u8, content: &[u8]) -> Vec<u8> {
    record(5, &[&[channel, 0][..], &[0; 20], content].concat())
}

/// A chunk that claims to unpack to a size.
fn chunk(size: u64, compression: &str, packed: &[u8]) -> Vec<u8> {
    let mut content = vec![0; 16];
    content.extend(size.to_le_bytes());
    // A checksum of zero is not verified.
    content.extend([0; 4]);
    content.extend(text(compression));
    content.extend((packed.len() as u64).to_le_bytes());
    content.extend(packed);
    record(6, &content)
}

/// A frame of zstd that unpacks to blocks of 128 KiB, each of them zeros. Nine zeros are an empty record.
fn zeros(blocks: usize) -> Vec<u8> {
    // No checksum, no size, a window of 128 KiB.
    let mut frame = vec![0x28, 0xb5, 0x2f, 0xfd, 0x00, 0x38];
    for block in 0..blocks {
        let is_last = u32::from(block + 1 == blocks);
        let head = is_last | 1 << 1 | (1 << 17) << 3;
        frame.extend(&head.to_le_bytes()[..3]);
        frame.push(0);
    }
    frame
}

pub(crate) fn cases() -> Vec<Case> {
    let imu = || schema(&text("sensor_msgs/msg/Imu"));
    let ascii = b"eeee".to_vec();
    let mut bags: Vec<(String, Vec<u8>, &str)> = Vec::new();
    let mut add = |bytes: Vec<u8>, expected| bags.push(("a.mcap".into(), bytes, expected));
    add(Vec::new(), "the bag ends in the middle");
    add(b"MCAP".to_vec(), "a.mcap: ");
    add(vec![7; 200], "not an MCAP file");
    add(bag(&[]), "the bag ends in the middle");
    add(bag(&[header()]), "the bag ends in the middle");
    for opcode in [1, 3, 4, 5, 6, 7, 15, 99] {
        add(
            bag(&[header(), long(opcode, 1 << 28, &[0; 100])]),
            "a.mcap: ",
        );
        add(
            bag(&[header(), long(opcode, u64::MAX, &[0; 100])]),
            "a.mcap: ",
        );
    }
    add(
        bag(&[header(), schema(&ascii)]),
        "damaged: a record is too short",
    );
    add(
        bag(&[header(), imu(), channel(&ascii)]),
        "damaged: a record is too short",
    );
    add(
        bag(&[header(), record(3, &[1])]),
        "damaged: a record is too short",
    );
    add(
        bag(&[header(), record(4, &[1])]),
        "damaged: a record is too short",
    );
    add(
        bag(&[header(), record(5, &[1])]),
        "damaged: a record is too short",
    );
    add(
        bag(&[header(), record(11, &[1])]),
        "damaged: a record is too short",
    );
    add(bag(&[header(), message(9, &[])]), "damaged: ");
    add(
        bag(&[
            header(),
            imu(),
            channel(&text("/imu")),
            message(1, &[0, 1, 0, 0]),
        ]),
        "the bag ends in the middle",
    );
    add(
        bag(&[header(), chunk(1 << 60, "zstd", &zeros(1))]),
        "a.mcap: ",
    );
    add(
        bag(&[header(), chunk(1 << 27, "zstd", &zeros(1))]),
        "a.mcap: ",
    );
    add(
        bag(&[header(), chunk(1 << 17, "brotli", &zeros(1))]),
        "compressed with \"brotli\"",
    );
    // Half a megabyte unpacks to seventeen gigabytes of empty records.
    add(
        bag(&[header(), chunk(1 << 34, "zstd", &zeros(1 << 17))]),
        "a.mcap: ",
    );
    let pieces: Vec<Vec<u8>> = (0..800)
        .map(|_| chunk(36 << 17, "zstd", &zeros(36)))
        .collect();
    add(
        bag(&[header(), pieces.concat()]),
        "damaged: the chunks unpack to too many times their size",
    );
    add(bag(&[header(), chunk(100, "lz4", &[0xff; 64])]), "a.mcap: ");
    for name in ["imu-zstd.mcap", "imu-lz4.mcap", "imu-plain.mcap"] {
        let bytes = fixture(name);
        for part in [9, 100, bytes.len() / 2, bytes.len() - 9] {
            add(bytes[..part].to_vec(), "a.mcap: ");
        }
    }
    // The flips lie in the chunk of the packed bag, which a checksum covers.
    let packed = fixture("imu-zstd.mcap");
    for at in (60..packed.len() / 2).step_by(97) {
        let mut bytes = packed.clone();
        bytes[at] ^= 0x40;
        // Some bytes mean nothing to a reader, and then the log is good.
        bags.push((format!("flip{at}.mcap"), bytes, ""));
    }
    bags.push((
        "a.mcap".into(),
        fixture("no-imu.mcap"),
        "no topic of sensor_msgs/msg/Imu",
    ));
    bags.push((
        "a.mcap".into(),
        fixture("two-imus.mcap"),
        "there are 2 IMU topics",
    ));
    let case = |(name, bytes, expected): (String, Vec<u8>, &str)| {
        let case = refused(&name, bytes, &format!("fit {name}"), expected);
        match name.starts_with("flip") {
            true => case.ambiguous(),
            false => case,
        }
    };
    bags.into_iter().map(case).collect()
}
