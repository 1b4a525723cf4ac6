//! Lists of limited length, filled by functions that cannot panic. heapless's own `insert`,
//! `remove` and `collect` can.

use core::{iter::Zip, mem, ops::Range};
use heapless::Vec;

/// Items with their places, counted from 0. `enumerate` panics beyond `usize` where overflow is
/// checked.
pub(crate) fn numbered<I: IntoIterator>(items: I) -> Zip<Range<usize>, I::IntoIter> {
    (0..usize::MAX).zip(items)
}

/// The number of items. Unlike that of `Iterator::count`, the arithmetic cannot overflow, so that it has no path to a
/// panic where overflow is checked.
pub(crate) fn count(items: impl Iterator) -> usize {
    items.fold(0, |count: usize, _| count.saturating_add(1))
}

/// A list of the first items, as many as there is room for.
pub(crate) fn fill<T, const N: usize>(items: impl IntoIterator<Item = T>) -> Vec<T, N> {
    let mut list = Vec::new();
    for item in items {
        if list.push(item).is_err() {
            break;
        }
    }
    list
}

/// Inserts an item at a place, or at the end if the place lies beyond it. Does nothing if there is no
/// room.
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

/// Removes the item at a place. Does nothing if there is none.
pub(crate) fn remove<T, const N: usize>(list: &mut Vec<T, N>, place: usize) {
    let later = list.get_mut(place..).and_then(<[T]>::split_first_mut);
    if let Some((item, later)) = later {
        for other in later.iter_mut().rev() {
            mem::swap(item, other);
        }
        list.pop();
    }
}

/// Inserts an item before the first one that is worse. A full list loses its last item. Returns the
/// item's place, or `None` if the list is full and has no worse item.
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
    use crate::numerics::test_random::Random;

    #[test]
    fn filling_a_list_stops_at_its_capacity() {
        assert_eq!(fill::<_, 3>(0..9), [0, 1, 2]);
    }

    #[test]
    fn an_item_is_ranked_before_the_first_worse_one() {
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

    /// The list is compared with one of unlimited length, which is sorted with earlier items first and
    /// then cut.
    #[test]
    fn ranking_keeps_the_best_items_in_order() {
        let mut random = Random::new(31);
        for _ in 0..200 {
            let mut list = Vec::<(usize, usize), 4>::new();
            let mut all = Vec::<(usize, usize), 40>::new();
            for order in 0..random.below(40) {
                let item = (random.below(6), order);
                let place = rank(&mut list, item, |other| other.0 > item.0);
                all.push(item).expect("room");
                all.sort_unstable();
                assert_eq!(list, all[..all.len().min(4)]);
                let expected = all.iter().position(|other| *other == item);
                assert_eq!(place, expected.filter(|place| *place < 4));
            }
        }
    }

    #[test]
    fn inserting_an_item_moves_the_later_ones_by_one_place() {
        for place in 0..6 {
            let mut list = Vec::<u8, 4>::from([0, 1, 2]);
            insert(&mut list, place, 9);
            // A place beyond the end stands for the end.
            let (before, later) = [0, 1, 2].split_at(place.min(3));
            assert_eq!(list[..before.len()], *before);
            assert_eq!(list[before.len()], 9);
            assert_eq!(list[before.len() + 1..], *later);
        }
    }

    #[test]
    fn numbered_items_count_from_zero() {
        assert!(numbered("abc".chars()).eq("abc".chars().enumerate()));
    }
}
