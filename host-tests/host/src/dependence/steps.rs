//! Columns that change in steps: the temperature of a thermometer in whole degrees.

/// A plateau has at least so many blocks, and this share of all. Shorter runs are the noise of the sensor at the edge between
/// two steps. Chosen by hand.
const PLATEAU: (usize, f64) = (8, 0.005);

/// The temperature is known where it crosses from one step to the next. With fewer crossings, nothing is said of a lag, nor
/// that there is no dependence. Chosen by hand.
const LEAST: usize = 8;

/// The crossings of a column, from the means of its blocks, if it changes by single steps and so seldom that they show
/// neither a lag nor that the rate does not follow what is between the steps. `None` for any other column.
pub fn seldom(means: &[f64]) -> Option<usize> {
    let crossings = plateaus(means)?.len().saturating_sub(1);
    (1..LEAST).contains(&crossings).then_some(crossings)
}

/// A stretch in which a column has one value, in blocks.
struct Plateau {
    level: f64,
    start: usize,
    end: usize,
}

/// The plateaus of a column, if it lies on them most of the time and they differ by one step.
fn plateaus(means: &[f64]) -> Option<Vec<Plateau>> {
    let least = PLATEAU.0.max((PLATEAU.1 * means.len() as f64) as usize);
    let (mut plateaus, mut blocks, mut start) = (Vec::<Plateau>::new(), 0, 0);
    for run in means.chunk_by(|one, other| one == other) {
        let end = start + run.len();
        if run.len() >= least {
            blocks += run.len();
            match plateaus.last_mut().filter(|last| last.level == run[0]) {
                Some(last) => last.end = end,
                None => plateaus.push(Plateau {
                    level: run[0],
                    start,
                    end,
                }),
            }
        }
        start = end;
    }
    let steps = plateaus.windows(2);
    let steps = steps.map(|pair| (pair[1].level - pair[0].level).abs());
    let smallest = steps.clone().fold(f64::INFINITY, f64::min);
    let are_single = steps.into_iter().all(|step| step < 1.5 * smallest);
    (2 * blocks >= means.len() && are_single).then_some(plateaus)
}

/// Where a column crosses from one plateau to the next, in blocks from the beginning, and the value half a step between them.
struct Crossing {
    at: f64,
    value: f64,
}

impl Crossing {
    /// Between two plateaus. What the blocks between them show is as long above the edge as its mean says.
    fn between(before: &Plateau, after: &Plateau, means: &[f64]) -> Self {
        let step = after.level - before.level;
        let between = &means[before.end..after.start];
        let behind: f64 = between
            .iter()
            .map(|mean| (mean - before.level) / step)
            .sum();
        Self {
            at: after.start as f64 - behind.clamp(0.0, between.len() as f64),
            value: f64::midpoint(before.level, after.level),
        }
    }
}

/// The course of a column between its steps.
pub struct Course {
    /// The means of its blocks.
    pub means: Vec<f64>,
    /// What they are off by, rms: of smooth courses a 16th of a step or less, by the test below.
    pub error: f64,
}

/// The course of a column that changes in steps, with what lies between its crossings: a cubic through these, which stays within
/// half a step of what the column says. `None` for a column without plateaus, or with fewer than two crossings.
///
/// A thermometer in whole degrees is off by up to half a degree, by the same amount for minutes. Taken as it is, it follows
/// the temperature late, and what the rate follows looks like a lag of half a plateau.
pub fn reconstructed(means: &[f64]) -> Option<Course> {
    let plateaus = plateaus(means)?;
    let pairs = plateaus.windows(2);
    let crossings = pairs.map(|pair| Crossing::between(&pair[0], &pair[1], means));
    let crossings: Vec<Crossing> = crossings.collect();
    if crossings.len() < 2 {
        return None;
    }
    let half = 0.5 * (plateaus[1].level - plateaus[0].level).abs();
    let lines = Line::all(&crossings);
    let slopes = slopes(&lines);
    let ends = [End::first(&lines), End::last(&lines)];
    let mut interval = 0;
    let value = |(block, &told): (usize, &f64)| {
        let at = block as f64 + 0.5;
        while crossings
            .get(interval)
            .is_some_and(|crossing| crossing.at <= at)
        {
            interval += 1;
        }
        let value = match (interval.checked_sub(1), crossings.get(interval)) {
            (Some(before), Some(after)) => {
                let ends = [
                    (&crossings[before], slopes[before]),
                    (after, slopes[interval]),
                ];
                cubic(ends, at)
            }
            (None, Some(after)) => after.value + ends[0].change(at - after.at),
            (Some(last), None) => crossings[last].value + ends[1].change(at - crossings[last].at),
            (None, None) => told,
        };
        value.clamp(told - half, told + half)
    };
    Some(Course {
        means: means.iter().enumerate().map(value).collect(),
        error: half / 8.0,
    })
}

/// The line between two crossings.
#[derive(Clone, Copy)]
struct Line {
    width: f64,
    slope: f64,
}

impl Line {
    fn all(crossings: &[Crossing]) -> Vec<Self> {
        let pairs = crossings.windows(2);
        let line = pairs.map(|pair| {
            let width = pair[1].at - pair[0].at;
            let slope = (pair[1].value - pair[0].value) / width;
            Self { width, slope }
        });
        line.collect()
    }
}

/// The course before the first crossing, or behind the last one: its slope there decays at a rate, as that of a warm-up does. The
/// rate is that of the two nearest lines; with one line, or where the course turns, the slope stays.
struct End {
    slope: f64,
    decay: f64,
}

impl End {
    fn first(lines: &[Line]) -> Self {
        Self::of(lines.first(), lines.first().zip(lines.get(1)), -1.0)
    }

    fn last(lines: &[Line]) -> Self {
        let before = lines.len().checked_sub(2);
        let pair = before
            .and_then(|before| lines.get(before))
            .zip(lines.last());
        Self::of(lines.last(), pair, 1.0)
    }

    fn of(nearest: Option<&Line>, pair: Option<(&Line, &Line)>, ahead: f64) -> Self {
        let Some(nearest) = nearest else {
            return Self {
                slope: 0.0,
                decay: 0.0,
            };
        };
        let decay = pair.map_or(0.0, |(one, next)| {
            let ratio = one.slope / next.slope;
            let distance = f64::midpoint(one.width, next.width);
            if ratio > 0.0 {
                ratio.ln() / distance
            } else {
                0.0
            }
        });
        let slope = nearest.slope * (-ahead * 0.5 * decay * nearest.width).exp();
        Self { slope, decay }
    }

    /// The change after so many blocks.
    fn change(&self, blocks: f64) -> f64 {
        if self.decay == 0.0 {
            return self.slope * blocks;
        }
        -self.slope * (-self.decay * blocks).exp_m1() / self.decay
    }
}

/// The slope at each crossing: that of the parabola through it and its neighbours.
fn slopes(lines: &[Line]) -> Vec<f64> {
    let inner = lines.windows(2).map(|pair| {
        let [one, next] = [pair[0], pair[1]];
        (one.slope * next.width + next.slope * one.width) / (one.width + next.width)
    });
    let (first, last) = (End::first(lines).slope, End::last(lines).slope);
    std::iter::once(first).chain(inner).chain([last]).collect()
}

/// The cubic with values and slopes at both ends (Hermite).
fn cubic([(from, slope), (to, other)]: [(&Crossing, f64); 2], at: f64) -> f64 {
    let width = to.at - from.at;
    let x = (at - from.at) / width;
    let y = 1.0 - x;
    from.value * (1.0 + 2.0 * x) * y * y
        + slope * width * x * y * y
        + to.value * x * x * (1.0 + 2.0 * y)
        - other * width * x * x * y
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A ramp in steps, with noise of a tenth of a step before it is rounded.
    fn ramp(blocks: u32, steps: f64, step: f64) -> Vec<f64> {
        let value = |n: u32| {
            let noise = f64::from(n.wrapping_mul(2_654_435_761) >> 16) / 65_536.0 - 0.5;
            step * (steps * f64::from(n) / f64::from(blocks) + 0.1 * noise).round()
        };
        (0..blocks).map(value).collect()
    }

    #[test]
    fn few_crossings_of_single_steps_are_counted_and_others_are_not() {
        assert_eq!(seldom(&ramp(4400, 4.0, 1.0)), Some(4));
        assert_eq!(seldom(&ramp(4400, 2.0, 0.5)), Some(2));
        assert_eq!(seldom(&ramp(4400, 12.0, 0.1)), None);
        assert_eq!(seldom(&ramp(4400, 900.0, 0.01)), None);
        assert_eq!(seldom(&[25.0; 500]), None);
        // What is switched over several steps is known at all times.
        let switched: Vec<f64> = (0..400)
            .map(|n| [20.0, 21.0, 30.0, 20.0][n / 100])
            .collect();
        assert_eq!(seldom(&switched), None);
        assert!(reconstructed(&switched).is_none());
    }

    #[test]
    fn what_lies_between_the_steps_is_found_to_a_fraction_of_a_step() {
        let blocks = 4400;
        let phase = |n: u32| f64::from(n) / f64::from(blocks);
        let courses: [&dyn Fn(u32) -> f64; 4] = [
            &|n| 6.3 * phase(n),
            &|n| 3.2 * (17.0 * phase(n)).sin(),
            &|n| -20.0 * (-3.0 * phase(n)).exp_m1(),
            &|n| -10.0 * (-12.0 * phase(n)).exp_m1(),
        ];
        for course in courses {
            let stepped: Vec<f64> = (0..blocks)
                .map(|n| {
                    let noise =
                        f64::from(u32::wrapping_mul(n, 2_654_435_761) >> 16) / 65_536.0 - 0.5;
                    (course(n) + 0.02 * noise).round()
                })
                .collect();
            let found = reconstructed(&stepped).unwrap();
            let rms = |means: &[f64]| {
                let squares = (0..blocks).zip(means).map(|(n, x)| (course(n) - x).powi(2));
                (squares.sum::<f64>() / f64::from(blocks)).sqrt()
            };
            assert!(rms(&found.means) < found.error, "{}", rms(&found.means));
            assert!(rms(&stepped) > 2.0 * found.error, "{}", rms(&stepped));
        }
        // One crossing, or none, tells of no course.
        assert!(reconstructed(&ramp(4400, 0.9, 1.0)).is_none());
        assert!(reconstructed(&[25.0; 500]).is_none());
    }
}
