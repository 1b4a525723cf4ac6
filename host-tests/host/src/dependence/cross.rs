//! Cross curves of series of block means.

use allanite::{
    covariate::{CrossCurve, CrossPoint},
    curve::Point,
};
use allanite_log::OCTAVES;

/// The differences of neighbouring cluster means of a series, octave by octave, as an accumulator forms them. Those
/// that touch a block in which samples are missing are left out.
pub struct Differences {
    /// The averaging factor in samples and the differences of every octave of a block and more.
    octaves: Vec<(u32, Vec<f64>)>,
}

impl Differences {
    /// The differences of a series whose blocks have so many samples, for the octaves of a curve.
    pub fn new(series: &[f64], broken: &[bool], samples: u32, points: &[Point]) -> Self {
        // Sums from the first block on. Its own value is subtracted, so that an offset takes no digits.
        let first = series.first().copied().unwrap_or(0.0);
        let mut sums = vec![0.0];
        let mut breaks = vec![0_u32];
        let (mut sum, mut number) = (0.0, 0);
        for (value, &is_broken) in series.iter().zip(broken) {
            sum += value - first;
            number += u32::from(is_broken);
            sums.push(sum);
            breaks.push(number);
        }
        let octave = |m: u32| {
            let width = (m / samples) as usize;
            let starts = (0..).step_by((width / 4).max(1));
            let ends = starts.map(|start| (start, start + width, start + 2 * width));
            let inside = ends.take_while(|&(_, _, end)| end < sums.len());
            let whole = inside.filter(|&(start, _, end)| breaks[start] == breaks[end]);
            let difference = |(start, middle, end)| -> f64 {
                (sums[end] - 2.0 * sums[middle] + sums[start]) / width as f64
            };
            whole.map(difference).collect()
        };
        let long = points.iter().filter(|point| point.m >= samples);
        Self {
            octaves: long.map(|point| (point.m, octave(point.m))).collect(),
        }
    }

    /// Half the mean product with the differences of another series, octave by octave; zero for an octave without any.
    fn covariances(&self, other: &Self) -> impl Iterator<Item = (u32, f64)> {
        let pairs = self.octaves.iter().zip(&other.octaves);
        pairs.map(|((m, own), (_, other))| {
            let products = own.iter().zip(other).map(|(a, b)| a * b);
            let number = own.len().max(1) as f64;
            (*m, 0.5 * products.sum::<f64>() / number)
        })
    }
}

/// The cross curve of two series, with the octaves of a curve. Octaves of less than `shortest` samples, and of less
/// than a block, are those of a smooth change, which falls as `τ²`.
pub fn cross_curve(
    gyro: &Differences,
    series: &Differences,
    points: &[Point],
    shortest: u32,
) -> CrossCurve<OCTAVES> {
    let both = gyro.covariances(series).zip(series.covariances(series));
    let long: Vec<CrossPoint> = both
        .map(|((m, covariance), (_, variance))| CrossPoint {
            m,
            covariance,
            variance,
        })
        .filter(|point| point.m >= shortest)
        .collect();
    let first = long.first();
    let short = points.iter().filter_map(|point| {
        let first = first.filter(|first| point.m < first.m)?;
        let share = (f64::from(point.m) / f64::from(first.m)).powi(2);
        Some(CrossPoint {
            m: point.m,
            covariance: share * first.covariance,
            variance: share * first.variance,
        })
    });
    CrossCurve::of_points(short.chain(long.iter().copied()))
}

/// The first octave, by its averaging factor, in which a column changes by far more than the noise of its sensor.
/// `of_column` is the cross curve of the column at the rate of its samples.
///
/// The noise of a sensor falls as `1/τ` where it is white. Where the curve of the column falls before it rises, the
/// noise behind the minimum is at most what falls on from there.
pub fn first_beyond_noise(of_column: &CrossCurve<OCTAVES>) -> u32 {
    let (points, risen) = (of_column.points(), of_column.first_octave());
    let fallen = &points[..risen.min(points.len())];
    let Some(least) = fallen
        .iter()
        .min_by(|a, b| a.variance.total_cmp(&b.variance))
    else {
        return 1;
    };
    let noise = |m: u32| least.variance * f64::from(least.m) / f64::from(m);
    let mut later = points[risen..].iter();
    let far = later.find(|point| point.variance > FAR * noise(point.m));
    far.unwrap_or(&points[risen]).m
}

/// How far a column has to exceed the noise of its sensor. Chosen by hand: the noise then takes one per cent from a
/// slope. `cargo xtask study thermal` runs with this value.
const FAR: f64 = 100.0;

#[cfg(test)]
mod tests {
    use super::*;
    use allanite::{Axis, Scale};

    #[test]
    fn octaves_of_four_blocks_and_more_are_those_of_the_samples() {
        let counts: Vec<(i32, i32)> = (0..4096_i32)
            .map(|n| (n * n % 4099, (n * 7919 % 4093) / 7 + n / 3))
            .collect();
        let mut axis = Axis::<OCTAVES, 1, (), ()>::new();
        for &(count, covariate) in &counts {
            axis.push((count, [covariate]));
        }
        let scale = Scale::new(0.5, 10.0).unwrap();
        let expected = axis.record_so_far(0, (scale, [0.25])).unwrap();
        let means = |value: &dyn Fn(&(i32, i32)) -> f64| -> Vec<f64> {
            let blocks = counts.chunks_exact(8);
            blocks
                .map(|block| block.iter().map(value).sum::<f64>() / 8.0)
                .collect()
        };
        let rate = means(&|one| 0.5 * f64::from(one.0));
        let column = means(&|one| 0.25 * f64::from(one.1));
        let (points, broken) = (expected.curve.points(), vec![false; rate.len()]);
        let of = |series: &[f64]| Differences::new(series, &broken, 8, points);
        let cross = cross_curve(&of(&rate), &of(&column), points, 1);
        let pairs = cross.points().iter().zip(expected.covariates[0].points());
        let mut compared = 0;
        for (one, truth) in pairs {
            assert_eq!(one.m, truth.m);
            if one.m >= 32 {
                compared += 1;
                assert!(
                    (one.covariance / truth.covariance - 1.0).abs() < 1e-9,
                    "{one:?}"
                );
                assert!(
                    (one.variance / truth.variance - 1.0).abs() < 1e-9,
                    "{one:?}"
                );
            }
        }
        assert!(compared >= 5);
    }
}
