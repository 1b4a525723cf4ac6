//! How long a record must be before a term can be measured.

use super::{
    Fit,
    estimate::Scale,
    memory::consecutive,
    tableau::Tableau,
    terms::{TERMS, Units},
};
use crate::{
    curve::{Curve, clusters},
    limits::SHOWN_IN_80,
    numerics::real::{Real, real, single},
};

/// The length of the longest record that is considered, in samples: that of the longest octave.
const LONGEST: f32 = (1_u32 << 30) as f32;

/// All terms, as a set.
const ALL: u8 = (1 << TERMS) - 1;

/// The sums over octaves of the products of terms.
type Products = [[f32; TERMS]; TERMS];

impl Fit {
    /// The length, in seconds, of a record in which the term at `place` would be measured, if it is as large as its
    /// [upper end](crate::Coefficient::upper) on the curve that was fitted. The present length is doubled as often as
    /// needed. `None` if no length is enough, or if the curve cannot distinguish the term from the others.
    ///
    /// Four of five such records measure it. The rule is that of [`State::NotObservable`](crate::fit::State::NotObservable) of the general fit. It is apart from
    /// the fit, so that a device that does not ask pays nothing.
    pub fn measured_after_s<const K: usize>(&self, curve: &Curve<K>, place: usize) -> Option<Real> {
        let points = consecutive(curve.points());
        let (last, middle) = (points.last()?, points.get(points.len() / 2)?);
        let units = Units::new(points.len());
        let scale = Scale::new(middle.variance, curve.interval_s(), units);
        let mut squares = [0.0; TERMS];
        for (term, (square, found)) in (0..TERMS).zip(squares.iter_mut().zip(&self.coefficients)) {
            let size = if term == place {
                found.upper
            } else {
                found.value
            };
            let root = single(size / scale.root(term));
            *square = root * root;
        }
        // No term is taken for absent, because a longer record shows some that this one does not.
        let others = ALL & !1_u8.wrapping_shl(place as u32);
        let own = squares
            .get(place)
            .copied()
            .filter(|own| *own < f32::INFINITY)?;
        // The equations are `samples · Σ q/2m − Σ q/2`, where q is an octave's share. Each doubling adds an octave.
        let (mut growing, mut fixed): (Products, Products) = Default::default();
        let mut samples = 2.0 * single(clusters(last) * real(last.m));
        let (mut octave, mut m) = (0, 1.0);
        while samples <= LONGEST {
            while samples >= 4.0 * m {
                let variance = units.model(&squares, octave);
                let relative = |term: usize| units.variance(term, octave) / variance;
                for (a, (growing, fixed)) in (0..TERMS).zip(growing.iter_mut().zip(&mut fixed)) {
                    let half = 0.5 * relative(a);
                    for (b, (growing, fixed)) in (0..TERMS).zip(growing.iter_mut().zip(fixed)) {
                        let product = half * relative(b);
                        *growing += product / m;
                        *fixed += product;
                    }
                }
                (octave, m) = (octave.saturating_add(1), 2.0 * m);
            }
            let mut tableau = Tableau::EMPTY;
            tableau.set(|a, b| {
                let of = |sums: &Products| sums.get(a).and_then(|row| row.get(b)).copied();
                // The column of the curve is not needed.
                of(&growing)
                    .zip(of(&fixed))
                    .map_or(0.0, |(growing, fixed)| samples * growing - fixed)
            });
            tableau.release(others);
            let variance = tableau.variance(place);
            if variance.is_some_and(|variance| own * own > SHOWN_IN_80 as f32 * variance) {
                return Some(real(samples) * curve.interval_s());
            }
            samples *= 2.0;
        }
        None
    }
}
