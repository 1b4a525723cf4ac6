//! A network of one hidden layer of rectified units.

use crate::numerics::real::Real;

/// The number of features of an axis.
pub(super) const FEATURES: usize = 12;
/// The number of features of three axes: the largest of each over the axes, and what the axes say together.
pub(super) const JOINT: usize = FEATURES + 6;

/// `I` features, `H` hidden units.
pub(super) struct Network<const I: usize, const H: usize> {
    /// What each unit adds up: the features times these weights.
    pub(super) hidden: [[Real; I]; H],
    /// The weight of a known unit of the features.
    pub(super) unit: [Real; H],
    /// The constant of each unit.
    pub(super) bias: [Real; H],
    /// The weights of the units, of which those below zero count as zero.
    pub(super) output: [Real; H],
    /// The least sum that says yes: without the unit of the features, and with it.
    pub(super) least: [Real; 2],
}

impl<const I: usize, const H: usize> Network<I, H> {
    /// Whether the network says yes. `unit` is known or not.
    #[inline(never)]
    pub(super) fn is_positive(&self, features: &[Real; I], unit: Option<Real>) -> bool {
        let [without, with] = self.least;
        let (known, least) = match unit {
            Some(_) => (1.0, with),
            None => (0.0, without),
        };
        let rows = self.hidden.iter().zip(&self.unit).zip(&self.bias);
        let mut sum = 0.0;
        for (((weights, of_unit), bias), output) in rows.zip(&self.output) {
            let mut activity = bias + of_unit * known;
            for (weight, feature) in weights.iter().zip(features) {
                activity += weight * feature;
            }
            if activity > 0.0 {
                sum += output * activity;
            }
        }
        sum > least
    }
}
