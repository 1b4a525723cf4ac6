//! Numbers and linear algebra, which know nothing of gyros.

pub(crate) mod algebra;
pub(crate) mod chi_squared;
pub(crate) mod cholesky;
pub(crate) mod deviance;
pub(crate) mod math;
pub(crate) mod nnls;
pub(crate) mod real;
#[cfg(test)]
pub(crate) mod test_random;
