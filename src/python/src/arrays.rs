//! Arrays of NumPy as columns of the host library.

use allanite_log::{Column, Fill, Numbers};
use numpy::{
    PyReadonlyArray1,
    ndarray::{ArrayView1, s},
};
use pyo3::{exceptions::PyTypeError, prelude::*};

/// A column that Python lends.
pub(crate) struct Lent<'py> {
    name: String,
    array: Array<'py>,
}

/// Arrays of one dimension, by their types.
macro_rules! arrays {
    ($($name:ident($element:ty) => $numbers:ident($wide:ty)),+ $(,)?) => {
        enum Array<'py> {
            $($name(PyReadonlyArray1<'py, $element>),)+
        }

        impl<'py> Array<'py> {
            fn of(object: &Bound<'py, PyAny>) -> PyResult<Self> {
                $(if let Ok(array) = object.extract() {
                    return Ok(Self::$name(array));
                })+
                // The Python part hands over no other type.
                Err(PyTypeError::new_err("an array of one dimension with plain numbers is needed"))
            }

            fn rows(&self) -> usize {
                match self {
                    $(Self::$name(array) => array.as_array().len(),)+
                }
            }

            fn numbers(&self) -> Numbers<'_> {
                match self {
                    $(Self::$name(array) => {
                        Numbers::$numbers(copy(array.as_array(), <$wide>::from))
                    })+
                }
            }
        }
    };
}

arrays! {
    F64(f64) => Float(f64),
    I16(i16) => Int32(i32),
    I32(i32) => Int32(i32),
    F32(f32) => Float(f64),
    I64(i64) => Int64(i64),
    I8(i8) => Int32(i32),
    U8(u8) => Int32(i32),
    U16(u16) => Int32(i32),
    U32(u32) => Int64(i64),
    U64(u64) => Uint64(u64),
}

/// Copies a run of a column as numbers of another type, whatever the layout of the array.
fn copy<'a, T, U>(
    view: ArrayView1<'a, T>,
    convert: impl Fn(T) -> U + Send + Sync + 'a,
) -> Fill<'a, U>
where
    T: Copy + Send + Sync + 'a,
{
    match view.to_slice() {
        Some(slice) => Box::new(move |first, to| {
            let rows = slice.get(first..).unwrap_or(&[]);
            for (to, row) in to.iter_mut().zip(rows) {
                *to = convert(*row);
            }
        }),
        None => Box::new(move |first, to| {
            let rows = view.slice(s![first..view.len().min(first + to.len())]);
            for (to, row) in to.iter_mut().zip(rows) {
                *to = convert(*row);
            }
        }),
    }
}

impl<'py> Lent<'py> {
    /// A column with its name.
    pub(crate) fn of((name, object): (String, Bound<'py, PyAny>)) -> PyResult<Self> {
        let array = Array::of(&object)?;
        Ok(Self { name, array })
    }

    pub(crate) fn rows(&self) -> usize {
        self.array.rows()
    }

    pub(crate) fn column(&self) -> Column<'_> {
        Column {
            name: self.name.clone(),
            numbers: self.array.numbers(),
        }
    }
}
