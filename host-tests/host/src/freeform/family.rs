//! Families of low passes whose responses are sums of columns with coefficients that are not negative.
//!
//! Behind poles, the columns are Bernstein polynomials in `(1 + cos ω)/2`: a filter that is sampled more slowly than it runs,
//! averaged or polled, has zeros besides its poles, and each zero is a shift by one sample. Only the first of the columns is not
//! zero at `ω = 0`.

use rustfft::num_complex::Complex;
use std::f64::consts::PI;

/// The most poles of a family.
const MAX_POLES: u8 = 8;

/// A family of responses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Family {
    /// Poles, and zeros that are free.
    Poles {
        /// Where the poles lie.
        place: Place,
        /// Their number.
        poles: u8,
        /// The degree of the polynomial.
        zeros: u8,
    },
    /// A response that only falls: a straight line in the square of the frequency from knot to knot, each of which is higher than
    /// the one before by this factor. A CIC with a half band and most FIR filters are of this kind.
    Falling {
        /// The factor.
        ratio: f64,
    },
}

/// Where the poles of a filter lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// A Butterworth filter by the bilinear transform at the rate of the record.
    Digital,
    /// A Butterworth filter that is analogue, or runs at a much higher rate.
    Matched,
    /// Equal poles on the real axis, as of first-order filters in series.
    Equal,
}

const fn poles(place: Place, poles: u8, zeros: u8) -> Family {
    Family::Poles {
        place,
        poles,
        zeros,
    }
}

/// All families that are tried.
pub(super) const FAMILIES: [Family; 25] = [
    poles(Place::Digital, 1, 1),
    poles(Place::Digital, 1, 3),
    poles(Place::Digital, 2, 2),
    poles(Place::Digital, 2, 4),
    poles(Place::Digital, 3, 3),
    poles(Place::Digital, 3, 5),
    poles(Place::Digital, 4, 4),
    poles(Place::Digital, 4, 6),
    poles(Place::Matched, 2, 2),
    poles(Place::Matched, 2, 4),
    poles(Place::Matched, 3, 3),
    poles(Place::Matched, 3, 5),
    poles(Place::Matched, 4, 4),
    poles(Place::Matched, 4, 6),
    poles(Place::Matched, 6, 2),
    poles(Place::Matched, 6, 6),
    poles(Place::Matched, 8, 2),
    poles(Place::Equal, 2, 2),
    poles(Place::Equal, 2, 4),
    poles(Place::Equal, 3, 3),
    poles(Place::Equal, 3, 5),
    Family::Falling { ratio: 1.07 },
    Family::Falling { ratio: 1.14 },
    Family::Falling { ratio: 1.3 },
    Family::Falling { ratio: 1.7 },
];

/// A Bernstein polynomial of degree `n` has `n + 1` columns.
fn binomial(n: u8, k: u8) -> f64 {
    (0..k).fold(1.0, |product, i| {
        product * f64::from(n - i) / f64::from(i + 1)
    })
}

impl Family {
    /// The number of parameters beyond the coefficients: a corner where there are poles.
    pub(super) const fn corners(&self) -> usize {
        matches!(self, Self::Poles { .. }) as usize
    }

    /// The columns at a frequency in cycles per sample, for a corner or a first knot in the same unit.
    pub(super) fn columns(&self, corner: f64, frequency: f64, columns: &mut Vec<f64>) {
        columns.clear();
        match *self {
            Self::Poles {
                place,
                poles,
                zeros,
            } => {
                let passed = passed(place, poles, corner, frequency);
                let c = 0.5 * (1.0 + (2.0 * PI * frequency).cos());
                columns.extend((0..=zeros).map(|i| {
                    let powers = c.powi(i32::from(zeros - i)) * (1.0 - c).powi(i32::from(i));
                    passed * binomial(zeros, i) * powers
                }));
            }
            Self::Falling { ratio } => {
                let mut knot = corner;
                let mut before = 0.0;
                while before < HIGHEST_KNOT {
                    let next = if knot * ratio < HIGHEST_KNOT {
                        knot
                    } else {
                        0.5
                    };
                    columns.push(falling(before, next, frequency));
                    before = next;
                    knot *= ratio;
                }
                columns.push(1.0);
            }
        }
    }
}

/// The highest knot below half the rate, in cycles per sample. Chosen by hand.
const HIGHEST_KNOT: f64 = 0.47;

/// One up to a knot, and then a line in the square of the frequency down to zero at the next one.
fn falling(knot: f64, next: f64, frequency: f64) -> f64 {
    let [low, high, at] = [knot, next, frequency].map(|f| f * f);
    ((high - at) / (high - low)).clamp(0.0, 1.0)
}

/// What poles pass of the power at a frequency, relative to that at zero.
fn passed(place: Place, poles: u8, corner: f64, frequency: f64) -> f64 {
    let one = Complex::new(1.0, 0.0);
    let z = Complex::from_polar(1.0, -2.0 * PI * frequency);
    let count = poles.clamp(1, MAX_POLES);
    let angle = |k: u8| PI * f64::from(2 * k + count - 1) / f64::from(2 * count);
    let parts = (1..=count).map(|k| {
        let unit = Complex::from_polar(1.0, angle(k));
        let pole = match place {
            Place::Digital => {
                let q = unit * (PI * corner.min(0.48)).tan();
                (one + q) / (one - q)
            }
            Place::Matched => (unit * (2.0 * PI * corner)).exp(),
            Place::Equal => {
                // Each of them passes more, so that all together pass a half at the corner.
                let wider = 1.0 / (2.0_f64.powf(1.0 / f64::from(count)) - 1.0).sqrt();
                Complex::new((-2.0 * PI * corner * wider).exp(), 0.0)
            }
        };
        ((one - pole) / (one - pole * z)).norm_sqr()
    });
    parts.product()
}
