//! Tells by the values beside it whether a column of numbers marks the sensors of which the rows are.
//!
//! Two sensors never have the same bias, and hardly ever the same noise. So the values of neighbouring rows with different
//! marks differ by more than chance, whereas those beside a flag, an index of packets or a coarse temperature do not. Only
//! neighbours are compared, so that no drift counts. Marks come in an order that the marks before them foretell, or their values are
//! far apart.

use super::field::{Field as _, Text};
use csv::ByteRecord;
use std::collections::BTreeMap;

/// The most numbers that mark sensors. Chosen by hand.
const MOST: usize = 8;

/// Each mark stands in at least this share of the rows. Chosen by hand.
const LEAST_SHARE: f64 = 0.05;

/// The marks before a mark foretell it in at least this share of the rows. Chosen by hand.
const FORETOLD: f64 = 0.85;

/// Rows of sensors that are sampled at almost the same time change places at random. Their values differ by so much more.
/// Chosen by hand.
const UNFORETOLD: f64 = 10.0;

/// The number of marks that foretell the next one.
const BEFORE: usize = 3;

/// The fewest pairs of neighbours that are compared.
const LEAST_PAIRS: usize = 8;

/// The sum of squares of the differences of columns, in their standard deviations, beyond which sensors differ: one part that
/// chance never reaches, and one for each column. Chosen by hand.
const DIFFERENT: (f64, f64) = (64.0, 8.0);

/// Whether the numbers of a column mark the sensors of these rows.
pub(super) fn are_marks(rows: &[ByteRecord], numbers: &[Vec<Option<f64>>], column: usize) -> bool {
    let Some(marks) = numbers[column]
        .iter()
        .copied()
        .collect::<Option<Vec<f64>>>()
    else {
        return false;
    };
    let mut counts: BTreeMap<u64, usize> = BTreeMap::new();
    for mark in &marks {
        *counts.entry(mark.to_bits()).or_default() += 1;
        if counts.len() > MOST {
            return false;
        }
    }
    let least = LEAST_SHARE * rows.len() as f64;
    let is_frequent = counts.values().all(|&count| count as f64 >= least);
    if counts.len() < 2 || !is_frequent {
        return false;
    }
    let times = if are_foretold(&marks) {
        1.0
    } else {
        UNFORETOLD
    };
    let others = numbers
        .iter()
        .enumerate()
        .filter(|(other, _)| *other != column);
    let others: Vec<&Vec<Option<f64>>> = others.map(|(_, values)| values).collect();
    let keys: Vec<u64> = counts.into_keys().collect();
    let bits: Vec<u64> = marks.iter().map(|mark| mark.to_bits()).collect();
    let pairs =
        (0..keys.len()).flat_map(|one| (one + 1..keys.len()).map(move |other| (one, other)));
    let mut pairs = pairs.map(|(one, other)| [keys[one], keys[other]]);
    pairs.any(|pair| are_different(&bits, &others, pair) > times)
}

/// The square of the difference of means, in standard deviations, beyond which rows that take turns are those of several
/// sensors, in at least two columns. Chosen by hand.
const TURNS: f64 = 144.0;

/// The rows in which turns are looked for. A lost row ends an order of turns.
const TURN_ROWS: usize = 256;

/// The number of rows after which these come again, if they take turns between sensors: 2 or 3.
pub(super) fn turns(numbers: &[Vec<Option<f64>>]) -> Option<usize> {
    let columns = numbers
        .iter()
        .map(|values| &values[..values.len().min(TURN_ROWS)]);
    let columns: Vec<&[Option<f64>]> = columns.filter(|values| !is_time(values)).collect();
    [2, 3].into_iter().find(|&turns| {
        let differs = |values: &&&[Option<f64>]| turn(values, turns) > TURNS;
        columns.iter().filter(differs).count() >= 2
    })
}

/// The largest square of the mean step from a row to the next one at a place among turns, less the mean step of all, in its standard
/// deviations. A quantity that rises steadily has the same step at every place.
fn turn(values: &[Option<f64>], turns: usize) -> f64 {
    let at_place = |place: usize| {
        let pairs = values.windows(2).skip(place).step_by(turns);
        let steps: Vec<f64> = pairs.filter_map(|pair| Some(pair[1]? - pair[0]?)).collect();
        let count = steps.len() as f64;
        let mean = steps.iter().sum::<f64>() / count;
        let squares: f64 = steps.iter().map(|step| (step - mean).powi(2)).sum();
        let is_noise = steps.len() >= LEAST_PAIRS && squares > 0.0;
        is_noise.then(|| (mean, squares / (count * (count - 1.0))))
    };
    let places: Vec<(f64, f64)> = (0..turns).filter_map(at_place).collect();
    let drift = places.iter().map(|(mean, _)| mean).sum::<f64>() / places.len() as f64;
    let squares = places
        .iter()
        .map(|(mean, variance)| (mean - drift).powi(2) / variance);
    squares.fold(0.0, f64::max)
}

/// The fewest rows whose decimals are compared.
const DECIMALS: usize = 32;

/// The number of rows after which these come again, if they take turns between sensors whose values have other numbers of decimals: 2
/// or 3.
pub(super) fn turns_of_decimals(rows: &[ByteRecord]) -> Option<usize> {
    let rows = &rows[..rows.len().min(TURN_ROWS)];
    let decimals = |row: &ByteRecord, column: usize| {
        let field = row.get(column)?.trim_ascii();
        let point = field.iter().position(|&byte| byte == b'.')?;
        let behind = &field[point + 1..];
        let is_exponent = |byte: &u8| matches!(byte, b'e' | b'E');
        let exponent = behind.iter().position(is_exponent);
        let digits = &behind[..exponent.unwrap_or(behind.len())];
        let are_digits = digits.iter().all(u8::is_ascii_digit);
        are_digits.then_some((exponent.is_some(), digits.len()))
    };
    [2, 3].into_iter().find(|&turns| {
        let take_turns = |column: &usize| {
            let own = |row: usize| decimals(&rows[row], *column);
            let is_own =
                (0..rows.len()).all(|row| own(row).is_some() && own(row) == own(row % turns));
            is_own && (1..turns).any(|row| own(row) != own(0))
        };
        let width = rows.first().map_or(0, ByteRecord::len);
        rows.len() >= DECIMALS && (0..width).filter(take_turns).count() >= 2
    })
}

/// The ratio of noises, and the step between means in deviations, beyond which the rows on both sides of a change are those of other
/// sensors, in at least two columns; and the fewest rows on each side. Chosen by hand.
const UNLIKE: (f64, f64) = (3.0, 20.0);
const LEAST_BESIDE: usize = 16;

/// Whether the rows before a change and those behind it are unlike each other, as those of two sensors are.
pub(super) fn are_unlike(before: &[ByteRecord], behind: &[ByteRecord]) -> bool {
    let statistics = |rows: &[ByteRecord], column: usize| {
        let numbers = rows.iter().map(|row| Text(row.get(column)?).number().ok());
        let numbers: Vec<Option<f64>> = numbers.collect();
        if is_time(&numbers) {
            return None;
        }
        let numbers = numbers.into_iter().collect::<Option<Vec<f64>>>()?;
        let count = numbers.len() as f64;
        let mean = numbers.iter().sum::<f64>() / count;
        let steps = numbers.windows(2).map(|pair| (pair[1] - pair[0]).powi(2));
        Some((mean, (0.5 * steps.sum::<f64>() / (count - 1.0)).sqrt()))
    };
    let is_unlike = |column: &usize| {
        let (Some((one, noise)), Some((other, beside))) =
            (statistics(before, *column), statistics(behind, *column))
        else {
            return false;
        };
        let (least, most) = (noise.min(beside), noise.max(beside));
        least > 0.0 && (most > UNLIKE.0 * least || (one - other).abs() > UNLIKE.1 * most)
    };
    let width = before.first().map_or(0, ByteRecord::len);
    before.len().min(behind.len()) >= LEAST_BESIDE && (0..width).filter(is_unlike).count() >= 2
}

/// Whether values rise as a time does.
fn is_time(values: &[Option<f64>]) -> bool {
    let rising = values.windows(2).filter(|pair| pair[1] >= pair[0]).count();
    10 * rising > 9 * values.len()
}

/// Whether the marks before a mark foretell it.
fn are_foretold(marks: &[f64]) -> bool {
    let bits: Vec<u64> = marks.iter().map(|mark| mark.to_bits()).collect();
    let mut next: BTreeMap<&[u64], BTreeMap<u64, usize>> = BTreeMap::new();
    for part in bits.windows(BEFORE + 1) {
        *next
            .entry(&part[..BEFORE])
            .or_default()
            .entry(part[BEFORE])
            .or_default() += 1;
    }
    let usual: usize = next
        .values()
        .filter_map(|counts| counts.values().max())
        .sum();
    usual as f64 >= FORETOLD * bits.len().saturating_sub(BEFORE) as f64
}

/// By how much the values beside two marks differ, where 1 is more than chance.
fn are_different(marks: &[u64], columns: &[&Vec<Option<f64>>], [one, other]: [u64; 2]) -> f64 {
    let (mut sum, mut compared) = (0.0, 0);
    for values in columns {
        if is_time(values) {
            continue;
        }
        let means = difference_of_means(marks, values, [one, other]);
        let noises = difference_of_noises(marks, values, [one, other]);
        for square in [means, noises].into_iter().flatten() {
            sum += square;
            compared += 1;
        }
    }
    sum / (DIFFERENT.0 + DIFFERENT.1 * f64::from(compared))
}

/// The square of the mean difference between neighbouring rows with these marks, in its standard deviations.
fn difference_of_means(
    marks: &[u64],
    values: &[Option<f64>],
    [one, other]: [u64; 2],
) -> Option<f64> {
    let steps = marks.windows(2).zip(values.windows(2));
    let steps = steps.filter(|(marks, _)| **marks == [one, other]);
    let steps: Vec<f64> = steps
        .filter_map(|(_, pair)| Some(pair[1]? - pair[0]?))
        .collect();
    let count = steps.len() as f64;
    let mean = steps.iter().sum::<f64>() / count;
    let squares: f64 = steps.iter().map(|step| (step - mean).powi(2)).sum();
    let is_noise = steps.len() >= LEAST_PAIRS && squares > 0.0;
    is_noise.then(|| mean.powi(2) * count * (count - 1.0) / squares)
}

/// The square of the logarithm of the ratio of the noises beside two marks, in its standard deviations.
fn difference_of_noises(marks: &[u64], values: &[Option<f64>], pair: [u64; 2]) -> Option<f64> {
    let noise = |wanted: u64| {
        let of_mark = marks
            .iter()
            .zip(values)
            .filter(|(mark, _)| **mark == wanted);
        let of_mark: Vec<f64> = of_mark.filter_map(|(_, value)| *value).collect();
        let squares: f64 = of_mark
            .windows(2)
            .map(|pair| (pair[1] - pair[0]).powi(2))
            .sum();
        let steps = of_mark.len().saturating_sub(1) as f64;
        (steps >= LEAST_PAIRS as f64 && squares > 0.0).then_some((squares / steps, steps))
    };
    let ([one, other], [ones, others]) = {
        let (one, other) = (noise(pair[0])?, noise(pair[1])?);
        ([one.0, other.0], [one.1, other.1])
    };
    // The mean of n squares of differences of neighbours has a relative variance of 3/n.
    Some((one / other).ln().powi(2) / (3.0 / ones + 3.0 / others))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(state: &mut u32) -> f64 {
        let mut uniform = || {
            *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(*state >> 8) / f64::from(1 << 24) - 0.5
        };
        (0..12).map(|_| uniform()).sum()
    }

    /// Whether marks in this order are those of sensors, whose values have these biases and noises.
    fn are_sensors(order: impl Fn(usize) -> usize, sensors: [(f64, f64); 2]) -> bool {
        let mut state = 5;
        let rows: Vec<[f64; 3]> = (0..600)
            .map(|row| {
                let which = order(row);
                let (bias, scatter) = sensors[which % 2];
                let drift = 0.01 * row as f64;
                [
                    which as f64,
                    drift + bias + scatter * noise(&mut state),
                    noise(&mut state),
                ]
            })
            .collect();
        let column = |column: usize| rows.iter().map(|row| Some(row[column])).collect();
        let numbers: Vec<Vec<Option<f64>>> = (0..3).map(column).collect();
        are_marks(&vec![ByteRecord::new(); 600], &numbers, 0)
    }

    #[test]
    fn numbers_beside_which_values_differ_mark_sensors() {
        let (one, biased, noisy) = ((0.0, 1.0), (3.0, 1.0), (0.0, 3.0));
        let taking_turns = |row: usize| row % 2;
        let in_blocks = |row: usize| row / 8 % 2;
        for other in [biased, noisy] {
            assert!(are_sensors(taking_turns, [one, other]));
            assert!(are_sensors(in_blocks, [one, other]));
        }
        // Rows of almost the same time change places.
        let changing =
            |row: usize| usize::from(row.is_multiple_of(2)) ^ usize::from(row / 2 * 7919 % 13 < 5);
        assert!(are_sensors(changing, [one, (8.0, 1.0)]));
    }

    #[test]
    fn rows_that_take_turns_are_those_of_sensors() {
        let mut state = 9;
        let mut column = |turns: usize, bias: f64| -> Vec<Option<f64>> {
            let value =
                |row: usize| Some(if row % turns == 1 { bias } else { 0.0 } + noise(&mut state));
            (0..600).map(value).collect()
        };
        let time: Vec<Option<f64>> = (0..600).map(|row| Some(f64::from(row / 2))).collect();
        for turns in [2, 3] {
            let columns = [time.clone(), column(turns, 3.0), column(turns, -4.0)];
            assert_eq!(super::turns(&columns), Some(turns));
        }
        let columns = [time.clone(), column(2, 0.0), column(2, 0.0)];
        assert_eq!(super::turns(&columns), None);
        // Angles of a sensor that turns.
        let mut angle = |rate: f64| -> Vec<Option<f64>> {
            let value = |row: usize| Some(rate * row as f64 + 1e-3 * noise(&mut state));
            (0..600).map(value).collect()
        };
        let columns = [time, angle(0.1), angle(-0.2)];
        assert_eq!(super::turns(&columns), None);
    }

    #[test]
    fn rows_whose_decimals_take_turns_are_those_of_sensors() {
        let rows = |forms: [fn(f64) -> String; 2]| -> Vec<ByteRecord> {
            let row = |row: u32| {
                let number = 0.001 + 1e-5 * f64::from(row * row % 97);
                let own = forms[row as usize % 2](number);
                ByteRecord::from(vec![format!("{row}"), own.clone(), own])
            };
            (0..64).map(row).collect()
        };
        let fixed = |number: f64| format!("{number:.4}");
        assert_eq!(turns_of_decimals(&rows([fixed, fixed])), None);
        for other in [
            |number: f64| format!("{number:.6}"),
            |number: f64| format!("{number:.4e}"),
        ] {
            assert_eq!(turns_of_decimals(&rows([fixed, other])), Some(2));
        }
    }

    #[test]
    fn an_index_a_flag_and_a_coarse_quantity_mark_no_sensors() {
        let (one, other) = ((0.0, 1.0), (2.0, 1.0));
        assert!(!are_sensors(|row| row % 2, [one, one]));
        assert!(!are_sensors(|row| row % 25, [one, other]));
        assert!(!are_sensors(|row| usize::from(row % 97 == 5), [one, other]));
        assert!(!are_sensors(|row| row * row / 7 % 5, [one, one]));
        // A flag that no row foretells, beside which values are a little larger.
        assert!(!are_sensors(|row| row * row / 7 % 2, [one, (0.3, 1.0)]));
        assert!(!are_sensors(|row| row / 300, [one, one]));
    }
}
