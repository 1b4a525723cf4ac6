//! The amplitudes of a sinusoid in the bins around it.

use crate::{
    numerics::{
        math,
        real::{Real, consts::PI, real},
    },
    theory::effect::Response,
};

/// The distance from a bin to a line is at least this many bins. Chosen by hand: the amplitudes change by a millionth with it,
/// and none of their quotients is 0/0.
const LEAST: Real = 1e-3;

/// The main lobe of a sinusoid, and that of its mirror image at half the rate of the blocks or at zero.
///
/// The transform of the Hann window at a distance of `x` bins is `h(x) = sin(πx)/(πx(1 − x²))`, relative to that at 0, for
/// segments of many blocks.
pub(crate) struct Lobe {
    length: Real,
    /// The place of the line in bins, from 0 to the length of a segment.
    place: Real,
    /// The square of the sine of `π place`, which is that of any bin's distance.
    square: Real,
}

impl Lobe {
    /// That of the sinusoid whose differences of adjacent samples have this response, in segments of `segment` blocks of
    /// `block` samples.
    pub(crate) fn new(response: Response, segment: usize, block: u32) -> Self {
        let turns = response.phase / (2.0 * PI) * real(block);
        let length = real(segment);
        let place = length * (turns - math::floor(turns));
        let within = place - math::floor(place + 0.5);
        let place = if within < 0.0 {
            place - (LEAST + within).max(0.0)
        } else {
            place + (LEAST - within).max(0.0)
        };
        let (sine, _) = math::sincos_of_turns(0.5 * place);
        Self {
            length,
            place,
            square: sine * sine,
        }
    }

    /// The power in a bin, relative to that of a line at the bin.
    pub(crate) fn power(&self, bin: u32) -> Real {
        self.product(bin, 0)
    }

    /// The amplitude in a bin times that in the bin `distance` above it: `h(k − x) h(k + d − x)`, and the same of the mirror
    /// image, whose order is reversed.
    pub(crate) fn product(&self, bin: u32, distance: i32) -> Real {
        let (bin, distance) = (real(bin), real(distance));
        self.product_at(bin - self.place, distance) + self.product_at(bin + self.place, -distance)
    }

    /// `h(x) h(x + d)`, where `x` is the nearest distance to the line or to its images by the sampling.
    fn product_at(&self, x: Real, distance: Real) -> Real {
        let x = x - self.length * math::floor(x / self.length + 0.5);
        let polynomial = |x: Real| x * (1.0 - x * x);
        let sign = if distance * distance == 1.0 {
            -1.0
        } else {
            1.0
        };
        sign * self.square / (PI * PI * polynomial(x) * polynomial(x + distance))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::real::double;
    use core::f64::consts::PI;

    /// The amplitude in a bin of a complex wave of so many periods in a segment, by a direct sum, without its phase.
    fn amplitude(bin: f64, periods: f64, length: usize) -> f64 {
        let mut sum = 0.0;
        for j in 0..length {
            let middle = j as f64 - length as f64 / 2.0;
            let weight = 0.5 - 0.5 * libm::cos(2.0 * PI * j as f64 / length as f64);
            sum += weight * libm::cos(2.0 * PI * (periods - bin) * middle / length as f64);
        }
        sum / (0.5 * length as f64)
    }

    #[test]
    fn products_are_those_of_the_transform() {
        let length = 64;
        for periods in [10.0, 10.3, 10.5, 20.9999, 31.17, 31.5, 31.95, 32.0] {
            let response = Response {
                amplitude: 1.0,
                phase: (2.0 * PI * periods / length as f64) as Real,
            };
            let lobe = Lobe::new(response, length, 1);
            let nearest = periods as u32;
            for bin in nearest - 1..=nearest.min(31) {
                for distance in [0, 1, 2, -1, -2] {
                    let at = |bin: f64, sign: f64| amplitude(bin, sign * periods, length);
                    let (one, other) = (f64::from(bin), f64::from(bin as i32 + distance));
                    let mirrored = f64::from(bin as i32 - distance);
                    let expected =
                        at(one, 1.0) * at(other, 1.0) + at(one, -1.0) * at(mirrored, -1.0);
                    let off = double(lobe.product(bin, distance)) - expected;
                    assert!(off.abs() < 4e-3, "{periods}, {bin}, {distance}: {off}");
                }
            }
        }
    }
}
