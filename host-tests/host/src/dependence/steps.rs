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
    let crossings = crossings(means)?;
    (1..LEAST).contains(&crossings).then_some(crossings)
}

/// The crossings from one plateau to the next, if the column lies on plateaus most of the time and these differ by one step.
fn crossings(means: &[f64]) -> Option<usize> {
    let least = PLATEAU.0.max((PLATEAU.1 * means.len() as f64) as usize);
    let runs = means.chunk_by(|one, other| one == other);
    let plateaus = runs.filter(|run| run.len() >= least);
    let (mut levels, mut blocks) = (Vec::new(), 0);
    for plateau in plateaus {
        blocks += plateau.len();
        levels.push(plateau[0]);
    }
    levels.dedup();
    let steps = levels.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let smallest = steps.clone().fold(f64::INFINITY, f64::min);
    let are_single = steps.clone().all(|step| step < 1.5 * smallest);
    (2 * blocks >= means.len() && are_single).then(|| steps.count())
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
    }
}
