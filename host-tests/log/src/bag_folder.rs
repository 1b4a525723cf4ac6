//! The files of a bag: the file itself, or those in the folder of a bag of ROS 2.

use super::{bag::Container, source::Format};
use crate::failure::{Failure, Place};
use std::path::{Path, PathBuf};

/// The most files in a folder that are looked at. Chosen by hand.
const MOST_FILES: usize = 1 << 14;

/// The files of a bag in the order of their messages, and how they store them.
pub(super) fn files(path: &Path, format: Format) -> Result<(Container, Vec<PathBuf>), Failure> {
    let container = match format {
        Format::Ros1 => Container::Ros1,
        Format::Sqlite => Container::Sqlite,
        Format::Folder => return in_folder(path),
        _ => Container::Mcap,
    };
    Ok((container, vec![path.to_owned()]))
}

fn in_folder(path: &Path) -> Result<(Container, Vec<PathBuf>), Failure> {
    let fail = |what: &str, remedy: &str| Err(Place::file(path).failure(what, remedy));
    let entries = path
        .read_dir()
        .map_err(|error| Place::file(path).io(&error))?;
    let files = entries.flatten().map(|entry| entry.path()).take(MOST_FILES);
    let files: Vec<PathBuf> = files.collect();
    let of = |extension: &str| -> Vec<PathBuf> {
        let is = |file: &&PathBuf| file.to_string_lossy().to_lowercase().ends_with(extension);
        let mut found: Vec<PathBuf> = files.iter().filter(is).cloned().collect();
        found.sort_by_key(|file| (number(file), file.clone()));
        found
    };
    match (of(".mcap"), of(".db3")) {
        (mcap, sqlite) if mcap.is_empty() && sqlite.is_empty() => {
            let packed = [of(".mcap.zstd"), of(".db3.zstd")].concat();
            match packed.first() {
                Some(_) => fail(
                    "the files of the bag are compressed",
                    "unpack them with `zstd -d *.zstd` in the folder",
                ),
                None => fail(
                    "is a directory",
                    "name a file in it, or a folder with a bag of ROS 2",
                ),
            }
        }
        (mcap, sqlite) if sqlite.is_empty() => Ok((Container::Mcap, mcap)),
        (mcap, sqlite) if mcap.is_empty() => Ok((Container::Sqlite, sqlite)),
        _ => fail(
            "the folder has files of two kinds of bags",
            "name one of them",
        ),
    }
}

/// The number at the end of a file's name: ROS 2 splits a bag into `x_0.mcap`, `x_1.mcap` … `x_10.mcap`.
fn number(file: &Path) -> u64 {
    let stem = file.file_stem().unwrap_or_default().to_string_lossy();
    let digits = stem.rsplit('_').next().unwrap_or_default();
    digits.parse().unwrap_or(u64::MAX)
}
