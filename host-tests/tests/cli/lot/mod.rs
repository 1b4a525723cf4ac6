//! Tests `lot`: what it says of hundreds of devices follows from their certificates alone.

mod devices;
mod outputs;

use allanite::{
    diagnosis::Verdict,
    effect::IEEE_952,
    integrity::Reason,
    storage::{CertifiedEvent, CertifiedTerm, CertifiedWhat},
};
use allanite_host::{
    lot::{Measurement, difference, threshold},
    simulate::{Coefficients, Preset, Simulator},
    verdict::{NOT_STATIONARY, NOT_STATIONARY_IN_WORDS},
};
use devices::{
    BEFORE, DEVICES, Lot, certificate, encoded, has_become_noisy, has_begun_to_walk, has_line,
    is_noisy, is_unstable, lot, name, truth,
};
use program::{command, json, number, output, refusal, rows, run};
use rayon::prelude::*;
use serde_json::Value;
use std::{collections::BTreeSet, fs};
use tempfile::TempDir;

/// A device of the lot, now or before.
fn measured(device: u64, now: bool) -> allanite::storage::Certificate {
    let line = if has_line(device) { 0.1 } else { 0.0 };
    let seed = 2 * device + u64::from(now);
    certificate(device, truth(device, now), line, seed)
}

/// The names of the devices in a list of findings about an effect.
fn devices(list: &Value, effect: &str) -> BTreeSet<String> {
    let all = list.as_array().unwrap().iter();
    let of_effect = all.filter(|one| one["effect"] == effect);
    of_effect
        .map(|one| one["device"].as_str().unwrap().to_owned())
        .collect()
}

fn named(devices: impl Iterator<Item = u64>, is: impl Fn(u64) -> bool) -> BTreeSet<String> {
    devices.filter(|device| is(*device)).map(name).collect()
}

fn count(value: &Value) -> usize {
    let count = value.as_u64().unwrap_or_else(|| panic!("{value}"));
    count as usize
}

fn row<'a>(lot: &'a Value, effect: &str) -> &'a Value {
    let mut rows = lot["limits"].as_array().unwrap().iter();
    rows.find(|row| row["effect"] == effect).unwrap()
}

fn decisions_agree_with_the_truth(lot: &Value, limits: [f64; 3]) {
    let effects = ["angle_random_walk", "quantization", "bias_instability"];
    let (mut false_passes, mut false_failures, mut expected) = (0, 0, 0.0);
    for (i, (effect, limit)) in effects.into_iter().zip(limits).enumerate() {
        let row = row(lot, effect);
        let keys = ["passed", "guarded", "failed", "misfit", "not_stationary"];
        let [passed, guarded, failed, misfit, disturbed] = keys.map(|key| count(&row[key]));
        assert_eq!(
            passed + guarded + failed + misfit + disturbed,
            DEVICES as usize,
            "{row}"
        );
        // No model explains a few records by chance.
        assert!(misfit * 50 <= DEVICES as usize, "{row}");
        assert!(disturbed * 100 <= DEVICES as usize, "{row}");
        assert!((number(&row["limit"]) / limit - 1.0).abs() < 1e-9, "{row}");
        let failures = devices(&lot["failures"], effect);
        let undecided = devices(&lot["undecided"], effect);
        assert_eq!((failures.len(), undecided.len()), (failed, guarded));
        let unexplained = lot["unexplained"].as_array().unwrap().iter();
        let unexplained: BTreeSet<String> = unexplained
            .map(|one| one["device"].as_str().unwrap().to_owned())
            .collect();
        assert!((misfit..=misfit + disturbed).contains(&unexplained.len()));
        let disturbed = lot["disturbed"].as_array().unwrap().iter();
        let disturbed: BTreeSet<String> = disturbed
            .map(|one| one["device"].as_str().unwrap().to_owned())
            .collect();
        let is_good = |device: u64| {
            let Coefficients {
                quantization,
                angle_random_walk,
                bias_instability,
                ..
            } = truth(device, true);
            [angle_random_walk, quantization, bias_instability][i] <= limit
        };
        let good = named(0..DEVICES, is_good);
        let bad = named(0..DEVICES, |device| !is_good(device));
        false_failures += failures.intersection(&good).count();
        let undecided = &(&undecided | &unexplained) | &disturbed;
        let not_passed = &failures | &undecided;
        false_passes += bad.difference(&not_passed).count();
        expected += number(&row["expected_false_passes"]);
        expected += number(&row["expected_false_failures"]);
    }
    println!(
        "{false_passes} false passes, {false_failures} false failures, {expected:.2} expected"
    );
    // Of 1500 decisions, the certificates expect about one in two to be wrong somewhere.
    assert!(expected < 1.5, "{expected}");
    assert!(false_passes + false_failures <= 3);
    let white = row(lot, "angle_random_walk");
    // All decide something: there are devices of every kind.
    for key in ["passed", "guarded", "failed"] {
        assert!(count(&white[key]) > 20, "{white}");
    }
    let decisions = ["passed", "guarded", "failed", "misfit", "not_stationary"];
    let counts = decisions.map(|key| count(&lot[key]));
    assert_eq!(counts.iter().sum::<usize>(), DEVICES as usize);
    let [passed, ..] = counts;
    let share = number(&lot["yield_share"]);
    assert!((share - passed as f64 / DEVICES as f64).abs() < 1e-12);
    let [low, high] = [0, 1].map(|i| number(&lot["yield_interval"][i]));
    // By scipy, the interval of 367 in 500 is 0.693 to 0.772; its half-width is nearly the same for others.
    assert!(low < share && share < high && (0.06..0.1).contains(&(high - low)));
    // The guard band is 1.96 standard errors: a square has one of about 2.3 %.
    let band = number(&white["guard_band"]) / number(&white["limit"]);
    assert!((0.018..0.03).contains(&band), "{white}");
}

fn distributions_agree_with_the_truth(lot: &Value, limit: f64) {
    let row = row(lot, "angle_random_walk");
    let truth: Vec<f64> = (0..DEVICES)
        .map(|device| truth(device, true).angle_random_walk)
        .collect();
    let logarithms: Vec<f64> = truth.iter().map(|one| one.ln()).collect();
    let mean = logarithms.iter().sum::<f64>() / DEVICES as f64;
    let squares = logarithms.iter().map(|one| (one - mean).powi(2));
    let deviation = (squares.sum::<f64>() / (DEVICES - 1) as f64).sqrt();
    let cpk = (limit.ln() - mean) / (3.0 * deviation);
    let [low, high] = [0, 1].map(|i| number(&row["cpk_interval"][i]));
    assert!(low < cpk && cpk < high, "{row}, {cpk}");
    assert!(
        (number(&row["cpk"]) / cpk - 1.0).abs() < 0.1,
        "{row}, {cpk}"
    );
    let mut sorted = truth;
    sorted.sort_by(f64::total_cmp);
    for (i, share) in [0.05, 0.5, 0.95].into_iter().enumerate() {
        let expected = sorted[(share * (DEVICES - 1) as f64) as usize];
        let found = number(&row["percentiles"][i]);
        assert!((found / expected - 1.0).abs() < 0.02, "{row}: {expected}");
    }
    // Bias instability does not show in every record of less than three minutes.
    let bias = self::row(lot, "bias_instability");
    assert!((300..500).contains(&count(&bias["measured"])), "{bias}");
}

fn bad_devices_are_named_and_no_others(lot: &Value) {
    let outliers = |effect| devices(&lot["outliers"], effect);
    let noisy = named(0..DEVICES, is_noisy);
    let white = outliers("angle_random_walk");
    assert!(white.is_superset(&noisy), "{white:?}");
    // A device that has drifted may have become one.
    let unusual = named(0..DEVICES, |one| is_noisy(one) || has_become_noisy(one));
    assert!(white.is_subset(&unusual), "{white:?}");
    let unstable = outliers("bias_instability");
    let expected = named(0..DEVICES, is_unstable);
    assert!(unstable.is_superset(&expected), "{unstable:?}");
    let walking = outliers("rate_random_walk");
    let expected = named(0..DEVICES, has_begun_to_walk);
    assert!(walking.is_superset(&expected), "{walking:?}");
    let bad = named(0..DEVICES, |device| {
        let is_lasting = is_noisy(device) || is_unstable(device) || has_line(device);
        is_lasting || has_become_noisy(device) || has_begun_to_walk(device)
    });
    let all = lot["outliers"].as_array().unwrap();
    let is_false = |one: &&Value| !bad.contains(one["device"].as_str().unwrap());
    let others: Vec<&Value> = all.iter().filter(is_false).collect();
    println!("{} outliers, false: {others:?}", all.len());
    assert!(others.len() <= 1);

    let drifted = |effect| devices(&lot["drifted"], effect);
    let compared = |is: fn(u64) -> bool| named(0..BEFORE, is);
    assert_eq!(drifted("angle_random_walk"), compared(has_become_noisy));
    assert_eq!(drifted("rate_random_walk"), compared(has_begun_to_walk));
    let changed = named(0..BEFORE, |device| {
        has_become_noisy(device) || has_begun_to_walk(device)
    });
    let all = lot["drifted"].as_array().unwrap();
    let is_false = |one: &&Value| !changed.contains(one["device"].as_str().unwrap());
    let others: Vec<&Value> = all.iter().filter(is_false).collect();
    println!("{} drifts, false: {others:?}", all.len());
    assert!(others.is_empty());
    assert_eq!(count(&lot["compared"]), BEFORE as usize);
    assert!(count(&lot["comparisons"]) > 2 * BEFORE as usize, "{lot}");

    let (found, lines) = (
        count(&lot["found"]["sinusoid"]),
        named(0..DEVICES, has_line).len(),
    );
    assert!((lines..=lines + 2).contains(&found), "{}", lot["found"]);
}

#[test]
fn a_device_whose_record_is_not_valid_not_stationary_or_not_explained_is_not_judged() {
    let usual = Preset::Mems.coefficients();
    let Lot {
        folder, mut now, ..
    } = lot(4, 0, |device, _| {
        let mut one = certificate(device, usual, 0.0, device);
        if device == 1 {
            let (hits, samples) = (300, one.conditions.samples);
            one.axes[0].verdict = Some(Verdict::Invalid(Reason::Railed { hits, samples }));
        }
        if device == 2 {
            one.axes[0].verdict = Some(Verdict::Unexplained);
        }
        if device == 3 {
            let step = CertifiedEvent {
                what: CertifiedWhat::Step,
                at_s: 80.0,
                size: 0.6,
                lower: 0.58,
                upper: 0.62,
                z: 47.0,
            };
            one.axes[0].findings.events = Some([step].into_iter().collect());
        }
        one
    });
    now.splice(0..0, ["lot", "--limit", "N=1"].map(String::from));
    let arguments: Vec<&str> = now.iter().map(String::as_str).collect();
    let lot = json(folder.path(), &arguments);
    // As `fit --limit` decides: a longer record would not help.
    let decided = [
        "passed",
        "guarded",
        "misfit",
        "not_stationary",
        "not_valid",
        "failed",
    ];
    let decided = decided.map(|decision| count(&lot[decision]));
    assert_eq!(decided, [1, 0, 1, 1, 1, 0]);
    let invalid = &lot["invalid"][0];
    assert_eq!(
        (&invalid["device"], &invalid["reason"]),
        (&"SN-0001".into(), &"railed".into())
    );
    assert_eq!(lot["unexplained"][0]["device"], "SN-0002");
    let disturbed = &lot["disturbed"][0];
    assert_eq!(disturbed["device"], "SN-0003");
    assert_eq!(
        disturbed["words"],
        "the rate stepped by 0.6000 deg/s at 80.000 s (47 σ)"
    );
    assert_eq!(count(&lot["limits"][0]["measured"]), 2);
    let text = output(folder.path(), &arguments);
    let counts = format!("1 not explained, 1 {NOT_STATIONARY_IN_WORDS}, 1 not valid, 0 fail");
    assert!(text.contains(&counts), "{text}");
}

/// A pass by one command and no decision by another would leave the choice to the user.
#[test]
fn a_device_whose_rate_stepped_is_judged_by_a_lot_as_by_a_fit() {
    let folder = TempDir::new().unwrap();
    let simulated = Simulator::new(Preset::Mems.coefficients(), 100.0, 5);
    let rows = (0..1 << 16).zip(simulated).map(|(n, rate)| {
        let step = if n < 40_000 { 0 } else { 600 };
        format!("{}\n", (rate / 1e-4).round() as i32 + step)
    });
    let text: String = ["x\n".to_owned()].into_iter().chain(rows).collect();
    fs::write(folder.path().join("log.csv"), text).unwrap();
    let about = ["--rate=100", "--scale=1e-4", "--unit=deg/s"];
    let of_log = |command: &[&'static str]| [command, &about].concat();
    let certify = of_log(&["certify", "log.csv", "--output=one.bin", "--device=one"]);
    output(folder.path(), &certify);
    let fit = of_log(&["fit", "log.csv", "--limit=N=1", "--json"]);
    let fit = run(folder.path(), &fit);
    assert_eq!(fit.status.code(), Some(3));
    let fit: Value = serde_json::from_slice(&fit.stdout).unwrap();
    assert_eq!(fit["axes"][0]["verdict"], NOT_STATIONARY);
    assert_eq!(fit["axes"][0]["limits"][0]["verdict"], NOT_STATIONARY);
    let of_certificate = vec!["lot", "one.bin", "--limit=N=1"];
    for lot in [of_log(&["lot", "log.csv", "--limit=N=1"]), of_certificate] {
        let lot = json(folder.path(), &lot);
        let decided = ["passed", "not_stationary"].map(|decision| count(&lot[decision]));
        assert_eq!(decided, [0, 1], "{lot}");
    }
    let decoded = json(folder.path(), &["decode", "one.bin"]);
    assert_eq!(decoded["records"][0]["axes"][0]["verdict"], NOT_STATIONARY);
}

#[test]
fn what_is_no_lot_is_refused_in_a_line() {
    let folder = TempDir::new().unwrap();
    let path = folder.path();
    for (file, seed) in [("a.bin", 1), ("b.bin", 2)] {
        let certificate = certificate(5, truth(5, true), 0.0, seed);
        fs::write(path.join(file), encoded(&certificate)).unwrap();
    }
    fs::write(path.join("c.bin"), b"no certificate").unwrap();
    fs::create_dir(path.join("empty")).unwrap();
    for (arguments, what) in rows! {
        &["a.bin", "--limit", "N"][..], "there is no value";
        &["a.bin", "--limit", "Z=1"], "there is no such effect";
        &["a.bin", "--limit", "N=-1"], "is not a positive number";
        &["a.bin", "--limit", "N=1°/h"], "angle_random_walk has no such unit";
        &["a.bin", "--limit", "N=1", "--limit", "angle_random_walk=2"], "angle_random_walk has two limits";
        &["a.bin", "--limit", "N=1", "--risk", "0.5"], "this is no risk";
        &["a.bin", "b.bin", "--limit", "N=1"], "device SN-0005 is in a.bin, too";
        &["c.bin", "--limit", "N=1"], "c.bin";
        &["missing.bin", "--limit", "N=1"], "missing.bin";
        &["empty", "--limit", "N=1"], "there is no certificate, curve file or log in this folder";
    } {
        let refusal = refusal(path, &[&["lot"], arguments].concat());
        assert!(refusal.contains(what), "{refusal}");
    }
    // A file that is none does not hide the others.
    let output = command(path, &["lot", "a.bin", "c.bin", "--limit", "N=1"]);
    let output = { output }.output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stdout).contains("1 device: 1 pass"));
}

/// What counts over hundreds of devices.
mod thorough {
    use super::*;

    #[test]
    fn five_hundred_devices_are_judged_by_three_limits() {
        let Lot {
            folder,
            now,
            before,
        } = lot(DEVICES, BEFORE, measured);
        let usual = Preset::Mems.coefficients();
        // The limit of the white noise lies where some devices are in the guard band.
        let walk = 1.08 * usual.angle_random_walk;
        let (quantum, bias) = (2.0 * usual.quantization, 4.0 * usual.bias_instability);
        let limits = [
            format!("N={walk}"),
            format!("quantization={quantum}"),
            format!("B={}°/h", 3600.0 * bias),
        ];
        let mut arguments = vec!["lot"];
        for limit in &limits {
            arguments.extend(["--limit", limit]);
        }
        arguments.extend(now.iter().map(String::as_str));
        arguments.push("--earlier");
        arguments.extend(before.iter().map(String::as_str));

        let text = command(folder.path(), &arguments).output().unwrap();
        assert!(text.status.success());
        let text = String::from_utf8(text.stdout).unwrap();
        let lot = json(folder.path(), &arguments);
        println!("{text}");

        decisions_agree_with_the_truth(&lot, [walk, quantum, bias]);
        distributions_agree_with_the_truth(&lot, walk);
        bad_devices_are_named_and_no_others(&lot);
        for part in [
            "500 devices: ",
            "yield ",
            "Cpk",
            "outliers:",
            "drifted:",
            "SN-0131 x: angle random walk",
            "SN-0077 x: rate random walk below 0.00",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        let widest = text.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(80), "{text}");
    }

    /// At the limit, a device passes with the probability that was asked for, and fails with it.
    #[test]
    fn devices_at_the_limit_pass_and_fail_with_the_stated_risk() {
        let usual = Preset::Mems.coefficients();
        let Lot { folder, now, .. } =
            lot(400, 0, |device, _| certificate(device, usual, 0.0, device));
        for risk in [0.025_f64, 0.2] {
            let white = format!("N={}", usual.angle_random_walk);
            let (bias, asked) = (format!("B={}", usual.bias_instability), risk.to_string());
            let mut arguments = vec!["lot", "--limit", &white, "--limit", &bias, "--risk", &asked];
            arguments.extend(now.iter().map(String::as_str));
            let lot = json(folder.path(), &arguments);
            let row = &lot["limits"][0];
            for key in ["passed", "failed"] {
                let share = count(&row[key]) as f64 / 400.0;
                println!("risk {risk}: {key} {share}");
                // Three standard errors of the share.
                let error = (risk * (1.0 - risk) / 400.0).sqrt();
                assert!((share - risk).abs() < 3.0 * error, "{row}");
            }
            // The error of bias instability is a third of it, and grows with it. By the errors at their own low values, 4 % of
            // the devices pass at a risk of 2.5 %.
            let row = &lot["limits"][1];
            let [passed, failed] = ["passed", "failed"].map(|key| count(&row[key]) as f64 / 400.0);
            println!("risk {risk}: bias instability, {passed} pass, {failed} fail");
            let most = risk + 1.5 * (risk * (1.0 - risk) / 400.0).sqrt();
            assert!(passed > 0.0 && passed <= most && failed <= most, "{row}");
        }
    }

    /// Pairs of records of one device that has not changed, whose rate random walk hides, shows at times, or dominates.
    #[test]
    fn devices_that_have_not_changed_seldom_drift() {
        const PAIRS: u64 = 200;
        let usual = Preset::Mems.coefficients();
        let mut walks = [0; 3];
        for factor in [1.0, 5.0, 15.0, 60.0] {
            let truth = Coefficients {
                rate_random_walk: factor * usual.rate_random_walk,
                ..usual
            };
            let compared: Vec<(&str, f64, usize)> = (0..PAIRS)
                .into_par_iter()
                .flat_map_iter(|pair| {
                    let seeds = [2 * pair, 2 * pair + 1].map(|seed| 10_000 + seed);
                    let [before, now] = seeds.map(|seed| certificate(1, truth, 0.0, seed));
                    let terms = now.axes[0].terms.clone().into_iter();
                    terms.filter_map(move |now| {
                        let same = |one: &&CertifiedTerm| one.effect == now.effect;
                        let before = before.axes[0].terms.iter().find(same)?;
                        let [before, now_measured] = [before, &now].map(Measurement::of);
                        let (before, now_measured) = (before?, now_measured?);
                        let z = difference(&before, &now_measured, 1.0);
                        let shown = [before, now_measured]
                            .into_iter()
                            .filter(|one| one.is_measured);
                        Some((now.effect.name(), z, shown.count()))
                    })
                })
                .collect();
            let mut false_ones = 0;
            for effect in IEEE_952.map(|effect| effect.name()) {
                let of_effect = compared.iter().filter(|(name, ..)| *name == effect);
                let beyond = of_effect.clone().filter(|(_, z, _)| z.abs() > threshold(1));
                let (all, beyond) = (of_effect.count(), beyond.count());
                println!("{factor}: {effect} {beyond} of {all}");
                false_ones += beyond;
                // One in a hundred, and three and a half standard errors of that.
                assert!(beyond <= 2 + 5, "{factor}: {effect} {beyond} of {all}");
            }
            assert!(false_ones <= compared.len() / 100 + 12);
            let of_walk = compared
                .iter()
                .filter(|(name, ..)| *name == "rate_random_walk");
            of_walk.for_each(|(.., shown)| walks[*shown] += 1);
        }
        // The comparisons are of all kinds.
        println!("{walks:?}");
        assert!(walks.iter().all(|count| *count > 50), "{walks:?}");
    }
}

/// Writes the certificates of the manual's example, which its readme test judges.
#[test]
#[ignore = "writes into the repository"]
fn write_the_lot_of_the_manual() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../data/lot");
    let write = |kind: &str, device: u64, now: bool| {
        let file = format!("{folder}/{kind}/{}.bin", name(device));
        fs::write(file, encoded(&measured(device, now))).unwrap();
    };
    for kind in ["now", "before"] {
        fs::create_dir_all(format!("{folder}/{kind}")).unwrap();
    }
    for device in (0..26).chain([31, 63, 77, 91]) {
        write("now", device, true);
    }
    for device in (0..8).chain([31, 77]) {
        write("before", device, false);
    }
}
