//! Tests the self-test: its verdicts, its looks, and the plans that it refuses.

use allanite::{
    Accumulator, Axis, Error, Scale,
    axis::AxisRecord,
    integrity::{Limits, Reason},
    self_test::{BIAS, Failure, InvalidPlan, Limit, Plan, SelfTest, Status},
};
use allanite_host::simulate::{Coefficients, Preset, Simulator};

const RATE_HZ: f64 = 100.0;
/// The size of a count, in °/s.
const UNIT: f64 = 1e-4;

fn plan(effect: &'static str, most: f64) -> Plan {
    Plan {
        limits: [Limit { effect, most }].into_iter().collect(),
        least_p: 0.0,
        false_pass: 0.01,
        false_fail: 0.01,
        shortest_s: 10.0,
        longest_s: 320.0,
    }
}

/// The number of samples at the last look of that plan, whose record is 128 samples longer: so many a gate holds back.
const LAST: u64 = 31_872;

fn scale() -> Scale {
    Scale::new(UNIT, RATE_HZ).unwrap()
}

/// A gyro without a gate.
type Gyro = Axis<16, 0, (), ()>;

fn look(test: &mut SelfTest<16>, gyro: &Gyro) -> Status {
    if !test.is_due(gyro.samples()) {
        return test.status(gyro.samples());
    }
    let record = gyro.record_so_far(0, scale()).unwrap();
    test.look(&record).unwrap()
}

/// Pushes the counts of a consumer gyro, changed by `change(index, count)`, until there is a
/// verdict.
fn verdict(test: &mut SelfTest<16>, gyro: &mut Gyro, change: impl Fn(u64, i32) -> i32) -> Status {
    for rate in Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 7) {
        let count = (rate / UNIT).round() as i32;
        gyro.push(change(gyro.samples(), count));
        let status = look(test, gyro);
        if !matches!(status, Status::Running { .. }) {
            return status;
        }
    }
    unreachable!()
}

fn run(plan: Plan) -> (Status, u64) {
    let (mut test, mut gyro) = (SelfTest::new(plan, scale()).unwrap(), Gyro::new());
    let status = verdict(&mut test, &mut gyro, |_, count| count);
    (status, gyro.samples())
}

#[test]
fn a_gyro_within_its_limits_passes_and_one_beyond_fails_with_the_excess() {
    // The angle random walk is 0.005 °/s/√Hz.
    let (status, samples) = run(plan("angle_random_walk", 0.02));
    assert_eq!((status, samples), (Status::Passed, 1000));
    let (status, samples) = run(plan("angle_random_walk", 0.002));
    let Status::Failed(Failure::Limit { limit, value }) = status else {
        panic!("{status:?}");
    };
    assert_eq!((limit.most, samples), (0.002, 1000));
    assert!((value / 0.005 - 1.0).abs() < 0.2, "{value}");
}

#[test]
fn a_gyro_at_its_limit_is_undecided_with_the_time_that_it_would_take() {
    let (status, samples) = run(plan("angle_random_walk", 0.00495));
    let Status::Undecided {
        limit,
        decided_by_s,
    } = status
    else {
        panic!("{status:?}");
    };
    assert_eq!((limit.effect, samples), ("angle_random_walk", LAST));
    assert!(
        decided_by_s.is_none_or(|seconds| seconds > 320.0),
        "{decided_by_s:?}"
    );
    // The limit is on a rate random walk that does not show within five minutes.
    let (status, _) = run(plan("rate_random_walk", 1e-5));
    assert!(matches!(status, Status::Undecided { .. }), "{status:?}");
}

#[test]
fn a_gyro_with_a_bias_fails_its_limit_and_one_without_passes() {
    let judged = |bias: i32| {
        let (mut test, mut gyro) = (
            SelfTest::new(plan(BIAS, 0.5), scale()).unwrap(),
            Gyro::new(),
        );
        let status = verdict(&mut test, &mut gyro, |_, count| count + bias);
        (status, gyro.samples())
    };
    assert_eq!(judged(0), (Status::Passed, 1000));
    // 15 °/s, to either side.
    for bias in [150_000, -150_000] {
        let (status, samples) = judged(bias);
        let Status::Failed(Failure::Limit { limit, value }) = status else {
            panic!("{status:?}");
        };
        assert_eq!((limit.effect, samples), ("bias", 1000));
        assert!((value - 15.0).abs() < 0.05, "{value}");
    }
}

#[test]
fn a_bias_at_its_limit_passes_as_seldom_as_the_plan_says() {
    // White noise of 0.005 °/s/√Hz.
    let white = Coefficients {
        angle_random_walk: 0.005,
        ..Coefficients::default()
    };
    let of = |seed: u64, bias: f64| {
        let mut plan = plan(BIAS, 0.01);
        (plan.false_pass, plan.false_fail) = (0.05, 0.05);
        let mut test = SelfTest::<16>::new(plan, scale()).unwrap();
        let mut gyro = Gyro::new();
        for rate in Simulator::new(white, RATE_HZ, seed) {
            gyro.push(((rate + bias) / UNIT).round() as i32);
            match look(&mut test, &gyro) {
                Status::Running { .. } => {}
                status => return status,
            }
        }
        unreachable!()
    };
    // Twice the noise of a minute above the limit, at it, and below.
    let count = |bias: f64| {
        let mut counts = [0; 3];
        for seed in 0..300 {
            let place = match of(seed, bias) {
                Status::Passed => 0,
                Status::Failed(_) => 1,
                _ => 2,
            };
            counts[place] += 1;
        }
        counts
    };
    let [passed, failed, _] = count(0.01);
    assert!(passed <= 25 && failed <= 25, "{passed} {failed}");
    let [passed, ..] = count(0.008);
    assert!(passed > 290, "{passed}");
    let [_, failed, _] = count(-0.012);
    assert!(failed > 290, "{failed}");
}

#[test]
fn slow_terms_pass_at_the_last_look_only() {
    let judged = |effect: &'static str| {
        let (status, samples) = run(plan(effect, 0.2));
        assert_eq!(status, Status::Passed, "{effect}");
        samples
    };
    for effect in ["quantization", "angle_random_walk", BIAS] {
        assert_eq!(judged(effect), 1000, "{effect}");
    }
    // Noise that is slower than the record so far is not in it.
    for effect in ["bias_instability", "rate_random_walk", "rate_ramp"] {
        assert_eq!(judged(effect), LAST, "{effect}");
    }
}

#[test]
fn looks_are_taken_once_per_octave_and_report_progress() {
    let mut test = SelfTest::<16>::new(plan("angle_random_walk", 0.00495), scale()).unwrap();
    let (mut gyro, mut looks, mut last) = (Gyro::new(), Vec::new(), None);
    for rate in Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 7).take(LAST as usize - 1) {
        gyro.push((rate / UNIT).round() as i32);
        let samples = gyro.samples();
        let is_look = test.is_due(samples);
        if is_look {
            looks.push(samples);
        }
        let Status::Running {
            progress,
            expected_s,
        } = look(&mut test, &gyro)
        else {
            panic!("{:?}", test.status(samples));
        };
        assert_eq!(progress, (samples as f64 / LAST as f64) as f32);
        let before = last.replace(expected_s);
        assert!(is_look || before.is_none_or(|before| before == expected_s));
        // The time from now to one of the looks that are left.
        let end = samples as f64 / RATE_HZ + expected_s;
        let left = [20.0, 40.0, 80.0, 160.0, LAST as f64 / RATE_HZ];
        assert!(
            !is_look || left.iter().any(|look| (look - end).abs() < 1e-9),
            "{samples} samples: {expected_s} s"
        );
    }
    assert_eq!(looks, [1000, 2000, 4000, 8000, 16_000]);
    assert!(test.is_due(LAST) && !test.is_due(LAST - 1));
}

#[test]
fn a_gyro_that_is_moved_or_hangs_is_invalid_with_the_reason() {
    let mut test = SelfTest::new(plan("angle_random_walk", 0.00495), scale()).unwrap();
    let moved = |at, count| {
        if (5000..5300).contains(&at) {
            count + 300_000
        } else {
            count
        }
    };
    assert!(matches!(
        verdict(&mut test, &mut Gyro::new(), moved),
        Status::Invalid(Reason::Moved { .. })
    ));
    let stuck = |at, count| if at < 500 { count } else { 5 };
    // The limits can be configured, such as rails that differ from those of 16 bits.
    static LIMITS: Limits = Limits {
        rails: &[-1, 1, 0],
        ..Limits::DEFAULT
    };
    let mut test = SelfTest::new(plan("angle_random_walk", 0.00495), scale()).unwrap();
    let mut gyro = Gyro::with_limits(&LIMITS).unwrap();
    assert!(matches!(
        verdict(&mut test, &mut gyro, stuck),
        Status::Invalid(Reason::Stuck { .. })
    ));
}

#[test]
fn a_curve_that_the_five_terms_do_not_explain_fails_if_the_plan_demands_a_fit() {
    let wave = |at: u64, count: i32| {
        let phase = std::f64::consts::TAU * 7.7 * at as f64 / RATE_HZ;
        count + (0.1 / UNIT * phase.sin()) as i32
    };
    let asked = Plan {
        least_p: 1e-3,
        ..plan("rate_ramp", 1.0)
    };
    let mut test = SelfTest::new(asked, scale()).unwrap();
    let status = verdict(&mut test, &mut Gyro::new(), wave);
    assert!(
        matches!(status, Status::Failed(Failure::Misfit { p_value }) if p_value < 1e-3),
        "{status:?}"
    );
}

/// A vibration raises the coefficients that stand for it. It is not one of them that fails.
#[test]
fn a_line_is_no_coefficient_above_its_limit() {
    let wave = |at: u64, count: i32| {
        let phase = std::f64::consts::TAU * 7.7 * at as f64 / RATE_HZ;
        count + (0.1 / UNIT * phase.sin()) as i32
    };
    let still = |_: u64, count: i32| count;
    let status = |limit, change: &dyn Fn(u64, i32) -> i32| {
        let plan = plan("bias_instability", limit);
        assert_eq!(plan.least_p, 0.0);
        let mut test = SelfTest::new(plan, scale()).unwrap();
        verdict(&mut test, &mut Gyro::new(), change)
    };
    let with_line = status(1e-4, &wave);
    assert!(
        matches!(with_line, Status::Failed(Failure::Misfit { p_value }) if p_value < 1e-6),
        "{with_line:?}"
    );
    // Without a line, the coefficient is named.
    let too_high = status(1e-4, &still);
    assert!(
        matches!(too_high, Status::Failed(Failure::Limit { limit, .. }) if limit.effect == "bias_instability"),
        "{too_high:?}"
    );
}

/// A weak line takes long to become an evident misfit, and looks like bias instability before. Without regard to the
/// p-value of the fit, half of the gyros at 0.2, 0.5 and 1 Hz failed by the coefficient.
#[test]
fn weak_slow_lines_are_seldom_blamed_on_bias_instability() {
    // The gyros' own bias instability is 0.003 °/s.
    let failures = |most: f64, amplitude: f64, frequency_hz: f64| {
        let seeds = 0..40;
        let tests = seeds.map(|seed| {
            let mut test = SelfTest::new(plan("bias_instability", most), scale()).unwrap();
            let mut gyro = Gyro::new();
            let rates = Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 700 + seed);
            for (at, rate) in rates.enumerate() {
                let phase = std::f64::consts::TAU * frequency_hz * at as f64 / RATE_HZ;
                gyro.push(((rate + amplitude * phase.sin()) / UNIT).round() as i32);
                match look(&mut test, &gyro) {
                    Status::Running { .. } => continue,
                    Status::Failed(failure) => return Some(failure),
                    _ => return None,
                }
            }
            None
        });
        let failures: Vec<Failure> = tests.flatten().collect();
        let blamed = failures
            .iter()
            .filter(|one| matches!(one, Failure::Limit { .. }));
        (failures.len(), blamed.count())
    };
    let mut all = (0, 0);
    for (amplitude, frequency_hz) in [(0.01, 0.1), (0.01, 0.2), (0.01, 0.5), (0.02, 1.0)] {
        let (failed, blamed) = failures(0.0045, amplitude, frequency_hz);
        println!("{amplitude} °/s at {frequency_hz} Hz: {failed} fail, {blamed} by the limit");
        assert!(failed >= 36, "{frequency_hz} Hz: {failed}");
        all = (all.0 + failed, all.1 + blamed);
    }
    assert!(10 * all.1 <= all.0, "{all:?}");
    // Without a line it is the coefficient that is named.
    let (failed, blamed) = failures(0.001, 0.0, 1.0);
    println!("no line: {failed} fail, {blamed} by the limit");
    assert!(failed >= 36 && failed - blamed <= 2, "{failed}, {blamed}");
}

#[test]
fn plans_that_contradict_themselves_are_refused() {
    let good = plan("angle_random_walk", 0.02);
    let refused = |change: fn(&mut Plan)| {
        let mut plan = good.clone();
        change(&mut plan);
        let error = SelfTest::<16>::new(plan, scale()).unwrap_err();
        assert!(error.to_string().contains(": ") && !error.to_string().contains('\n'));
        error
    };
    assert_eq!(
        refused(|plan| plan.limits.clear()),
        InvalidPlan::NothingAsked
    );
    let unknown = refused(|plan| plan.limits[0].effect = "sinusoid");
    assert_eq!(unknown, InvalidPlan::UnknownEffect("sinusoid"));
    let twice = refused(|plan| plan.limits.push(plan.limits[0]).unwrap());
    assert_eq!(twice, InvalidPlan::TwoLimits("angle_random_walk"));
    for most in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let mut plan = good.clone();
        plan.limits[0].most = most;
        let error = SelfTest::<16>::new(plan, scale()).unwrap_err();
        assert!(matches!(error, InvalidPlan::InvalidLimit(_)));
    }
    assert_eq!(
        refused(|plan| plan.false_pass = 0.0),
        InvalidPlan::InvalidProbability(0.0)
    );
    assert_eq!(
        refused(|plan| plan.false_fail = 0.5),
        InvalidPlan::InvalidProbability(0.5)
    );
    assert_eq!(
        refused(|plan| plan.least_p = 1.0),
        InvalidPlan::InvalidProbability(1.0)
    );
    for change in [
        (|plan: &mut Plan| plan.shortest_s = 0.01) as fn(&mut Plan),
        |plan| plan.longest_s = 5.0,
        |plan| plan.longest_s = 1e5,
        |plan| plan.longest_s = f64::NAN,
    ] {
        assert!(matches!(refused(change), InvalidPlan::InvalidLength { .. }));
    }
}

#[test]
fn a_look_in_pieces_judges_the_record_that_it_began_with() {
    let new = || SelfTest::<16>::new(plan("angle_random_walk", 0.00505), scale()).unwrap();
    let (mut whole, mut pieces, mut gyro) = (new(), new(), Gyro::new());
    let mut looks = 0;
    for rate in Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 7) {
        gyro.push((rate / UNIT).round() as i32);
        if !whole.is_due(gyro.samples()) {
            continue;
        }
        let record = gyro.record_so_far(0, scale()).unwrap();
        let expected = whole.look(&record).unwrap();
        let mut look = pieces.begin_look(&record).unwrap();
        let mut calls = 1;
        while !look.advance() {
            calls += 1;
        }
        // The fit, and the comparison with the limit.
        assert_eq!(calls, 2);
        assert_eq!(pieces.conclude(&mut look), Ok(expected));
        looks += 1;
        if !matches!(expected, Status::Running { .. }) {
            break;
        }
    }
    assert!(looks > 1, "{looks} looks");
    assert_eq!(pieces, whole);
}

#[test]
fn a_look_at_an_accumulator_says_what_one_at_an_axis_does() {
    let new = || SelfTest::<16>::new(plan("angle_random_walk", 0.00505), scale()).unwrap();
    let (mut of_axis, mut of_sums) = (new(), new());
    let (mut gyro, mut sums) = (Gyro::new(), Accumulator::<16>::new());
    let mut looks = 0;
    for rate in Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 7) {
        let count = (rate / UNIT).round() as i32;
        gyro.push(count);
        sums.push(count);
        if of_axis.is_due(gyro.samples()) {
            let record = gyro.record_so_far(0, scale()).unwrap();
            let expected = of_axis.look(&record).unwrap();
            let mut invalid = of_sums.clone();
            assert_eq!(of_sums.look_at(&sums, None), expected);
            let reason = Reason::Coarse { per_mille: 1 };
            assert_eq!(
                invalid.look_at(&sums, Some(reason)),
                Status::Invalid(reason)
            );
            looks += 1;
        }
        if !matches!(of_axis.status(gyro.samples()), Status::Running { .. }) {
            break;
        }
    }
    assert!(looks > 1, "{looks} looks");
    assert_eq!(of_sums.status(0), of_axis.status(0));
}

#[test]
fn a_look_that_is_not_complete_is_completed_by_its_conclusion() {
    let new = || SelfTest::<16>::new(plan("angle_random_walk", 0.02), scale()).unwrap();
    let record = early();
    for pieces in [0, 1, 5, 1000] {
        let mut test = new();
        let mut look = test.begin_look(&record).unwrap();
        for _ in 0..pieces {
            look.advance();
        }
        assert_eq!(
            test.conclude(&mut look),
            Ok(Status::Passed),
            "{pieces} pieces"
        );
    }
}

/// Two axes have the same plan, and only one of them keeps its limit.
#[test]
fn a_test_concludes_only_the_last_look_that_it_began() {
    let new = || SelfTest::<16>::new(plan("angle_random_walk", 0.02), scale()).unwrap();
    let [mut good, mut bad] = [new(), new()];
    let record = early();
    let mut of_good = good.begin_look(&record).unwrap();
    assert_eq!(bad.conclude(&mut of_good), Err(Error::OtherTest));
    let mut of_bad = bad.begin_look(&record).unwrap();
    assert_eq!(bad.conclude(&mut of_good), Err(Error::OtherTest));
    assert_eq!(good.conclude(&mut of_bad), Err(Error::OtherTest));
    assert!(bad.is_due(record.samples) && good.is_due(record.samples));
    let mut again = good.begin_look(&record).unwrap();
    assert_eq!(good.conclude(&mut of_good), Err(Error::OtherTest));
    // A test may move while a look is in progress.
    let mut moved = Box::new(good);
    assert_eq!(moved.conclude(&mut again), Ok(Status::Passed));
    assert_eq!(moved.conclude(&mut again), Err(Error::OtherTest));
    assert_eq!(bad.conclude(&mut of_bad), Ok(Status::Passed));
}

/// A record that is long enough for the first look.
fn early() -> AxisRecord<16> {
    let mut gyro = Gyro::new();
    for rate in Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 7).take(1000) {
        gyro.push((rate / UNIT).round() as i32);
    }
    gyro.record_so_far(0, scale()).unwrap()
}

#[test]
fn a_record_of_another_unit_is_refused() {
    let mut test = SelfTest::<16>::new(plan("angle_random_walk", 0.02), scale()).unwrap();
    let mut gyro = Gyro::new();
    for rate in Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 7).take(1000) {
        gyro.push((rate / UNIT).round() as i32);
    }
    let other = Scale::new(0.01 * UNIT, RATE_HZ).unwrap();
    let refused = test.look(&gyro.record_so_far(0, other).unwrap());
    let (record, test_unit) = (0.01 * UNIT, UNIT);
    assert_eq!(
        refused,
        Err(Error::OtherScale {
            record,
            test: test_unit
        })
    );
    assert!(test.is_due(gyro.samples()), "nothing was decided");
}

#[test]
fn a_record_of_another_rate_is_refused() {
    let mut test = SelfTest::<16>::new(plan("angle_random_walk", 0.02), scale()).unwrap();
    let mut gyro = Gyro::new();
    for rate in Simulator::new(Preset::Mems.coefficients(), RATE_HZ, 7).take(1000) {
        gyro.push((rate / UNIT).round() as i32);
    }
    let other = Scale::new(UNIT, 2.0 * RATE_HZ).unwrap();
    let record = gyro.record_so_far(0, other).unwrap();
    let refused = test.look(&record);
    let (record_hz, test_hz) = (2.0 * RATE_HZ, RATE_HZ);
    assert_eq!(refused, Err(Error::OtherRate { record_hz, test_hz }));
    assert!(test.is_due(gyro.samples()), "nothing was decided");
}
