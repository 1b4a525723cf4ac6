//! Every transcendental function of the library, by name: a method such as `x.sqrt()` becomes
//! std's once anything in a build links std, and host and target would compute different numbers.

pub(crate) use libm::{erfc, exp, log, sqrt};
