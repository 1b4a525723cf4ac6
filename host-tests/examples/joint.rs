use allanite::{
    Accumulator, Curve, Model, Observed, Scale,
    diagnosis::{Diagnosis, Evidence, Options, Step},
    effect::{CATALOGUE, IEEE_952},
    spectrum::{Spectrum, SpectrumAccumulator},
};
use host_tests::simulate::{Hidden, Preset, Simulator};
use rayon::prelude::*;
const B: usize = 112;
fn quantum(c: host_tests::simulate::Coefficients, rate: f64) -> f64 {
    (c.angle_random_walk.powi(2) * rate
        + 3.0 * (c.quantization * rate).powi(2)
        + c.bias_instability.powi(2)
        + c.rate_random_walk.powi(2) / rate)
        .sqrt()
        / 4096.0
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let preset = match args[1].as_str() {
        "mems" => Preset::Mems,
        "fog" => Preset::Fog,
        _ => Preset::Tactical,
    };
    let name: &str = Box::leak(args[2].clone().into_boxed_str());
    let p: [f64; 2] = [args[3].parse().unwrap(), args[4].parse().unwrap()];
    let size: f64 = args[5].parse().unwrap();
    let records: u64 = args[6].parse().unwrap();
    let bits: u32 = args.get(7).map_or(17, |x| x.parse().unwrap());
    let with = args.get(8).is_none();
    let base = preset.coefficients();
    let sigma = base.angle_random_walk * 10.0;
    let out: Vec<(String, f64)> = (0..records)
        .into_par_iter()
        .map(|seed| {
            let hidden: Vec<Hidden> = if name == "none" {
                vec![]
            } else {
                let mut h = Hidden::new(name, p, base.angle_random_walk).unwrap();
                if !h.replaces_white_noise() {
                    h.coefficient = size * sigma;
                }
                vec![h]
            };
            let mut s = Simulator::with_hidden(base, &hidden, 100.0, seed);
            let q = quantum(base, 100.0);
            let mut a = Accumulator::<24>::new();
            let mut sp = SpectrumAccumulator::<64, 7>::new();
            let mut buf = [0; 1024];
            for _ in 0..(1usize << bits) / 1024 {
                for b in &mut buf {
                    *b = (s.next().unwrap() / q).round() as i32;
                }
                a.push_slice(&buf);
                sp.push_slice(&buf);
            }
            let scale = Scale::new(q, 100.0).unwrap();
            let curve: Curve<24> = a.curve(scale);
            let spectrum: Spectrum<B> = if with {
                sp.spectrum(scale)
            } else {
                SpectrumAccumulator::<64, 7>::new().spectrum(scale)
            };
            let mut steps: Vec<Step<24, B>> = vec![];
            let model = Model::ieee_952();
            let t = std::time::Instant::now();
            let v = Diagnosis::with_spectrum(
                curve,
                spectrum,
                Evidence::NONE,
                &model,
                &CATALOGUE,
                Options::default(),
            )
            .run(|s| steps.push(s.clone()));
            let t = t.elapsed().as_secs_f64();
            let last = steps.last().unwrap();
            let first = &steps[0];
            let terms: Vec<String> = last
                .model
                .terms()
                .iter()
                .enumerate()
                .filter(|(_, t)| !IEEE_952.iter().any(|e| e.name() == t.effect.name()))
                .map(|(i, t)| {
                    format!(
                        "{}[{:.5},{:.3}]={:.4}",
                        t.effect.name(),
                        t.parameters[0],
                        t.parameters[1],
                        last.fit.coefficients[i].value
                            / if t.effect.replaces().is_some() {
                                base.angle_random_walk
                            } else {
                                sigma
                            }
                    )
                })
                .collect();
            let amb: Vec<&str> = steps
                .iter()
                .flat_map(|s| s.ambiguous.iter().copied())
                .collect();
            let five: Vec<String> = last
                .fit
                .coefficients
                .iter()
                .take(5)
                .map(|c| format!("{:.3e}", c.value))
                .collect();
            (
                format!(
                    "{seed:3} χ² {:.0}/{} → {:.1}/{} p {:.4} {:?} | {} | amb {:?} | {} {:.2}s",
                    first.fit.chi_squared,
                    first.fit.degrees_of_freedom,
                    last.fit.chi_squared,
                    last.fit.degrees_of_freedom,
                    last.fit.p_value,
                    v.ok(),
                    terms.join(" + "),
                    amb,
                    five.join(" "),
                    t
                ),
                first.fit.p_value,
            )
        })
        .collect();
    let mut ps: Vec<f64> = out.iter().map(|o| o.1).collect();
    ps.sort_by(f64::total_cmp);
    if records <= 60 {
        for o in &out {
            println!("{}", o.0);
        }
    }
    let below = |x: f64| ps.iter().filter(|p| **p < x).count() as f64 / ps.len() as f64;
    println!(
        "p below 0.01 0.05 0.1 0.25 0.5 0.75 0.9: {:?}",
        [0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9].map(below)
    );
    let mut kinds = std::collections::BTreeMap::new();
    for o in &out {
        let parts: Vec<&str> = o.0.split('|').collect();
        let names: Vec<&str> = parts[1]
            .split('+')
            .map(|x| x.trim().split('[').next().unwrap())
            .collect();
        *kinds
            .entry(format!("{} / amb {}", names.join("+"), parts[2]))
            .or_insert(0) += 1;
    }
    for (k, n) in kinds {
        println!("{n:4} {k}");
    }
}
