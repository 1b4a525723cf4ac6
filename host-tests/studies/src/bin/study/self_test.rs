//! The errors and the length of the self-test.

use allanite_studies::self_test::{self, Looks};

/// The factors between coefficient and limit that are studied.
const FACTORS: [f64; 7] = [0.5, 1.0 / 1.3, 0.9, 1.0, 1.1, 1.3, 2.0];

pub(crate) fn print(devices: u64, effect: Option<&str>, flicker: Option<f64>) {
    println!(
        "{devices} devices per line; the plan allows {} % of false pass and as much of false fail",
        100.0 * self_test::PROBABILITY
    );
    println!(
        "false verdicts: share of passes above the limit, of fails below it, of either at it;"
    );
    println!("in brackets the upper end of its one-sided 95 % confidence interval");
    let wanted = |case: &self_test::Case| {
        effect.is_none_or(|effect| effect == case.effect)
            && flicker.is_none_or(|flicker| flicker == case.flicker)
    };
    for case in self_test::CASES.into_iter().filter(wanted) {
        let (shortest, longest) = case.lengths_s;
        println!(
            "\n{}, {shortest} s to {longest} s, {} times the flicker noise",
            case.effect, case.flicker
        );
        println!(
            "coefficient / limit   passed   failed  undecided  median s   false passes    false fails"
        );
        let mut missed: f64 = 0.0;
        let tallies = self_test::study(case, &FACTORS, devices, Looks::Early);
        for (factor, tally) in FACTORS.into_iter().zip(tallies) {
            println!(
                "{factor:>19.3} {:>6.2} % {:>6.2} % {:>8.2} % {:>9.2} {} {}",
                100.0 * tally.passed,
                100.0 * tally.failed,
                100.0 * tally.undecided,
                tally.median_s,
                false_share(factor >= 1.0, tally.passed, devices),
                false_share(factor <= 1.0, tally.failed, devices),
            );
            if factor == 1.3 || factor == 1.0 / 1.3 {
                let right = if factor > 1.0 {
                    tally.failed
                } else {
                    tally.passed
                };
                missed = missed.max(1.0 - right);
            }
        }
        let shares = [self_test::PROBABILITY, missed];
        for missed in shares.into_iter().filter(|_| case.compared) {
            let fixed = self_test::fixed_length_s(case, devices, missed);
            println!(
                "a test of one look that misses at most {:.2} % of devices a factor of 1.3 off the limit: {fixed:.1} s",
                100.0 * missed
            );
        }
    }
}

/// A share of false verdicts with the upper end of its confidence interval; nothing if the verdict is
/// right.
fn false_share(is_false: bool, share: f64, devices: u64) -> String {
    if !is_false {
        return format!("{:>14}", "");
    }
    let upper = self_test::at_most(share, devices);
    format!("{:>5.2} ({:.2}) %", 100.0 * share, 100.0 * upper)
}
