//! The exactness of the sums.
use super::*;
use crate::test_random::Random;
