//! Dates and times in text: ISO 8601 as loggers write it, the forms of several countries, and times of day.

/// The most bytes that a date and time have.
const LONGEST: usize = 40;

const MONTHS: [&str; 12] = [
    "jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec",
];

/// The nanoseconds since 1970, or since midnight if there is no date: `2024-05-01T12:00:00.005Z`, `2024-05-01
/// 12:00:00,005`, `2024/05/01 12:00:00.005+02:00`, `5/1/2024 0:00:00.005 PM`, `01.05.2024 12:00:00`, `01-May-2024
/// 12:00:00`, `12:00:00.005`. Returns `None` for any other text.
pub(super) fn nanoseconds(text: &[u8]) -> Option<i64> {
    let text = text.trim_ascii();
    // Most fields are numbers, and have neither.
    if text.len() > LONGEST || !(text.contains(&b':') || text.contains(&b'T')) {
        return None;
    }
    let text = std::str::from_utf8(text).ok()?;
    let (days, time) = match text.split_once(['T', ' ', 't']) {
        Some((date, time)) if date.contains(['-', '/', '.']) => (days(date)?, time.trim_start()),
        _ => (0, text),
    };
    let (time, offset_s) = without_offset(time)?;
    let of_day = nanoseconds_of_day(time)?;
    let seconds = days.checked_mul(86_400)?.checked_sub(offset_s)?;
    seconds.checked_mul(1_000_000_000)?.checked_add(of_day)
}

/// The days since 1970. With a year in front, the month follows; with the name of a month, its place tells. Otherwise
/// `5/1/2024` is the fifth month's first day where `5` can be a month, and `1.5.2024` and `1-5-2024` are too.
fn days(date: &str) -> Option<i64> {
    let separator = date.find(['-', '/', '.'])?;
    let separator = date[separator..].chars().next()?;
    let parts: Vec<&str> = date.split(separator).collect();
    let &[first, second, third] = parts.as_slice() else {
        return None;
    };
    let number = |text: &str| -> Option<i64> {
        let is_number = (1..=4).contains(&text.len()) && text.bytes().all(|c| c.is_ascii_digit());
        is_number.then(|| text.parse().ok()).flatten()
    };
    let named = |text: &str| {
        let text = text.to_lowercase();
        let month = MONTHS.iter().position(|month| text.starts_with(month));
        month.and_then(|month| i64::try_from(month + 1).ok())
    };
    let (year, month, day) = if first.len() == 4 {
        (
            number(first)?,
            number(second).or(named(second))?,
            number(third)?,
        )
    } else if let Some(month) = named(second) {
        (number(third)?, month, number(first)?)
    } else {
        let (one, two) = (number(first)?, number(second)?);
        let is_month_first = (separator == '/' && one <= 12) || two > 12;
        let (month, day) = if is_month_first {
            (one, two)
        } else {
            (two, one)
        };
        (number(third)?, month, day)
    };
    let year = if third.len() == 2 && first.len() <= 2 {
        year + 2000
    } else {
        year
    };
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) || !(1900..=9999).contains(&year) {
        return None;
    }
    // Counted from March, so that a leap day ends a year (Hinnant 2013, `days_from_civil`).
    let from_march = (month + 9) % 12;
    let year = year - i64::from(month <= 2);
    let of_year = (153 * from_march + 2) / 5 + day - 1;
    Some(365 * year + year / 4 - year / 100 + year / 400 + of_year - 719_468)
}

/// The nanoseconds of a time of day: `7:48:12.005`, `12:00:00,005`, `22.13.19.994`, `1:02:03.5 PM`. The 61st second of a
/// minute is a leap second.
fn nanoseconds_of_day(time: &str) -> Option<i64> {
    let lower = time.trim().to_lowercase();
    let (time, is_afternoon) = match (lower.strip_suffix("am"), lower.strip_suffix("pm")) {
        (Some(time), _) => (time.trim_end(), Some(false)),
        (_, Some(time)) => (time.trim_end(), Some(true)),
        _ => (lower.as_str(), None),
    };
    let time = time.replace(',', ".");
    let mut parts = match time.contains(':') {
        true => time.splitn(3, ':'),
        false => time.splitn(3, '.'),
    };
    let whole = |text: &str, most: i64| -> Option<i64> {
        let is_number = (1..=2).contains(&text.len()) && text.bytes().all(|c| c.is_ascii_digit());
        let number = is_number.then(|| text.parse().ok()).flatten()?;
        (number <= most).then_some(number)
    };
    let hours = whole(parts.next()?, 23)?;
    let minutes = whole(parts.next()?, 59)?;
    let seconds = parts.next()?.replace(':', ".");
    let (seconds, fraction) = seconds.split_once('.').unwrap_or((&seconds, ""));
    let seconds = whole(seconds, 60)?;
    if fraction.len() > 18 || !fraction.bytes().all(|c| c.is_ascii_digit()) {
        return None;
    }
    let nanoseconds: i64 = format!("{fraction:0<9}").get(..9)?.parse().ok()?;
    let hours = match is_afternoon {
        None => hours,
        Some(is_afternoon) => hours % 12 + 12 * i64::from(is_afternoon),
    };
    Some((3600 * hours + 60 * minutes + seconds) * 1_000_000_000 + nanoseconds)
}

/// A time without its offset from UTC, and that offset in seconds: `Z`, ` UTC`, `+02:00`, `-0430`.
fn without_offset(time: &str) -> Option<(&str, i64)> {
    let time = time
        .strip_suffix("UTC")
        .or(time.strip_suffix(['Z', 'z']))
        .unwrap_or(time)
        .trim_end();
    let Some(at) = time.rfind(['+', '-']) else {
        return Some((time, 0));
    };
    let (time, offset) = time.split_at(at);
    let sign = if offset.starts_with('-') { -1 } else { 1 };
    let digits = offset[1..].replace(':', "");
    let is_offset =
        matches!(digits.len(), 2 | 4) && digits.bytes().all(|byte| byte.is_ascii_digit());
    let hours: i64 = digits.get(..2)?.parse().ok().filter(|_| is_offset)?;
    let minutes: i64 = digits
        .get(2..)
        .filter(|rest| !rest.is_empty())
        .map_or(Some(0), |rest| rest.parse().ok())?;
    Some((time.trim_end(), sign * (3600 * hours + 60 * minutes)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn dates_and_times_are_nanoseconds() {
        let noon = 1_714_564_800_000_000_000;
        for (text, expected) in [
            ("2024-05-01T12:00:00Z", noon),
            ("2024-05-01T12:00:00.005Z", noon + 5_000_000),
            ("2024-05-01 12:00:00,005", noon + 5_000_000),
            ("2024/05/01 12:00:00.000000001", noon + 1),
            ("2024-05-01T14:00:00.5+02:00", noon + 500_000_000),
            ("2024-05-01T07:30:00-0430", noon),
            ("2024-05-01 12:00:00 UTC", noon),
            (" 00:00:01.25 ", 1_250_000_000),
            ("1:00:00", 3_600_000_000_000),
            ("5/1/2024 12:00:00.005", noon + 5_000_000),
            ("05/01/2024 12:00:00 PM", noon),
            ("5/1/2024 3:00:00 pm", noon + 3 * 3_600_000_000_000),
            (
                "25/12/2024 00:00:00",
                noon + (238 * 24 - 12) * 3_600_000_000_000,
            ),
            ("01.05.2024 12:00:00,5", noon + 500_000_000),
            ("1-May-2024 12:00:00", noon),
            ("01-05-2024 12:00:00", noon),
            ("2024-05-01T12.00.00.005", noon + 5_000_000),
            ("1969-12-31 23:59:59.5", -500_000_000),
            ("2016-12-31T23:59:60.5Z", 1_483_228_800_500_000_000),
            ("2000-02-29 00:00:00", 951_782_400_000_000_000),
        ] {
            assert_eq!(nanoseconds(text.as_bytes()), Some(expected), "{text}");
        }
        for text in [
            "",
            "12",
            "2024-05-01",
            "a:b",
            "12:00:00.5x",
            "0x10:00",
            "::",
            "12:00:00+",
            "é:+é",
            "13/13/2024 12:00:00",
            "2024-05-01 24:00:00",
            "T",
            "1.5T",
        ] {
            assert_eq!(nanoseconds(text.as_bytes()), None, "{text}");
        }
    }

    proptest! {
        #[test]
        fn any_text_is_a_time_or_not(text in "[-0-9:.,TZ+ é/]{0,40}") {
            let _ = nanoseconds(text.as_bytes());
        }
    }
}
