//! Nearly all that a product runs on a sensor's counts, but for its bus and its flash: to be searched for
//! panics. Started, it does nothing.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::effect::CATALOGUE;
    use allanite::queue::{self, Queued};
    use allanite::self_test::{Plan, SelfTest};
    use allanite::{
        Accumulator, CrossSums, FourthMoments, Gate, Integrity, Model, Scale,
        diagnosis::{Diagnosis, Evidence},
        fit::{Options, fit},
    };
    use core::hint::black_box;
    use heapless::{Vec, spsc::Queue};

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        if let Ok(scale) = Scale::new(black_box(1.0), black_box(100.0)) {
            characterise(scale);
            test(scale);
        }
        semihosting::process::exit(0)
    }

    fn characterise(scale: Scale) {
        let mut gate = Gate::<20>::new(Integrity::default());
        let mut moments = FourthMoments::<20>::new();
        let mut cross = CrossSums::<20>::new();
        let mut queue = Queue::<Queued<i32>, 16>::new();
        let (mut sender, mut receiver) = queue::split(&mut queue);
        while let Some(count) = black_box(None) {
            sender.send(count);
            if let Some(Queued { sample, lost }) = receiver.receive() {
                if lost > 0 {
                    gate.gap();
                    moments.gap();
                    cross.gap();
                }
                gate.push(sample);
                moments.push(sample);
                cross.push(sample, black_box(0));
            }
        }
        let mut records = black_box(Accumulator::<20>::new());
        records.merge(gate.accumulator());
        records.push_slice(black_box(&[0; 4]));
        let Ok(temperature) = cross.curve(gate.accumulator(), scale, 0.01) else {
            return;
        };
        let kurtosis = moments.kurtosis();
        let evidence = Evidence {
            kurtosis: Some(&kurtosis),
            covariates: &[temperature],
            invalid: gate.integrity().verdict(),
        };
        let (curve, model) = (records.curve(scale), Model::ieee_952());
        let report = |step: &_| {
            black_box(step);
        };
        let verdict = Diagnosis::default().run(&curve, &evidence, &model, &CATALOGUE, report);
        let _ = black_box(verdict);
        if let Ok(fit) = fit(&curve, &model, Options::default()) {
            let _ = black_box(fit.correlations(&curve, &model));
        }
    }

    fn test(scale: Scale) {
        let plan = Plan {
            limits: black_box(Vec::new()),
            least_p: black_box(0.1),
            false_pass: 0.01,
            false_fail: 0.01,
            shortest_s: 1.0,
            longest_s: 100.0,
        };
        let Ok(mut test) = SelfTest::<16>::new(plan, scale) else {
            return;
        };
        while let Some(count) = black_box(None) {
            test.push(count);
            black_box(test.status());
        }
    }
}

#[cfg(target_os = "none")]
mod panic;
