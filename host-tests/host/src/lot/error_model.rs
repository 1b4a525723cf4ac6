//! The standard error of a squared coefficient as a function of the square.

use super::Measurement;

/// The least number of devices that tell the function. Chosen by hand.
const LEAST: usize = 8;

/// The number of times that the model is improved. Chosen by hand.
const ROUNDS: usize = 3;

/// Errors above so many times the model's are left out. Chosen by hand.
const WIDENED: f64 = 2.0;

/// `e² = a² + (r s)²` for a square s: `a` is the error where other effects hide the coefficient, and `r` the relative error
/// where it dominates its octaves.
///
/// An error is known at the best value. A device near its limit asks for the error that a device at the limit would have,
/// which is larger if its value happens to be low. The devices of a lot tell it, if their records are of one length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorModel {
    constant: f64,
    relative: f64,
}

impl ErrorModel {
    /// The model of these devices. `None` for fewer than eight.
    ///
    /// It minimises the sum of `((a² + r² s²)/w − e²/w)²`. The weights are the devices' own `e²` at first, which lets no
    /// widened error count for much, and then the squares of the model before. Errors above twice that model are left
    /// out: those of devices with an effect that no model explains are widened.
    pub fn of(measurements: &[Measurement]) -> Option<Self> {
        let known = measurements.iter().filter(|one| one.error > 0.0);
        let rows: Vec<[f64; 2]> = known.map(|one| [one.square, one.error]).collect();
        if rows.len() < LEAST {
            return None;
        }
        let mut model = Self::weighted(&rows, |[_, error]| *error);
        for _ in 0..ROUNDS {
            let near = rows.iter().copied();
            let near = near.filter(|[square, error]| *error <= WIDENED * model.error(*square));
            let near: Vec<[f64; 2]> = near.collect();
            if near.len() < LEAST {
                break;
            }
            model = Self::weighted(&near, |[square, _]| model.error(*square));
        }
        Some(model)
    }

    /// The model with the least squares, where a row is a square and its error, and `scale` is the root of its weight.
    fn weighted(rows: &[[f64; 2]], scale: impl Fn(&[f64; 2]) -> f64) -> Self {
        // Sums of products of 1, s² and e², all over w.
        let [mut one, mut both, mut other, mut first, mut second] = [0.0; 5];
        for row in rows {
            let scale = scale(row);
            let [x, y] = [1.0 / scale, row[0] / scale].map(|root| root * root);
            let target = (row[1] / scale).powi(2);
            one += x * x;
            both += x * y;
            other += y * y;
            first += x * target;
            second += y * target;
        }
        let determinant = one * other - both * both;
        let constant = (first * other - second * both) / determinant;
        let relative = (second * one - first * both) / determinant;
        // Neither is negative. If all squares are the same, the two cannot be told apart, and the error is taken to grow.
        let is_regular = determinant > 1e-9 * one * other;
        let (constant, relative) = if is_regular && constant >= 0.0 && relative >= 0.0 {
            (constant, relative)
        } else if other <= 0.0 || (is_regular && constant >= 0.0) {
            (first / one, 0.0)
        } else {
            (0.0, second / other)
        };
        Self {
            constant: constant.sqrt(),
            relative: relative.sqrt(),
        }
    }

    /// The standard error of a coefficient with this square.
    pub fn error(&self, square: f64) -> f64 {
        self.constant.hypot(self.relative * square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn device(square: f64, error: f64) -> Measurement {
        Measurement {
            square,
            above: error,
            below: error,
            error,
            is_measured: true,
            is_observable: true,
        }
    }

    #[test]
    fn both_parts_are_found() {
        let squares = (0..20).map(|i| 0.5 * f64::from(i));
        let all: Vec<Measurement> = squares.map(|s| device(s, 2.0_f64.hypot(0.3 * s))).collect();
        let model = ErrorModel::of(&all).unwrap();
        assert!((model.error(0.0) - 2.0).abs() < 1e-9);
        assert!((model.error(50.0) - 2.0_f64.hypot(15.0)).abs() < 1e-9);
    }

    #[test]
    fn errors_that_are_constant_or_relative_stay_so() {
        let squares = || (1..20).map(f64::from);
        let hidden: Vec<Measurement> = squares().map(|s| device(s, 2.0)).collect();
        let hidden = ErrorModel::of(&hidden).unwrap();
        assert!((hidden.error(100.0) - 2.0).abs() < 1e-6, "{hidden:?}");
        let dominant: Vec<Measurement> = squares().map(|s| device(s, 0.1 * s)).collect();
        let dominant = ErrorModel::of(&dominant).unwrap();
        assert!((dominant.error(100.0) - 10.0).abs() < 1e-6, "{dominant:?}");
        // An error that falls where the square grows, and one that grows faster than it.
        let falling: Vec<Measurement> = squares().map(|s| device(s, 3.0 - 0.1 * s)).collect();
        let falling = ErrorModel::of(&falling).unwrap();
        assert!(falling.relative == 0.0 && (1.0..3.0).contains(&falling.constant));
        let growing: Vec<Measurement> = squares().map(|s| device(s, s * s)).collect();
        let growing = ErrorModel::of(&growing).unwrap();
        assert!(
            growing.constant == 0.0 && growing.relative >= 1.0,
            "{growing:?}"
        );
    }

    #[test]
    fn errors_that_scatter_have_their_mean_square_and_widened_ones_do_not_count() {
        let of = |factors: &[f64]| {
            let all = (0..100).flat_map(|i| {
                let square = 1.0 + 0.05 * f64::from(i);
                factors
                    .iter()
                    .map(move |factor| device(square, factor * 1.0_f64.hypot(0.2 * square)))
            });
            ErrorModel::of(&all.collect::<Vec<_>>()).unwrap()
        };
        let expected = ((0.64 + 1.44) / 2.0_f64).sqrt() * 1.0_f64.hypot(2.0);
        let found = of(&[0.8, 1.2]).error(10.0);
        assert!((found / expected - 1.0).abs() < 0.01, "{found} {expected}");
        let widened = of(&[1.0, 1.0, 1.0, 1.0, 10.0]).error(10.0);
        assert!((widened / 5.0_f64.sqrt() - 1.0).abs() < 0.01, "{widened}");
    }

    #[test]
    fn few_devices_have_no_model() {
        assert_eq!(ErrorModel::of(&[device(1.0, 0.1); 7]), None);
        assert_eq!(ErrorModel::of(&[device(1.0, 0.0); 20]), None);
        let same = ErrorModel::of(&[device(1.0, 0.1); 20]).unwrap();
        assert!((same.error(2.0) - 0.2).abs() < 1e-9, "{same:?}");
        let zero = ErrorModel::of(&[device(0.0, 0.1); 20]).unwrap();
        assert!((zero.error(2.0) - 0.1).abs() < 1e-9, "{zero:?}");
    }
}
