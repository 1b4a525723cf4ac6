//! What lost samples cost.

use super::SYMBOLS;
use host_tests::{
    simulate::Preset,
    study::losses::{LOSSES, study},
};

pub(crate) fn print(records: u64) {
    println!(
        "{records} records of 2^17 samples a row, each with losses and without; error: rms error of the square with losses \
         relative to that without; shift: in standard errors; 95 %: coverage; |: without losses | with them"
    );
    for preset in [Preset::Mems, Preset::Tactical, Preset::Fog] {
        for losses in LOSSES {
            let outcome = study(preset, 1 << 17, losses, records);
            let (share, gap) = losses;
            println!(
                "\n{preset:?}, {} % lost in gaps of {gap}: fewer octaves in {} of {}; p below 5 %: {:.1} | {:.1} %",
                100.0 * share,
                outcome.fewer_octaves,
                outcome.records,
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
    }
}
