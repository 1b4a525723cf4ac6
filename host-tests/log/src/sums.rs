//! What is kept of an axis while a log is read.

use super::{
    OCTAVES, Spectrogram, SpectrumSums, disturbed::Extremes, part::PartSums,
    spectrogram::SpectrogramSums, watched::WatchedAxis,
};
use allanite::{Accumulator, course::Course};

/// What is kept of one axis.
pub(super) enum Sums {
    /// The sums of the first rows, and those of the remaining rows.
    InTwo { first: Box<Part>, rest: Box<Part> },
    /// The axis with everything that is kept beside its curve.
    Watched(Box<dyn WatchedAxis>, OwnSums),
}

/// The curve and the spectrum of some rows.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) accumulator: Accumulator<OCTAVES>,
    pub(super) spectrum: SpectrumSums,
}

/// What is kept beside an axis of the library.
pub(super) struct OwnSums {
    pub(super) spectrum: Box<SpectrumSums>,
    pub(super) course: Box<Course>,
    pub(super) extremes: Extremes,
    spectrogram: Option<Box<SpectrogramSums>>,
    part: Option<Box<PartSums>>,
}

impl OwnSums {
    /// Nothing yet. A log that is a part of a longer record tells the number of its first sample.
    pub(super) fn new(has_spectrogram: bool, first_sample: Option<u64>) -> Self {
        Self {
            spectrum: Box::new(SpectrumSums::new()),
            course: Box::new(Course::new()),
            extremes: Extremes::new(),
            spectrogram: has_spectrogram.then(|| Box::new(SpectrogramSums::new())),
            part: first_sample.map(|first| Box::new(PartSums::new(first))),
        }
    }

    pub(super) fn push(&mut self, counts: &[i32]) {
        self.spectrum.push_slice(counts);
        self.course.push_slice(counts);
        self.extremes.push(counts);
        if let Some(spectrogram) = &mut self.spectrogram {
            spectrogram.push(counts);
        }
        if let Some(part) = &mut self.part {
            part.push(counts);
        }
    }

    /// Tells that so many samples are missing here. `filled` are the values that fill their places, or none.
    pub(super) fn gap(&mut self, missing: u64, filled: &[i32]) {
        go_on(&mut self.spectrum, filled);
        self.course.lost(missing);
        self.extremes.lost(missing);
        if let Some(spectrogram) = &mut self.spectrogram {
            spectrogram.gap(missing);
        }
        if let Some(part) = &mut self.part {
            part.gap(missing);
        }
    }

    /// The spectrogram, if it was asked for and the record is long enough.
    pub(super) fn spectrogram(&self, rate_hz: f64, rate_per_count: f64) -> Option<Spectrogram> {
        let sums = self.spectrogram.as_ref()?;
        sums.spectrogram(rate_hz, rate_per_count)
    }

    /// What rejoins the axis with its neighbours, if the log is a part of a longer record.
    pub(super) fn take_part(&mut self) -> Option<PartSums> {
        self.part.take().map(|part| *part)
    }
}

/// The values that fill the places of lost samples; none if they are too many.
pub(super) fn filled(accumulator: &Accumulator<OCTAVES>, lost: u64) -> Vec<i32> {
    accumulator.filling(lost).into_iter().flatten().collect()
}

/// Goes on with the values that fill a gap. Without any, no segment spans it.
fn go_on(spectrum: &mut SpectrumSums, filled: &[i32]) {
    if filled.is_empty() {
        spectrum.gap();
    } else {
        spectrum.push_slice(filled);
    }
}

impl Part {
    pub(super) fn new() -> Box<Self> {
        Box::new(Self {
            accumulator: Accumulator::new(),
            spectrum: SpectrumSums::new(),
        })
    }

    pub(super) fn push(&mut self, counts: &[i32]) {
        self.accumulator.push_slice(counts);
        self.spectrum.push_slice(counts);
    }

    pub(super) fn gap(&mut self, lost: u64) {
        go_on(&mut self.spectrum, &filled(&self.accumulator, lost));
        match lost {
            0 => self.accumulator.gap(),
            lost => self.accumulator.lost(lost),
        }
    }
}

impl Sums {
    /// The accumulator of the rows that were asked for.
    pub(super) fn accumulator(&self) -> &Accumulator<OCTAVES> {
        match self {
            Self::InTwo { first, .. } => &first.accumulator,
            Self::Watched(axis, _) => axis.accumulator(),
        }
    }

    /// The spectrum of the rows that were asked for.
    pub(super) fn spectrum(&self) -> &SpectrumSums {
        match self {
            Self::InTwo { first, .. } => &first.spectrum,
            Self::Watched(_, beside) => &beside.spectrum,
        }
    }
}
