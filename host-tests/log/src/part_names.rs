//! The names of the files in a folder that are the parts of one record.

use std::{
    cmp::Ordering,
    path::{Path, PathBuf},
};

/// The extensions of text in the order in which they are looked for, before that of gzip.
const EXTENSIONS: [&str; 5] = ["csv", "tsv", "txt", "log", "dat"];

/// The most files in a folder that are looked at. Chosen by hand.
const MOST_FILES: usize = 1 << 14;

/// The files of the first kind of text that a folder has, in the natural order of their names: part 2 before part 10.
pub(super) fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = folder.read_dir().into_iter().flatten().flatten();
    let files: Vec<PathBuf> = entries
        .map(|entry| entry.path())
        .filter(|file| !name(file).starts_with('.') && file.is_file())
        .take(MOST_FILES)
        .collect();
    let is_of_bag = |file: &PathBuf| {
        let name = name(file).to_lowercase();
        [".mcap", ".db3", ".zstd"]
            .iter()
            .any(|extension| name.ends_with(extension))
    };
    if files.iter().any(is_of_bag) {
        return Vec::new();
    }
    let of = |extension: &&str| {
        let is = |file: &&PathBuf| {
            let name = name(file).to_lowercase();
            let name = name.strip_suffix(".gz").unwrap_or(&name);
            name.strip_suffix(extension)
                .is_some_and(|stem| stem.ends_with('.'))
        };
        let mut parts: Vec<PathBuf> = files.iter().filter(is).cloned().collect();
        parts.sort_by(|a, b| natural(&name(a), &name(b)));
        parts
    };
    let found = EXTENSIONS.iter().map(of).find(|parts| !parts.is_empty());
    found.unwrap_or_default()
}

pub(super) fn name(file: &Path) -> String {
    let name = file.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// Compares names as people do: numbers in them by their value.
fn natural(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a, b);
    loop {
        let digits =
            |text: &str| text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let (in_left, in_right) = (digits(left), digits(right));
        if in_left > 0 && in_right > 0 {
            let [x, y] =
                [&left[..in_left], &right[..in_right]].map(|number| number.trim_start_matches('0'));
            let order = x.len().cmp(&y.len()).then_with(|| x.cmp(y));
            if order != Ordering::Equal {
                return order;
            }
            (left, right) = (&left[in_left..], &right[in_right..]);
            continue;
        }
        let (mut next_left, mut next_right) = (left.chars(), right.chars());
        let order = next_left.next().cmp(&next_right.next());
        if order != Ordering::Equal {
            return order;
        }
        if left.is_empty() {
            return a.cmp(b);
        }
        (left, right) = (next_left.as_str(), next_right.as_str());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_names_are_compared_by_their_value() {
        let mut names = [
            "imu_10.csv",
            "imu_2.csv",
            "imu_02b.csv",
            "imu.csv",
            "imu_1.csv",
        ];
        names.sort_by(|a, b| natural(a, b));
        assert_eq!(
            names,
            [
                "imu.csv",
                "imu_1.csv",
                "imu_2.csv",
                "imu_02b.csv",
                "imu_10.csv"
            ]
        );
    }
}
