//! The data that a plot shows of the course of a record: the rate, the noise and the recorded columns over time.

use super::{frame::ends, ticks};
use allanite::{Scale, course::Course};
use allanite_log::unit::Unit;
use serde::Serialize;

/// The median of the size of a normal variable, in standard deviations.
const MEDIAN: f64 = 0.674_489_75;

/// The course of a record. Times are in seconds since its first sample.
#[derive(Clone, Debug, Serialize)]
pub struct CourseFigure {
    /// Begin and end of the record.
    pub span: [f64; 2],
    /// The title of the axis of times.
    pub across: String,
    /// The labelled ticks of that axis.
    pub times: Vec<(f64, String)>,
    /// The middle of every block that holds samples.
    pub at_s: Vec<f32>,
    /// What is shown, from the top.
    pub strips: Vec<Strip>,
    /// What happened, the earliest first.
    pub events: Vec<Mark>,
}

/// One quantity over time, on a linear axis.
#[derive(Clone, Debug, Serialize)]
pub struct Strip {
    /// The title of its axis.
    pub title: String,
    /// The value of every block.
    pub values: Vec<f32>,
    /// The standard error of every value; empty if it is not known.
    pub errors: Vec<f32>,
    /// Lower and upper end of the axis.
    pub span: [f64; 2],
    /// The labelled ticks of the axis.
    pub ticks: Vec<(f64, String)>,
}

/// Something that happened at a time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mark {
    /// When it happened.
    pub at_s: f64,
    /// What happened, in a few words.
    pub words: String,
}

impl CourseFigure {
    /// The figure of a course in a unit of the rate, with columns that were recorded beside it, which have a value for
    /// every block. `None` for fewer than two blocks.
    pub fn new(
        course: &Course,
        scale: Scale,
        unit: Unit,
        columns: &[(String, Vec<f64>)],
        events: Vec<Mark>,
    ) -> Option<Self> {
        let blocks: Vec<_> = course.blocks(scale).collect();
        let end = blocks
            .last()
            .map(|block| block.start_s + block.duration_s)?;
        let shown: Vec<usize> = (0..blocks.len())
            .filter(|&at| blocks[at].samples > 0)
            .collect();
        if shown.len() < 2 {
            return None;
        }
        let samples = |at: usize| f64::from(blocks[at].samples);
        let sum: f64 = shown.iter().map(|&at| samples(at) * blocks[at].mean).sum();
        let mean = sum / shown.iter().map(|&at| samples(at)).sum::<f64>();
        let rates: Vec<f64> = shown.iter().map(|&at| blocks[at].mean - mean).collect();
        let full = shown.iter().map(|&at| samples(at)).fold(0.0, f64::max);
        let scatter = scatter(&rates);
        let errors = shown
            .iter()
            .map(|&at| scatter * (full / samples(at)).sqrt());
        let noise = shown
            .iter()
            .map(|&at| (0.5 * blocks[at].mean_square_difference).sqrt())
            .collect();
        let mut strips = vec![
            Strip::new(format!("rate − mean, {unit}"), rates, errors.collect()),
            Strip::new(format!("noise, {unit}"), noise, Vec::new()),
        ];
        for (name, values) in columns {
            let values = shown.iter().filter_map(|&at| values.get(at).copied());
            let strip = Strip::new(name.clone(), values.collect(), Vec::new());
            strips.extend((strip.values.len() == shown.len()).then_some(strip));
        }
        let (name, seconds) = ticks::time_unit(end);
        let times = ticks::told_apart(&ticks::linear(0.0, end / seconds));
        Some(Self {
            span: [0.0, end],
            across: format!("time, {name}"),
            times: times
                .into_iter()
                .map(|(time, label)| (seconds * time, label))
                .collect(),
            at_s: shown
                .iter()
                .map(|&at| (blocks[at].start_s + 0.5 * blocks[at].duration_s) as f32)
                .collect(),
            strips,
            events,
        })
    }

    /// The position of a time, from 0 at the begin of the record to 1 at its end.
    pub fn along(&self, time_s: f64) -> f64 {
        (time_s - self.span[0]) / (self.span[1] - self.span[0])
    }
}

impl Strip {
    fn new(title: String, values: Vec<f64>, errors: Vec<f64>) -> Self {
        let reach = values.iter().enumerate().flat_map(|(at, value)| {
            let error = errors.get(at).copied().unwrap_or(0.0);
            [value - error, value + error]
        });
        let (low, high) = ends(reach.filter(|value| value.is_finite())).unwrap_or((0.0, 0.0));
        // A quantity that does not change has an axis all the same.
        let least = 1e-6 * low.abs().max(high.abs()).max(1e-12);
        let half = (0.5 * (high - low)).max(least);
        let span = [0.5 * (low + high) - half, 0.5 * (low + high) + half];
        Self {
            title,
            ticks: ticks::told_apart(&ticks::linear(span[0], span[1])),
            span,
            values: values.into_iter().map(|value| value as f32).collect(),
            errors: errors.into_iter().map(|error| error as f32).collect(),
        }
    }

    /// The position of a value, from 0 at the lower end of the axis to 1 at the upper end.
    pub fn up(&self, value: f64) -> f64 {
        (value - self.span[0]) / (self.span[1] - self.span[0])
    }
}

/// The standard deviation of a block's mean, from the median of the second differences of neighbouring blocks. A drift
/// does not reach it where it is straight over three blocks, and neither do a few steps.
fn scatter(means: &[f64]) -> f64 {
    let triples = means.windows(3);
    let mut sizes: Vec<f64> = triples
        .map(|means| (means[2] - 2.0 * means[1] + means[0]).abs())
        .collect();
    sizes.sort_by(f64::total_cmp);
    let median = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    median / (MEDIAN * 6_f64.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_have_their_means_and_the_scatter_of_neighbours_as_their_error() {
        let mut course = Course::new();
        // Deterministic noise of whole numbers, with a drift and a step that the median does not notice.
        let mut state = 1_u32;
        let counts: Vec<i32> = (0..64 * 128)
            .map(|n| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 22) as i32 + n / 4 + if n < 64 * 64 { 0 } else { 5000 }
            })
            .collect();
        counts.iter().for_each(|&count| course.push(count, []));
        let scale = Scale::new(0.5, 100.0).unwrap();
        let temperatures = ("temp_C".to_owned(), vec![20.0; 64]);
        let figure = CourseFigure::new(
            &course,
            scale,
            Unit::DegreesPerSecond,
            &[temperatures],
            Vec::new(),
        );
        let figure = figure.unwrap();
        assert_eq!(figure.strips.len(), 3);
        assert_eq!(figure.span, [0.0, 81.92]);
        let rate = &figure.strips[0];
        let mean = |counts: &[i32]| {
            0.5 * counts.iter().map(|&count| f64::from(count)).sum::<f64>() / counts.len() as f64
        };
        let all = mean(&counts);
        assert_eq!(rate.values.len(), 64);
        for (value, block) in rate.values.iter().zip(counts.chunks(128)) {
            assert!((f64::from(*value) - (mean(block) - all)).abs() < 1e-3);
        }
        // Numbers from 0 to 1023 of equal probability, of which 128 are averaged.
        let expected = 0.5 * 1024.0 / 12_f64.sqrt() / 128_f64.sqrt();
        let ratio = f64::from(rate.errors[0]) / expected;
        assert!((0.6..1.6).contains(&ratio), "{ratio}");
        for strip in &figure.strips {
            assert!(strip.ticks.len() >= 2, "{strip:?}");
        }
    }
}
