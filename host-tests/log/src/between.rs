//! Recognises rows that a logger interpolated between two samples of the sensor, as a common table of two rates has them.

/// The rows that are examined. Where there are interpolated rows, they are everywhere.
const EXAMINED: u64 = 1 << 16;

/// The fewest interpolated rows, and their least share, that are worth a decision. Chosen by hand.
const FEWEST: u64 = 20;
const LEAST: f64 = 0.002;

/// Distances from the line are counted by their octaves, in counts. What lies there by chance grows by a factor of two with
/// each of them at least, and of two axes beside the longest step by four. Interpolated rows have the distance that rounding
/// leaves, and hardly any more come within so many octaves above it.
const OCTAVES: usize = 32;
const EMPTY_OCTAVES: usize = 4;
const MORE: f64 = 1.1;

/// A third of the sensor's own samples lie between their neighbours on one axis. So large a share of them is off the line, or
/// the counts are too few to tell a line. Chosen by hand.
const OTHERS: f64 = 0.1;

/// A step of fewer counts tells no line.
const SHORTEST: i64 = 8;

/// So many times more rows lie on the line than chance puts there. Chosen by hand: the estimate of chance is a rough one.
const BEYOND_CHANCE: f64 = 10.0;

/// Counts rows whose values all lie the same share of the way from the row before to the row behind.
#[derive(Clone, Debug, Default)]
pub(super) struct Between {
    examined: u64,
    /// By octaves of the distance from the line.
    distances: [u64; OCTAVES],
    last: [Vec<i32>; 2],
    /// Of each axis.
    grids: Vec<Grid>,
}

/// How fine the values of an axis are beside their changes.
#[derive(Clone, Debug, Default)]
struct Grid {
    /// The least step between neighbours that differ; 0 for none yet.
    least: u64,
    /// The sum of the absolute second differences, and their number.
    bends: f64,
    rows: f64,
}

impl Grid {
    fn push(&mut self, [before, row, behind]: [i32; 3]) {
        let [step, next] = [row, behind].map(i64::from);
        let (step, next) = (step - i64::from(before), next - step);
        if step != 0 && (self.least == 0 || step.unsigned_abs() < self.least) {
            self.least = step.unsigned_abs();
        }
        self.bends += (next - step).unsigned_abs() as f64;
        self.rows += 1.0;
    }

    /// The probability that a row lies within a distance of a point that has nothing to do with it, about.
    fn chance(&self, distance: f64) -> f64 {
        let window = 2.0 * distance.max(self.least as f64);
        (window * self.rows / self.bends).min(1.0)
    }
}

impl Between {
    /// Examines rows of at least two axes, which follow those before.
    pub(super) fn push(&mut self, axes: &[Vec<i32>]) {
        if axes.len() < 2 || self.examined >= EXAMINED {
            return;
        }
        let rows = axes.first().map_or(0, Vec::len);
        self.examined += rows as u64;
        self.grids.resize(axes.len(), Grid::default());
        for row in 0..rows {
            let here: Vec<i32> = axes.iter().map(|axis| axis[row]).collect();
            let rows = self.last[0].iter().zip(&self.last[1]).zip(&here);
            for (grid, ((&before, &row), &behind)) in self.grids.iter_mut().zip(rows) {
                grid.push([before, row, behind]);
            }
            if let Some(distance) = self.distance_of_last(&here) {
                let octave = distance.max(1.0).log2().ceil() as usize;
                self.distances[octave.min(OCTAVES - 1)] += 1;
            }
            self.step_to(here);
        }
    }

    pub(super) fn gap(&mut self) {
        self.last = Default::default();
    }

    fn step_to(&mut self, here: Vec<i32>) {
        self.last.rotate_left(1);
        self.last[1] = here;
    }

    /// By how many counts the row before this one is off the line between its neighbours, if it lies between them.
    fn distance_of_last(&self, here: &[i32]) -> Option<f64> {
        let [before, row] = &self.last;
        distance([before, row, here])
    }

    /// The distance, in counts, that interpolated rows keep, if there are any.
    pub(super) fn limit(&self) -> Option<f64> {
        let least = (LEAST * self.examined as f64).max(FEWEST as f64);
        let up_to = |octave: usize| self.distances[..=octave].iter().sum::<u64>() as f64;
        let all = up_to(OCTAVES - 1);
        let is_limit = |&octave: &usize| {
            let (found, further) = (up_to(octave), up_to(octave + EMPTY_OCTAVES));
            let others = self.examined as f64 - found;
            found >= least && further <= MORE * found && all - further >= OTHERS * others
        };
        // Where a half of a decimal is rounded, some rows are on the line and others half a step off.
        let last = (0..OCTAVES - EMPTY_OCTAVES).rfind(is_limit)?;
        let octave = (0..last).find(|&octave| MORE * up_to(octave) >= up_to(last));
        let octave = octave.unwrap_or(last);
        // The tail of what rounding leaves reaches into the next octave.
        let limit = (2_u64 << octave) as f64;
        (up_to(octave) >= BEYOND_CHANCE * self.expected(limit)).then_some(limit)
    }

    /// The number of rows that lie so near the line by chance, about. The axis with the longest step tells the place on the line,
    /// which a third of all rows have between the others.
    fn expected(&self, limit: f64) -> f64 {
        let mut chances: Vec<f64> = self.grids.iter().map(|grid| grid.chance(limit)).collect();
        chances.sort_unstable_by(f64::total_cmp);
        chances.iter().skip(1).product::<f64>() * self.examined as f64 / 3.0
    }

    /// Which of these rows lie within a distance of the line between their neighbours. The last one is not among them,
    /// because the row behind it is not known.
    pub(super) fn find(&mut self, axes: &[Vec<i32>], limit: f64) -> Vec<bool> {
        let rows = axes.first().map_or(0, Vec::len);
        let mut found = vec![false; rows];
        for row in 0..rows {
            let here: Vec<i32> = axes.iter().map(|axis| axis[row]).collect();
            if let Some(before) = row.checked_sub(1) {
                let distance = self.distance_of_last(&here);
                found[before] = distance.is_some_and(|distance| distance <= limit);
            }
            self.step_to(here);
        }
        found
    }
}

/// The distance of the middle one of three rows from the line between the others, if it lies between them.
fn distance([before, row, behind]: [&[i32]; 3]) -> Option<f64> {
    let steps = || {
        let rows = before.iter().zip(row).zip(behind);
        rows.map(|((&before, &row), &behind)| {
            [row, behind].map(|count| i64::from(count) - i64::from(before))
        })
    };
    let [part, whole] = steps().max_by_key(|[_, whole]| whole.unsigned_abs())?;
    let is_between = part.signum() == whole.signum() && part.abs() < whole.abs();
    if whole.abs() < SHORTEST || !is_between {
        return None;
    }
    let distances = steps().map(|[own_part, own_whole]| {
        // Steps of counts have 33 bits.
        let off =
            i128::from(own_part) * i128::from(whole) - i128::from(part) * i128::from(own_whole);
        off.unsigned_abs() as f64 / (whole.unsigned_abs() + own_whole.unsigned_abs()) as f64
    });
    Some(distances.fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt as _, SeedableRng as _};
    use rand_xoshiro::Xoshiro256PlusPlus;

    /// Noise of so many counts on three axes, each value of which is the mean of so many.
    fn noise(rows: usize, counts: f64, mean_of: usize) -> [Vec<i32>; 3] {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(rows as u64);
        [(); 3].map(|()| {
            let raw: Vec<f64> = (0..rows + mean_of)
                .map(|_| counts * random.random_range(-1.0..1.0))
                .collect();
            let means = raw.windows(mean_of).take(rows);
            means
                .map(|window| (window.iter().sum::<f64>() / mean_of as f64) as i32)
                .collect()
        })
    }

    /// The rows with others between them, which an interpolation puts there.
    fn filled(axes: &[Vec<i32>; 3], every: usize, share: f64) -> [Vec<i32>; 3] {
        axes.clone().map(|axis| {
            let pairs = axis.windows(2).enumerate();
            let rows = pairs.flat_map(|(row, pair)| {
                let step = f64::from(pair[1]) - f64::from(pair[0]);
                let between = (f64::from(pair[0]) + share * step).round() as i32;
                let is_filled = row % every == 0;
                [Some(pair[0]), is_filled.then_some(between)]
            });
            rows.flatten().collect()
        })
    }

    fn limit(axes: &[Vec<i32>; 3]) -> Option<f64> {
        let mut between = Between::default();
        between.push(axes);
        between.limit()
    }

    #[test]
    fn interpolated_rows_are_found_and_no_others() {
        for (every, share, decimal) in [(10, 0.37, 1), (100, 0.5, 1), (1, 0.5, 1), (1, 0.5, 1000)] {
            let rounded = |axis: Vec<i32>| {
                axis.iter()
                    .map(|count| (count + decimal / 2).div_euclid(decimal) * decimal)
                    .collect()
            };
            let axes = noise(20_000, 1e6, 1).map(rounded);
            let filled = filled(&axes, every, share).map(rounded);
            let limit = limit(&filled).expect("interpolated rows");
            let mut between = Between::default();
            let found = between.find(&filled, limit);
            for (filled, axis) in filled.iter().zip(&axes) {
                let rows = filled.iter().zip(&found);
                let kept = rows.filter(|(_, found)| !**found).map(|(count, _)| count);
                // Behind the last rows no line leads on.
                let differ = kept
                    .zip(axis)
                    .take(19_990)
                    .filter(|(kept, count)| kept != count);
                assert_eq!(differ.count(), 0, "{every} {share} {decimal}");
            }
        }
    }

    #[test]
    fn noise_has_no_interpolated_rows_however_smooth_or_coarse() {
        for (counts, mean_of) in [
            (2.0, 1),
            (10.0, 1),
            (100.0, 1),
            (1e6, 1),
            (1e6, 4),
            (1e6, 50),
            (1e9, 300),
        ] {
            assert_eq!(
                limit(&noise(60_000, counts, mean_of)),
                None,
                "{counts} {mean_of}"
            );
        }
    }

    /// Values on a grid lie exactly on the line now and then, and far from it else.
    #[test]
    fn noise_on_a_grid_has_none_either() {
        const GRID: i32 = 1_000_000;
        for steps in [1, 2, 3, 5, 8, 15] {
            for finer in [1, 2, 3, 5, 8] {
                let [x, y, z] = noise(60_000, f64::from(2 * steps) + 0.9, 1);
                let on_grid = |axis: Vec<i32>, finer: i32| -> Vec<i32> {
                    axis.iter().map(|count| count / finer * GRID).collect()
                };
                let rows = [on_grid(x, 1), on_grid(y, finer), on_grid(z, finer)];
                let mut of_two = Between::default();
                of_two.push(&rows[..2]);
                assert_eq!(
                    (of_two.limit(), limit(&rows)),
                    (None, None),
                    "{steps} {finer}"
                );
            }
        }
    }
}
