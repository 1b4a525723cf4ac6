//! How far long work has come: on standard error, and on a terminal only.

use indicatif::{ProgressBar, ProgressStyle};
use std::path::Path;

/// A file that is read in a moment needs no bar.
const BYTES_OF_A_MOMENT: u64 = 1 << 24;

/// Nor do samples that are simulated in one.
const SAMPLES_OF_A_MOMENT: u64 = 1 << 22;

/// A bar over the bytes of a file.
pub(super) fn reading(path: &Path) -> ProgressBar {
    let length = path.metadata().map_or(0, |metadata| metadata.len());
    if length < BYTES_OF_A_MOMENT {
        return ProgressBar::hidden();
    }
    styled(
        length,
        "{wide_bar} {bytes}/{total_bytes} {bytes_per_sec} {eta}",
    )
}

/// A bar over simulated samples.
pub(super) fn simulating(samples: u64) -> ProgressBar {
    if samples < SAMPLES_OF_A_MOMENT {
        return ProgressBar::hidden();
    }
    styled(
        samples,
        "{wide_bar} {human_pos}/{human_len} samples {per_sec} {eta}",
    )
}

fn styled(length: u64, template: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(template);
    // Hidden by itself where standard error is no terminal.
    ProgressBar::new(length).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
