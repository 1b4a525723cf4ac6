//! Files of HDF5 of which a part cannot be read, or has lost samples as numbers.

use super::try_read;
use allanite_log::{Log, Options};
use hdf5_pure::{FileBuilder, ScaleOffset};
use rand::SeedableRng as _;
use rand_distr::{Distribution as _, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::fs;
use tempfile::TempDir;

const ROWS: usize = 2000;

/// An address that is none, by the format specification.
const UNDEFINED: u64 = u64::MAX;

fn noise(seed: u64) -> Vec<f64> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let draw = |_| {
        let value: f64 = StandardNormal.sample(&mut random);
        0.01 * value
    };
    (0..ROWS).map(draw).collect()
}

fn read(bytes: &[u8]) -> Result<Log, String> {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("a.h5");
    fs::write(&path, bytes).unwrap();
    let options = Options {
        rate_hz: Some(200.0),
        ..Options::default()
    };
    try_read(&path, &options)
}

/// What a link of the root group leads to.
enum Target {
    Values(Vec<f64>),
    /// One chunk of bytes that a filter with this number packed.
    Packed(u16),
    Soft(&'static str),
}

fn padded(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.resize(bytes.len().next_multiple_of(8), 0);
    bytes
}

/// A version 1 object header (section IV.A.1.a) with these messages.
fn header(messages: &[(u16, Vec<u8>)]) -> Vec<u8> {
    let mut body = Vec::new();
    for (kind, message) in messages {
        let message = padded(message.clone());
        body.extend(kind.to_le_bytes());
        body.extend((message.len() as u16).to_le_bytes());
        body.extend([0; 4]);
        body.extend(message);
    }
    let mut header = vec![1, 0];
    header.extend((messages.len() as u16).to_le_bytes());
    header.extend(1_u32.to_le_bytes());
    header.extend((body.len() as u32).to_le_bytes());
    header.extend([0; 4]);
    header.extend(body);
    header
}

/// The head of a node of a version 1 B-tree with one child.
fn node(kind: u8) -> Vec<u8> {
    let mut node = b"TREE".to_vec();
    node.extend([kind, 0, 1, 0]);
    node.extend([UNDEFINED; 2].map(u64::to_le_bytes).concat());
    node
}

/// Puts bytes at the end of a file, and returns their address.
fn put(file: &mut Vec<u8>, bytes: Vec<u8>) -> u64 {
    let address = file.len() as u64;
    file.extend(padded(bytes));
    address
}

/// Puts a data set of doubles into a file, and returns the address of its header.
fn dataset(file: &mut Vec<u8>, target: &Target) -> u64 {
    let space = [&[1, 1, 0, 0, 0, 0, 0, 0][..], &(ROWS as u64).to_le_bytes()].concat();
    let mut double = vec![0x11, 0x20, 0x3f, 0, 8, 0, 0, 0, 0, 0, 64, 0, 52, 11, 0, 52];
    double.extend(1023_u32.to_le_bytes());
    let mut messages = vec![(1, space), (3, double), (5, vec![2, 3, 2, 0, 0, 0, 0, 0])];
    match target {
        Target::Values(values) => {
            let bytes: Vec<u8> = values
                .iter()
                .flat_map(|value| value.to_le_bytes())
                .collect();
            let length = bytes.len() as u64;
            let at = put(file, bytes);
            let layout = [&[3, 1][..], &at.to_le_bytes(), &length.to_le_bytes()].concat();
            messages.push((8, layout));
        }
        Target::Packed(filter) => {
            let chunk = put(file, vec![7; 64]);
            let mut tree = node(1);
            tree.extend([64_u32, 0].map(u32::to_le_bytes).concat());
            tree.extend(
                [0, 0, chunk, 0, ROWS as u64, 0]
                    .map(u64::to_le_bytes)
                    .concat(),
            );
            let tree = put(file, tree).to_le_bytes();
            let shape = [ROWS as u32, 8].map(u32::to_le_bytes).concat();
            messages.push((8, [&[3, 2, 2][..], &tree, &shape].concat()));
            let [low, high] = filter.to_le_bytes();
            let filter = [low, high, 0, 0, 0, 0, 0, 0];
            messages.push((11, [&[1, 1, 0, 0, 0, 0, 0, 0], &filter[..]].concat()));
        }
        Target::Soft(_) => unreachable!("a soft link has no object"),
    }
    let header = header(&messages);
    put(file, header)
}

/// A file of HDF5 with a root group of the old form (format specification 3.0, sections II.A, III.A.1, III.B and III.D), which HDF5
/// writes unless it is asked for a newer one. The names have to be in order.
fn file(links: &[(&str, Target)]) -> Vec<u8> {
    let mut file = vec![0; 96];
    let mut names = vec![0; 8];
    let mut text = |text: &str| put(&mut names, [text.as_bytes(), b"\0"].concat());
    let mut entries = Vec::new();
    let mut last = 0;
    for (name, target) in links {
        last = text(name);
        let (object, kind, more) = match target {
            Target::Soft(to) => (UNDEFINED, 2, text(to)),
            _ => (dataset(&mut file, target), 0, 0),
        };
        entries.extend([last, object, kind, more, 0].map(u64::to_le_bytes).concat());
    }
    let mut table = b"SNOD\x01\0".to_vec();
    table.extend((links.len() as u16).to_le_bytes());
    table.extend(entries);
    table.resize(8 + 8 * 40, 0);
    let table = put(&mut file, table);
    let mut tree = node(0);
    tree.extend([0, table, last].map(u64::to_le_bytes).concat());
    tree.resize(544, 0);
    let tree = put(&mut file, tree);
    let length = names.len() as u64;
    let names = put(&mut file, names);
    let mut heap = b"HEAP\0\0\0\0".to_vec();
    heap.extend([length, 1, names].map(u64::to_le_bytes).concat());
    let heap = put(&mut file, heap);
    let group = [tree, heap].map(u64::to_le_bytes).concat();
    let root = header(&[(17, group.clone())]);
    let root = put(&mut file, root);
    let mut head = b"\x89HDF\r\n\x1a\n\0\0\0\0\0\x08\x08\0\x04\0\x10\0\0\0\0\0".to_vec();
    let end = file.len() as u64;
    head.extend(
        [0, UNDEFINED, end, UNDEFINED]
            .map(u64::to_le_bytes)
            .concat(),
    );
    head.extend([0, root, 1].map(u64::to_le_bytes).concat());
    head.extend(group);
    file[..96].copy_from_slice(&head);
    file
}

fn names(log: &Log) -> Vec<&str> {
    log.axes.iter().map(|axis| axis.name.as_str()).collect()
}

/// A soft link, which `f["latest"] = h5py.SoftLink("/gyro_x")` makes in h5py 3.16, is an entry without an object in a group of the old
/// form.
#[test]
fn a_soft_link_is_left_out_and_the_data_sets_are_read() {
    let bytes = file(&[
        ("gyro_x", Target::Values(noise(1))),
        ("gyro_y", Target::Values(noise(2))),
        ("latest", Target::Soft("/gyro_x")),
    ]);
    let log = read(&bytes).unwrap();
    assert_eq!(names(&log), ["gyro_x", "gyro_y"]);
    assert_eq!(log.axes[0].accumulator.samples(), ROWS as u64);
    let note = "left out: /latest (it is a soft link to /gyro_x)";
    assert!(log.notes.iter().any(|one| one == note), "{:?}", log.notes);
}

/// The HDF Group registers the numbers of filters of plugins, which hdf5plugin 7.1 for h5py writes: 32013 for zfp, 32015 for zstd.
#[test]
fn a_data_set_of_a_filter_that_is_not_read_is_left_out() {
    for (number, name) in [
        (32013, "zfp"),
        (32015, "zstd"),
        (4, "szip"),
        (40_000, "of a plugin"),
    ] {
        let reason = format!("it is packed by filter {number}, {name}, which is not read");
        let remedy = "unpack it with `h5repack -f NONE IN OUT`";
        let bytes = file(&[
            ("gyro_x", Target::Values(noise(1))),
            ("gyro_y", Target::Packed(number)),
            ("gyro_z", Target::Values(noise(3))),
        ]);
        let log = read(&bytes).unwrap();
        assert_eq!(names(&log), ["gyro_x", "gyro_z"]);
        let note = format!("left out: /gyro_y ({reason}); {remedy}");
        assert!(log.notes.contains(&note), "{:?}", log.notes);

        let alone = file(&[
            ("gyro_x", Target::Packed(number)),
            ("gyro_y", Target::Packed(number)),
        ]);
        let expected = format!("a.h5: no data set can be read: /gyro_x: {reason}; {remedy}");
        assert_eq!(read(&alone).unwrap_err(), expected);

        // The rest may have no axes.
        let rest = file(&[
            (
                "a_time",
                Target::Values((0..ROWS).map(|n| n as f64 / 200.0).collect()),
            ),
            ("gyro_x", Target::Packed(number)),
        ]);
        let line = read(&rest).unwrap_err();
        let why = format!("and left out: /gyro_x ({reason})");
        assert!(line.contains(&why) && !line.contains("damaged"), "{line}");
    }
}

/// HDF5 2.0 has no code for NaN in the filter scale-offset of floats, and reads each as the lowest value of its chunk: h5py 3.16 with
/// `scaleoffset=6`.
#[test]
fn lost_samples_that_scale_offset_made_numbers_of_are_said() {
    for lost in [0, 20] {
        let mut builder = FileBuilder::new();
        for (seed, name) in [(1, "gyro_x"), (2, "gyro_y")] {
            let mut values = noise(seed);
            let lowest = values[..500].iter().copied().fold(0.0, f64::min);
            values[100..100 + lost].fill(lowest);
            let dataset = builder.create_dataset(name);
            dataset.with_f64_data(&values).with_chunks(&[500]);
            dataset.with_scale_offset(ScaleOffset::FloatDScale(8));
        }
        let log = read(&builder.finish().unwrap()).unwrap();
        assert_eq!(names(&log), ["gyro_x", "gyro_y"]);
        let note = "the filter scale-offset of /gyro_x, /gyro_y keeps no NaN: lost samples may stand as the lowest value of their \
                    chunk, which occurs repeatedly";
        let is_said = log.notes.iter().any(|one| one == note);
        assert_eq!(is_said, lost > 0, "{:?}", log.notes);
    }
}
