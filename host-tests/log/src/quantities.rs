//! Recognises by their values which columns can be the axes of a gyro, where no name tells it.
//!
//! An accelerometer at rest feels gravity in every row, whatever its direction is. A quaternion has the length 1. Angles and
//! velocities change from row to row by far less than over many rows. A temperature and a pressure are far from zero beside
//! their scatter. What is left may be the axes of a gyro, of a magnetometer, or increments: if more than three columns are
//! left, only the user knows.

use super::columns::{AxisColumn, Columns, Look};
use crate::{
    MOST_AXES,
    failure::{Failure, Place},
    unit::Sensor,
};
use std::{ops::Range, path::Path};

/// Gravity in g, in m/s² and in thousandths of g.
const GRAVITIES: [Range<f64>; 3] = [0.95..1.05, 9.3..10.3, 950.0..1050.0];

/// Gravity in counts of 16 bits over ranges of 2, 4, 8 and 16 g, and how far from it an accelerometer without calibration may be.
const COUNTS_OF_GRAVITY: [f64; 4] = [16_384.0, 8192.0, 4096.0, 2048.0];
const UNCALIBRATED: f64 = 0.03;

/// The length of gravity scatters by at most this share of it, and that of a quaternion. Chosen by hand.
const SCATTERS: (f64, f64) = (0.06, 1e-4);

/// A value is far from zero if its mean is so many times its scatter: no gyro's bias is. Chosen by hand.
const FAR: f64 = 500.0;

/// Three columns are those of a gyro, and not of a magnetometer, if the length of their mean is below so many times their
/// scatter. The field of the earth is above it. Chosen by hand.
const NEAR: f64 = 15.0;

/// The differences of neighbours of a smooth quantity have a variance below this share of that of white noise. Chosen by hand.
const SMOOTH: f64 = 0.05;

/// The differences of angles have a variance below this share in so many rows. Chosen by hand.
const SMOOTHEST: f64 = 0.02;
const MANY_ROWS: usize = 256;

/// Those of noise have one above this share.
const ROUGH: f64 = 0.5;

/// A flag has its usual value in at least this share of the rows.
const USUAL: f64 = 0.9;

/// The fewest rows that tell a quantity.
const LEAST_ROWS: usize = 16;

/// The most choices that are spelled out.
const MOST_CHOICES: usize = 8;

/// What the values of some columns show.
#[derive(Debug, Default, PartialEq, Eq)]
struct Shown {
    /// The first columns of three that feel gravity.
    gravity: Vec<usize>,
    /// The columns that may be the axes of a gyro.
    open: Vec<usize>,
}

/// Mean and scatter of some numbers.
struct Statistics {
    mean: f64,
    /// The deviation of the differences of neighbours over √2.
    scatter: f64,
    /// The variance of these differences over twice the variance: 1 for white noise.
    roughness: f64,
}

impl Statistics {
    fn of(numbers: &[f64]) -> Self {
        let count = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / count;
        let variance = numbers.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / count;
        let steps = numbers.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
        let squares = 0.5 * steps.sum::<f64>() / (count - 1.0);
        Self {
            mean,
            scatter: squares.sqrt(),
            roughness: squares / variance,
        }
    }
}

impl Columns {
    /// What the first values of these columns, which are in their order, show.
    fn shown(&self, columns: &[usize]) -> Shown {
        let mut shown = Shown::default();
        for run in columns.chunk_by(|one, other| one + 1 == *other) {
            let mut rest = run;
            while let Some((_, others)) = rest.split_first() {
                if rest.get(..4).is_some_and(|four| self.is_quaternion(four)) {
                    rest = &rest[4..];
                } else if let Some(until) = self.until_quaternion(rest) {
                    self.show_run(&rest[..until], &mut shown);
                    rest = &rest[until..];
                } else {
                    rest = others;
                }
            }
        }
        shown
    }

    /// The number of columns in front of the next quaternion or the end.
    fn until_quaternion(&self, run: &[usize]) -> Option<usize> {
        let next = run.windows(4).position(|four| self.is_quaternion(four));
        next.or(Some(run.len())).filter(|&until| until > 0)
    }

    /// Shows what is in columns one behind the other, among which there is no quaternion.
    fn show_run(&self, run: &[usize], shown: &mut Shown) {
        let felt = run.windows(3).filter(|three| self.feel_gravity(three));
        let felt: Vec<usize> = felt.map(|three| three[0]).collect();
        let mut rest = run;
        for overlapping in felt.chunk_by(|one, other| other - one < 3) {
            // An axis that feels gravity makes other columns next to it look so too. The axes of sensors come by threes.
            let are_threes = |part: &[usize]| {
                let open = part.iter().filter(|&&column| self.is_open(column)).count();
                open.is_multiple_of(3)
            };
            let is_whole = |first: &&usize| {
                let at = rest.iter().position(|column| column == *first);
                at.is_some_and(|at| {
                    let behind = rest.get(at + 3..).unwrap_or_default();
                    are_threes(&rest[..at]) && are_threes(behind)
                })
            };
            let mut whole = overlapping.iter().filter(is_whole);
            let only = match (overlapping, whole.next(), whole.next()) {
                (&[only], ..) | (_, Some(&only), None) => only,
                _ => continue,
            };
            let Some(at) = rest.iter().position(|&column| column == only) else {
                continue;
            };
            let is_open = |column: &usize| self.is_open(*column);
            shown
                .open
                .extend(rest[..at].iter().copied().filter(is_open));
            shown.gravity.push(only);
            rest = &rest[at + 3..];
        }
        shown
            .open
            .extend(rest.iter().copied().filter(|&column| self.is_open(column)));
    }

    /// Whether three columns feel gravity, in a unit or in counts.
    fn feel_gravity(&self, three: &[usize]) -> bool {
        let Some((mean, scatter)) = self.length(three) else {
            return false;
        };
        let is_near = |gravity: &f64| (mean / gravity - 1.0).abs() < UNCALIBRATED;
        let are_counts = || {
            let mut numbers = three.iter().flat_map(|&column| self.head(column));
            numbers.all(|number| number.fract() == 0.0)
        };
        let is_gravity = GRAVITIES.iter().any(|range| range.contains(&mean))
            || (COUNTS_OF_GRAVITY.iter().any(is_near) && are_counts());
        // The noise of an accelerometer is that of a sensor on all axes, or rounded away.
        let roughness = three.iter().map(|&column| self.roughness(column));
        let roughness: Vec<f64> = roughness.filter(|one| one.is_finite()).collect();
        let is_smooth = roughness.iter().any(|&one| one <= SMOOTH);
        let is_rough = roughness.iter().any(|&one| one > ROUGH);
        is_gravity && scatter < SCATTERS.0 * mean && !(is_smooth && is_rough)
    }

    fn is_quaternion(&self, four: &[usize]) -> bool {
        let is_one =
            |(mean, scatter): (f64, f64)| (mean - 1.0).abs() < SCATTERS.1 && scatter < SCATTERS.1;
        self.length(four).is_some_and(is_one)
    }

    /// The variance of differences of neighbours as a share of that of white noise; NaN if the first values are all the same.
    fn roughness(&self, column: usize) -> f64 {
        Statistics::of(self.head(column)).roughness
    }

    fn head(&self, column: usize) -> &[f64] {
        self.heads.get(column).map_or(&[], Vec::as_slice)
    }

    /// The mean and the deviation of the length of a vector.
    fn length(&self, columns: &[usize]) -> Option<(f64, f64)> {
        let heads: Vec<&[f64]> = columns.iter().map(|&column| self.head(column)).collect();
        let rows = heads.iter().map(|head| head.len()).min()?;
        if rows < LEAST_ROWS || heads.iter().any(|head| head.len() != rows) {
            return None;
        }
        let length = |row: usize| {
            heads
                .iter()
                .map(|head| head[row].powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let lengths: Vec<f64> = (0..rows).map(length).collect();
        let mean = lengths.iter().sum::<f64>() / rows as f64;
        let squares: f64 = lengths.iter().map(|one| (one - mean).powi(2)).sum();
        Some((mean, (squares / rows as f64).sqrt()))
    }

    /// Whether a column may be an axis: it is no constant, no flag, nothing far from zero, and not smooth.
    fn is_open(&self, column: usize) -> bool {
        let head = self.head(column);
        if head.len() < LEAST_ROWS {
            return true;
        }
        let is_whole = head.iter().all(|one| one.fract() == 0.0);
        let mut sorted = head.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let usual = sorted
            .chunk_by(|one, other| one == other)
            .map(<[f64]>::len)
            .max();
        let is_flag = usual.is_some_and(|usual| usual as f64 >= USUAL * head.len() as f64);
        let Statistics {
            mean,
            scatter,
            roughness,
        } = Statistics::of(head);
        !(is_whole && is_flag) && scatter > 0.0 && mean.abs() < FAR * scatter && roughness > SMOOTH
    }

    /// The axes among columns that no name tells to be axes, if more than three columns come into question or gravity is felt.
    ///
    /// # Errors
    /// When several sensors come into question.
    pub(super) fn told_by_values(
        &self,
        path: &Path,
        wanted: Option<Sensor>,
        columns: &[usize],
    ) -> Result<Option<(Sensor, Vec<usize>)>, Failure> {
        let shown = self.shown(columns);
        // A comment `unit=deg/s` says that all columns are rates.
        let is_told = self.said.contains("unit=") || !(4..=MOST_AXES).contains(&columns.len());
        if shown.gravity.is_empty() && is_told {
            self.check_for_angles(path, columns)?;
            return Ok(None);
        }
        let three = |first: usize| vec![first, first + 1, first + 2];
        let is_alone = shown.open.is_empty() && columns.len() == 3;
        match (wanted, shown.gravity.as_slice()) {
            (Some(Sensor::Accelerometer), &[only]) => {
                return Ok(Some((Sensor::Accelerometer, three(only))));
            }
            (Some(Sensor::Gyro), [_]) if is_alone => {
                return Ok(Some((Sensor::Gyro, columns.to_vec())));
            }
            (None | Some(Sensor::Gyro), gravity) if gravity.len() <= 1 => {
                let is_gyro = gravity.is_empty() || self.is_near(&shown.open);
                let is_whole =
                    shown.open.len() == 3 || !self.is_beside_angles(&shown.open, columns);
                if (1..=3).contains(&shown.open.len()) && is_gyro && is_whole {
                    return Ok(Some((Sensor::Gyro, shown.open)));
                }
            }
            _ => {}
        }
        Err(self.open_choice(path, &shown, columns))
    }

    /// Checks that three columns of a text are not angles.
    ///
    /// # Errors
    /// When all of them are smooth.
    fn check_for_angles(&self, path: &Path, columns: &[usize]) -> Result<(), Failure> {
        let &[first, second, third] = columns else {
            return Ok(());
        };
        let is_smooth = |column: &usize| {
            let values = self.longer.get(*column).map_or(&[][..], Vec::as_slice);
            values.len() >= MANY_ROWS && Statistics::of(values).roughness <= SMOOTHEST
        };
        if self.said.contains("unit=") || !columns.iter().all(is_smooth) {
            return Ok(());
        }
        Err(Place::file(path).failure(
            format!(
                "{} hardly change from row to row, as angles do and the rates of a sensor at rest do not",
                self.list(columns)
            ),
            format!(
                "give rates, or --columns gx={},gy={},gz={} if they are",
                first + 1,
                second + 1,
                third + 1
            ),
        ))
    }

    /// Whether another column next to these ones is smooth, as an angle is, so that they may be angles too.
    fn is_beside_angles(&self, open: &[usize], columns: &[usize]) -> bool {
        let is_next = |column: &usize| open.iter().any(|own| own.abs_diff(*column) == 1);
        let is_smooth = |column: &usize| {
            self.head(*column).len() >= LEAST_ROWS && self.roughness(*column) <= SMOOTH
        };
        let mut others = columns.iter().filter(|column| !open.contains(column));
        others.any(|column| is_next(column) && is_smooth(column))
    }

    /// Whether the mean of three columns is near zero beside their scatter, as that of a gyro at rest is.
    fn is_near(&self, columns: &[usize]) -> bool {
        let of = |&column: &usize| Statistics::of(self.head(column));
        let all: Vec<Statistics> = columns.iter().map(of).collect();
        let sum = |of: fn(&Statistics) -> f64| all.iter().map(|one| of(one).powi(2)).sum::<f64>();
        sum(|one| one.mean) < NEAR.powi(2) * sum(|one| one.scatter)
    }

    /// The failure to know which of several columns are the axes, with all choices.
    fn open_choice(&self, path: &Path, shown: &Shown, columns: &[usize]) -> Failure {
        let open = if shown.open.len() < 3 {
            columns
        } else {
            &shown.open
        };
        let runs = open.chunk_by(|one, other| one + 1 == *other);
        let triples = |run: &[usize]| -> Vec<usize> {
            let step = if run.len().is_multiple_of(3) { 3 } else { 1 };
            (0..run.len().saturating_sub(2))
                .step_by(step)
                .map(|at| run[at])
                .collect()
        };
        let firsts: Vec<usize> = runs.flat_map(triples).collect();
        let list = |first: &usize| format!("{} to {}", self.called(*first), self.called(first + 2));
        let option = |first: &usize| {
            format!(
                "--columns gx={},gy={},gz={}",
                first + 1,
                first + 2,
                first + 3
            )
        };
        let join = |texts: Vec<String>| texts.join(" or ");
        let shown_firsts = &firsts[..firsts.len().min(MOST_CHOICES)];
        let mut what = match shown_firsts {
            [] => format!("no name tells which of {} are the axes", self.list(columns)),
            firsts => format!(
                "{} may be the axes of a gyro",
                join(firsts.iter().map(list).collect())
            ),
        };
        let mut options: Vec<String> = shown_firsts.iter().map(option).collect();
        if let [only] = shown.gravity.as_slice() {
            what += &format!(
                ", and {} feel gravity, as an accelerometer does",
                list(only)
            );
            options.push("--sensor accel".into());
        }
        if options.is_empty() {
            options.push("--columns, such as gx=3,gy=4,gz=5".into());
        }
        Place::file(path).failure(what, format!("choose with {}", join(options)))
    }

    /// The three columns without names of an accelerometer that stand beside these axes, if their values show it.
    pub(super) fn gravity_beside(&self, axes: &[AxisColumn]) -> Option<[usize; 3]> {
        let is_free = |column: &usize| {
            self.looks[*column] == Look::Number
                && self.name(*column).is_none()
                && axes.iter().all(|axis| axis.column != *column)
        };
        let free: Vec<usize> = (0..self.looks.len()).filter(is_free).collect();
        match self.shown(&free).gravity.as_slice() {
            &[first] => Some([first, first + 1, first + 2]),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// White noise of these means and scatters.
    fn columns(values: &[(f64, f64)]) -> Columns {
        let mut state = 7_u32;
        let mut uniform = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state >> 8) / f64::from(1 << 24) - 0.5
        };
        let head = |&(mean, scatter): &(f64, f64)| {
            (0..100).map(|_| mean + 3.0 * scatter * uniform()).collect()
        };
        Columns {
            names: None,
            looks: vec![Look::Number; values.len()],
            heads: values.iter().map(head).collect(),
            longer: Vec::new(),
            tags: Vec::new(),
            defined: Vec::new(),
            said: String::new(),
        }
    }

    const GYRO: [(f64, f64); 3] = [(0.1, 0.1), (-0.3, 0.1), (0.2, 0.1)];
    const FORCE: [(f64, f64); 3] = [(0.1, 0.05), (-0.2, 0.05), (9.8, 0.05)];
    const FIELD: [(f64, f64); 3] = [(20.0, 0.4), (-30.0, 0.4), (5.0, 0.4)];
    const TEMPERATURE: [(f64, f64); 1] = [(25.0, 0.02)];

    fn told(
        values: &[&[(f64, f64)]],
        wanted: Option<Sensor>,
    ) -> Result<Option<(Sensor, Vec<usize>)>, String> {
        let columns = columns(&values.concat());
        let all: Vec<usize> = (0..columns.looks.len()).collect();
        columns
            .told_by_values(Path::new("a.csv"), wanted, &all)
            .map_err(|failure| failure.to_string())
    }

    #[test]
    fn three_columns_beside_those_that_feel_gravity_are_the_gyro() {
        for (values, first) in [
            (&[&FORCE[..], &GYRO] as &[&[(f64, f64)]], 3),
            (&[&GYRO, &FORCE], 0),
            (&[&TEMPERATURE, &GYRO, &FORCE], 1),
            (&[&GYRO, &TEMPERATURE], 0),
            (&[&GYRO, &[FORCE[2], FORCE[0], FORCE[1]]], 0),
            (&[&TEMPERATURE, &GYRO, &[FORCE[2], FORCE[0], FORCE[1]]], 1),
        ] {
            assert_eq!(
                told(values, None),
                Ok(Some((Sensor::Gyro, vec![first, first + 1, first + 2])))
            );
        }
        let accelerometer = told(&[&GYRO, &FORCE], Some(Sensor::Accelerometer));
        assert_eq!(
            accelerometer,
            Ok(Some((Sensor::Accelerometer, vec![3, 4, 5])))
        );
        assert_eq!(told(&[&GYRO], None), Ok(None));
    }

    #[test]
    fn choices_are_spelled_out_where_values_do_not_tell() {
        for (values, line) in [
            (
                &[&GYRO[..], &GYRO] as &[&[(f64, f64)]],
                "a.csv: column 1 to column 3 or column 4 to column 6 may be the axes of a gyro; choose with --columns \
                 gx=1,gy=2,gz=3 or --columns gx=4,gy=5,gz=6",
            ),
            (
                &[&FORCE, &FIELD],
                "a.csv: column 4 to column 6 may be the axes of a gyro, and column 1 to column 3 feel gravity, as an \
                 accelerometer does; choose with --columns gx=4,gy=5,gz=6 or --sensor accel",
            ),
            (
                &[&FORCE],
                "a.csv: column 1 to column 3 may be the axes of a gyro, and column 1 to column 3 feel gravity, as an \
                 accelerometer does; choose with --columns gx=1,gy=2,gz=3 or --sensor accel",
            ),
        ] {
            assert_eq!(told(values, None), Err(line.into()));
        }
    }
}
