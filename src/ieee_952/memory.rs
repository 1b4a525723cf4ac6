//! The octaves of a curve as rows, in memory of a fixed size.

use super::{row::Row, rows::Rows};
use crate::{
    curve::Point,
    numerics::real::{Real, single},
};

/// What a fit needs for each octave.
pub(super) struct Memory<const K: usize> {
    rows: [Row; K],
    factor: [[u16; K]; K],
}

impl<const K: usize> Memory<K> {
    pub(super) const EMPTY: Self = Self {
        rows: [Row::EMPTY; K],
        factor: [[0; K]; K],
    };

    /// The rows of octaves, and the variance of a middle one, so that single precision holds the ratios to it whatever the
    /// unit of the rates.
    pub(super) fn rows(&mut self, points: &[Point]) -> (Rows<'_, K>, Real) {
        let reference = points.get(points.len() / 2);
        let reference = reference.map_or(1.0, |point| point.variance);
        for (row, point) in self.rows.iter_mut().zip(points) {
            row.measured = single(point.variance / reference);
            row.model = row.measured;
            row.per_difference = 1.0 / point.differences as f32;
            row.ends = point.stretches as f32 * row.per_difference;
        }
        let rows = self.rows.get_mut(..points.len()).unwrap_or_default();
        (Rows::new(rows, &mut self.factor), reference)
    }
}

/// The first octaves, as far as they follow each other from `m = 1` on.
pub(super) fn consecutive(points: &[Point]) -> &[Point] {
    let missing = (0_u32..32).zip(points).find(|(k, point)| point.m != 1 << k);
    let known = missing.map_or(points.len(), |(k, _)| k as usize);
    points.get(..known).unwrap_or_default()
}
