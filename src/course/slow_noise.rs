//! How many shifts the block means need in addition to slow noise of any size.
//!
//! The fit to a curve that holds a ramp or a step does not resolve rate random walk and flicker noise. In the wander
//! of a walk whose coefficient is fitted as zero, any part of it looks like a step; if it has absorbed a step,
//! no step is significant. The block means themselves know how much of their wander is noise. Therefore models with
//! more and with fewer shifts are compared by their likelihood, each with the slow noise that suits it best.

use super::{
    contrasts::BlockMeans,
    form::{Form, MAX_SHIFTS},
};
use crate::{
    evidence::course::is_complete,
    limits::MAX_EFFECTS,
    list::numbered,
    numerics::real::{Real, real},
    theory::{
        effect::{BiasInstability, Effect, RateRamp, RateRandomWalk},
        model::Model,
    },
};

/// The squared coefficients of a model.
type Squares = [Real; MAX_EFFECTS];

/// The ratio of neighbouring sizes of the slow noise that are tried, as variances. The most likely size lies within √2
/// of one of them, where `−2 ln L` of 63 contrasts is less than 2 above its least value.
const RATIO: Real = 2.0;

/// The largest number of sizes of one kind of slow noise. They reach from noise that is larger than all that the
/// blocks show down to a trillionth of its variance.
const SIZES: u32 = 40;

/// The largest size is that of slow noise alone, times this factor.
const LARGEST: Real = 4.0;

/// Slow noise whose Allan variance at half of the course is below this share of that of the other terms is as good as
/// none.
const NEGLIGIBLE: Real = 0.05;

/// The number of blocks at which flicker noise and a random walk have the same Allan variance where they are tried
/// together: in the middle, on a logarithmic scale, of the durations that the course resolves.
const MIDDLE: u32 = 8;

/// The number of shifts that are needed, and the squared coefficients of the noise fitted with them.
pub(super) struct Needed {
    pub(super) number: usize,
    pub(super) squares: Squares,
}

/// The most likely slow noise for some number of shifts.
#[derive(Clone, Copy)]
struct Likeliest {
    /// `−2 ln L`, up to a constant.
    deviance: Real,
    squares: Squares,
}

/// The number of shifts that the block means need, of the first ones of a list.
///
/// The bias instability, the rate random walk and the slope of the course are free, as far as the model has them. The
/// other coefficients are known well from shorter averaging times, and remain. The number is that with the least
/// `−2 ln L + Σ z²` (Yao, Statistics & Probability Letters 6, 181, 1988), where `z` is the limit of each form: a shift, or two
/// that make a bump, must be as much more likely than slow noise as a form of this size is in known noise.
///
/// The errors of the sizes are those in the larger one of the slow noise that is most likely, and of that which was
/// fitted. The first one is too small by its own choice, and the second one where the curve does not resolve it.
#[inline(never)]
pub(super) fn needed(means: &BlockMeans<'_>, squares: &[Real], forms: &[Form]) -> Needed {
    let model = means.model;
    let mut fitted = [0.0; MAX_EFFECTS];
    for (own, square) in fitted.iter_mut().zip(squares) {
        *own = *square;
    }
    set(&mut fitted, model, &RateRamp, 0.0);
    let likeliest = likeliest(means, &fitted, forms);
    let mut best = Needed {
        number: 0,
        squares: fitted,
    };
    let (mut least, mut price) = (Real::INFINITY, 0.0);
    let mut prices = forms.iter().map(|form| form.limit_square());
    for (number, one) in numbered(&likeliest).take(forms.len().saturating_add(1)) {
        if one.deviance + price < least {
            least = one.deviance + price;
            best.number = number;
            best.squares = one.squares;
        }
        price += prices.next().unwrap_or(0.0);
    }
    for (square, fitted) in best.squares.iter_mut().zip(fitted) {
        *square = square.max(fitted);
    }
    best
}

/// The most likely slow noise with the first shifts of a list, for every number of them from none on.
///
/// Flicker noise, a random walk, and both together are tried in sizes that fall by a [`RATIO`].
fn likeliest(
    means: &BlockMeans<'_>,
    fitted: &Squares,
    forms: &[Form],
) -> [Likeliest; MAX_SHIFTS + 1] {
    let model = means.model;
    let mut best = [Likeliest {
        deviance: Real::INFINITY,
        squares: *fitted,
    }; MAX_SHIFTS + 1];
    compare(means, fitted, forms, &mut best);
    let mut none = *fitted;
    set(&mut none, model, &BiasInstability, 0.0);
    set(&mut none, model, &RateRandomWalk, 0.0);
    compare(means, &none, forms, &mut best);

    let allan_variance = |squares: &Squares, blocks: u32| {
        let m = means.length.saturating_mul(blocks);
        model.variance(squares, m, means.interval_s)
    };
    let half = (means.levels.len() / 2) as u32;
    let negligible = NEGLIGIBLE * allan_variance(&none, half);
    let largest = LARGEST * scatter(means);
    let mut flicker = [0.0; MAX_EFFECTS];
    set(&mut flicker, model, &BiasInstability, 1.0);
    let mut walk = [0.0; MAX_EFFECTS];
    set(&mut walk, model, &RateRandomWalk, 1.0);
    let ratio = allan_variance(&flicker, MIDDLE) / allan_variance(&walk, MIDDLE);
    let both = core::array::from_fn(|i| {
        let of = |squares: &Squares| squares.get(i).copied().unwrap_or(0.0);
        of(&flicker) + ratio * of(&walk)
    });
    for unit in [flicker, walk, both] {
        let (at_block, at_half) = (allan_variance(&unit, 1), allan_variance(&unit, half));
        // Neither the kinds that the model lacks nor blocks that are all the same have a size to begin with.
        let mut size = largest / at_block;
        if !(size > 0.0 && size.is_finite()) {
            continue;
        }
        for _ in 0..SIZES {
            if size * at_half < negligible {
                break;
            }
            let mut squares = none;
            for (square, unit) in squares.iter_mut().zip(unit) {
                *square += size * unit;
            }
            compare(means, &squares, forms, &mut best);
            size /= RATIO;
        }
    }
    best
}

/// Keeps some squared coefficients for every number of shifts with which they are more likely than what was tried
/// before.
#[inline(never)]
fn compare(means: &BlockMeans<'_>, squares: &Squares, forms: &[Form], best: &mut [Likeliest]) {
    let Some(mut contrasts) = means.contrasts(squares) else {
        return;
    };
    contrasts.remove_slope_of(means.model);
    let mut forms = forms.iter();
    for best in best {
        let deviance = contrasts.deviance();
        if deviance < best.deviance {
            *best = Likeliest {
                deviance,
                squares: *squares,
            };
        }
        if let Some(form) = forms.next() {
            contrasts.remove_form(*form);
        }
    }
}

/// Sets the square of an effect, if the model has it.
fn set(squares: &mut Squares, model: &Model, effect: &dyn Effect, value: Real) {
    let place = model.position(effect.name());
    if let Some(square) = place.and_then(|place| squares.get_mut(place)) {
        *square = value;
    }
}

/// Half of the mean square of the differences of neighbouring block means: their Allan variance.
fn scatter(means: &BlockMeans<'_>) -> Real {
    let (mut sum, mut number) = (0.0, 0_u32);
    for pair in means.levels.windows(2) {
        if let [a, b] = pair
            && is_complete(a, means.length)
            && is_complete(b, means.length)
        {
            sum += 0.5 * (b.mean - a.mean) * (b.mean - a.mean);
            number = number.saturating_add(1);
        }
    }
    sum / real(number.max(1))
}
