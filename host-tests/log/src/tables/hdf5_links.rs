//! The links of a group of HDF5 in the old form, which the reader of HDF5 does not list if one of them is soft.
//!
//! Every file that HDF5 writes without being asked for a newer form has such groups: the format specification 3.0 calls them
//! version 1 B-trees of symbol table nodes (sections III.A.1 and III.B), with the names in a local heap (III.D). A soft link has an
//! entry without an object, whose address is undefined.

use std::{
    fs::File,
    io::{Read as _, Seek as _, SeekFrom},
    path::Path,
};

/// The most levels of a tree, and the most links of a group. A damaged file may have circles. Chosen by hand.
const DEEPEST: usize = 8;
const MOST: usize = 10_000;

/// The longest name, in bytes.
const LONGEST: u64 = 1024;

/// What an entry says about its object in its last 16 bytes: that it is a group, with the addresses of its tree and heap; or that
/// it is a soft link, with the offset of its path in the heap.
const GROUP: u32 = 1;
const SOFT: u32 = 2;

const ENTRY: u64 = 40;

/// The names in a group.
#[derive(Debug, Default)]
pub(super) struct Links {
    /// The names of objects.
    pub(super) objects: Vec<String>,
    /// The names of soft links, and the paths that they lead to.
    pub(super) soft: Vec<(String, String)>,
}

/// The links of the group at a path such as `/imu`. `None` if it is not of the old form.
pub(super) fn of(file: &Path, group: &str) -> Option<Links> {
    let mut bytes = Bytes::open(file)?;
    let mut at = bytes.root()?;
    for name in group.split('/').filter(|name| !name.is_empty()) {
        let mut inside = Vec::new();
        bytes.entries(at.tree, DEEPEST, &mut inside)?;
        let entry = inside
            .into_iter()
            .find(|entry| bytes.text(at.heap, entry.name).as_deref() == Some(name))?;
        at = entry.group()?;
    }
    let mut inside = Vec::new();
    bytes.entries(at.tree, DEEPEST, &mut inside)?;
    let mut links = Links::default();
    for entry in inside {
        let name = bytes.text(at.heap, entry.name)?;
        match entry.kind {
            SOFT => links
                .soft
                .push((name, bytes.text(at.heap, entry.more[0] & 0xffff_ffff)?)),
            _ => links.objects.push(name),
        }
    }
    Some(links)
}

/// The addresses of the tree of a group and of the heap with its names.
#[derive(Clone, Copy)]
struct Group {
    tree: u64,
    heap: u64,
}

/// An entry of a symbol table.
struct Entry {
    /// The offset of its name in the heap of its group.
    name: u64,
    kind: u32,
    more: [u64; 2],
}

impl Entry {
    fn group(&self) -> Option<Group> {
        let [tree, heap] = self.more;
        (self.kind == GROUP).then_some(Group { tree, heap })
    }
}

/// A file, whose addresses count from where HDF5 begins in it.
struct Bytes {
    file: File,
    start: u64,
}

impl Bytes {
    /// HDF5 begins at the start of the file, or behind 512 bytes of another program, 1024, and so on.
    fn open(path: &Path) -> Option<Self> {
        let file = File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        let mut bytes = Self { file, start: 0 };
        while bytes.start < length {
            if bytes.at::<8>(0)? == *b"\x89HDF\r\n\x1a\n" {
                return Some(bytes);
            }
            bytes.start = (2 * bytes.start).max(512);
        }
        None
    }

    fn at<const N: usize>(&mut self, address: u64) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        let place = SeekFrom::Start(self.start.checked_add(address)?);
        self.file.seek(place).ok()?;
        self.file.read_exact(&mut bytes).ok()?;
        Some(bytes)
    }

    fn word(&mut self, address: u64) -> Option<u64> {
        self.at(address).map(u64::from_le_bytes)
    }

    /// The root group, by the entry in the superblock of version 0 or 1. Addresses and lengths have eight bytes.
    fn root(&mut self) -> Option<Group> {
        let [version, .., addresses, lengths, _, _, _] = self.at::<10>(8)?;
        let entry = match (version, addresses, lengths) {
            (0, 8, 8) => 56,
            (1, 8, 8) => 60,
            _ => return None,
        };
        self.entry(entry)?.group()
    }

    fn entry(&mut self, address: u64) -> Option<Entry> {
        Some(Entry {
            name: self.word(address)?,
            kind: u32::from_le_bytes(self.at(address.checked_add(16)?)?),
            more: [
                self.word(address.checked_add(24)?)?,
                self.word(address.checked_add(32)?)?,
            ],
        })
    }

    /// Collects the entries of a tree, in order.
    fn entries(&mut self, tree: u64, levels: usize, all: &mut Vec<Entry>) -> Option<()> {
        let [b'T', b'R', b'E', b'E', 0, level, low, high] = self.at(tree)? else {
            return None;
        };
        let levels = levels.checked_sub(1)?;
        for child in 0..u64::from(u16::from_le_bytes([low, high])) {
            // Each child stands between two keys, behind a head of 24 bytes.
            let child = self.word(tree.checked_add(32 + 16 * child)?)?;
            if level > 0 {
                self.entries(child, levels, all)?;
                continue;
            }
            let [b'S', b'N', b'O', b'D', 1, 0, low, high] = self.at(child)? else {
                return None;
            };
            for entry in 0..u64::from(u16::from_le_bytes([low, high])) {
                all.push(self.entry(child.checked_add(8 + ENTRY * entry)?)?);
            }
            if all.len() > MOST {
                return None;
            }
        }
        Some(())
    }

    /// The text at an offset of a heap, which ends with a zero.
    fn text(&mut self, heap: u64, offset: u64) -> Option<String> {
        if self.at(heap)? != *b"HEAP" {
            return None;
        }
        let segment = self.word(heap.checked_add(24)?)?;
        let place = self.start.checked_add(segment)?.checked_add(offset)?;
        self.file.seek(SeekFrom::Start(place)).ok()?;
        let mut text = Vec::new();
        let mut rest = (&self.file).take(LONGEST);
        rest.read_to_end(&mut text).ok()?;
        let end = text.iter().position(|&byte| byte == 0)?;
        text.truncate(end);
        String::from_utf8(text).ok()
    }
}
