//! Nearly everything that a product does with a sensor's counts, except for its bus and its flash. The image
//! is searched for panics. It does nothing when it is started.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::effect::CATALOGUE;
    use allanite::queue::{self, Queued};
    use allanite::self_test::{Plan, SelfTest};
    use allanite::{
        Accumulator, Axes, Model, Scale,
        axis::{Courses, Gated, Moments, Spectral},
        course::analyse,
        diagnosis::{self, Diagnosis},
        fit::{Options, fit},
    };
    use core::{hint::black_box, ops::ControlFlow};
    use heapless::{Vec, spsc::Queue};

    /// Three axes and a temperature, with every part.
    type Gyro = Axes<20, 1, Gated, Moments, 3, Spectral, Courses>;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        if let Ok(scale) = Scale::new(black_box(1.0), black_box(100.0)) {
            characterise(scale);
        }
        semihosting::process::exit(0)
    }

    fn characterise(scale: Scale) {
        let plan = Plan {
            limits: black_box(Vec::new()),
            least_p: black_box(0.1),
            false_pass: 0.01,
            false_fail: 0.01,
            shortest_s: 1.0,
            longest_s: 100.0,
        };
        let Ok(mut test) = SelfTest::<20>::new(plan, scale) else {
            return;
        };
        let mut gyro = Gyro::new();
        let mut queue = Queue::<Queued<[i32; 3]>, 16>::new();
        let (mut sender, mut receiver) = queue::split(&mut queue);
        while let Some(counts) = black_box(None) {
            sender.send(counts);
            if let Some(Queued { sample, lost }) = receiver.receive() {
                gyro.lost(lost.into());
                gyro.push((sample, [black_box(0)]));
            }
            if test.is_due(gyro.samples())
                && let Ok(x) = gyro.record_so_far(0, (scale, [0.01]))
            {
                let _ = black_box(test.look(&x));
            }
        }
        gyro.release();
        let mut records = black_box(Gyro::new());
        records.merge(&gyro);
        diagnose(&records, scale);
    }

    fn diagnose(records: &Gyro, scale: Scale) {
        let mut slices = black_box(Accumulator::<20>::new());
        slices.push_slice(black_box(&[0; 4]));
        black_box(&slices);
        let Ok(x) = records.record_so_far(black_box(0), (scale, [0.01])) else {
            return;
        };
        let model = Model::ieee_952();
        let report = |step: &_| {
            black_box(step);
        };
        let mut pause = || black_box(ControlFlow::Continue(()));
        let options = diagnosis::Options::default();
        let verdict = Diagnosis::new(&x, &model, &CATALOGUE, options).run(report, &mut pause);
        let _ = black_box(verdict);
        if let [Some(course), ..] = records.courses() {
            let analysis = analyse(&x.curve, &model, course, scale, Options::default());
            black_box(analysis.is_ok());
        }
        if let Ok(fit) = fit(&x.curve, &model, Options::default()) {
            let _ = black_box(fit.correlations(&x.curve, &model));
        }
    }
}

#[cfg(target_os = "none")]
mod panic;
