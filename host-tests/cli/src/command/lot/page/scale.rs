//! The scale of an axis of a picture, which is logarithmic because the devices of a lot differ by factors.

/// The most ticks of a scale.
const MOST_TICKS: usize = 6;

/// A logarithmic scale between two places of a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    values: (f64, f64),
    places: (f64, f64),
}

impl Scale {
    /// The scale on which these positive values lie, with a margin at both ends. `None` without such values.
    pub(super) fn of(values: impl IntoIterator<Item = f64>, places: (f64, f64)) -> Option<Self> {
        let positive = values
            .into_iter()
            .filter(|one| one.is_finite() && *one > 0.0);
        let ends = positive.fold(None, |ends, one| match ends {
            None => Some((one, one)),
            Some((low, high)) => Some((one.min(low), one.max(high))),
        });
        let (low, high) = ends?;
        // The margin is 5 % of the span, and 5 % of the value where there is no span.
        let margin = (high / low).powf(0.05).max(1.05);
        Some(Self {
            values: (low / margin, high * margin),
            places,
        })
    }

    /// The place of a positive value, within the picture.
    pub(super) fn place(&self, value: f64) -> f64 {
        let ((low, high), (from, to)) = (self.values, self.places);
        let share = (value.max(low) / low).ln() / (high / low).ln();
        from + share.min(1.0) * (to - from)
    }

    /// Round values on the scale, at most six.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let (low, high) = self.values;
        let span = high - low;
        let candidates = if high / low < 5.0 {
            // Equal steps of 1, 2 or 5.
            let step = 10_f64.powf((span / MOST_TICKS as f64).log10().floor());
            let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * step);
            let step = steps
                .into_iter()
                .find(|step| span / step <= MOST_TICKS as f64);
            let step = step.unwrap_or(span);
            let first = (low / step).ceil() as i64;
            (0..MOST_TICKS as i64)
                .map(|i| (first + i) as f64 * step)
                .collect()
        } else {
            let first = low.log10().floor() as i32;
            let decades = first..=high.log10().ceil() as i32;
            let factors: &[f64] = if high / low < 300.0 {
                &[1.0, 2.0, 5.0]
            } else {
                &[1.0]
            };
            let all = decades.flat_map(|decade| {
                factors
                    .iter()
                    .map(move |factor| factor * 10_f64.powi(decade))
            });
            all.collect::<Vec<_>>()
        };
        let inside: Vec<f64> = candidates
            .into_iter()
            .filter(|tick| (low..=high).contains(tick))
            .collect();
        let every = inside.len().div_ceil(MOST_TICKS).max(1);
        inside.into_iter().step_by(every).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Scale;

    #[test]
    fn ticks_are_few_round_and_on_the_scale() {
        for (low, high) in [
            (0.3, 0.42),
            (1.0, 1.0),
            (0.001, 0.02),
            (1e-6, 1e3),
            (9.9, 10.1),
        ] {
            let scale = Scale::of([low, high], (0.0, 100.0)).unwrap();
            let ticks = scale.ticks();
            assert!((1..=6).contains(&ticks.len()), "{low} {high}: {ticks:?}");
            for tick in ticks {
                let place = scale.place(tick);
                assert!((0.0..=100.0).contains(&place), "{tick}: {place}");
            }
        }
    }

    #[test]
    fn factors_are_distances() {
        let scale = Scale::of([1.0, 100.0], (0.0, 100.0)).unwrap();
        assert!((scale.place(10.0) - 50.0).abs() < 1e-9);
        // What lies beyond is drawn at the end.
        assert_eq!((scale.place(1e-9), scale.place(1e9)), (0.0, 100.0));
    }

    #[test]
    fn what_is_not_positive_has_no_scale() {
        assert!(Scale::of([0.0, -1.0, f64::NAN, f64::INFINITY], (0.0, 1.0)).is_none());
    }
}
