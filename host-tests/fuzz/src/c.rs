//! Calls of the interface for C in any order and with any arguments that its contract allows: pointers are null or lead
//! to what they say, and memory may hold nothing yet.

use allanite_c::*;
use std::{
    ffi::{CStr, c_void},
    ptr,
};

/// The pieces of work of a look in a call.
const PIECES: usize = 64;

/// Memory of a C program, in which nothing was made.
fn zeroed<T>() -> Box<T> {
    // SAFETY: every type of the interface that is used here is made of words, numbers and C's enumerations, all of
    // which have a value of 0.
    Box::new(unsafe { std::mem::zeroed() })
}

/// All that a program has.
struct Program {
    gyros: [Box<AllaniteGyro>; 2],
    evidence: Box<AllaniteRecord>,
    test: Box<AllaniteSelfTest>,
    look: Box<AllaniteLook>,
    diagnosis: Box<AllaniteDiagnosis>,
    certificate: Box<AllaniteCertificate>,
    stored: Vec<u8>,
    /// Whether the evidence changed since the diagnosis began, which then must not be used.
    is_stale: bool,
}

struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn next(&mut self) -> u8 {
        match self.0.split_first() {
            Some((&first, rest)) => {
                self.0 = rest;
                first
            }
            None => 0,
        }
    }

    fn word(&mut self) -> u32 {
        u32::from_le_bytes(std::array::from_fn(|_| self.next()))
    }

    /// Mostly a number that means something, and sometimes any.
    fn number(&mut self) -> f32 {
        match self.next() {
            kind @ 0..200 => 10_f32.powf((f32::from(kind) - 100.0) / 20.0),
            200 => f32::NAN,
            201 => f32::INFINITY,
            202 => 0.0,
            203 => -1.0,
            _ => f32::from_bits(self.word()),
        }
    }

    /// The right size mostly.
    fn size<T>(&mut self) -> usize {
        match self.next() {
            0 => 0,
            1 => usize::MAX,
            2 => size_of::<T>() - 8,
            _ => size_of::<T>(),
        }
    }

    /// The pointer mostly.
    fn or_null<T>(&mut self, to: *mut T) -> *mut T {
        match self.next() {
            0 => ptr::null_mut(),
            _ => to,
        }
    }
}

/// Plays the calls that the bytes encode.
pub fn check(bytes: &[u8]) {
    let mut program = Program {
        gyros: [zeroed(), zeroed()],
        evidence: zeroed(),
        test: zeroed(),
        look: zeroed(),
        diagnosis: zeroed(),
        certificate: zeroed(),
        stored: Vec::new(),
        is_stale: true,
    };
    let mut bytes = Bytes(bytes);
    // A hundred calls are a long program. A diagnosis takes milliseconds.
    for _ in 0..100 {
        if bytes.0.is_empty() {
            return;
        }
        let status = program.call(&mut bytes);
        // SAFETY: the text is static and ends with 0.
        let text = unsafe { CStr::from_ptr(allanite_status_text(status as i32)) };
        assert!(!text.is_empty(), "{status:?}");
    }
}

impl Program {
    /// One call. Every pointer is null, or leads to as much memory as its type has, which nothing else uses.
    fn call(&mut self, bytes: &mut Bytes<'_>) -> AllaniteStatus {
        let choice = bytes.next();
        let which = usize::from(choice >= 128);
        let gyro: *mut AllaniteGyro = &raw mut *self.gyros[which];
        let other: *mut AllaniteGyro = &raw mut *self.gyros[1 - which];
        let gyro = bytes.or_null(gyro);
        let evidence: *mut AllaniteRecord = &raw mut *self.evidence;
        let test: *mut AllaniteSelfTest = &raw mut *self.test;
        let look: *mut AllaniteLook = &raw mut *self.look;
        let diagnosis: *mut AllaniteDiagnosis = &raw mut *self.diagnosis;
        let certificate: *mut AllaniteCertificate = &raw mut *self.certificate;
        let mut flag = false;
        let flag = bytes.or_null(&raw mut flag);
        let (mut one, mut two) = (0_u64, 0_u64);
        // SAFETY: all pointers lead to memory of this program, or are null.
        unsafe {
            match choice % 24 {
                0 => allanite_gyro_init(gyro, bytes.size::<AllaniteGyro>(), 100.0),
                1..=4 => push(gyro, bytes),
                5 => allanite_gyro_gap(gyro),
                6 => allanite_gyro_lost(gyro, u64::from(bytes.word()) << (choice % 33)),
                7 => allanite_gyro_advance(gyro, flag),
                8 => allanite_gyro_release(gyro),
                9 => {
                    let other = if bytes.next() == 0 { gyro } else { other };
                    allanite_gyro_merge(gyro, other)
                }
                10 => {
                    let status =
                        allanite_gyro_samples(gyro, &raw mut one, bytes.or_null(&raw mut two));
                    assert!(status != AllaniteStatus::Ok || one < 1 << 60);
                    status
                }
                11 => {
                    let capacity = usize::from(bytes.next()) * 128;
                    let mut buffer = vec![0; capacity.min(ALLANITE_SNAPSHOT_BYTES)];
                    let mut written = 0;
                    let test = bytes.or_null(test);
                    let (to, length) = (buffer.as_mut_ptr(), buffer.len());
                    let status = allanite_gyro_snapshot(gyro, test, to, length, &raw mut written);
                    if status == AllaniteStatus::Ok {
                        assert!(written <= length);
                        buffer.truncate(written);
                        self.stored = buffer;
                    }
                    status
                }
                12 => {
                    let damaged = usize::from(bytes.next());
                    if let Some(byte) = self.stored.get_mut(damaged.wrapping_sub(1)) {
                        *byte ^= bytes.next();
                    }
                    let (from, length) = (self.stored.as_ptr(), self.stored.len());
                    allanite_gyro_restore(gyro, bytes.or_null(test), from, length)
                }
                13 | 14 => {
                    self.is_stale = true;
                    let axis = usize::from(bytes.next() % 4);
                    let size = bytes.size::<AllaniteRecord>();
                    let [count, rate, kelvin] = [(); 3].map(|()| bytes.number());
                    allanite_record_take(evidence, size, gyro, axis, count, rate, kelvin)
                }
                15 => {
                    let mut reason: Box<AllaniteReason> = zeroed();
                    let reason = bytes.or_null(&raw mut *reason);
                    allanite_record_summary(evidence, bytes.or_null(&raw mut one), reason)
                }
                16 => {
                    let mut fit: Box<AllaniteFit> = zeroed();
                    allanite_fit(evidence, bytes.or_null(&raw mut *fit))
                }
                17 => make_test(test, bytes),
                18 => {
                    let mut status: Box<AllaniteTestStatus> = zeroed();
                    let samples = u64::from(bytes.word());
                    allanite_self_test_status(test, samples, &raw mut *status);
                    allanite_self_test_is_due(test, samples, flag)
                }
                19 => allanite_look_begin(look, bytes.size::<AllaniteLook>(), test, evidence),
                20 => {
                    let mut status: Box<AllaniteTestStatus> = zeroed();
                    for _ in 0..PIECES {
                        allanite_look_advance(look, flag);
                    }
                    allanite_look_conclude(test, look, bytes.or_null(&raw mut *status))
                }
                21 => {
                    let size = bytes.size::<AllaniteDiagnosis>();
                    let status = allanite_diagnosis_begin(diagnosis, size, bytes.or_null(evidence));
                    // What was there before stays if the call is refused.
                    self.is_stale &= status != AllaniteStatus::Ok;
                    status
                }
                22 if self.is_stale => AllaniteStatus::Ok,
                22 => {
                    let mut progress = AllaniteProgress::Working;
                    let progress = bytes.or_null(&raw mut progress);
                    let mut left = 1_u32 << (bytes.word() % 14);
                    let context = (&raw mut left).cast();
                    allanite_diagnosis_advance_with(diagnosis, progress, Some(pause), context);
                    let mut fit: Box<AllaniteFit> = zeroed();
                    allanite_diagnosis_fit(diagnosis, &raw mut *fit);
                    let mut dependence: Box<AllaniteDependence> = zeroed();
                    allanite_diagnosis_dependence(diagnosis, &raw mut *dependence);
                    allanite_certificate_add(certificate, diagnosis)
                }
                _ => certify(certificate, bytes),
            }
        }
    }
}

/// Counts pieces of work, and ends the work after the last one.
///
/// # Safety
/// `context` points to the number of pieces that are left.
unsafe extern "C" fn pause(context: *mut c_void) -> bool {
    // SAFETY: the caller promises that.
    let left = unsafe { &mut *context.cast::<u32>() };
    *left = left.saturating_sub(1);
    *left > 0
}

/// Pushes some samples.
///
/// # Safety
/// As of `allanite_gyro_push`.
unsafe fn push(gyro: *mut AllaniteGyro, bytes: &mut Bytes<'_>) -> AllaniteStatus {
    let mut random = bytes.word();
    let shift = random % 32;
    let mut status = AllaniteStatus::Ok;
    for _ in 0..1 << (random % 11) {
        let counts = [(); ALLANITE_AXES].map(|()| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random as i32) >> shift
        });
        // SAFETY: the caller promises that of the gyro, and the counts are here.
        status = unsafe { allanite_gyro_push(gyro, counts.as_ptr(), counts[0] >> 4) };
    }
    status
}

/// Makes a self-test of any plan and limits.
///
/// # Safety
/// As of `allanite_self_test_init`.
unsafe fn make_test(test: *mut AllaniteSelfTest, bytes: &mut Bytes<'_>) -> AllaniteStatus {
    let [least_p, false_pass, false_fail, shortest_s, longest_s] = [(); 5].map(|()| bytes.number());
    let plan = AllanitePlan {
        least_p,
        false_pass,
        false_fail,
        shortest_s,
        longest_s,
    };
    let limits: Vec<AllaniteLimit> = (0..bytes.next() % 8)
        .map(|_| AllaniteLimit {
            effect: i32::from(bytes.next() as i8),
            most: bytes.number(),
        })
        .collect();
    let size = bytes.size::<AllaniteSelfTest>();
    let [count, rate] = [(); 2].map(|()| bytes.number());
    // SAFETY: the caller promises that of the test, and the others are here.
    unsafe {
        allanite_self_test_init(
            test,
            size,
            &raw const plan,
            limits.as_ptr(),
            limits.len(),
            count,
            rate,
        )
    }
}

/// Makes and encodes a certificate.
///
/// # Safety
/// As of `allanite_certificate_init`.
unsafe fn certify(certificate: *mut AllaniteCertificate, bytes: &mut Bytes<'_>) -> AllaniteStatus {
    let device = [1; 20];
    let conditions = AllaniteConditions {
        duration_s: bytes.number().into(),
        rate_hz: bytes.number().into(),
        samples: bytes.word().into(),
        gaps: bytes.next().into(),
        lowest_c: bytes.number(),
        highest_c: bytes.number(),
        firmware: [1, 2, 3],
    };
    let mut buffer = vec![0; (usize::from(bytes.next()) * 32).min(ALLANITE_CERTIFICATE_BYTES)];
    let mut written = 0;
    let (to, length) = (buffer.as_mut_ptr(), buffer.len());
    // SAFETY: the caller promises that of the certificate, and the others are here.
    unsafe {
        if bytes.next().is_multiple_of(2) {
            let size = bytes.size::<AllaniteCertificate>();
            let longer = usize::from(bytes.next()) % 21;
            allanite_certificate_init(
                certificate,
                size,
                device.as_ptr(),
                longer,
                &raw const conditions,
            );
        }
        let status = allanite_certificate_encode(certificate, to, length, &raw mut written);
        assert!(status != AllaniteStatus::Ok || written <= length);
        status
    }
}
