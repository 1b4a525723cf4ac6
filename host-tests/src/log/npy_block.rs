//! Converts the elements of NumPy arrays, block by block.

use super::{
    columns::AxisColumn,
    field::Field,
    npy_header::{Header, Kind},
    table::{RUN, Stop, Visitor},
};

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

/// Why and where a visitor wanted no more values.
pub(super) struct Stopped {
    /// The place of the column among those that were asked for.
    pub(super) axis: usize,
    pub(super) row: u64,
    pub(super) stop: Stop,
}

impl Block<'_> {
    /// Shows the elements to a visitor.
    pub(super) fn show<V: Visitor>(
        &self,
        header: &Header,
        axes: &[AxisColumn],
        visitor: &mut V,
    ) -> Result<(), Stopped> {
        // The type and the order of the bytes are decided once for all elements, which leaves a short loop.
        macro_rules! elements {
            ($element:ty as $field:ty) => {
                if header.big_endian {
                    self.show_elements(axes, visitor, |bytes| {
                        <$field>::from(<$element>::from_be_bytes(bytes))
                    })
                } else {
                    self.show_elements(axes, visitor, |bytes| {
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
        visitor: &mut V,
        convert: impl Fn([u8; SIZE]) -> F,
    ) -> Result<(), Stopped> {
        let here = axes.iter().enumerate().filter_map(|(i, axis)| {
            let at = axis.column.checked_sub(self.first)?;
            (at < self.columns).then_some((i, at))
        });
        let here: Vec<_> = here.collect();
        let (elements, _) = self.bytes.as_chunks::<SIZE>();
        if V::BY_ROWS {
            for (elements, row) in elements.chunks_exact(self.columns).zip(self.row..) {
                for &(axis, at) in &here {
                    let shown = visitor.visit(axis, convert(elements[at]));
                    shown.map_err(|stop| Stopped { axis, row, stop })?;
                }
            }
            return Ok(());
        }
        let mut values = [F::default(); RUN];
        let runs = elements.chunks(RUN * self.columns);
        for (run, row) in runs.zip((self.row..).step_by(RUN)) {
            let mut stopped: Option<Stopped> = None;
            for &(axis, at) in &here {
                let values = &mut values[..run.len() / self.columns];
                if self.columns == 1 {
                    for (value, &element) in values.iter_mut().zip(run) {
                        *value = convert(element);
                    }
                } else {
                    for (value, row) in values.iter_mut().zip(run.chunks_exact(self.columns)) {
                        *value = convert(row[at]);
                    }
                }
                if let Err((place, stop)) = visitor.visit_run(axis, values) {
                    let row = row + place as u64;
                    // The value that comes first in the order of the rows is reported.
                    if stopped.as_ref().is_none_or(|stopped| row < stopped.row) {
                        stopped = Some(Stopped { axis, row, stop });
                    }
                }
            }
            if let Some(stopped) = stopped {
                return Err(stopped);
            }
        }
        Ok(())
    }
}
