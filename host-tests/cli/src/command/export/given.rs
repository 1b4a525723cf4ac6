//! A number for a filter, or the reason why there is none. A zero never stands for "not known".

/// The number that a record gives for a parameter, or the reason why it gives none.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Given {
    /// A positive number, with a remark that may be empty.
    Number { value: f64, remark: String },
    /// There is no number, for this reason.
    Missing { why: String },
}

/// The two continuous-time densities that most filters use.
pub(super) struct Pair {
    /// White noise, in rad/s/√Hz, or m/s²/√Hz of an accelerometer.
    pub(super) noise_density: Given,
    /// Random walk, in rad/s²/√Hz, or m/s³/√Hz of an accelerometer.
    pub(super) random_walk: Given,
}

impl Given {
    /// A number without a remark.
    pub(super) fn plain(value: f64) -> Self {
        Self::Number {
            value,
            remark: String::new(),
        }
    }

    /// The number, if there is one.
    pub(super) fn value(&self) -> Option<f64> {
        match self {
            Self::Number { value, .. } => Some(*value),
            Self::Missing { .. } => None,
        }
    }

    /// The remark or the reason.
    pub(super) fn words(&self) -> &str {
        match self {
            Self::Number { remark, .. } => remark,
            Self::Missing { why } => why,
        }
    }

    /// The number times a factor.
    pub(super) fn times(self, factor: f64) -> Self {
        self.map(|value| factor * value)
    }

    /// The number as a function makes it.
    pub(super) fn map(self, of: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Number { value, remark } => Self::Number {
                value: of(value),
                remark,
            },
            missing => missing,
        }
    }

    /// The same, and where there is no number, what the other program does without it.
    pub(super) fn without(self, program_does: &str) -> Self {
        match self {
            Self::Missing { why } if !program_does.is_empty() => Self::Missing {
                why: format!("{why}; {program_does}"),
            },
            same => same,
        }
    }

    /// The numbers of three axes, in which an axis without one has the largest of the others, with a remark that says so if
    /// there is such an axis. `None` if no axis has a number, or there are not three axes.
    pub(super) fn three(axes: &[Self]) -> Option<([f64; 3], &'static str)> {
        let [x, y, z] = axes else {
            return None;
        };
        let values = [x, y, z].map(Self::value);
        let largest = values.into_iter().flatten().reduce(f64::max)?;
        let is_complete = values.iter().all(Option::is_some);
        let remark = match is_complete {
            true => "",
            false => "an axis without a number has the largest of the others",
        };
        Some((values.map(|value| value.unwrap_or(largest)), remark))
    }

    /// The largest number of the axes, with the remarks and reasons of all axes.
    pub(super) fn largest<'a>(axes: impl Iterator<Item = (&'a str, Self)>) -> Self {
        let axes: Vec<(&str, Self)> = axes.collect();
        if let [(_, only)] = axes.as_slice() {
            return only.clone();
        }
        let names = axes.iter().filter(|(_, given)| given.value().is_some());
        let names: Vec<String> = names.map(|(name, _)| format!("{name:?}")).collect();
        let said = axes.iter().filter(|(_, given)| !given.words().is_empty());
        let said = said.map(|(name, given)| format!("{name:?}: {}", given.words()));
        let values = axes.iter().filter_map(|(_, given)| given.value());
        match values.reduce(f64::max) {
            Some(value) => {
                let of = format!("largest of axes {}", names.join(", "));
                let remarks: Vec<String> = std::iter::once(of).chain(said).collect();
                Self::Number {
                    value,
                    remark: remarks.join("; "),
                }
            }
            None => Self::Missing {
                why: said.collect::<Vec<_>>().join("; "),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn missing(why: &str) -> Given {
        Given::Missing { why: why.into() }
    }

    #[test]
    fn largest_number_stands_for_all_axes_and_axes_without_one_are_named() {
        let axes = [
            ("x", Given::plain(1.0)),
            ("y", Given::plain(3.0)),
            ("z", missing("not observable")),
        ];
        let common = Given::largest(axes.into_iter());
        assert_eq!(common.value(), Some(3.0));
        assert_eq!(
            common.words(),
            "largest of axes \"x\", \"y\"; \"z\": not observable"
        );
    }

    #[test]
    fn an_axis_without_a_number_gets_the_largest_of_the_others() {
        let (x, y) = (Given::plain(1.0), Given::plain(3.0));
        let complete = [x.clone(), y.clone(), Given::plain(2.0)];
        assert_eq!(Given::three(&complete), Some(([1.0, 3.0, 2.0], "")));
        let (numbers, remark) = Given::three(&[x, y, missing("short")]).unwrap();
        assert_eq!(numbers, [1.0, 3.0, 3.0]);
        assert!(remark.contains("the largest of the others"));
        assert_eq!(
            Given::three(&[missing("a"), missing("b"), missing("c")]),
            None
        );
        assert_eq!(Given::three(&complete[..2]), None);
    }

    #[test]
    fn axes_without_any_number_give_none() {
        let axes = [("x", missing("a")), ("y", missing("b"))];
        let common = Given::largest(axes.into_iter());
        assert_eq!(common, missing("\"x\": a; \"y\": b"));
    }
}
