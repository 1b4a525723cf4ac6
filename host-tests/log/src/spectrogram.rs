//! The spectrogram of an axis: its spectral density over time and frequency, in fixed memory, and with it a fine spectrum of the
//! whole record. Neither is fitted. They are for the eye: a line that drifts, or a motor that runs for a while, is seen only
//! there.
//!
//! Segments of 2048 samples overlap by half and are weighted by a window of Hann (Welch 1967), so that a bin is 0.05 % of the
//! sampling rate. Columns of the spectrogram hold a number of segments each. When the columns are full, neighbours are joined.

use rustfft::{Fft as _, FftDirection, algorithm::Radix4, num_complex::Complex};
use serde::Serialize;

/// The number of samples of a segment.
const SEGMENT: usize = 2048;
/// The number of samples between the begins of segments.
const HOP: usize = SEGMENT / 2;
/// The number of bins of the fine spectrum: the mean has none.
const BINS: usize = SEGMENT / 2 - 1;
/// The number of frequencies of the spectrogram. Each is the mean of some bins.
const ROWS: usize = 128;
/// The largest number of columns.
const COLUMNS: usize = 128;
/// The levels of a cell, each a character of this alphabet.
const LEVELS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// A cell without samples.
const NONE: u8 = b' ';

/// The sums of a spectrogram.
pub(super) struct SpectrogramSums {
    transform: Radix4<f64>,
    window: Vec<f64>,
    /// The samples of the open segment.
    open: Vec<i32>,
    /// The time of its first sample, in samples that were missing or not.
    begin: u64,
    buffer: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    fine: Vec<f64>,
    segments: u64,
    columns: Vec<Column>,
    /// The time from one column to the next, in samples.
    width: u64,
}

#[derive(Clone)]
struct Column {
    segments: u32,
    rows: Vec<f64>,
}

impl Column {
    fn empty() -> Self {
        Self {
            segments: 0,
            rows: vec![0.0; ROWS],
        }
    }

    fn join(&mut self, other: &Self) {
        self.segments += other.segments;
        for (own, other) in self.rows.iter_mut().zip(&other.rows) {
            *own += other;
        }
    }
}

impl SpectrogramSums {
    pub(super) fn new() -> Self {
        let transform = Radix4::new(SEGMENT, FftDirection::Forward);
        let scratch = vec![Complex::default(); transform.get_inplace_scratch_len()];
        let angle = |at: usize| std::f64::consts::TAU * (at as f64 + 0.5) / SEGMENT as f64;
        Self {
            transform,
            window: (0..SEGMENT).map(|at| 0.5 - 0.5 * angle(at).cos()).collect(),
            open: Vec::with_capacity(SEGMENT),
            begin: 0,
            buffer: vec![Complex::default(); SEGMENT],
            scratch,
            fine: vec![0.0; BINS],
            segments: 0,
            columns: Vec::new(),
            width: HOP as u64,
        }
    }

    pub(super) fn push(&mut self, counts: &[i32]) {
        let mut rest = counts;
        while !rest.is_empty() {
            let (now, later) = rest.split_at(rest.len().min(SEGMENT - self.open.len()));
            self.open.extend_from_slice(now);
            rest = later;
            if self.open.len() == SEGMENT {
                self.close();
                self.open.drain(..HOP);
                self.begin += HOP as u64;
            }
        }
    }

    /// Tells that so many samples are missing here. No segment spans them.
    pub(super) fn gap(&mut self, missing: u64) {
        self.begin += self.open.len() as u64 + missing;
        self.open.clear();
    }

    /// Adds the open segment, which is full.
    fn close(&mut self) {
        let sum: f64 = self.open.iter().map(|&count| f64::from(count)).sum();
        let mean = sum / SEGMENT as f64;
        for ((value, &count), weight) in self.buffer.iter_mut().zip(&self.open).zip(&self.window) {
            *value = Complex::new((f64::from(count) - mean) * weight, 0.0);
        }
        self.transform
            .process_with_scratch(&mut self.buffer, &mut self.scratch);
        let mut column = (self.begin / self.width) as usize;
        while column >= COLUMNS {
            self.join();
            column = (self.begin / self.width) as usize;
        }
        if self.columns.len() <= column {
            self.columns.resize(column + 1, Column::empty());
        }
        self.segments += 1;
        let Some(column) = self.columns.get_mut(column) else {
            return;
        };
        column.segments += 1;
        for (bin, value) in self.buffer[1..=BINS].iter().enumerate() {
            let power = value.norm_sqr();
            self.fine[bin] += power;
            // The first bins lack the mean, so that the first row has one bin fewer.
            column.rows[(bin + 1) * ROWS / (SEGMENT / 2)] += power;
        }
    }

    /// Joins neighbouring columns.
    fn join(&mut self) {
        let pairs = self.columns.chunks(2);
        self.columns = pairs
            .map(|pair| {
                let mut joined = pair[0].clone();
                pair[1..].iter().for_each(|other| joined.join(other));
                joined
            })
            .collect();
        self.width *= 2;
    }

    /// The spectrogram in units; `None` for a record that is shorter than a segment.
    pub(super) fn spectrogram(&self, rate_hz: f64, rate_per_count: f64) -> Option<Spectrogram> {
        if self.segments == 0 {
            return None;
        }
        let squares: f64 = self.window.iter().map(|weight| weight * weight).sum();
        // One-sided.
        let unit = 2.0 * rate_per_count * rate_per_count / (rate_hz * squares);
        let density = |power: f64, summed: f64| unit * power / summed;
        let fine = self.fine.iter();
        let fine = fine.map(|&power| density(power, self.segments as f64).sqrt() as f32);
        let bins_of = |row: usize| (SEGMENT / 2 / ROWS - usize::from(row == 0)) as f64;
        let cells: Vec<Option<f64>> = self
            .columns
            .iter()
            .flat_map(|column| {
                let segments = f64::from(column.segments);
                let cell = move |(row, &power): (usize, &f64)| {
                    (segments > 0.0).then(|| density(power, segments * bins_of(row)).sqrt())
                };
                column.rows.iter().enumerate().map(cell)
            })
            .collect();
        let mut sorted: Vec<f64> = cells.iter().flatten().copied().collect();
        sorted.retain(|value| *value > 0.0);
        sorted.sort_by(f64::total_cmp);
        // The darkest hundredth is one level, so that a notch does not take all contrast.
        let (low, high) = (*sorted.get(sorted.len() / 100)?, *sorted.last()?);
        let span = (high / low).ln().max(f64::MIN_POSITIVE);
        let level = |value: f64| {
            let share = ((value / low).ln() / span).clamp(0.0, 1.0);
            LEVELS[(share * 63.0).round() as usize]
        };
        let cells = cells
            .into_iter()
            .map(|cell| char::from(cell.map_or(NONE, level)));
        Some(Spectrogram {
            bin_hz: rate_hz / SEGMENT as f64,
            fine: fine.collect(),
            column_s: self.width as f64 / rate_hz,
            row_hz: 0.5 * rate_hz / ROWS as f64,
            rows: ROWS,
            low,
            high,
            cells: cells.collect(),
        })
    }
}

/// The spectral density of an axis over time and frequency, and over frequency. Densities are roots of one-sided densities, in
/// the unit of the rate per √Hz.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Spectrogram {
    /// The distance of the bins of the fine spectrum, the first of which is at this frequency.
    bin_hz: f64,
    fine: Vec<f32>,
    /// The time of a column.
    column_s: f64,
    /// The frequencies of a row.
    row_hz: f64,
    /// The number of rows of a column, the lowest frequency first.
    rows: usize,
    /// The densities of the first and of the last level.
    low: f64,
    high: f64,
    /// The level of every cell, column by column, as a character of the alphabet of Base64, whose levels are logarithmic; a
    /// blank is a cell without samples.
    cells: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// White noise of one count with a line whose frequency rises from 10 to 30 Hz, at 100 Hz.
    fn drifting(samples: usize) -> Vec<i32> {
        let mut state = 1_u64;
        let mut phase = 0.0_f64;
        let noise = (0..samples).map(|at| {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            let uniform = (state >> 11) as f64 / (1_u64 << 53) as f64;
            phase += std::f64::consts::TAU * (10.0 + 20.0 * at as f64 / samples as f64) / 100.0;
            ((uniform - 0.5) * 12_f64.sqrt() * 1000.0 + 500.0 * phase.sin()).round() as i32
        });
        noise.collect()
    }

    #[test]
    fn a_drifting_line_is_a_slope_and_white_noise_has_its_density() {
        let counts = drifting(1 << 20);
        let mut sums = SpectrogramSums::new();
        counts.chunks(777).for_each(|part| sums.push(part));
        let drawn = sums.spectrogram(100.0, 0.001).unwrap();
        // A variance of one over 50 Hz.
        let white = &drawn.fine[820..1000];
        let mean = white.iter().map(|value| value * value).sum::<f32>() / white.len() as f32;
        assert!((mean / 0.02 - 1.0).abs() < 0.03, "{mean}");
        let columns: Vec<&[u8]> = drawn.cells.as_bytes().chunks(ROWS).collect();
        assert!(columns.len() <= COLUMNS && columns.len() > COLUMNS / 2);
        let brightest = |column: &[u8]| {
            let level = |row: &usize| LEVELS.iter().position(|one| *one == column[*row]);
            (0..ROWS).max_by_key(level).unwrap() as f64 * drawn.row_hz
        };
        for (at, column) in columns.iter().enumerate() {
            let expected = 10.0 + 20.0 * (at as f64 + 0.5) * drawn.column_s / 10485.76;
            assert!(
                (brightest(column) - expected).abs() < 0.6,
                "{at}: {expected}"
            );
        }
    }

    #[test]
    fn a_gap_takes_time_and_short_records_have_no_spectrogram() {
        let counts = drifting(4096);
        let mut sums = SpectrogramSums::new();
        sums.push(&counts[..SEGMENT - 1]);
        assert!(sums.spectrogram(100.0, 1.0).is_none());
        sums.push(&counts[SEGMENT - 1..]);
        sums.gap(100_000);
        sums.push(&counts);
        let drawn = sums.spectrogram(100.0, 1.0).unwrap();
        let columns: Vec<&[u8]> = drawn.cells.as_bytes().chunks(ROWS).collect();
        let empty = columns.iter().filter(|column| column[0] == NONE).count();
        let missing = 100_000.0 / 100.0 / drawn.column_s;
        assert!((empty as f64 - missing).abs() < 3.0, "{empty} {missing}");
    }
}
