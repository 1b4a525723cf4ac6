//! The axes of a sensor while samples arrive: kept and judged as a device without a gate keeps and judges them.

use allanite::{Accumulator, Axes, axis::Courses, course::Course, integrity::Reason};
use allanite_log::{Axis, Evidence, OCTAVES, SpectrumSums};

/// The axes of a sensor, of which no sample is kept.
#[derive(Clone)]
pub struct Live {
    sums: Box<dyn Together>,
    spectra: Vec<SpectrumSums>,
}

/// Axes that are judged together. Three of them show more than one, and more than three are judged one by one.
type Joint<const AXES: usize> = Axes<OCTAVES, 0, (), (), AXES, (), Courses>;

/// What is kept of the axes, however many they are.
trait Together: Send + Sync {
    /// Adds counts of every axis, all of one length.
    fn push(&mut self, columns: &[&[i32]]);
    fn gap(&mut self);
    fn accumulator(&self, axis: usize) -> &Accumulator<OCTAVES>;
    fn course(&self, axis: usize) -> &Course;
    fn verdict(&self, axis: usize) -> Option<Reason>;
    fn copy(&self) -> Box<dyn Together>;
}

impl Clone for Box<dyn Together> {
    fn clone(&self) -> Self {
        self.copy()
    }
}

impl<const AXES: usize> Together for Joint<AXES> {
    fn push(&mut self, columns: &[&[i32]]) {
        let of_axis = |axis: usize| columns.get(axis).copied().unwrap_or_default();
        self.push_slices(std::array::from_fn(of_axis));
    }

    fn gap(&mut self) {
        self.gap();
    }

    fn accumulator(&self, axis: usize) -> &Accumulator<OCTAVES> {
        self.accumulators()[axis]
    }

    fn course(&self, axis: usize) -> &Course {
        // The type keeps them.
        const NONE: &Course = &Course::new();
        self.courses()[axis].unwrap_or(NONE)
    }

    fn verdict(&self, axis: usize) -> Option<Reason> {
        self.verdict(axis)
    }

    fn copy(&self) -> Box<dyn Together> {
        Box::new(self.clone())
    }
}

impl Together for Vec<Joint<1>> {
    fn push(&mut self, columns: &[&[i32]]) {
        for (axis, counts) in self.iter_mut().zip(columns) {
            axis.push_slices([counts]);
        }
    }

    fn gap(&mut self) {
        self.iter_mut().for_each(Joint::gap);
    }

    fn accumulator(&self, axis: usize) -> &Accumulator<OCTAVES> {
        Together::accumulator(&self[axis], 0)
    }

    fn course(&self, axis: usize) -> &Course {
        Together::course(&self[axis], 0)
    }

    fn verdict(&self, axis: usize) -> Option<Reason> {
        self[axis].verdict(0)
    }

    fn copy(&self) -> Box<dyn Together> {
        Box::new(self.clone())
    }
}

impl Live {
    /// No samples yet.
    pub fn new(axes: usize) -> Self {
        Self {
            sums: match axes {
                2 => Box::new(Joint::<2>::new()),
                3 => Box::new(Joint::<3>::new()),
                _ => Box::new(vec![Joint::<1>::new(); axes]),
            },
            spectra: vec![SpectrumSums::new(); axes],
        }
    }

    /// The number of axes.
    pub const fn width(&self) -> usize {
        self.spectra.len()
    }

    /// Adds counts of every axis, all of one length.
    pub fn push(&mut self, columns: &[&[i32]]) {
        self.sums.push(columns);
        for (spectrum, counts) in self.spectra.iter_mut().zip(columns) {
            spectrum.push_slice(counts);
        }
    }

    /// Tells that samples are missing here, an unknown number of them.
    pub fn gap(&mut self) {
        self.sums.gap();
        self.spectra.iter_mut().for_each(SpectrumSums::gap);
    }

    /// Samples of each axis so far.
    pub fn samples(&self) -> u64 {
        self.first().map_or(0, Accumulator::samples)
    }

    /// Gaps so far.
    pub fn gaps(&self) -> u64 {
        self.first().map_or(0, Accumulator::gaps)
    }

    fn first(&self) -> Option<&Accumulator<OCTAVES>> {
        (self.width() > 0).then(|| self.sums.accumulator(0))
    }

    /// The axes so far, with these names, in counts of this size.
    pub fn axes(&self, names: &[String], rate_per_count: f64) -> Vec<Axis> {
        let axes = names.iter().zip(&self.spectra).enumerate();
        let axis = |(axis, (name, spectrum)): (usize, (&String, &SpectrumSums))| Axis {
            name: name.clone(),
            rate_per_count,
            zero: 0.0,
            accumulator: self.sums.accumulator(axis).clone(),
            spectrum: spectrum.clone(),
            evidence: Some(Evidence {
                course: Some(self.sums.course(axis).clone()),
                invalid: self.sums.verdict(axis),
                ..Evidence::default()
            }),
        };
        axes.map(axis).collect()
    }
}
