//! What a rate follows that was recorded beside it: a column, its rate of change, its square, or the column with a lag.
//!
//! The octave sums of the library know one instant only. A gyro has a thermal mass, so that its rate follows a
//! temperature with a lag of seconds to minutes. The host therefore keeps [block means](allanite_log::block_means) of the axes and
//! of the columns beside them, forms other [series] from those of a column, and computes their
//! [cross curves](cross). A series whose cross curve is known is a covariate like any other, which the diagnosis
//! tries, believes and subtracts by the same rules.

pub mod candidates;
pub mod cross;
pub mod lag;
pub mod noise;
pub mod series;
pub mod steps;
