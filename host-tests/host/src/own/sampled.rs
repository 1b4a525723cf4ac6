//! What was computed of the last shapes.

use super::{covariance::Covariance, density::Density};
use allanite::effect::MAX_PARAMETERS;
use std::{
    collections::HashMap,
    sync::{Mutex, PoisonError},
};

/// Shapes whose covariances are kept. A search goes from shape to shape, and asks of each for many lags.
const KEPT: usize = 16;

/// An effect in a shape, by the address of its description, and by the bits of the sample interval and of the parameters.
pub(super) type Key = (usize, [u64; 1 + MAX_PARAMETERS]);

/// A shape, sampled, and its covariances by the bits of the lag.
struct Sampled {
    key: Key,
    process: Process,
    lags: HashMap<u64, f64>,
}

/// The last shapes of all effects, in the order in which they came, so that memory stays bounded however many formulas there are.
static SAMPLED: Mutex<Vec<Sampled>> = Mutex::new(Vec::new());

/// A shape of an effect, sampled.
pub(super) enum Process {
    Density(Density),
    Covariance(Covariance<Box<dyn Fn(f64) -> f64 + Send>>),
}

/// The generalised covariance at a lag, which is computed once for each of the last shapes.
pub(super) fn covariance(key: Key, lag: f64, process: impl FnOnce() -> Process) -> f64 {
    let mut all = SAMPLED.lock().unwrap_or_else(PoisonError::into_inner);
    let at = all.iter().position(|one| one.key == key);
    let at = at.unwrap_or_else(|| {
        if all.len() >= KEPT {
            all.remove(0);
        }
        all.push(Sampled {
            key,
            process: process(),
            lags: HashMap::new(),
        });
        all.len() - 1
    });
    let Sampled { process, lags, .. } = &mut all[at];
    *lags.entry(lag.to_bits()).or_insert_with(|| match process {
        Process::Density(density) => density.covariance(lag),
        Process::Covariance(covariance) => covariance.covariance(lag),
    })
}
