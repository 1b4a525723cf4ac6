//! Values in memory that the caller owns.

use crate::status::AllaniteStatus;
use core::ptr;

/// Memory of the caller: words of which C knows the number, and the value that they hold.
///
/// # Safety
/// `Self` must be words and nothing else, and `MARK` must differ between all implementations.
pub(crate) unsafe trait Memory: Sized {
    /// The value in the memory.
    type Value;
    /// What stands before a value of this type, so that memory without one is refused.
    const MARK: u64;
}

/// What the memory holds.
#[repr(C, align(8))]
pub(crate) struct Marked<V> {
    mark: u64,
    value: V,
}

/// Checks a pointer to memory, whatever it holds.
fn checked<M: Memory>(memory: *mut M) -> Result<*mut Marked<M::Value>, AllaniteStatus> {
    let marked = memory.cast::<Marked<M::Value>>();
    if memory.is_null() {
        Err(AllaniteStatus::NullPointer)
    } else if !marked.is_aligned() {
        Err(AllaniteStatus::Misaligned)
    } else if size_of::<Marked<M::Value>>() > size_of::<M>() {
        Err(AllaniteStatus::WrongSize)
    } else {
        Ok(marked)
    }
}

/// Makes a value in memory of so many bytes.
///
/// # Safety
/// `memory` is null, or points to as many writable bytes as `M` has, and nothing else uses them during the call.
#[inline(always)]
pub(crate) unsafe fn make<M: Memory>(
    memory: *mut M,
    bytes: usize,
    value: impl FnOnce() -> Result<M::Value, AllaniteStatus>,
) -> Result<(), AllaniteStatus> {
    let marked = checked(memory)?;
    if bytes != size_of::<M>() {
        return Err(AllaniteStatus::WrongSize);
    }
    // SAFETY: the caller promises that the memory is there, and its size and alignment are checked. A field of it is
    // written without a look at what was there before.
    let (mark, place) = unsafe { (&raw mut (*marked).mark, &raw mut (*marked).value) };
    // SAFETY: as before. The mark is taken away first, so that no half-made value is ever used.
    unsafe { ptr::write(mark, 0) };
    let value = value()?;
    // SAFETY: as before.
    unsafe { ptr::write(place, value) };
    // SAFETY: as before.
    unsafe { ptr::write(mark, M::MARK) };
    Ok(())
}

/// The value in the memory.
///
/// # Safety
/// `memory` is null, or points to as many readable bytes as `M` has, which nothing changes during `'a`. If they begin with
/// the mark, `make` made a value there.
pub(crate) unsafe fn get<'a, M: Memory>(memory: *const M) -> Result<&'a M::Value, AllaniteStatus> {
    let marked = checked(memory.cast_mut())?;
    // SAFETY: the caller promises that the bytes can be read; size and alignment are checked. Words have no invalid value.
    let mark = unsafe { ptr::read(&raw const (*marked).mark) };
    if mark != M::MARK {
        return Err(AllaniteStatus::NotInitialised);
    }
    // SAFETY: the mark says that there is a value, and the caller promises that it stays.
    Ok(unsafe { &(*marked).value })
}

/// The value in the memory, to be changed.
///
/// # Safety
/// As of [`get`], and nothing else uses the bytes during `'a`.
pub(crate) unsafe fn get_mut<'a, M: Memory>(
    memory: *mut M,
) -> Result<&'a mut M::Value, AllaniteStatus> {
    let marked = checked(memory)?;
    // SAFETY: the caller promises that the bytes can be read; size and alignment are checked. Words have no invalid value.
    let mark = unsafe { ptr::read(&raw const (*marked).mark) };
    if mark != M::MARK {
        return Err(AllaniteStatus::NotInitialised);
    }
    // SAFETY: the mark says that there is a value, and the caller promises that nothing else uses it.
    Ok(unsafe { &mut (*marked).value })
}

/// Writes a result where the caller wants it.
///
/// # Safety
/// `to` is null, or points to a writable, aligned `T`.
pub(crate) unsafe fn put<T>(to: *mut T, value: T) -> Result<(), AllaniteStatus> {
    if to.is_null() {
        return Err(AllaniteStatus::NullPointer);
    }
    if !to.is_aligned() {
        return Err(AllaniteStatus::Misaligned);
    }
    // SAFETY: the pointer is checked as far as it can be, and the caller promises the rest.
    unsafe { ptr::write(to, value) };
    Ok(())
}

/// The elements that a pointer and a length stand for. A null pointer is an error unless the length is 0.
///
/// # Safety
/// `first` is null, or points to `length` readable elements, which nothing changes during `'a`.
pub(crate) unsafe fn slice<'a, T>(
    first: *const T,
    length: usize,
) -> Result<&'a [T], AllaniteStatus> {
    if length == 0 {
        return Ok(&[]);
    }
    if first.is_null() {
        return Err(AllaniteStatus::NullPointer);
    }
    if !first.is_aligned() {
        return Err(AllaniteStatus::Misaligned);
    }
    if size_of::<T>().saturating_mul(length) > isize::MAX as usize {
        return Err(AllaniteStatus::WrongSize);
    }
    // SAFETY: null, alignment and size are checked, and the caller promises that the elements are there.
    Ok(unsafe { core::slice::from_raw_parts(first, length) })
}

/// The elements that a pointer and a length stand for, to be changed.
///
/// # Safety
/// As of [`slice`], and nothing else uses the elements during `'a`.
pub(crate) unsafe fn slice_mut<'a, T>(
    first: *mut T,
    length: usize,
) -> Result<&'a mut [T], AllaniteStatus> {
    if length == 0 {
        return Ok(&mut []);
    }
    if first.is_null() {
        return Err(AllaniteStatus::NullPointer);
    }
    if !first.is_aligned() {
        return Err(AllaniteStatus::Misaligned);
    }
    if size_of::<T>().saturating_mul(length) > isize::MAX as usize {
        return Err(AllaniteStatus::WrongSize);
    }
    // SAFETY: null, alignment and size are checked, and the caller promises that the elements are there and are its own.
    Ok(unsafe { core::slice::from_raw_parts_mut(first, length) })
}

/// What a function returns.
pub(crate) fn status(result: Result<(), AllaniteStatus>) -> AllaniteStatus {
    result.err().unwrap_or(AllaniteStatus::Ok)
}
