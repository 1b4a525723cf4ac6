//! Dates and times in text: ISO 8601 as loggers write it, and times of day.

/// The most bytes that a date and time have.
const LONGEST: usize = 40;

/// The nanoseconds since 1970, or since midnight if there is no date: `2024-05-01T12:00:00.005Z`, `2024-05-01
/// 12:00:00,005`, `2024/05/01 12:00:00.005+02:00`, `12:00:00.005`. Returns `None` for any other text.
pub(super) fn nanoseconds(text: &[u8]) -> Option<i64> {
    let text = text.trim_ascii();
    // Most fields are numbers, and have no colon.
    if text.len() > LONGEST || !text.contains(&b':') {
        return None;
    }
    let text = std::str::from_utf8(text).ok()?;
    let (date, time) = match text.split_once(['T', ' ', 't']) {
        Some((date, time)) => (date.replace('/', "-"), time.trim_start()),
        None => ("1970-01-01".into(), text),
    };
    let (time, offset_s) = without_offset(time)?;
    let mut time = time.replace(',', ".");
    // A logger may leave out leading zeros of hours.
    if time.find(':') == Some(1) {
        time.insert(0, '0');
    }
    let moment = humantime::parse_rfc3339_weak(&format!("{date} {time}")).ok()?;
    let since = moment.duration_since(std::time::UNIX_EPOCH).ok()?;
    let nanoseconds = i64::try_from(since.as_nanos()).ok()?;
    nanoseconds.checked_sub(offset_s.checked_mul(1_000_000_000)?)
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
