//! What lost samples cost.

use super::SYMBOLS;
use allanite_host::simulate::Preset;
use allanite_studies::losses::{LOSSES, study, words};

pub(crate) fn print(records: u64) {
    println!(
        "{records} records of 2^17 samples a row, each with losses and without; error: rms error of the square with losses \
         relative to that without; shift: in standard errors; 95 %: coverage; |: without losses | with them"
    );
    for preset in [Preset::Mems, Preset::Tactical, Preset::Fog] {
        for losses in LOSSES {
            let (share, gap) = losses;
            let outcomes = study(preset, 1 << 17, losses, records);
            for (outcome, what) in outcomes.iter().zip(["curve", "curve and spectrum"]) {
                println!(
                    "\n{preset:?}, {} % lost in gaps of {gap}, {what}: fewer octaves in {} of {}, fewer bins in {}; p below \
                     5 %: {:.1} | {:.1} %",
                    100.0 * share,
                    outcome.fewer_octaves,
                    outcome.records,
                    outcome.fewer_bins,
                    100.0 * outcome.low_p[0],
                    100.0 * outcome.low_p[1]
                );
                for (symbol, one) in SYMBOLS.iter().zip(outcome.accuracies) {
                    let percent = |[whole, lossy]: [f64; 2]| {
                        format!("{:>5.1} | {:>5.1} %", 100.0 * whole, 100.0 * lossy)
                    };
                    println!(
                        "{symbol:>3} error {:>6.3}, shift {:>6.3}, 95 % {}, measured {}",
                        one.error_ratio,
                        one.shift,
                        percent(one.coverage),
                        percent(one.measured)
                    );
                }
            }
            for line in [false, true] {
                let said = words(preset, line, 1 << 17, losses, records);
                println!(
                    "diagnosed, {}: right {} | {}, a wrong word {} | {} of {}",
                    if line {
                        "with a line"
                    } else {
                        "nothing hidden"
                    },
                    said.exact[0],
                    said.exact[1],
                    said.wrong[0],
                    said.wrong[1],
                    said.records
                );
            }
        }
    }
}
