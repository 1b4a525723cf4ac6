//! The series of a record that a diagnosis tries: the columns beside an axis, and what is formed from them.

use super::{
    cross::{Differences, cross_curve, first_beyond_noise},
    lag::{Found, Lag, Record, Search, Unresolved},
    noise::Noise,
    series::{lagged, mean, rate_of_change, squared},
    steps::{reconstructed, seldom},
};
use allanite::{
    Curve, Error, Model,
    covariate::{CrossCurve, Pair, Slope},
    diagnosis::FollowedCovariate,
    spectrum::Spectrum,
};
use allanite_log::{BINS, Evidence, OCTAVES, block_means::BlockMeans, is_temperature};

/// How a series is formed from its column.
#[derive(Clone, Debug)]
pub enum Form {
    /// The column as it is.
    Itself,
    /// Its rate of change, per second.
    RateOfChange,
    /// The column behind a thermal mass.
    Behind(Box<Lag>),
    /// The square of the distance from the column's mean, behind a thermal mass or not.
    Square {
        /// The mean, in units of the column.
        centre: f64,
        /// The lag in seconds, if there is one.
        lag_s: Option<f64>,
    },
}

/// A series that is tried.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The name, such as `temp_C`, `rate(temp_C)` or `temp_C behind a lag of 28 s`.
    pub name: String,
    /// The column that it is formed from.
    pub column: String,
    /// How it is formed.
    pub form: Form,
    /// Whether it was asked for, or found by its name.
    pub asked: bool,
    /// Lags that are not excluded, of a column as it is.
    pub unresolved: Option<Unresolved>,
    /// The steps in which its column changes, if they are so few that no lag and no absence of a dependence is told.
    pub seldom: Option<usize>,
    /// The standard error of a slope, as a share of it, by what is not known between the steps of its column.
    pub between_steps: f64,
}

/// What bounds a dependence on a column that does not show: the error of the amplitude of the rate per unit of the
/// column, whatever the phase, at the period of the column's main changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The largest amplitude that the record does not exclude, in rate units per unit of the column.
    pub most: f64,
    /// The period of the main changes, in seconds.
    pub period_s: f64,
}

/// Everything that a diagnosis tries beside an axis.
#[derive(Clone, Debug, Default)]
pub struct Candidates {
    /// The candidates.
    pub all: Vec<Candidate>,
    /// What the axis has in common with each of them, octave by octave.
    pub crosses: Vec<CrossCurve<OCTAVES>>,
    /// Those that may act together.
    pub pairs: Vec<Pair<OCTAVES>>,
    means: Option<BlockMeans>,
}

/// By how much a lag has to explain more than the column or its rate of change alone, as `z²`: what an effect has to
/// improve a model by (`Options::threshold`). `cargo xtask study thermal` counts how often it is claimed wrongly.
const LAG_NEEDS: f64 = 8.0;

/// A lag is preferred to a pair of the column and its rate of change that explains by this more. It has as many
/// parameters, and a meaning. Chosen by hand.
const PREFERRED: f64 = 2.0;

impl Candidates {
    /// What is tried of the evidence of an axis: what was asked for, and what is formed from it.
    ///
    /// # Errors
    /// Those of a fit.
    pub fn new(
        curve: &Curve<OCTAVES>,
        spectrum: &Spectrum<BINS>,
        model: &Model,
        evidence: &Evidence,
    ) -> Result<Self, Error> {
        let asked = evidence.covariates.iter().map(|(name, _)| {
            let inner = name.strip_prefix("rate(");
            let inner = inner.and_then(|inner| inner.strip_suffix(')'));
            Candidate {
                name: name.clone(),
                column: inner.unwrap_or(name).to_owned(),
                form: inner.map_or(Form::Itself, |_| Form::RateOfChange),
                asked: true,
                unresolved: None,
                seldom: None,
                between_steps: 0.0,
            }
        });
        let crosses = evidence.covariates.iter().map(|(_, cross)| cross.clone());
        let mut candidates = Self {
            all: asked.collect(),
            crosses: crosses.collect(),
            pairs: evidence.pairs.clone(),
            means: None,
        };
        let (means, stepped) = between_steps(evidence.means.as_ref());
        if let Some(means) = &means
            && evidence.invalid.is_none()
            && !means.rate.is_empty()
        {
            let rate = Differences::new(&means.rate, &means.broken, means.samples, curve.points());
            let record = Record {
                curve,
                spectrum,
                model,
                means,
                rate: &rate,
            };
            candidates.replace(&record, &stepped);
            candidates.form(&record, &stepped)?;
        }
        candidates.means = means;
        Ok(candidates)
    }

    /// Replaces what columns in steps have in common with the axis, and with each other, by that of their course between the steps.
    fn replace(&mut self, record: &Record<'_>, stepped: &[Stepped]) {
        let of_steps = |one: &Candidate| {
            let mut known = stepped.iter();
            known.any(|known| known.course_error > 0.0 && known.column == one.column)
        };
        let of =
            |one: &Candidate| series(one, record.means).map(|series| record.differences(&series));
        for (one, cross) in self.all.iter().zip(&mut self.crosses) {
            if let Some(own) = of(one).filter(|_| of_steps(one)) {
                *cross = cross_curve(record.rate, &own, record.points(), 1);
            }
        }
        for pair in &mut self.pairs {
            let [one, other] = pair.covariates.map(|at| &self.all[at]);
            if let (Some(own), Some(its)) = (of(one), of(other))
                && (of_steps(one) || of_steps(other))
            {
                pair.shared = cross_curve(&own, &its, record.points(), 1);
            }
        }
    }

    /// A curve and a spectrum with the candidates, as a diagnosis takes them.
    pub fn record<'a>(
        &'a self,
        curve: &'a Curve<OCTAVES>,
        spectrum: &'a Spectrum<BINS>,
    ) -> allanite::Record<'a, OCTAVES, BINS> {
        allanite::Record {
            covariates: &self.crosses,
            pairs: &self.pairs,
            ..allanite::Record::new(curve, spectrum)
        }
    }

    /// The lag of a covariate that has one.
    pub fn lag(&self, index: usize) -> Option<&Lag> {
        match &self.all.get(index)?.form {
            Form::Behind(lag) => Some(lag.as_ref()),
            _ => None,
        }
    }

    /// The slopes with which the rate follows covariates, each with its covariate. The errors include those of a lag,
    /// whether it is told or not.
    pub fn slopes(&self, followed: &FollowedCovariate) -> Vec<(Slope, &Candidate)> {
        let between_steps = |slope: Slope, one: &Candidate| Slope {
            error: slope.error.hypot(one.between_steps * slope.value),
            ..slope
        };
        let own = |index: usize, slope: Slope| match (self.lag(index), self.all.get(index)) {
            (Some(lag), _) if followed.beside.is_none() => lag.slope,
            (_, Some(candidate)) => {
                let unresolved = candidate.unresolved.filter(|_| followed.beside.is_none());
                unresolved.map_or(slope, |unresolved| unresolved.widened(slope))
            }
            _ => slope,
        };
        let beside = followed.beside.map(|beside| (beside.index, beside.slope));
        let all = std::iter::once((followed.index, followed.slope)).chain(beside);
        all.filter_map(|(at, slope)| {
            let one = self.all.get(at)?;
            Some((between_steps(own(at, slope), one), one))
        })
        .collect()
    }

    /// What follows the covariates, in rate units, as means of groups of `samples` samples.
    pub fn followed(&self, followed: &FollowedCovariate, samples: u32) -> Vec<f64> {
        let Some(means) = &self.means else {
            return Vec::new();
        };
        let beside = followed.beside.map(|beside| (beside.index, beside.slope));
        let all = std::iter::once((followed.index, followed.slope)).chain(beside);
        let mut sum = vec![0.0; means.rate.len()];
        for (index, slope) in all {
            let Some(candidate) = self.all.get(index) else {
                continue;
            };
            let series = series(candidate, means).unwrap_or_default();
            for (sum, x) in sum.iter_mut().zip(series) {
                *sum += slope.value * x;
            }
        }
        let blocks = (samples / means.samples).max(1) as usize;
        sum.chunks(blocks).map(mean).collect()
    }

    /// Adds what is formed from each column.
    fn form(&mut self, record: &Record<'_>, stepped: &[Stepped]) -> Result<(), Error> {
        let columns: Vec<(usize, String)> = self
            .all
            .iter()
            .enumerate()
            .filter(|(_, one)| matches!(one.form, Form::Itself))
            .map(|(at, one)| (at, one.column.clone()))
            .collect();
        if columns.is_empty() {
            return Ok(());
        }
        let before = Noise::fitted(record.curve, record.spectrum, record.model)?;
        let unstepped = Stepped::NOT;
        for (at, column) in columns {
            let known = stepped.iter().find(|known| known.column == column);
            let known = known.unwrap_or(&unstepped);
            self.form_of(record, (at, known), &column, &before)?;
        }
        Ok(())
    }

    /// Adds what is formed from one column.
    fn form_of(
        &mut self,
        record: &Record<'_>,
        (at, known): (usize, &Stepped),
        column: &str,
        before: &Noise,
    ) -> Result<(), Error> {
        let Some(means) = record.means.column(column) else {
            return Ok(());
        };
        let is_rate =
            |one: &Candidate| one.column == column && matches!(one.form, Form::RateOfChange);
        let asked_rate = self.all.iter().position(is_rate);
        let change = rate_of_change(means, record.means.block_s);
        let of_change = record.cross(&change, 1);
        let rate = match asked_rate {
            // The means of blocks have less of the sensor's noise than neighbouring samples.
            Some(rate) => {
                self.crosses[rate] = of_change;
                rate
            }
            None => {
                let candidate = Candidate {
                    name: format!("rate({column})"),
                    column: column.to_owned(),
                    form: Form::RateOfChange,
                    asked: false,
                    unresolved: None,
                    seldom: None,
                    between_steps: 0.0,
                };
                self.add(candidate, of_change)
            }
        };
        self.pairs.retain(|pair| pair.covariates != [at, rate]);
        let error = known.course_error / deviation(means);
        for one in [at, rate] {
            self.all[one].seldom = known.seldom;
            self.all[one].between_steps = SHARED * error;
        }
        let shortest = first_beyond_noise(&self.crosses[at]);
        let search = Search {
            record,
            column: means,
            shortest,
        };
        let found = match known.seldom {
            Some(_) => None,
            None => search.run(before)?,
        };
        // What is not known between the steps may look like a lag, a rate of change or a square. As `z²`, it is this share of what
        // the column explains.
        let share = error * error;
        let mut may_act_together = error == 0.0;
        let both = Both::new(record, means, &change, shortest);
        let lag = found.and_then(|found| {
            let Found {
                lag,
                unresolved,
                noise,
                explained,
                factor,
            } = found;
            let others = both.explained(&noise, record.samples());
            let alone = others.alone[0].max(others.alone[1]) / factor;
            may_act_together |= share * alone < 1.0;
            let needed = alone * (1.0 + share) + LAG_NEEDS;
            let is_better =
                explained >= needed && explained >= others.together / factor - PREFERRED;
            self.all[at].unresolved = unresolved;
            lag.filter(|_| is_better)
        });
        if lag.is_none() && may_act_together {
            self.pair(record, (at, rate), (means, &change));
        }
        if may_act_together {
            self.add_square(record, at, column, means, None);
        }
        if let Some(lag) = lag {
            let lag_s = lag.lag_s;
            let candidate = Candidate {
                name: format!("{column} behind a lag of {}", seconds(lag_s)),
                column: column.to_owned(),
                form: Form::Behind(Box::new(lag.clone())),
                asked: false,
                unresolved: None,
                seldom: None,
                between_steps: 0.0,
            };
            let behind = self.add(candidate, lag.cross);
            self.all[behind].between_steps = SHARED * error;
            if !may_act_together {
                return Ok(());
            }
            let series = lagged(means, lag_s / record.means.block_s);
            self.add_square(record, behind, column, &series, Some(lag_s));
        }
        Ok(())
    }

    fn add(&mut self, candidate: Candidate, cross: CrossCurve<OCTAVES>) -> usize {
        self.all.push(candidate);
        self.crosses.push(cross);
        self.all.len() - 1
    }

    /// Adds the square of a series, which may act beside it.
    fn add_square(
        &mut self,
        record: &Record<'_>,
        at: usize,
        column: &str,
        series: &[f64],
        lag_s: Option<f64>,
    ) {
        let centre = mean(series);
        let square = squared(series, centre);
        let behind = lag_s.map_or(String::new(), |lag_s| {
            format!(" behind a lag of {}", seconds(lag_s))
        });
        let sign = if centre < 0.0 { '+' } else { '−' };
        let candidate = Candidate {
            name: format!("({column} {sign} {:.4})²{behind}", centre.abs()),
            column: column.to_owned(),
            form: Form::Square { centre, lag_s },
            asked: false,
            unresolved: None,
            seldom: None,
            between_steps: 0.0,
        };
        let cross = record.cross(&square, 1);
        let square_at = self.add(candidate, cross);
        self.pair(record, (at, square_at), (series, &square));
    }

    /// Adds a pair of covariates that may act together.
    fn pair(&mut self, record: &Record<'_>, places: (usize, usize), series: (&[f64], &[f64])) {
        let [one, other] = [series.0, series.1].map(|series| record.differences(series));
        self.pairs.push(Pair {
            covariates: [places.0, places.1],
            shared: cross_curve(&one, &other, record.points(), 1),
        });
    }

    /// The bound on a dependence on a column that does not show beside a noise, whatever its phase.
    pub fn bound(
        &self,
        curve: &Curve<OCTAVES>,
        index: usize,
        noise: impl Fn(usize) -> f64,
    ) -> Option<Bound> {
        let candidate = self.all.get(index)?;
        let is_rate = |one: &Candidate| {
            one.column == candidate.column && matches!(one.form, Form::RateOfChange)
        };
        let rate = self.all.iter().position(is_rate)?;
        let (points, crosses) = (curve.points(), [&self.crosses[index], &self.crosses[rate]]);
        let [value, change] = crosses.map(|cross| Slope::of(cross, points, &noise));
        let (value, change) = (value?, change?);
        let shortest = first_beyond_noise(crosses[0]).max(first_beyond_noise(crosses[1]));
        // Of a sinusoid, the squares of the rate of change are (2π/period)² times those of the value.
        let square = |cross: &CrossCurve<OCTAVES>| -> f64 {
            let octaves = cross.points().iter().enumerate();
            let counted = octaves.filter(|(_, point)| point.m >= shortest);
            let weighted = counted.map(|(k, point)| point.variance / f64::from(point.m) / noise(k));
            weighted.sum()
        };
        let angular = (square(crosses[1]) / square(crosses[0])).sqrt();
        let most = |slope: &Slope| {
            let (lower, upper) = slope.interval();
            lower.abs().max(upper.abs())
        };
        let bound = most(&value).hypot(angular * most(&change));
        bound.is_finite().then_some(Bound {
            most: bound,
            period_s: 2.0 * std::f64::consts::PI / angular,
        })
    }
}

/// The root of the mean square of the distances from the mean; at least the smallest number above zero.
fn deviation(means: &[f64]) -> f64 {
    mean(&squared(means, mean(means)))
        .sqrt()
        .max(f64::MIN_POSITIVE)
}

/// A temperature that changes in steps.
struct Stepped {
    column: String,
    /// The number of its steps, if they are few.
    seldom: Option<usize>,
    /// What its course between the steps is off by, rms; zero where it is as the column says.
    course_error: f64,
}

impl Stepped {
    /// A column that does not change in steps.
    const NOT: Self = Self {
        column: String::new(),
        seldom: None,
        course_error: 0.0,
    };
}

/// What the course between the steps is off by, as far as it goes with the column: what a slope takes over of it. Chosen by hand:
/// with it, `cargo xtask study thermal --steps` finds the slope in its interval in 858 of 888 records.
const SHARED: f64 = 0.25;

/// Means in which temperatures that change in steps have the course between these, and what is known of such temperatures.
fn between_steps(means: Option<&BlockMeans>) -> (Option<BlockMeans>, Vec<Stepped>) {
    let Some(means) = means else {
        return (None, Vec::new());
    };
    let (mut stepped, mut columns) = (Vec::new(), Vec::new());
    for (column, values) in means.columns.iter() {
        let course = reconstructed(values).filter(|_| is_temperature(column));
        if is_temperature(column) {
            stepped.push(Stepped {
                column: column.clone(),
                seldom: seldom(values),
                course_error: course.as_ref().map_or(0.0, |course| course.error),
            });
        }
        columns.push((
            column.clone(),
            course.map_or_else(|| values.clone(), |course| course.means.into()),
        ));
    }
    let means = BlockMeans {
        columns: columns.into(),
        ..means.clone()
    };
    (Some(means), stepped)
}

/// The block means of a candidate.
fn series(candidate: &Candidate, means: &BlockMeans) -> Option<Vec<f64>> {
    let column = means.column(&candidate.column)?;
    let behind = |lag_s: f64| lagged(column, lag_s / means.block_s);
    Some(match &candidate.form {
        Form::Itself => column.to_vec(),
        Form::RateOfChange => rate_of_change(column, means.block_s),
        Form::Behind(lag) => behind(lag.lag_s),
        Form::Square { centre, lag_s } => {
            let series = lag_s.map_or_else(|| column.to_vec(), behind);
            squared(&series, *centre)
        }
    })
}

/// A lag in words, to two digits. That of no lag is 0 s, whose logarithm is not finite.
pub fn seconds(lag_s: f64) -> String {
    let digits = (1.0 - lag_s.log10().floor()).clamp(0.0, 12.0) as usize;
    let digits = if lag_s > 0.0 { digits } else { 0 };
    format!("{lag_s:.digits$} s")
}

/// A column and its rate of change, in the octaves that count.
struct Both {
    value: CrossCurve<OCTAVES>,
    change: CrossCurve<OCTAVES>,
    shared: CrossCurve<OCTAVES>,
}

/// What a column and its rate of change explain, as `z²` times the factor of the slope's variance.
struct Explained {
    alone: [f64; 2],
    together: f64,
}

impl Both {
    fn new(record: &Record<'_>, value: &[f64], change: &[f64], shortest: u32) -> Self {
        let [of_value, of_change] = [value, change].map(|series| record.differences(series));
        let points = record.points();
        Self {
            value: cross_curve(record.rate, &of_value, points, shortest),
            change: cross_curve(record.rate, &of_change, points, shortest),
            shared: cross_curve(&of_value, &of_change, points, shortest),
        }
    }

    fn explained(&self, noise: &Noise, samples: f64) -> Explained {
        let (b, a) = noise.sums(&self.value, samples);
        let (other_b, other_a) = noise.sums(&self.change, samples);
        let (shared, _) = noise.sums(&self.shared, samples);
        let ratio = |b: f64, a: f64| if a > 0.0 { b * b / a } else { 0.0 };
        let alone = [ratio(b, a), ratio(other_b, other_a)];
        let determinant = a * other_a - shared * shared;
        let together = match determinant > 1e-6 * a * other_a {
            true => {
                (b * b * other_a - 2.0 * b * other_b * shared + other_b * other_b * a) / determinant
            }
            false => alone[0].max(alone[1]),
        };
        Explained { alone, together }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lags_of_any_size_have_words() {
        let lags = [0.0, 1e-300, 0.0123, 2.64, 28.4, 1234.5, f64::INFINITY];
        let words = lags.map(seconds);
        assert_eq!(
            words,
            [
                "0 s",
                "0.000000000000 s",
                "0.012 s",
                "2.6 s",
                "28 s",
                "1234 s",
                "inf s"
            ]
        );
    }
}
