/* A product in C: it records three axes and a temperature, tests itself, loses its power once, and diagnoses the first
 * axis. It prints the bits of what it finds. `product.rs` does the same in Rust and prints the same lines. */

#include "allanite.h"

void print(const char *text);
void leave(int status);

#define SAMPLES 65536u
#define SNAPSHOT 40000u
#define POWER_LOSS 41000u

static AllaniteGyro gyro;
static AllaniteSelfTest test;
static AllaniteLook look;
static AllaniteRecord record;
static AllaniteDiagnosis diagnosis;
static AllaniteCertificate certificate;
static uint8_t stored[ALLANITE_SNAPSHOT_BYTES];
static uint8_t bytes[ALLANITE_CERTIFICATE_BYTES];

/* The sensor: white noise, an oscillation, and a temperature that rises and falls, which the first axis follows with a lag of 20 s. */
static uint32_t seed;
static int32_t sine, cosine, inside;

static int32_t noise(void) {
    int32_t sum = 0;
    for (int i = 0; i < 4; i++) {
        seed = seed * 1664525u + 1013904223u;
        sum += (int32_t)(seed >> 25);
    }
    return sum;
}

static void sample(uint32_t n, int32_t counts[3], int32_t *temperature) {
    sine -= cosine * 3 / 4;
    cosine += sine * 3 / 4;
    *temperature = 2500 + (int32_t)((n < SAMPLES / 2 ? n : SAMPLES - n) / 128);
    inside += (*temperature * 65536 - inside) / 2048;
    counts[0] = noise() + sine / 64 + inside / 131072;
    counts[1] = noise() + (n == 5000u ? 20000 : 0);
    counts[2] = noise();
}

/* Printing without a C library. */
static void print_number(uint32_t number) {
    char text[12];
    int at = 11;
    text[at] = '\0';
    do {
        text[--at] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number > 0u);
    print(&text[at]);
}

static void print_bits(float value) {
    union {
        float value;
        uint32_t bits;
    } both = {value};
    char text[10];
    text[0] = ' ';
    for (int i = 0; i < 8; i++) {
        text[1 + i] = "0123456789abcdef"[(both.bits >> (28 - 4 * i)) & 15u];
    }
    text[9] = '\0';
    print(text);
}

static void check(AllaniteStatus status, const char *where) {
    if (status != ALLANITE_STATUS_OK) {
        print(where);
        print(": ");
        print(allanite_status_text(status));
        print("\n");
        leave(1);
    }
}

static void make_test(void) {
    static const AllaniteLimit limits[] = {{ALLANITE_EFFECT_ANGLE_RANDOM_WALK, 0.5f}, {ALLANITE_EFFECT_BIAS_INSTABILITY, 0.5f}};
    static const AllanitePlan plan = {0.0f, 0.01f, 0.01f, 5.0f, 640.0f};
    check(allanite_self_test_init(&test, sizeof test, &plan, limits, 2, 1.0f / 131.0f, 100.0f), "self-test");
}

static void take_record(void) {
    check(allanite_record_take(&record, sizeof record, &gyro, 0, 1.0f / 131.0f, 100.0f, 0.01f), "record");
}

static void print_status(const AllaniteTestStatus *status) {
    print("self-test ");
    print_number((uint32_t)status->verdict);
    print(" effect ");
    print_number((uint32_t)status->effect);
    print_bits(status->value);
    print_bits(status->expected_s);
    print("\n");
}

static void test_if_due(void) {
    uint64_t samples;
    bool due;
    check(allanite_gyro_samples(&gyro, &samples, NULL), "samples");
    check(allanite_self_test_is_due(&test, samples, &due), "due");
    if (!due) {
        return;
    }
    AllaniteTestStatus status;
    bool complete = false;
    take_record();
    check(allanite_look_begin(&look, sizeof look, &test, &record), "look");
    while (!complete) {
        check(allanite_look_advance(&look, &complete), "look");
    }
    check(allanite_look_conclude(&test, &look, &status), "conclude");
    print_status(&status);
}

static void print_fit(const AllaniteFit *fit) {
    print("adequacy ");
    print_number((uint32_t)fit->adequacy);
    print(" degrees ");
    print_number((uint32_t)fit->degrees_of_freedom);
    print_bits(fit->chi_squared);
    print_bits(fit->p_value);
    print("\n");
    for (int i = 0; i < fit->coefficient_count; i++) {
        const AllaniteCoefficient *one = &fit->coefficients[i];
        print("  ");
        print(allanite_effect_name(one->effect));
        print(" state ");
        print_number((uint32_t)one->state);
        print_bits(one->value);
        print_bits(one->lower);
        print_bits(one->upper);
        print("\n");
    }
    for (int i = 0; i < fit->shape_count; i++) {
        const AllaniteShape *one = &fit->shapes[i];
        print("  ");
        print(allanite_parameter_name(fit->coefficients[one->coefficient].effect, one->parameter));
        print_bits(one->value);
        print_bits(one->lower);
        print_bits(one->upper);
        print("\n");
    }
}

static void print_sum(const char *what, const uint8_t *from, size_t length) {
    uint32_t sum = 0;
    for (size_t i = 0; i < length; i++) {
        sum = sum * 31u + from[i];
    }
    print(what);
    print(" bytes ");
    print_number((uint32_t)length);
    print(" sum ");
    print_number(sum);
    print("\n");
}

/* Called between two pieces of a diagnosis. A product feeds its watchdog here and takes the next samples. */
static bool count(void *context) {
    uint32_t *pauses = context;
    *pauses += 1;
    return true;
}

void product(void) {
    size_t length = 0;
    seed = 1;
    sine = 0;
    cosine = 4096;
    inside = 2500 * 65536;
    check(allanite_gyro_init(&gyro, sizeof gyro, 100.0f), "gyro");
    make_test();
    for (uint32_t n = 0; n < SAMPLES; n++) {
        int32_t counts[3], temperature;
        bool more = true;
        sample(n, counts, &temperature);
        check(allanite_gyro_push(&gyro, counts, temperature), "push");
        while (more) {
            check(allanite_gyro_advance(&gyro, &more), "advance");
        }
        test_if_due();
        if (n == SNAPSHOT) {
            check(allanite_gyro_snapshot(&gyro, &test, stored, sizeof stored, &length), "snapshot");
            print_sum("snapshot", stored, length);
        }
        if (n == POWER_LOSS) {
            check(allanite_gyro_init(&gyro, sizeof gyro, 100.0f), "gyro");
            make_test();
            check(allanite_gyro_restore(&gyro, &test, stored, length), "restore");
            check(allanite_gyro_lost(&gyro, POWER_LOSS - SNAPSHOT), "missing");
        }
    }
    check(allanite_gyro_release(&gyro), "release");
    uint64_t kept, left_out;
    check(allanite_gyro_samples(&gyro, &kept, &left_out), "samples");
    print("kept ");
    print_number((uint32_t)kept);
    print(" left out ");
    print_number((uint32_t)left_out);
    print("\n");

    AllaniteFit fit;
    AllaniteProgress progress;
    take_record();
    check(allanite_fit(&record, &fit), "fit");
    print_fit(&fit);
    check(allanite_diagnosis_begin(&diagnosis, sizeof diagnosis, &record), "diagnosis");
    uint32_t pauses = 0;
    do {
        check(allanite_diagnosis_advance_with(&diagnosis, &progress, count, &pauses), "advance");
        if (progress == ALLANITE_PROGRESS_STEP) {
            check(allanite_diagnosis_fit(&diagnosis, &fit), "fit");
            print_fit(&fit);
        }
    } while (progress <= ALLANITE_PROGRESS_STEP);
    print("verdict ");
    print_number((uint32_t)progress);
    print(" pauses ");
    print_number(pauses);
    print("\n");
    AllaniteDependence follows;
    check(allanite_diagnosis_dependence(&diagnosis, &follows), "dependence");
    print("follows the temperature");
    print_bits(follows.slope);
    print_bits(follows.slope_error);
    print_bits(follows.lag_s);
    print_bits(follows.lag_error_s);
    print("\n");

    static const uint8_t device[] = {'S', 'N', '-', '7'};
    const AllaniteConditions conditions = {655.36, 100.0, kept, 1, 25.0f, 27.5f, {1, 2, 3}};
    check(allanite_certificate_init(&certificate, sizeof certificate, device, sizeof device, &conditions), "certificate");
    check(allanite_certificate_add(&certificate, &diagnosis), "add");
    check(allanite_certificate_encode(&certificate, bytes, sizeof bytes, &length), "encode");
    print_sum("certificate", bytes, length);
}
