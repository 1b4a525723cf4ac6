//! The columns of noise that passes a filter of the whole signal.

use super::{Observation, Values, Workspace};
use crate::{
    list::numbered,
    numerics::real::{Real, single},
    theory::{
        effect::Behind,
        model::{Model, Term, is_passed},
    },
};

impl<const B: usize> Workspace<B> {
    /// Lets the common columns pass a filter of all noise: that of the first own column, or one that is common itself. Without
    /// such a filter they pass none any more.
    #[inline(never)]
    pub(crate) fn pass(&mut self, observation: &Observation<'_, B>, filter: Option<&Term>) {
        let own = filter.filter(|filter| filter.effect.passes_all());
        let filter = match (own, self.known.first()) {
            (Some(filter), _) => Some((*filter, self.common, self.factor(0))),
            // A known filter stays as it is.
            (None, Some(_)) if self.is_passed => return,
            (None, Some((place, filter))) => {
                let factor = self.effects.get(*place).map_or(0.0, |(_, factor)| *factor);
                Some((*filter, *place, factor))
            }
            (None, None) => None,
        };
        if filter.is_none() && !self.is_passed {
            return;
        }
        let passed = filter.and_then(|(filter, place, factor)| {
            Some((filter, self.passed_by(observation, place, factor)?))
        });
        for (column, (effect, factor)) in self.columns.iter_mut().zip(&self.effects) {
            let term = Term::new(*effect);
            if is_passed(&term) {
                set_behind(observation, &term, passed.as_ref(), *factor, column);
            }
        }
        self.is_passed = passed.is_some();
    }

    /// Lets all columns of a model pass its filter of all noise, if it has one. All of them are own columns.
    #[inline(never)]
    pub(crate) fn pass_own(&mut self, observation: &Observation<'_, B>, model: &Model) {
        let Some((place, filter)) = model.passing() else {
            return;
        };
        let Some(passed) = self.passed_by(observation, place, self.factor(place)) else {
            return;
        };
        let passed = Some((*filter, passed));
        let columns = self.columns.iter_mut().zip(&self.factors);
        for (term, (column, factor)) in model.terms().iter().zip(columns) {
            if is_passed(term) {
                set_behind(observation, term, passed.as_ref(), *factor, column);
            }
        }
    }

    /// What the filter of a column leaves of white noise in each row. The column is that of a coefficient of one, divided by
    /// the factor.
    fn passed_by(
        &self,
        observation: &Observation<'_, B>,
        place: usize,
        factor: Real,
    ) -> Option<Values<B>> {
        let column = self.columns.get(place)?;
        let scale = 1.0 / single(factor.max(Real::MIN_POSITIVE));
        let mut passed = Values::zeros(self.shape.lows());
        for row in observation.rows() {
            passed.put(row, observation.of_white(row, column[row] * scale));
        }
        Some(passed)
    }

    /// Lets a derivative by a shape of the first own term change what passes it by the same share, if all noise does.
    pub(crate) fn pass_slope(&self, slope: &mut Values<B>) {
        if !self.is_passed {
            return;
        }
        let Some(own) = self.own_column(0) else {
            return;
        };
        let mut all = Values::zeros(self.shape.lows());
        let passing = |i: usize| match self.effects.get(i) {
            Some((effect, _)) => is_passed(&Term::new(*effect)),
            None => i == self.common,
        };
        for (i, column) in numbered(&self.columns).filter(|(i, _)| passing(*i)) {
            all.add_scaled(column, single(self.squares[i]));
        }
        let square = single(self.squares[self.common]);
        all.change_by(own, |all, own| {
            let own = own * square;
            if own > 0.0 { all / own } else { 0.0 }
        });
        slope.change_by(&all, |slope, all| slope * all);
    }
}

/// Sets the column of a term behind a filter of all noise, which comes with what it leaves of white noise, or behind none.
fn set_behind<const B: usize>(
    observation: &Observation<'_, B>,
    term: &Term,
    passed: Option<&(Term, Values<B>)>,
    factor: Real,
    column: &mut Values<B>,
) {
    let exact = passed.and_then(|(filter, _)| {
        let shape = filter.sampled_shape(observation.interval_s);
        let behind = Behind::new(term.effect, filter.effect, &shape)?;
        Some(observation.column_of(&behind, filter, Some(factor), column))
    });
    if exact.is_none() {
        observation.column(term, Some(factor), column);
        if let Some((_, passed)) = passed {
            column.change_by(passed, |own, passed| own * passed);
        }
    }
}
