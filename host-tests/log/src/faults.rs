//! Watches what a logger did to the samples of the axes, and leaves out samples that it repeated or interpolated.

use super::{Places, Repeats, between::Between};
use allanite::{
    faults::{JointRepeats, Reads, SampleFaults},
    integrity::Reason,
};

/// The shares of repeats that are worth a note because smaller ones cannot be told. Chosen by hand.
const NOTED: f64 = 0.1;

/// The axes of a sensor.
const SENSOR: usize = 3;

/// The counts that are watched together.
const TOGETHER: usize = 1 << 10;

/// How the faults of the axes are watched.
#[derive(Clone, Default)]
pub(super) struct Plan {
    /// The counts of zero. Missing ones are 0.
    pub(super) zeros: Vec<i32>,
    /// Whether the columns come row by row, so that the axes can be compared.
    pub(super) by_rows: bool,
    /// The share of the rows that the logger repeated, if rows are left out in which all axes repeat.
    pub(super) left_out: Option<f64>,
    /// How far, in counts, interpolated rows lie from the line between their neighbours, if they are left out.
    pub(super) between: Option<f64>,
    /// What to do with repeats and interpolated rows that are certain.
    pub(super) repeats: Repeats,
}

/// The faults of all axes.
pub(super) struct Faults {
    plan: Plan,
    axes: Vec<SampleFaults>,
    /// What every three axes show together, if there are only whole sensors.
    sensors: Vec<Reads>,
    /// Which rows repeat the one before: of every sensor, or of every axis.
    places: Vec<Places>,
    /// The last row, unless a gap follows it.
    last: Vec<i32>,
    between: Between,
    rows: u64,
    dropped: u64,
}

impl Faults {
    pub(super) fn new(plan: Plan, axes: usize) -> Self {
        let zero = |axis| plan.zeros.get(axis).copied().unwrap_or(0);
        let sensors = match plan.by_rows && axes.is_multiple_of(SENSOR) {
            true => axes / SENSOR,
            false => 0,
        };
        Self {
            axes: (0..axes)
                .map(|axis| SampleFaults::with_zero(zero(axis)))
                .collect(),
            sensors: vec![Reads::new(); sensors],
            places: vec![Places::default(); if sensors > 0 { sensors } else { axes }],
            last: Vec::new(),
            between: Between::default(),
            rows: 0,
            dropped: 0,
            plan,
        }
    }

    /// Whether the columns of a row are needed together.
    pub(super) const fn by_rows(&self) -> bool {
        self.plan.by_rows
    }

    /// Watches some counts of an axis.
    pub(super) fn push(&mut self, axis: usize, counts: &[i32]) {
        let (faults, places) = (&mut self.axes[axis], &mut self.places[axis]);
        let mut steps = [0; TOGETHER];
        for counts in counts.chunks(TOGETHER) {
            faults.push_slice(counts, &mut steps);
            let steps = &steps[..counts.len()];
            steps.iter().for_each(|step| places.push(*step == 0));
        }
    }

    /// Watches the counts of some rows. The first columns are the axes. Rows that are left out are taken out of all
    /// columns.
    pub(super) fn push_rows(&mut self, columns: &mut [Vec<i32>]) {
        let axes = self.axes.len();
        self.rows += columns[0].len() as u64;
        match (self.plan.left_out, self.plan.between) {
            (Some(_), _) => self.drop_repeats(columns),
            (None, Some(limit)) => {
                let found = self.between.find(&columns[..axes], limit);
                self.drop(columns, &found);
            }
            (None, None) => self.between.push(&columns[..axes]),
        }
        if self.sensors.is_empty() {
            return columns[..axes]
                .iter()
                .enumerate()
                .for_each(|(axis, counts)| self.push(axis, counts));
        }
        let axes = self.axes.as_chunks_mut::<SENSOR>().0.iter_mut();
        let counts = columns.as_chunks::<SENSOR>().0;
        let sensors = self.sensors.iter_mut().zip(&mut self.places);
        for ((axes, (reads, places)), [x, y, z]) in axes.zip(sensors).zip(counts) {
            let counts = [x, y, z].map(|counts| counts.chunks(TOGETHER));
            let [x, y, z] = counts;
            let mut steps = [[0; TOGETHER]; SENSOR];
            for ((x, y), z) in x.zip(y).zip(z) {
                for ((axis, counts), steps) in axes.iter_mut().zip([x, y, z]).zip(&mut steps) {
                    axis.push_slice(counts, steps);
                }
                for (row, ((&x, &y), &z)) in x.iter().zip(y).zip(z).enumerate() {
                    let steps = steps.each_ref().map(|steps| steps[row]);
                    reads.push_steps([x, y, z], steps.map(Some));
                    places.push(steps == [0; SENSOR]);
                }
            }
        }
    }

    fn drop_repeats(&mut self, columns: &mut [Vec<i32>]) {
        let axes = &columns[..self.axes.len()];
        let rows = axes[0].len();
        let repeats: Vec<bool> = (0..rows)
            .map(|row| match row.checked_sub(1) {
                Some(before) => axes.iter().all(|axis| axis[row] == axis[before]),
                None => {
                    let mut last = self.last.iter().zip(axes);
                    !self.last.is_empty() && last.all(|(last, axis)| axis[0] == *last)
                }
            })
            .collect();
        if rows > 0 {
            self.last = axes.iter().map(|axis| axis[rows - 1]).collect();
        }
        self.drop(columns, &repeats);
    }

    /// Takes rows out of all columns.
    fn drop(&mut self, columns: &mut [Vec<i32>], rows: &[bool]) {
        self.dropped += rows.iter().filter(|&&is_dropped| is_dropped).count() as u64;
        for column in columns {
            let mut rows = rows.iter();
            column.retain(|_| !rows.next().copied().unwrap_or(false));
        }
    }

    pub(super) fn gap(&mut self) {
        self.last.clear();
        self.between.gap();
        self.axes.iter_mut().for_each(SampleFaults::gap);
        self.places.iter_mut().for_each(Places::gap);
        self.sensors.iter_mut().for_each(Reads::gap);
    }

    fn of_axis(&self, axis: usize) -> (&SampleFaults, Option<JointRepeats>) {
        let reads = self.sensors.get(axis / SENSOR);
        (&self.axes[axis], reads.map(Reads::joint))
    }

    /// Why the curve of an axis is not valid. How many samples repeat is told by their places, where these are regular.
    pub(super) fn verdict(&self, axis: usize) -> Option<Reason> {
        let (faults, joint) = self.of_axis(axis);
        let reads = self.sensors.get(axis / SENSOR);
        let reads = reads.and_then(Reads::verdict);
        let own = || faults.verdict(joint.as_ref()).or(reads);
        // Reads without an answer look like many things that are not there.
        let unanswered = reads.filter(|reason| matches!(reason, Reason::Unanswered { .. }));
        let reason = unanswered.or_else(own)?;
        let Reason::Repeated { times, samples, .. } = reason else {
            return Some(reason);
        };
        let share = self.share_by_places(axis, &faults.repeats(joint.as_ref()));
        Some(share.map_or(reason, |share| Reason::Repeated {
            times,
            changes: samples - (share * samples as f64).round() as u64,
            samples,
        }))
    }

    fn share_by_places(&self, axis: usize, counted: &allanite::faults::Repeats) -> Option<f64> {
        let place = if self.sensors.is_empty() {
            axis
        } else {
            axis / SENSOR
        };
        self.places.get(place)?.share(counted)
    }

    /// Whether the counts of an axis are pulses of an angle, which need no noise of half a count.
    pub(super) fn has_pulses(&self, axis: usize) -> bool {
        let reads = self.sensors.get(axis / SENSOR);
        reads.is_some_and(|reads| reads.joint().is_alternating())
    }

    /// The plan of another pass that leaves out the rows that are no samples of the sensor, if they are certain.
    pub(super) fn without_copies(&self) -> Option<Plan> {
        let Plan {
            left_out,
            between,
            repeats,
            by_rows,
            ..
        } = self.plan;
        if repeats == Repeats::Keep || left_out.is_some() || between.is_some() || !by_rows {
            return None;
        }
        let between = || {
            let is_sound = (0..self.axes.len()).all(|axis| self.verdict(axis).is_none());
            let limit = self.between.limit().filter(|_| is_sound)?;
            Some(Plan {
                between: Some(limit),
                ..self.plan.clone()
            })
        };
        self.without_repeats().or_else(between)
    }

    /// The plan without the repeats, if all of them are certain: hardly any is there by chance, all axes have them, and no
    /// value is held.
    fn without_repeats(&self) -> Option<Plan> {
        let verdicts = (0..self.axes.len()).map(|axis| self.verdict(axis));
        let mut others = verdicts.flatten();
        if others.any(|reason| !matches!(reason, Reason::Repeated { .. })) {
            return None;
        }
        let own = self.axes.iter().map(|faults| faults.repeats(None));
        // An axis that never changes repeats whatever the others do.
        let own = own.filter(|repeats| repeats.chance < 1.0);
        let joint = self.sensors.iter().map(Reads::joint);
        let all: Vec<_> = match self.sensors.is_empty() {
            true => own.collect(),
            false => joint.map(|joint| joint.repeats()).collect(),
        };
        let shares = all.iter().map(|repeats| repeats.share);
        let by_places = all.first().and_then(|first| self.share_by_places(0, first));
        let (least, most) = (
            shares.clone().fold(1.0, f64::min),
            shares.fold(0.0, f64::max),
        );
        let certain = all.iter().all(|repeats| repeats.are_certain());
        // The axes of a sensor repeat together.
        (certain && !all.is_empty() && most - least < 0.005).then(|| Plan {
            left_out: Some(by_places.unwrap_or(0.5 * (least + most))),
            ..self.plan.clone()
        })
    }

    /// The rate of the sensor, of a record with this one, and a note on the rows that were left out.
    pub(super) fn sensor_rate(&self, rate_hz: f64) -> (f64, Option<String>) {
        if self.plan.between.is_some() {
            let share = self.dropped as f64 / self.rows.max(1) as f64;
            let rate_hz = rate_of(1.0 - share, self.rows, rate_hz);
            let note = format!(
                "{:.1} % of the rows lie on the straight line between their neighbours: the sensor runs at {rate_hz} Hz; the {} interpolated rows are left out (keep them with --repeats keep)",
                100.0 * share,
                self.dropped
            );
            return (rate_hz, Some(note));
        }
        let Some(share) = self.plan.left_out else {
            return (rate_hz, None);
        };
        // The sensor's own samples that equal the one before are few and count here.
        let rate_hz = rate_of(1.0 - share, self.rows, rate_hz);
        let note = format!(
            "{}: the sensor runs at {rate_hz} Hz; the {} repeats are left out (keep them with --repeats keep)",
            said(share, true),
            self.dropped
        );
        (rate_hz, Some(note))
    }

    /// The smallest share of repeats that can be told of an axis.
    pub(super) fn least(&self, axis: usize) -> f64 {
        let (faults, joint) = self.of_axis(axis);
        faults.repeats(joint.as_ref()).least
    }
}

/// A note that only larger shares of repeats than this one can be told, if it is worth one.
pub(super) fn bound(least: f64) -> Option<String> {
    (least > NOTED).then(|| {
        format!(
            "repeats below {:.0} % cannot be told: neighbours are equal too often by chance",
            (100.0 * least).ceil()
        )
    })
}

/// The rate of the samples that are the sensor's own, with as many digits as so many samples tell.
pub fn rate_of(own: f64, samples: u64, rate_hz: f64) -> f64 {
    let rate = rate_hz * own;
    let digits = f64::from(samples.max(1000).ilog10()) - 1.0;
    let unit = 10_f64.powf(rate.log10().floor() - digits);
    // Division by a whole number leaves no digits behind the last one.
    match unit < 1.0 {
        true => (rate / unit).round() / (1.0 / unit).round(),
        false => (rate / unit).round() * unit,
    }
}

/// How many samples repeat the one before, in words.
pub fn said(share: f64, regular: bool) -> String {
    const ORDINALS: [&str; 9] = [
        "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth",
    ];
    let (every, times) = ((1.0 / share).round(), (1.0 / (1.0 - share)).round());
    let is_near = |value: f64| (share / value - 1.0).abs() < 0.01;
    if regular && (2.0..=10.0).contains(&every) && is_near(1.0 / every) {
        let every = ORDINALS[every as usize - 2];
        return format!("every {every} sample repeats the one before");
    }
    if regular && times >= 2.0 && is_near(1.0 - 1.0 / times) {
        return format!("every sample is there {times} times");
    }
    let digits = usize::from(share < 0.1);
    format!(
        "{:.digits$} % of the samples repeat the one before",
        100.0 * share
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_said_as_fractions_where_they_are_regular() {
        assert_eq!(said(0.2, true), "every fifth sample repeats the one before");
        assert_eq!(
            said(0.199, false),
            "20 % of the samples repeat the one before"
        );
        assert_eq!(said(0.8, true), "every sample is there 5 times");
        assert_eq!(
            said(0.35, true),
            "35 % of the samples repeat the one before"
        );
        assert_eq!(
            said(0.02, true),
            "2.0 % of the samples repeat the one before"
        );
    }

    #[test]
    fn rates_have_the_digits_that_the_samples_tell() {
        assert_eq!(rate_of(0.80002, 19_999, 500.0), 400.0);
        assert_eq!(rate_of(0.8, 7000, 1250.0), 1000.0);
        assert_eq!(rate_of(2.0 / 3.0, 3, 0.1), 0.0667);
    }

    #[test]
    fn rows_are_left_out_where_all_axes_repeat_and_no_gap_lies_between() {
        let plan = Plan {
            by_rows: true,
            left_out: Some(0.3),
            ..Plan::default()
        };
        let mut faults = Faults::new(plan, 2);
        let mut columns = [vec![1, 1, 1, 2], vec![5, 5, 6, 6], vec![0, 1, 2, 3]];
        faults.push_rows(&mut columns);
        assert_eq!(columns, [vec![1, 1, 2], vec![5, 6, 6], vec![0, 2, 3]]);
        let mut next = [vec![2], vec![6], vec![4]];
        faults.push_rows(&mut next);
        assert_eq!(next, [vec![], vec![], vec![]] as [Vec<i32>; 3]);
        faults.gap();
        let mut next = [vec![2], vec![6], vec![4]];
        faults.push_rows(&mut next);
        assert_eq!(next, [vec![2], vec![6], vec![4]]);
        assert_eq!((faults.rows, faults.dropped), (6, 2));
    }
}
