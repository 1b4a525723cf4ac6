//! A short run of the study of speed: every way through the same samples ends at the same variances. Times are for the
//! manual.

use allanite_studies::speed::study;

#[test]
fn every_type_of_element_gives_the_same_variances() {
    let rows = study(20_000).expect("a temporary folder");
    let curves: Vec<_> = rows.iter().filter(|row| row.variances.len() == 8).collect();
    assert_eq!(curves.len(), 5);
    for row in &curves {
        // Floats are read in other counts, and counts² of any size are rounded once.
        for (found, expected) in row.variances.iter().zip(&curves[0].variances) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{row:?}");
        }
    }
    let neighbours = rows.iter().find(|row| row.variances.len() == 1);
    let neighbours = neighbours.expect("the least work").variances[0];
    assert!((neighbours / curves[0].variances[0] - 1.0).abs() < 1e-12);
    for row in &rows {
        let [first, third] = row.time.quartiles_ns;
        assert!(0.0 < first && first <= row.time.median_ns && row.time.median_ns <= third);
    }
}
