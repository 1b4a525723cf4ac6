//! Progress bars of long work. They appear on standard error, and only if that is a terminal.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::{
    path::Path,
    sync::atomic::{AtomicBool, Ordering::Relaxed},
};

/// Whether progress and notes are suppressed.
static QUIET: AtomicBool = AtomicBool::new(false);

/// Whether several files are read at once, in which case no file has a bar of its own.
static SHARED: AtomicBool = AtomicBool::new(false);

/// A smaller file is read so quickly that it needs no bar. Chosen by hand.
const BYTES_OF_A_MOMENT: u64 = 1 << 24;

/// Fewer samples are simulated so quickly that they need no bar. Chosen by hand.
const SAMPLES_OF_A_MOMENT: u64 = 1 << 22;

/// Suppresses progress and notes from now on.
pub(crate) fn be_quiet() {
    QUIET.store(true, Relaxed);
}

/// Whether progress and notes are suppressed.
pub(crate) fn is_quiet() -> bool {
    QUIET.load(Relaxed)
}

/// Hides the bars of single files from now on, so that the bar over all files has the terminal.
pub(crate) fn share_terminal() {
    SHARED.store(true, Relaxed);
}

/// A bar over files.
pub(crate) fn files(number: u64) -> ProgressBar {
    styled(number, "{wide_bar} {pos}/{len} files {eta}")
}

/// A bar over the bytes of a file.
pub(crate) fn reading(path: &Path) -> ProgressBar {
    let length = path.metadata().map_or(0, |metadata| metadata.len());
    if length < BYTES_OF_A_MOMENT || SHARED.load(Relaxed) {
        return ProgressBar::hidden();
    }
    styled(
        length,
        "{wide_bar} {bytes}/{total_bytes} {bytes_per_sec} {eta}",
    )
}

/// A bar over simulated samples.
pub(crate) fn simulating(samples: u64) -> ProgressBar {
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
    // The target hides itself if standard error is not a terminal.
    let target = if is_quiet() {
        ProgressDrawTarget::hidden()
    } else {
        ProgressDrawTarget::stderr()
    };
    ProgressBar::with_draw_target(Some(length), target)
        .with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
