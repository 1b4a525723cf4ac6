//! Everything that the studies keep of a simulated record.

use super::{OCTAVES, RATE_HZ, quantum, record_at};
use allanite::{
    Axis, Curve, Record, Scale,
    course::{CosineTransform, Course},
    kurtosis::Kurtosis,
    spectrum::Spectrum,
};
use allanite_host::simulate::{Coefficients, Simulator};
use allanite_log::{BINS, SpectrumSums};

/// The sums of a record, beside its curve.
#[derive(Clone, Debug)]
pub struct Sums {
    gyro: Axis<OCTAVES, 0, ()>,
    spectrum: SpectrumSums,
    course: Course,
}

impl Default for Sums {
    fn default() -> Self {
        Self::new()
    }
}

impl Sums {
    /// No samples.
    pub const fn new() -> Self {
        Self {
            gyro: Axis::new(),
            spectrum: SpectrumSums::new(),
            course: Course::new(),
        }
    }

    /// Adds counts.
    pub fn push_slice(&mut self, counts: &[i32]) {
        counts.iter().for_each(|&count| self.gyro.push(count));
        self.spectrum.push_slice(counts);
        self.course.push_slice(counts);
    }

    /// Marks that so many samples are missing here.
    pub fn lost(&mut self, samples: u64) {
        let [accumulator] = self.gyro.accumulators();
        match accumulator.filling(samples) {
            Some(filling) => {
                let filled: Vec<i32> = filling.collect();
                self.spectrum.push_slice(&filled);
            }
            None => self.spectrum.gap(),
        }
        self.gyro.miss(samples);
        self.course.lost(samples);
    }

    /// The number of samples.
    pub fn samples(&self) -> u64 {
        let [accumulator] = self.gyro.accumulators();
        accumulator.samples()
    }

    /// The blocks of the record over time.
    pub const fn course(&self) -> &Course {
        &self.course
    }

    /// What the sums tell in this scale.
    pub fn measured(&self, scale: Scale) -> Measured {
        let evidence = self.gyro.record_so_far(0, scale).expect("one axis");
        let [accumulator] = self.gyro.accumulators();
        let spectrum = self.spectrum.spectrum(scale);
        Measured {
            curve: evidence.curve,
            spectrum: spectrum.without_bridges(accumulator.bridged(), accumulator.samples()),
            course: self.course.cosine_transform(scale),
            kurtosis: evidence.kurtosis,
        }
    }
}

/// What is known of a record.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The curve.
    pub curve: Curve<OCTAVES>,
    /// The spectrum.
    pub spectrum: Spectrum<BINS>,
    /// The course.
    pub course: Option<CosineTransform>,
    /// The kurtosis.
    pub kurtosis: Option<Kurtosis<OCTAVES>>,
}

impl Measured {
    /// The next `samples` of a simulator. The size of a count is that of a gyro with these coefficients.
    pub fn of(simulator: &mut Simulator, coefficients: Coefficients, samples: usize) -> Self {
        Self::at(RATE_HZ, simulator, coefficients, samples)
    }

    /// The same for a simulator that has this rate.
    pub fn at(
        rate_hz: f64,
        simulator: &mut Simulator,
        coefficients: Coefficients,
        samples: usize,
    ) -> Self {
        let mut sums = Sums::new();
        record_at(rate_hz, simulator, coefficients, samples, |counts| {
            sums.push_slice(counts);
        });
        sums.measured(Scale::new(quantum(coefficients, rate_hz), rate_hz).expect("positive"))
    }

    /// The record that a diagnosis takes.
    pub fn record(&self) -> Record<'_, OCTAVES, BINS> {
        Record {
            course: self.course.as_ref(),
            kurtosis: self.kurtosis.as_ref(),
            ..Record::new(&self.curve, &self.spectrum)
        }
    }
}
