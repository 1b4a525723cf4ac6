//! placeholder
use crate::{
    effect::{Effect, SampledShape},
    real::Real,
};
use heapless::Vec;

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Bin {
    pub block: u32,
    pub index: u32,
    pub frequency_hz: Real,
    pub density: Real,
    pub segments: u32,
    pub effective: Real,
}
impl Bin {
    pub(crate) fn relative_covariance(&self, apart: usize) -> Real {
        [1.0, 4.0 / 9.0, 1.0 / 36.0]
            .get(apart)
            .copied()
            .unwrap_or(0.0)
            / self.effective
    }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Density<const B: usize = 0> {
    bins: Vec<Bin, B>,
}
impl<const B: usize> Density<B> {
    pub const EMPTY: Self = Self { bins: Vec::new() };
    pub const fn bins_(&self) -> &Vec<Bin, B> {
        &self.bins
    }
    pub fn bins(&self) -> &[Bin] {
        &self.bins
    }
    pub fn expected(&self, _e: &dyn Effect, _s: &SampledShape, _each: &mut dyn FnMut(Real)) {}
}
