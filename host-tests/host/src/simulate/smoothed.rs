//! Sources that pass a filter together.

use super::{
    Hidden, Random, Source,
    filtered::{FORGOTTEN, Section, sections},
};
use allanite::effect::SampledShape;
use std::collections::VecDeque;

/// Sources whose sum passes a filter.
pub(super) struct Smoothed {
    sources: Vec<Box<dyn Source>>,
    filter: Filter,
}

/// A filter of whole records.
enum Filter {
    Sections(Vec<Section>),
    /// The last samples of a moving average.
    Average(VecDeque<f64>),
}

impl Smoothed {
    /// The sources behind the filter of an effect that [all noise passes](allanite::effect::Effect::passes_all). A moving
    /// average is one over whole samples.
    pub(super) fn new(
        sources: Vec<Box<dyn Source>>,
        hidden: &Hidden,
        interval_s: f64,
        random: &mut Random,
    ) -> Self {
        let shape = SampledShape {
            interval_s,
            parameters: hidden.parameters,
        };
        let [first, ..] = hidden.parameters;
        let (filter, samples) = match sections(hidden.effect, &shape) {
            Some(sections) => (Filter::Sections(sections), first / interval_s),
            None => (Filter::Average(vec![0.0; first as usize].into()), first),
        };
        let mut smoothed = Self { sources, filter };
        for _ in 0..(FORGOTTEN * samples).ceil() as u64 {
            let _ = smoothed.next(random);
        }
        smoothed
    }
}

impl Source for Smoothed {
    fn next(&mut self, random: &mut Random) -> f64 {
        let sources = self.sources.iter_mut();
        let sum: f64 = sources.map(|source| source.next(random)).sum();
        match &mut self.filter {
            Filter::Sections(sections) => sections
                .iter_mut()
                .fold(sum, |x, section| section.output(x)),
            Filter::Average(last) => {
                last.pop_front();
                last.push_back(sum);
                last.iter().sum::<f64>() / last.len() as f64
            }
        }
    }
}
