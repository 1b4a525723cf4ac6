//! The image of `diagnosis.rs` with the explanations of all effects, which take flash only where a program prints them.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::effect::{CATALOGUE, EXPLAINED};
    use allanite::{
        Accumulator, Model, Scale,
        diagnosis::{Diagnosis, Options},
    };
    use core::{hint::black_box, ops::ControlFlow};

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        let mut accumulator = Accumulator::<20>::new();
        while let Some(count) = black_box(None) {
            accumulator.push(count);
        }
        let verdict = Scale::new(1.0, 100.0).and_then(|scale| {
            let curve = accumulator.curve(scale);
            let model = Model::ieee_952();
            let report = |step: &_| {
                black_box(step);
            };
            let mut pause = || black_box(ControlFlow::Continue(()));
            let options = Options::default();
            Diagnosis::new(&curve, &model, &CATALOGUE, options).run(report, &mut pause)
        });
        black_box(&verdict);
        for effect in EXPLAINED {
            black_box(effect.explanation());
        }
        semihosting::process::exit(0)
    }
}

#[cfg(target_os = "none")]
mod panic;
