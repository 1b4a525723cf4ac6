//! Lists of limited length, filled without a way to panic: heapless's own `insert` and `collect` have one.

use core::{iter::Zip, mem, ops::Range};
use heapless::Vec;

/// Items with their places: the numbers of `enumerate` panic beyond `usize` where overflow is checked.
pub(crate) fn numbered<I: IntoIterator>(items: I) -> Zip<Range<usize>, I::IntoIter> {
    (0..usize::MAX).zip(items)
}

/// The first items, as many as there is room for.
pub(crate) fn fill<T, const N: usize>(items: impl IntoIterator<Item = T>) -> Vec<T, N> {
    let mut list = Vec::new();
    for item in items {
        if list.push(item).is_err() {
            break;
        }
    }
    list
}

/// Puts an item before the one at a place, or last; not where there is no room.
pub(crate) fn insert<T, const N: usize>(list: &mut Vec<T, N>, place: usize, item: T) {
    if list.push(item).is_err() {
        return;
    }
    let later = list.get_mut(place..).and_then(<[T]>::split_last_mut);
    if let Some((item, later)) = later {
        for other in later {
            mem::swap(item, other);
        }
    }
}

/// Puts an item before the first that is worse; the last one goes where there is no room. The item's
/// place, or `None` if it is worse than all of a full list.
pub(crate) fn rank<T, const N: usize>(
    list: &mut Vec<T, N>,
    item: T,
    is_worse: impl Fn(&T) -> bool,
) -> Option<usize> {
    let place = list.iter().position(is_worse).unwrap_or(list.len());
    if place >= N {
        return None;
    }
    if list.is_full() {
        list.pop();
    }
    insert(list, place, item);
    Some(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_takes_what_fits() {
        assert_eq!(fill::<_, 3>(0..9), [0, 1, 2]);
    }

    #[test]
    fn items_come_before_what_is_worse() {
        let mut list = Vec::<u8, 3>::new();
        for (item, place) in [
            (5, Some(0)),
            (3, Some(0)),
            (9, Some(2)),
            (4, Some(1)),
            (7, None),
        ] {
            assert_eq!(
                rank(&mut list, item, |other| *other > item),
                place,
                "{item}"
            );
        }
        assert_eq!(list, [3, 4, 5]);
        insert(&mut list, 1, 8);
        assert_eq!(list, [3, 4, 5], "full");
    }
}
