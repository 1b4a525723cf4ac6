//! Converts the elements of NumPy arrays, block by block.

use super::{
    columns::AxisColumn,
    field::Field,
    npy_header::{Header, Kind},
    table::{RUN, Visitor, after_stop},
};
use crate::failure::{Failure, Place};
use std::path::Path;

/// Some rows of an array that follow each other, or a part of one of its columns.
pub(super) struct Block<'a> {
    pub(super) bytes: &'a [u8],
    /// The number of elements that lie side by side in each row.
    pub(super) columns: usize,
    /// The number of the first row.
    pub(super) row: u64,
    /// The column of the first element of a row.
    pub(super) first: usize,
}

impl Block<'_> {
    /// Shows the elements to a visitor. Returns whether it wants more.
    pub(super) fn show<V: Visitor>(
        &self,
        header: &Header,
        axes: &[AxisColumn],
        visitor: &mut V,
        path: &Path,
    ) -> Result<bool, Failure> {
        // The type and the order of the bytes are decided once for all elements, which leaves a short loop.
        macro_rules! elements {
            ($element:ty as $field:ty) => {
                if header.big_endian {
                    self.show_elements(axes, (visitor, path), |bytes| {
                        <$field>::from(<$element>::from_be_bytes(bytes))
                    })
                } else {
                    self.show_elements(axes, (visitor, path), |bytes| {
                        <$field>::from(<$element>::from_le_bytes(bytes))
                    })
                }
            };
        }
        match (header.kind, header.size) {
            (Kind::Signed, 1) => elements!(i8 as i32),
            (Kind::Signed, 2) => elements!(i16 as i32),
            (Kind::Signed, 4) => elements!(i32 as i32),
            (Kind::Signed, _) => elements!(i64 as i64),
            (Kind::Unsigned, 1) => elements!(u8 as i32),
            (Kind::Unsigned, 2) => elements!(u16 as i32),
            (Kind::Unsigned, 4) => elements!(u32 as i64),
            (Kind::Unsigned, _) => elements!(u64 as u64),
            (Kind::Float, 4) => elements!(f32 as f64),
            (Kind::Float, _) => elements!(f64 as f64),
        }
    }

    fn show_elements<const SIZE: usize, F: Field + Default, V: Visitor>(
        &self,
        axes: &[AxisColumn],
        (visitor, path): (&mut V, &Path),
        convert: impl Fn([u8; SIZE]) -> F,
    ) -> Result<bool, Failure> {
        let here = axes.iter().enumerate().filter_map(|(i, axis)| {
            let at = axis.column.checked_sub(self.first)?;
            (at < self.columns).then_some((i, at))
        });
        let here: Vec<_> = here.collect();
        let (elements, _) = self.bytes.as_chunks::<SIZE>();
        let mut values = [F::default(); RUN];
        let runs = elements.chunks(RUN * self.columns);
        for (run, first) in runs.zip((self.row..).step_by(RUN)) {
            let rows = || run.chunks_exact(self.columns);
            // A row whose values are not all numbers has to be seen as a row.
            let is_whole =
                || rows().all(|row| here.iter().all(|&(_, at)| convert(row[at]).is_number()));
            if V::BY_ROWS || !is_whole() {
                for (elements, row) in rows().zip(first..) {
                    let place = || Place::row(path, row + 1);
                    for &(axis, at) in &here {
                        let shown = visitor.visit(axis, convert(elements[at]));
                        let Err(stop) = shown else { continue };
                        if !after_stop(visitor, (axis, &stop), axes, place)? {
                            return Ok(false);
                        }
                        break;
                    }
                }
                continue;
            }
            for &(axis, at) in &here {
                let values = &mut values[..run.len() / self.columns];
                if self.columns == 1 {
                    for (value, &element) in values.iter_mut().zip(run) {
                        *value = convert(element);
                    }
                } else {
                    for (value, row) in values.iter_mut().zip(rows()) {
                        *value = convert(row[at]);
                    }
                }
                if let Err((place, stop)) = visitor.visit_run(axis, values) {
                    let place = || Place::row(path, first + place as u64 + 1);
                    return after_stop(visitor, (axis, &stop), axes, place).map(|_| false);
                }
            }
        }
        Ok(true)
    }
}
