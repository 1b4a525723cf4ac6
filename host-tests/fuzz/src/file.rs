//! Logs of every kind that has no optional part, and curve files, of any contents.

use allanite_host::curve_file::CurveFile;
use allanite_log::{self as log, Options};
use indicatif::ProgressBar;
use std::fs;

const NAMES: [&str; 4] = ["a.csv", "a.npy", "a.ulg", "a.json"];

/// Writes the bytes after the first to a file, whose kind the first selects, and reads it.
pub fn check(bytes: &[u8]) {
    let Some((&kind, contents)) = bytes.split_first() else {
        return;
    };
    let name = NAMES[usize::from(kind) % NAMES.len()];
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    fs::write(&path, contents).unwrap();
    let failure = if name == "a.json" {
        CurveFile::read(&path).map(drop).err()
    } else {
        let options = Options {
            rate_hz: (kind >= 128).then_some(100.0),
            ..Options::default()
        };
        log::read(&path, &options, &ProgressBar::hidden())
            .map(|log| {
                assert!(log.rate_hz.is_finite() && log.rate_hz > 0.0);
                assert!(!log.axes.is_empty());
            })
            .err()
    };
    if let Some(failure) = failure {
        let text = failure.to_string();
        assert!(text.contains(name), "the message names no file: {text}");
        assert!(!text.contains(|c: char| c.is_control()), "{text:?}");
    }
}
