//! What a formula is.

/// What a formula is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// The power spectral density over the frequency `f` in Hz, relative to white noise with an angle random walk of one.
    Density,
    /// The autocovariance of the rate over the lag `t` in seconds.
    Covariance,
}

impl Kind {
    pub(super) const ALL: [Self; 2] = [Self::Density, Self::Covariance];

    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Density => "density",
            Self::Covariance => "covariance",
        }
    }

    pub(super) const fn variable(self) -> &'static str {
        match self {
            Self::Density => "f",
            Self::Covariance => "t",
        }
    }

    pub(super) const fn half_seconds(self) -> i8 {
        match self {
            Self::Density => 1,
            Self::Covariance => 0,
        }
    }
}

/// The kind of a text that is a formula, and what follows the colon; `None` for another text.
pub(super) fn kind_of(text: &str) -> Option<(Kind, &str)> {
    let (name, rest) = text.split_once(':')?;
    let kind = Kind::ALL
        .into_iter()
        .find(|kind| kind.name() == name.trim())?;
    Some((kind, rest))
}
