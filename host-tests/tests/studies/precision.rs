//! A short run of the study of single precision.

use allanite_studies::precision;

#[test]
fn single_and_double_precision_reach_the_same_result() {
    let fits = precision::fits(4).unwrap_or_else(|error| panic!("{error:#}"));
    assert!(fits.standard_errors.len() > 4 * 4);
    let largest = |sorted: &[f64]| sorted.last().copied().unwrap_or(f64::NAN);
    assert!(largest(&fits.standard_errors) < 2e-3, "{fits:?}");
    assert!(largest(&fits.chi_squared) < 2e-3, "{fits:?}");
    let diagnoses = precision::diagnoses(2).unwrap_or_else(|error| panic!("{error:#}"));
    for (name, alike) in diagnoses {
        assert_eq!((alike.records, alike.same), (2, 2), "{name}");
    }
}
