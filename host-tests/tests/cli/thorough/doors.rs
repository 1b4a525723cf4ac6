//! Six hundred records by all doors.

use crate::doors::{Count, Truth};

#[test]
fn six_hundred_records_get_one_verdict_each() {
    // Fifteen events and six kinds of rest a round, and as many rounds of rest again.
    let count = Count::of(28, 4000, 2_000..40_000);
    println!("{count:#?}");
    assert!(count.records >= 580, "{count:?}");
    assert!(count.unequal.len() * 100 <= count.records, "{count:?}");
    let [of_rest, rest] = count.found["Nothing"];
    assert!(of_rest * 60 <= rest, "{count:?}");
    for (event, [found, all]) in &count.found {
        let least = match event.as_str() {
            "Nothing" => continue,
            // Slight motion has the shape of noise behind a low pass.
            "Vehicle" => 80,
            // An offset may keep the counts of an axis from zero.
            "Unsigned" => 85,
            _ => 95,
        };
        assert!(found * 100 >= least * all, "{event}: {count:?}");
    }
}

#[test]
fn a_device_is_right_about_four_thousand_records() {
    Truth::of(200, 2, 2_000..30_000).assert();
}

#[test]
fn a_small_core_is_right_about_what_it_sees() {
    Truth::by_screens(100, 4, 2_000..30_000).assert_screened();
}
