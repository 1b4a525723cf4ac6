//! Bags of few bytes whose names, definitions, channels and tables claim much memory and time.

use super::{
    bags::{MAGIC, bag, chunk, fixture, header, record, ros1, ros1_bag, text},
    case::{Case, refused},
};
use rusqlite::Connection;
use std::{fs, io::Write as _};
use tempfile::TempDir;

/// The records in a chunk of LZ4, some hundred times shorter than they are if they repeat.
fn packed(records: &[u8]) -> Vec<u8> {
    let mut encoder = lz4::EncoderBuilder::new().build(Vec::new()).unwrap();
    encoder.write_all(records).unwrap();
    let (packed, ended) = encoder.finish();
    ended.unwrap();
    chunk(records.len() as u64, "lz4", &packed)
}

fn schema(id: u16, name: &str, definition: &str) -> Vec<u8> {
    let parts = [text(name), text("ros2msg"), text(definition)].concat();
    record(3, &[&id.to_le_bytes()[..], &parts].concat())
}

fn channel(id: u16, schema: u16, topic: &str) -> Vec<u8> {
    let ids = [id.to_le_bytes(), schema.to_le_bytes()].concat();
    record(
        4,
        &[&ids[..], &text(topic), &text("cdr"), &text("")].concat(),
    )
}

/// A definition whose types lie in each other, each with this line for the next one.
fn nested(line: &str, times: usize, deepest: &str) -> String {
    let names: Vec<char> = ('C'..='M').collect();
    let mut definition = line.replace("TYPE", "a/C").repeat(times);
    for pair in names.windows(2) {
        let lines = line.replace("TYPE", &format!("a/{}", pair[1]));
        definition += &format!("===\nMSG: a/{}\n{}", pair[0], lines.repeat(times));
    }
    definition + &format!("===\nMSG: a/M\n{deepest}\n")
}

/// A bag of a definition, with messages of nothing.
fn defined(definition: &str) -> Vec<u8> {
    let message = record(
        5,
        &[&[1, 0][..], &[0; 20], &[0, 1, 0, 0], &[1; 40]].concat(),
    );
    let records = [
        schema(1, "a/msg/B", definition),
        channel(1, 1, "/a"),
        message.repeat(1000),
    ];
    bag(&[header(), packed(&records.concat())])
}

fn mcaps() -> Vec<(Vec<u8>, &'static str)> {
    let many = |record: &dyn Fn(u16) -> Vec<u8>| (0..60_000).flat_map(record).collect::<Vec<u8>>();
    let longest = "S".repeat(4000);
    let long = "float64 x\n".repeat(20_000);
    let definitions = |id: u16| schema(id, "a/msg/B", &long[..usize::from(id % 400) * 10]);
    table! {
        // As many schemas as there are identifiers, each with other text.
        bag(&[header(), packed(&many(&|id| schema(id, "", &format!("{id:0>120}"))))]) => "a.mcap: ";
        bag(&[header(), packed(&(0..4000).flat_map(definitions).collect::<Vec<u8>>())]) => "a.mcap: ";
        bag(&[header(), packed(&schema(1, &longest.repeat(1000), ""))])
            => "damaged: the names of its channels are too long or too many";
        bag(&[header(), packed(&(0..4000).flat_map(|id| channel(id, 1, &format!("{longest}{id}"))).collect::<Vec<u8>>())])
            => "damaged: the names of its channels are too long or too many";
        bag(&[header(), packed(&[schema(1, "a/msg/B", &long), many(&|id| channel(id, 1, &format!("{id}")))].concat())])
            => "a.mcap: ";
        defined(&nested("TYPE x\n", 30, "float64 gyr")) => "a.mcap: ";
        defined(&nested("TYPE[16] x\n", 1, "string gyr")) => "a.mcap: ";
        defined(&nested("TYPE[16] gyr\n", 1, "float64 gyr")) => "a.mcap: ";
        defined(&nested("TYPE[4000000000] gyr\n", 1, "float64 gyr")) => "a.mcap: ";
        defined(&format!("float64 {}", "gyr".repeat(60_000))) => "a.mcap: ";
        defined(&(0..20_000).map(|i| format!("a/T{i} x\n===\nMSG: a/T{i}\n")).collect::<String>()) => "a.mcap: ";
    }
}

/// A database with these statements behind those of a table of topics and one of messages.
fn database(topics: &str, messages: &str, more: &str) -> Vec<u8> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.db3");
    let database = Connection::open(&path).unwrap();
    let statements =
        format!("CREATE TABLE topics({topics}); CREATE TABLE messages({messages}); {more}");
    database.execute_batch(&statements).unwrap();
    drop(database);
    fs::read(path).unwrap()
}

fn databases() -> Vec<(Vec<u8>, &'static str)> {
    const TOPICS: &str = "id INTEGER PRIMARY KEY, name, type, serialization_format";
    const MESSAGES: &str = "id INTEGER PRIMARY KEY, topic_id, data";
    let imu = "INSERT INTO topics VALUES(1, '/imu', 'sensor_msgs/msg/Imu', 'cdr');";
    let rows = |values: &str, count: u32| {
        format!(
            "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n WHERE i < {count}) \
             INSERT INTO {values} FROM n;"
        )
    };
    let name = "id INTEGER PRIMARY KEY, type, serialization_format, name AS (hex(zeroblob(32000)))";
    let no_tables = "a SQLite database without the tables of a bag";
    table! {
        database(name, MESSAGES, &rows("topics(id) SELECT i", 4000)) => no_tables;
        database(TOPICS, "id INTEGER PRIMARY KEY, topic_id, data AS (zeroblob(1000000))", &rows("messages(topic_id) SELECT 1", 4000))
            => no_tables;
        database(TOPICS, "id INTEGER PRIMARY KEY, topic_id, data AS (zeroblob(1000)) STORED", imu) => no_tables;
        // Messages that would have to be sorted before the first one is seen.
        database(TOPICS, "id, topic_id, data", &format!("{imu}{}", rows("messages SELECT -i, 1, zeroblob(300)", 2000)))
            => no_tables;
        database(TOPICS, MESSAGES, &rows("topics SELECT i, hex(zeroblob(2000)) || i, 'a', 'b'", 200))
            => "no topic of sensor_msgs/msg/Imu: only ";
        database(TOPICS, MESSAGES, "INSERT INTO topics VALUES(1, hex(zeroblob(400000)), 'a', 'b');")
            => "damaged: the names of its channels are too long or too many";
        database(TOPICS, MESSAGES, &rows("topics SELECT i, i, 'a', 'b'", 9000)) => "damaged: the bag has too many topics";
        // Thirty thousand rows of one byte, and the table's statement has a default of a megabyte for their data.
        database(TOPICS, "id INTEGER PRIMARY KEY, topic_id", &format!("{imu}{}ALTER TABLE messages ADD COLUMN data DEFAULT x'{}';", rows("messages SELECT i, 1", 30_000), "00".repeat(200_000)))
            => "damaged: the chunks unpack to too many times their size";
    }
}

fn ros1_bags() -> Vec<(Vec<u8>, &'static str)> {
    let connection = |id: u32, topic: &str| {
        let head = [
            ("op", &[7][..]),
            ("conn", &id.to_le_bytes()),
            ("topic", topic.as_bytes()),
        ];
        ros1(&head, 0, &[])
    };
    let long: Vec<Vec<u8>> = (0..250)
        .map(|id| connection(id, &format!("{id}{}", "t".repeat(4000))))
        .collect();
    table! {
        ros1_bag(13, &long) => "no topic of sensor_msgs/msg/Imu: only ";
        ros1_bag(13, &[connection(1, &"t".repeat(9000))]) => "damaged: the names of its channels are too long or too many";
    }
}

pub(super) fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for (name, bags) in [
        ("a.mcap", mcaps()),
        ("a.db3", databases()),
        ("a.bag", ros1_bags()),
    ] {
        for (bytes, expected) in bags {
            assert!(bytes.len() < 1 << 20, "{name}: {} bytes", bytes.len());
            cases.push(refused(name, bytes, &format!("fit {name}"), expected));
        }
    }
    // A folder of many small files, each of which claims as much as one may.
    let folder = |name: &dyn Fn(u16) -> Vec<u8>, expected| {
        let first = || refused("bag/a_0.mcap", whole(&name(0)), "fit bag", expected);
        (1..300).fold(first(), |case, i| {
            case.beside(format!("bag/a_{i}.mcap"), whole(&name(i)))
        })
    };
    let names = |file: u16| {
        let topic = |id: u16| channel(id, 1, &format!("{file}-{id}{}", "t".repeat(4000)));
        (0..20).flat_map(topic).collect()
    };
    cases.push(folder(
        &names,
        "the names of its channels are too long or too many",
    ));
    cases.push(folder(
        &|_| vec![0; 9 * 880_000],
        "too many times their size",
    ));
    // Names and neighbours of databases that mean something to SQLite.
    let good = || fixture("origins/humble.db3");
    let reads = |name: &str, prepare: &str| {
        refused(name, good(), &format!("fit {name}"), "")
            .status(0)
            .prepared(prepare)
    };
    cases.push(reads("a.db3", "mkfifo a.db3-journal a.db3-wal a.db3-shm"));
    cases.push(reads("a.db3", "mkdir a.db3-journal a.db3-wal"));
    cases.push(reads(
        "a.db3",
        "ln -s /dev/zero a.db3-wal; ln -s /dev/zero a.db3-journal",
    ));
    for name in [
        "file:a.db3",
        "file:a.db3?mode=memory",
        "file:%00.db3",
        "a#b%41.db3",
    ] {
        cases.push(reads(name, "true"));
    }
    cases
}

/// An MCAP file with these records in a chunk, and without a summary.
fn whole(records: &[u8]) -> Vec<u8> {
    let ends = [record(15, &[0; 4]), record(2, &[0; 20])].concat();
    [bag(&[header(), packed(records), ends]), MAGIC.to_vec()].concat()
}
