//! Bad bags in MCAP files.

use super::case::{Case, refused};
use std::{fs, path::Path};

pub(super) fn fixture(name: &str) -> Vec<u8> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fixtures");
    fs::read(folder.join(name)).unwrap()
}

pub(super) const MAGIC: &[u8] = b"\x89MCAP0\r\n";

pub(super) fn record(opcode: u8, content: &[u8]) -> Vec<u8> {
    long(opcode, content.len() as u64, content)
}

/// A record that claims a length.
fn long(opcode: u8, length: u64, content: &[u8]) -> Vec<u8> {
    [&[opcode], &length.to_le_bytes()[..], content].concat()
}

pub(super) fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes(), text.as_bytes()].concat()
}

/// A bag of these records.
pub(super) fn bag(records: &[Vec<u8>]) -> Vec<u8> {
    [MAGIC, &records.concat()].concat()
}

pub(super) fn header() -> Vec<u8> {
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
pub(super) fn chunk(size: u64, compression: &str, packed: &[u8]) -> Vec<u8> {
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

/// Fields of a header of ROS 1, each with its name.
pub(super) fn fields(fields: &[(&str, &[u8])]) -> Vec<u8> {
    let field = |(name, value): &(&str, &[u8])| {
        let bytes = [name.as_bytes(), b"=", value].concat();
        [&(bytes.len() as u32).to_le_bytes()[..], &bytes].concat()
    };
    fields.iter().flat_map(field).collect()
}

/// A record of ROS 1 whose data claim a length.
pub(super) fn ros1(header: &[(&str, &[u8])], claimed: u32, data: &[u8]) -> Vec<u8> {
    let header = fields(header);
    [
        &(header.len() as u32).to_le_bytes()[..],
        &header,
        &claimed.to_le_bytes(),
        data,
    ]
    .concat()
}

/// A bag of ROS 1 with these records, whose header gives the offset of an index.
pub(super) fn ros1_bag(index: u64, records: &[Vec<u8>]) -> Vec<u8> {
    let header = ros1(&[("op", &[3]), ("index_pos", &index.to_le_bytes())], 0, &[]);
    [&b"#ROSBAG V2.0\n"[..], &header, &records.concat()].concat()
}

fn ros1_chunk(size: u32, compression: &str, packed: &[u8]) -> Vec<u8> {
    let header = [
        ("op", &[5][..]),
        ("compression", compression.as_bytes()),
        ("size", &size.to_le_bytes()),
    ];
    ros1(&header, packed.len() as u32, packed)
}

/// Bags, the name of each, and what is said of it.
type Bags = Vec<(String, Vec<u8>, &'static str)>;

fn named(name: &str, bags: Vec<(Vec<u8>, &'static str)>) -> Bags {
    let bags = bags.into_iter();
    bags.map(|(bytes, expected)| (name.to_owned(), bytes, expected))
        .collect()
}

/// Bad bags of ROS 1.
fn ros1_cases() -> Bags {
    let mut all: Vec<(Vec<u8>, &str)> = table! {
        Vec::new() => "not a bag of ROS 1";
        vec![7; 200] => "not a bag of ROS 1";
        b"#ROSBAG V2.0\n".to_vec() => "the bag ends in the middle";
        ros1_bag(0, &[]) => "the bag was not closed";
        ros1_bag(1 << 40, &[]) => "the bag was not closed";
        ros1_bag(13, &[]) => "no topic of sensor_msgs/msg/Imu: no topic at all";
        ros1_bag(13, &[ros1(&[("op", &[2])], 0, &[])]) => "a record names no connection";
        ros1_bag(13, &[ros1(&[("op", &[2]), ("conn", &[0; 4])], 0, &[])]) => "a message names no connection";
        ros1_bag(13, &[ros1(&[("op", &[2])], u32::MAX, &[0; 50])]) => "the bag ends in the middle";
        ros1_bag(13, &[ros1(&[("none", &[2])], 0, &[])]) => "a record has no kind";
        ros1_bag(13, &[ros1(&[("op", &[5])], 0, &[])]) => "a chunk has no size";
        ros1_bag(13, &[ros1_chunk(u32::MAX, "none", &[0; 50])]) => "to too many times their size";
        ros1_bag(13, &[ros1_chunk(50, "none", &[0xff; 50])]) => "a record in a chunk is too short";
        ros1_bag(13, &[ros1_chunk(50, "lz4", &[0xff; 50])]) => "a chunk cannot be unpacked";
        ros1_bag(13, &[ros1_chunk(50, "bz2", &[0xff; 50])]) => "a chunk cannot be unpacked";
        ros1_bag(13, &[ros1_chunk(50, "zip", &[0; 50])]) => "compressed with \"zip\"";
    };
    let connection = |i: u32| {
        ros1(
            &[("op", &[7]), ("conn", &i.to_le_bytes()), ("topic", b"/a")],
            0,
            &[],
        )
    };
    let connections: Vec<_> = (0..9000).map(connection).collect();
    all.push((ros1_bag(13, &connections), "too many connections"));
    for name in ["ros1.bag", "ros1-lz4.bag", "ros1-bz2.bag"] {
        let bytes = fixture(&format!("origins/{name}"));
        for part in [9, 100, 4117, bytes.len() / 2, bytes.len() - 9] {
            all.push((bytes[..part].to_vec(), "a.bag: "));
        }
    }
    let mut bags = named("a.bag", all);
    for name in ["ros1.bag", "ros1-lz4.bag", "ros1-bz2.bag"] {
        let good = fixture(&format!("origins/{name}"));
        for at in (30..good.len()).step_by(389) {
            let mut bytes = good.clone();
            bytes[at] ^= 0x41;
            bags.push((format!("flip{at}-{name}"), bytes, ""));
        }
    }
    bags
}

/// Bad bags of ROS 2 in SQLite.
fn sqlite_cases() -> Bags {
    let good = fixture("origins/humble.db3");
    let database = |statements: &str| {
        let folder = tempfile::TempDir::new().unwrap();
        let path = folder.path().join("a.db3");
        let database = rusqlite::Connection::open(&path).unwrap();
        database.execute_batch(statements).unwrap();
        drop(database);
        fs::read(path).unwrap()
    };
    let topics = "CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format);";
    let endless = "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 FROM n) \
                   SELECT id, 1 AS topic_id, x'00' AS data FROM n;";
    let no_messages = format!("{topics}CREATE TABLE messages(a);");
    let no_topic = format!(
        "{topics}CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, data); \
         INSERT INTO messages VALUES(1, 2, x'00');"
    );
    let mut bags = named(
        "a.db3",
        table! {
            Vec::new() => "without the tables of a bag";
            vec![7; 2000] => "not a SQLite database";
            database("CREATE TABLE a(b);") => "without the tables of a bag";
            database(&format!("{topics}{endless}")) => "without the tables of a bag";
            database(&no_messages) => "damaged: ";
            database(&no_topic) => "a message has no topic";
        },
    );
    for part in [100, good.len() / 2, good.len() - 600] {
        bags.push(("a.db3".into(), good[..part].to_vec(), "a.db3: "));
    }
    for at in (16..good.len()).step_by(389) {
        let mut bytes = good.clone();
        bytes[at] ^= 0x41;
        bags.push((format!("flip{at}.db3"), bytes, ""));
    }
    bags
}

pub(crate) fn cases() -> Vec<Case> {
    let imu = || schema(&text("sensor_msgs/msg/Imu"));
    let ascii = b"eeee".to_vec();
    let mut all: Vec<(Vec<u8>, &str)> = table! {
        Vec::new() => "the bag ends in the middle";
        b"MCAP".to_vec() => "a.mcap: ";
        vec![7; 200] => "not an MCAP file";
        bag(&[]) => "the bag ends in the middle";
        bag(&[header()]) => "the bag ends in the middle";
    };
    for opcode in [1, 3, 4, 5, 6, 7, 15, 99] {
        for length in [1 << 28, u64::MAX] {
            all.push((
                bag(&[header(), long(opcode, length, &[0; 100])]),
                "a.mcap: ",
            ));
        }
    }
    all.extend(table! {
        bag(&[header(), schema(&ascii)]) => "damaged: a record is too short";
        bag(&[header(), imu(), channel(&ascii)]) => "damaged: a record is too short";
        bag(&[header(), record(3, &[1])]) => "damaged: a record is too short";
        bag(&[header(), record(4, &[1])]) => "damaged: a record is too short";
        bag(&[header(), record(5, &[1])]) => "damaged: a record is too short";
        bag(&[header(), record(11, &[1])]) => "damaged: a record is too short";
        bag(&[header(), message(9, &[])]) => "damaged: ";
        bag(&[header(), imu(), channel(&text("/imu")), message(1, &[0, 1, 0, 0])]) => "the bag ends in the middle";
        bag(&[header(), chunk(1 << 60, "zstd", &zeros(1))]) => "a.mcap: ";
        bag(&[header(), chunk(1 << 27, "zstd", &zeros(1))]) => "a.mcap: ";
        bag(&[header(), chunk(1 << 17, "brotli", &zeros(1))]) => "compressed with \"brotli\"";
        // Half a megabyte unpacks to seventeen gigabytes of empty records.
        bag(&[header(), chunk(1 << 34, "zstd", &zeros(1 << 17))]) => "a.mcap: ";
    });
    let pieces: Vec<Vec<u8>> = (0..800)
        .map(|_| chunk(36 << 17, "zstd", &zeros(36)))
        .collect();
    all.extend(table! {
        bag(&[header(), pieces.concat()]) => "damaged: the chunks unpack to too many times their size";
        bag(&[header(), chunk(100, "lz4", &[0xff; 64])]) => "a.mcap: ";
    });
    for name in ["imu-zstd.mcap", "imu-lz4.mcap", "imu-plain.mcap"] {
        let bytes = fixture(name);
        for part in [9, 100, bytes.len() / 2, bytes.len() - 9] {
            all.push((bytes[..part].to_vec(), "a.mcap: "));
        }
    }
    let mut bags = named("a.mcap", all);
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
    bags.extend(ros1_cases());
    bags.extend(sqlite_cases());
    let case = |(name, bytes, expected): (String, Vec<u8>, &str)| {
        let case = refused(&name, bytes, &format!("fit {name}"), expected);
        match name.starts_with("flip") {
            true => case.ambiguous(),
            false => case,
        }
    };
    bags.into_iter().map(case).collect()
}
