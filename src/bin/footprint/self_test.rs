//! The smallest image that takes counts and tests the gyro against limits, with a verdict as early as the record allows.

#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(not(target_os = "none"))]
fn main() {}

#[cfg(target_os = "none")]
mod image {
    use allanite::{
        Accumulator, Scale,
        heapless::Vec,
        self_test::{Limit, Plan, SelfTest, Status},
    };
    use core::hint::black_box;

    #[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
    #[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
    fn main() -> ! {
        black_box(tested());
        semihosting::process::exit(0)
    }

    fn tested() -> Option<Status> {
        let mut limits = Vec::new();
        let _ = limits.push(Limit {
            effect: "angle_random_walk",
            most: black_box(0.02),
        });
        let plan = Plan {
            limits,
            least_p: 1e-3,
            false_pass: 0.01,
            false_fail: 0.01,
            shortest_s: 1.0,
            longest_s: 256.0,
        };
        let scale = Scale::new(1.0, 100.0).ok()?;
        let mut test = SelfTest::<14>::new(plan, scale).ok()?;
        let mut accumulator = Accumulator::new();
        while let Some(count) = black_box(None) {
            accumulator.push(count);
            black_box(test.look_at(&accumulator, None));
        }
        Some(test.status(accumulator.samples()))
    }
}

#[cfg(target_os = "none")]
mod panic;
