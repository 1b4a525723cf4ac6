//! The findings of a diagnosis in a certificate, besides the terms of its model.

use super::EffectCode;
use crate::{
    comparison::{Band, Comparison, MAX_BANDS},
    course::{Event, Events, MAX_EVENTS, What},
    diagnosis::{FollowedCovariate, Step},
    list,
    numerics::real::{real, single},
    theory::effect::CATALOGUE,
};
use heapless::Vec;

/// The number of covariates that a rate can follow at once.
pub const MAX_COVARIATES: usize = 2;

/// The number of doubts that a certificate has room for.
pub const MAX_DOUBTS: usize = 12;

/// What a diagnosis found besides the terms of its model, in single precision.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Findings {
    /// The covariates that the rate follows. The curve that was fitted is that without their share.
    pub covariates: Vec<CertifiedSlope, MAX_COVARIATES>,
    /// Effects that explain the record about as well as one of the model's.
    pub doubts: Vec<Doubt, MAX_DOUBTS>,
    /// The bands in which the spectrum differs from the model. Empty if there are none, or if there is no spectrum.
    pub bands: Vec<CertifiedBand, MAX_BANDS>,
    /// What happened during the record, the earliest first. An empty list says that the record is stationary. `None` if
    /// no course of it was kept.
    pub events: Option<Vec<CertifiedEvent, MAX_EVENTS>>,
}

/// A covariate that the rate follows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedSlope {
    /// The covariate's place among those of the diagnosis.
    pub covariate: u8,
    /// The slope, in rate units per unit of the covariate.
    pub value: f32,
    /// Its standard error, in the same unit.
    pub error: f32,
}

/// Two effects between which the record does not decide.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Doubt {
    /// The effect in the model.
    pub effect: EffectCode,
    /// An effect that explains the record about as well.
    pub other: EffectCode,
}

/// Neighbouring bins of the spectrum on one side of the model, as [`Band`] has them.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedBand {
    /// Frequency of the lowest bin, in hertz.
    pub from_hz: f32,
    /// Frequency of the highest bin, in hertz.
    pub to_hz: f32,
    /// How far the band lies above the model, in standard errors.
    pub z: f32,
}

/// Something that happened during the record, as [`Event`] has it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CertifiedEvent {
    /// The kind of the event, which says what the size means.
    pub what: CertifiedWhat,
    /// When it happened, in seconds since the first sample of the course.
    pub at_s: f32,
    /// How large it is.
    pub size: f32,
    /// Lower end of the 95 % interval of the size.
    pub lower: f32,
    /// Upper end of the 95 % interval of the size.
    pub upper: f32,
    /// The size's distance from that of no event, in standard errors, with its sign.
    pub z: f32,
}

/// The kind of an event, as [`What`](crate::course::What) has it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum CertifiedWhat {
    /// The noise changed.
    NoiseChange,
    /// The noise of some blocks stood out.
    Bursts {
        /// The number of such blocks.
        blocks: u8,
    },
    /// The rate stepped.
    Step,
    /// The gyro warmed up.
    WarmUp {
        /// The time constant, in seconds.
        time_constant_s: f32,
    },
}

impl Findings {
    /// Whether there are no findings.
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }

    /// Whether the record is stationary; `None` if no course of it was kept.
    pub fn is_stationary(&self) -> Option<bool> {
        self.events.as_ref().map(|events| events.is_empty())
    }

    /// Takes over the events of the record's course. An empty list says that the record is stationary.
    pub fn set_events(&mut self, events: &Events) {
        self.events = Some(list::fill(events.iter().map(CertifiedEvent::of)));
    }

    /// Takes over what a step of a diagnosis says. `holds` tells whether the model has the effect of a code.
    pub(super) fn take<const K: usize, const B: usize>(
        &mut self,
        step: &Step<K, B>,
        holds: impl Fn(EffectCode) -> bool,
    ) {
        self.covariates.clear();
        if let Some(followed) = &step.covariate {
            for slope in slopes(followed) {
                let _ = self.covariates.push(slope);
            }
        }
        self.bands = bands(&step.comparison);
        // What was in doubt stays so as long as the effect stays. What the step adds enters the model in the next one.
        let doubts = core::mem::take(&mut self.doubts);
        self.doubts = list::fill(doubts.into_iter().filter(|doubt| holds(doubt.effect)));
        let Some(added) = step.candidates.first().filter(|_| step.added.is_some()) else {
            return;
        };
        let effect = EffectCode::of(added.term.effect);
        for name in &step.ambiguous {
            let mut catalogue = CATALOGUE.iter();
            let other = catalogue.find(|effect| effect.name() == *name);
            let other = other.map_or(EffectCode::OTHER, |other| EffectCode::of(*other));
            let _ = self.doubts.push(Doubt { effect, other });
        }
    }
}

/// The slopes of a covariate, and of a second one that acts as well.
fn slopes(followed: &FollowedCovariate) -> impl Iterator<Item = CertifiedSlope> {
    let own = (followed.index, followed.slope);
    let beside = followed.beside.map(|beside| (beside.index, beside.slope));
    let both = [Some(own), beside].into_iter().flatten();
    both.map(|(index, slope)| CertifiedSlope {
        covariate: index.min(usize::from(u8::MAX)) as u8,
        value: single(slope.value),
        error: single(slope.error),
    })
}

fn bands<const K: usize, const B: usize>(
    comparison: &Comparison<K, B>,
) -> Vec<CertifiedBand, MAX_BANDS> {
    let bands = comparison.bands();
    list::fill(bands.iter().map(|band: &Band| CertifiedBand {
        from_hz: single(band.from_hz),
        to_hz: single(band.to_hz),
        z: single(band.z),
    }))
}

impl CertifiedBand {
    /// The band in the precision of the library.
    pub fn band(&self) -> Band {
        Band {
            from_hz: real(self.from_hz),
            to_hz: real(self.to_hz),
            z: real(self.z),
        }
    }
}

impl CertifiedEvent {
    /// An event in single precision.
    fn of(event: &Event) -> Self {
        Self {
            what: match event.what {
                What::NoiseChange => CertifiedWhat::NoiseChange,
                What::Bursts { blocks } => CertifiedWhat::Bursts { blocks },
                What::Step => CertifiedWhat::Step,
                What::WarmUp { time_constant_s } => CertifiedWhat::WarmUp {
                    time_constant_s: single(time_constant_s),
                },
            },
            at_s: single(event.at_s),
            size: single(event.size),
            lower: single(event.lower),
            upper: single(event.upper),
            z: single(event.z),
        }
    }

    /// The event in the precision of the library.
    pub fn event(&self) -> Event {
        Event {
            what: match self.what {
                CertifiedWhat::NoiseChange => What::NoiseChange,
                CertifiedWhat::Bursts { blocks } => What::Bursts { blocks },
                CertifiedWhat::Step => What::Step,
                CertifiedWhat::WarmUp { time_constant_s } => What::WarmUp {
                    time_constant_s: real(time_constant_s),
                },
            },
            at_s: real(self.at_s),
            size: real(self.size),
            lower: real(self.lower),
            upper: real(self.upper),
            z: real(self.z),
        }
    }
}
