//! Tests the scales of gyro and temperature counts.

use crate::common::precision::double;
use allanite::Real;
use allanite::sensor::{
    BMI160, CATALOGUE, Description, ICM_20602, ICM_42688_P, L3GD20, LSM6DSO, LSM9DS1, MPU_6050,
    MPU_6500, Temperature,
};

#[test]
fn temperatures_are_those_of_the_data_sheets() {
    let celsius = |description: &Description, count| {
        description
            .temperature
            .map(|t: Temperature| t.celsius(count))
    };
    let near = |found: Option<Real>, expected: f64| {
        let found = double(found.unwrap());
        assert!(
            (found - expected).abs() < 100.0 * double(Real::EPSILON),
            "{found} instead of {expected}"
        );
    };
    near(celsius(&BMI160, 0), 23.0);
    near(celsius(&BMI160, 0x7FFF), 87.0 - 1.0 / 512.0);
    near(celsius(&ICM_20602, 3268), 35.0);
    near(celsius(&ICM_42688_P, -1325), 25.0 - 1325.0 / 132.48);
    near(celsius(&LSM6DSO, -2560), 15.0);
    near(celsius(&LSM9DS1, -16), 24.0);
    near(celsius(&MPU_6050, -3400), 26.53);
    near(celsius(&MPU_6500, 0), 21.0);
    assert_eq!(celsius(&L3GD20, 0), None);
}

#[test]
fn scales_span_the_range_that_was_set() {
    for description in CATALOGUE {
        let full = description.scale_dps * 32768.0;
        // The range is ±250 °/s. The sensitivities allow up to a seventh more.
        assert!(
            (249.0..290.0).contains(&full),
            "{}: {full}",
            description.name
        );
        let scale = description.scale().unwrap();
        assert_eq!(scale.rate_hz(), description.rate_hz);
        assert_eq!(scale.rate_per_count(), description.scale_dps);
    }
}
