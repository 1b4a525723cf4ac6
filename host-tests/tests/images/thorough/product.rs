//! Images of whole products lose nothing to power cuts.

use crate::product::{check, there};
use demonstration::appliance::{CUTS, SAMPLES};
use rayon::prelude::*;

/// The images, each with a seed of its power cuts, and another one for the run with the watchdog's reset.
const IMAGES: [(&str, [u64; 2]); 3] = [
    ("appliance_loop", [1, 2]),
    ("appliance_rtic", [3, 4]),
    ("appliance_embassy", [5, 6]),
];

#[test]
fn images_lose_nothing_to_ten_power_cuts_and_agree_with_the_host_to_the_bit() {
    IMAGES.par_iter().for_each(|&(image, [seed, _])| {
        let there = there(image, &[&seed.to_string()]);
        assert_eq!(there.cuts.len(), CUTS, "{image}");
        check(image, seed, &there);
        // The last cut interrupts the report.
        assert!(there.cuts[CUTS - 1].made > SAMPLES, "{image}");
        assert!(there.lives[CUTS - 1].len() > 1, "{image}");
    });
}

#[test]
fn watchdog_resets_a_product_that_diagnoses_in_one_piece() {
    IMAGES.par_iter().for_each(|&(image, [_, seed])| {
        let there = there(image, &[&seed.to_string(), "true"]);
        // The watchdog resets the board once, which is one cut more.
        assert_eq!(there.cuts.len(), CUTS + 1, "{image}");
        check(image, seed, &there);
    });
}
