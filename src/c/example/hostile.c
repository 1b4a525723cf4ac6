/* Calls that a careful program never makes. Each must be refused with the right status, and none may touch memory that it
 * was not given: this program runs under sanitizers. */

#include "allanite.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void print(const char *text);
void leave(int status);
void product(void);

static AllaniteGyro gyro, other;
static AllaniteSelfTest test;
static AllaniteLook look;
static AllaniteRecord record;
static AllaniteDiagnosis diagnosis;
static AllaniteCertificate certificate;
static uint8_t stored[ALLANITE_SNAPSHOT_BYTES], damaged[ALLANITE_SNAPSHOT_BYTES];
static uint8_t bytes[ALLANITE_CERTIFICATE_BYTES];

static void expect(AllaniteStatus found, AllaniteStatus wanted, int line) {
    if (found != wanted) {
        printf("line %d: %s, not: %s\n", line, allanite_status_text(found), allanite_status_text(wanted));
        leave(1);
    }
}

#define EXPECT(wanted, call) expect((call), ALLANITE_STATUS_##wanted, __LINE__)

static const AllaniteLimit limits[] = {{2, 0.5f}};
static const AllanitePlan plan = {0.0f, 0.01f, 0.01f, 5.0f, 640.0f};
static const AllaniteConditions conditions = {100.0, 100.0, 10000, 0, 25.0f, 27.5f, {1, 2, 3}};
static const int32_t counts[3] = {1, 2, 3};

static AllaniteStatus make_test(AllaniteSelfTest *to, const AllanitePlan *by, const AllaniteLimit *of, size_t count) {
    return allanite_self_test_init(to, sizeof *to, by, of, count, 1.0f, 100.0f);
}

static AllaniteStatus take(size_t axis, float scale, float rate, float kelvin) {
    return allanite_record_take(&record, sizeof record, &gyro, axis, scale, rate, kelvin);
}

/* A pause that ends the work. */
static bool end(void *context) {
    (void)context;
    return false;
}

/* Nothing is there, or nothing was made there. */
static void without_values(void) {
    size_t length;
    uint64_t samples;
    bool flag;
    AllaniteTestStatus status;
    AllaniteProgress progress;
    AllaniteFit fit;
    EXPECT(NULL_POINTER, allanite_gyro_init(NULL, sizeof gyro, 100.0f));
    EXPECT(WRONG_SIZE, allanite_gyro_init(&gyro, sizeof gyro - 8, 100.0f));
    EXPECT(WRONG_SIZE, allanite_gyro_init(&gyro, 0, 100.0f));
    EXPECT(WRONG_SIZE, allanite_gyro_init(&gyro, SIZE_MAX, 100.0f));
    EXPECT(MISALIGNED, allanite_gyro_init((AllaniteGyro *)((char *)&gyro + 4), sizeof gyro, 100.0f));
    EXPECT(NOT_INITIALISED, allanite_gyro_push(&gyro, counts, 0));
    EXPECT(NOT_INITIALISED, allanite_gyro_gap(&gyro));
    EXPECT(NOT_INITIALISED, allanite_gyro_lost(&gyro, 1));
    EXPECT(NOT_INITIALISED, allanite_gyro_advance(&gyro, &flag));
    EXPECT(NOT_INITIALISED, allanite_gyro_release(&gyro));
    EXPECT(NOT_INITIALISED, allanite_gyro_merge(&gyro, &other));
    EXPECT(INVALID_ARGUMENT, allanite_gyro_merge(&gyro, &gyro));
    EXPECT(NOT_INITIALISED, allanite_gyro_samples(&gyro, &samples, NULL));
    EXPECT(NOT_INITIALISED, allanite_gyro_snapshot(&gyro, NULL, stored, sizeof stored, &length));
    EXPECT(NOT_INITIALISED, allanite_gyro_restore(&gyro, NULL, stored, sizeof stored));
    EXPECT(NOT_INITIALISED, take(0, 1.0f, 100.0f, 1.0f));
    EXPECT(NOT_INITIALISED, allanite_record_summary(&record, &samples, NULL));
    EXPECT(NOT_INITIALISED, allanite_fit(&record, &fit));
    EXPECT(NOT_INITIALISED, allanite_self_test_is_due(&test, 1, &flag));
    EXPECT(NOT_INITIALISED, allanite_self_test_status(&test, 1, &status));
    EXPECT(NOT_INITIALISED, allanite_look_begin(&look, sizeof look, &test, &record));
    EXPECT(NOT_INITIALISED, allanite_look_advance(&look, &flag));
    EXPECT(NOT_INITIALISED, allanite_look_conclude(&test, &look, &status));
    EXPECT(NOT_INITIALISED, allanite_diagnosis_begin(&diagnosis, sizeof diagnosis, &record));
    EXPECT(NOT_INITIALISED, allanite_diagnosis_advance(&diagnosis, &progress));
    EXPECT(NOT_INITIALISED, allanite_diagnosis_advance_with(&diagnosis, &progress, end, NULL));
    EXPECT(NOT_INITIALISED, allanite_diagnosis_fit(&diagnosis, &fit));
    AllaniteDependence dependence;
    EXPECT(NOT_INITIALISED, allanite_diagnosis_dependence(&diagnosis, &dependence));
    EXPECT(NOT_INITIALISED, allanite_certificate_add(&certificate, &diagnosis));
    EXPECT(NOT_INITIALISED, allanite_certificate_encode(&certificate, bytes, sizeof bytes, &length));
    EXPECT(NULL_POINTER, allanite_gyro_push(NULL, counts, 0));
    EXPECT(NULL_POINTER, allanite_gyro_merge(&gyro, NULL));
    EXPECT(NULL_POINTER, allanite_diagnosis_advance(NULL, NULL));
    EXPECT(NULL_POINTER, allanite_diagnosis_advance_with(&diagnosis, &progress, NULL, NULL));
    EXPECT(NULL_POINTER, allanite_look_conclude(NULL, NULL, NULL));
    EXPECT(NULL_POINTER, allanite_certificate_encode(NULL, NULL, 0, NULL));
}

/* Values are there, and the arguments are wrong. */
static void with_values(void) {
    size_t length;
    bool flag;
    AllaniteFit fit;
    AllaniteProgress progress;
    AllaniteTestStatus status;
    EXPECT(OK, allanite_gyro_init(&gyro, sizeof gyro, 100.0f));
    EXPECT(OK, allanite_gyro_init(&other, sizeof other, 100.0f));
    EXPECT(NULL_POINTER, allanite_gyro_push(&gyro, NULL, 0));
    EXPECT(MISALIGNED, allanite_gyro_push(&gyro, (const int32_t *)((const char *)counts + 1), 0));
    EXPECT(OK, allanite_gyro_advance(&gyro, NULL));
    EXPECT(OK, allanite_gyro_samples(&gyro, NULL, NULL));
    EXPECT(OK, allanite_gyro_lost(&gyro, UINT64_MAX));
    EXPECT(OK, allanite_gyro_init(&gyro, sizeof gyro, 100.0f));
    EXPECT(UNKNOWN_AXIS, take(3, 1.0f, 100.0f, 1.0f));
    EXPECT(NOT_INITIALISED, allanite_fit(&record, &fit));
    EXPECT(UNKNOWN_AXIS, take(SIZE_MAX, 1.0f, 100.0f, 1.0f));
    const float bad[] = {0.0f, -1.0f, NAN, INFINITY};
    for (int i = 0; i < 4; i++) {
        EXPECT(INVALID_ARGUMENT, allanite_gyro_init(&gyro, sizeof gyro, bad[i]));
        EXPECT(INVALID_ARGUMENT, take(0, bad[i], 100.0f, 1.0f));
        EXPECT(INVALID_ARGUMENT, take(0, 1.0f, bad[i], 1.0f));
        EXPECT(INVALID_ARGUMENT, take(0, 1.0f, 100.0f, bad[i]));
        const AllaniteLimit limit = {2, bad[i]};
        EXPECT(INVALID_PLAN, make_test(&test, &plan, &limit, 1));
        EXPECT(NOT_INITIALISED, allanite_self_test_is_due(&test, 1, &flag));
    }
    /* An empty record. */
    EXPECT(OK, take(0, 1.0f, 100.0f, 1.0f));
    EXPECT(TOO_SHORT, allanite_fit(&record, &fit));
    EXPECT(OK, allanite_diagnosis_begin(&diagnosis, sizeof diagnosis, &record));
    EXPECT(TOO_SHORT, allanite_diagnosis_advance(&diagnosis, &progress));
    EXPECT(OK, allanite_certificate_init(&certificate, sizeof certificate, NULL, 0, &conditions));
    EXPECT(INVALID_ARGUMENT, allanite_certificate_add(&certificate, &diagnosis));
    EXPECT(INVALID_ARGUMENT, allanite_certificate_init(&certificate, sizeof certificate, bytes, 17, &conditions));
    EXPECT(NULL_POINTER, allanite_certificate_init(&certificate, sizeof certificate, NULL, 4, &conditions));
    /* A constant record has no noise. */
    for (int i = 0; i < 1000; i++) {
        EXPECT(OK, allanite_gyro_push(&gyro, counts, 0));
    }
    EXPECT(OK, allanite_gyro_release(&gyro));
    EXPECT(OK, take(0, 1.0f, 100.0f, 1.0f));
    AllaniteStatus constant = allanite_fit(&record, &fit);
    if (constant != ALLANITE_STATUS_NO_NOISE && constant != ALLANITE_STATUS_TOO_SHORT) {
        EXPECT(NO_NOISE, constant);
    }
    /* Plans. */
    EXPECT(NULL_POINTER, make_test(&test, NULL, limits, 1));
    EXPECT(NULL_POINTER, make_test(&test, &plan, NULL, 1));
    EXPECT(INVALID_PLAN, make_test(&test, &plan, NULL, 0));
    const AllaniteLimit unknown = {99, 1.0f};
    EXPECT(INVALID_PLAN, make_test(&test, &plan, &unknown, 1));
    const AllaniteLimit twice[] = {{2, 1.0f}, {2, 2.0f}};
    EXPECT(INVALID_PLAN, make_test(&test, &plan, twice, 2));
    EXPECT(OK, make_test(&test, &plan, limits, 1));
    EXPECT(NULL_POINTER, allanite_self_test_is_due(&test, 1, NULL));
    /* A look is concluded once, by the test that began it, of a record of its scale. */
    static AllaniteSelfTest same;
    EXPECT(OK, make_test(&same, &plan, limits, 1));
    EXPECT(OK, allanite_look_begin(&look, sizeof look, &test, &record));
    EXPECT(OTHER_TEST, allanite_look_conclude(&same, &look, &status));
    EXPECT(OK, allanite_look_conclude(&test, &look, &status));
    EXPECT(OTHER_TEST, allanite_look_conclude(&test, &look, &status));
    EXPECT(OK, allanite_look_begin(&look, sizeof look, &test, &record));
    EXPECT(NULL_POINTER, allanite_look_conclude(&test, &look, NULL));
    EXPECT(OK, take(0, 2.0f, 100.0f, 1.0f));
    EXPECT(INVALID_ARGUMENT, allanite_look_begin(&look, sizeof look, &test, &record));
    EXPECT(OK, take(0, 1.0f, 100.0f, 1.0f));
    /* Buffers. */
    EXPECT(BUFFER_TOO_SMALL, allanite_gyro_snapshot(&gyro, &test, stored, 10, &length));
    EXPECT(NULL_POINTER, allanite_gyro_snapshot(&gyro, &test, NULL, 10, &length));
    EXPECT(NULL_POINTER, allanite_gyro_snapshot(&gyro, &test, stored, sizeof stored, NULL));
}

/* Stored bytes that are damaged in any way. */
static void with_damage(void) {
    size_t length;
    EXPECT(OK, make_test(&test, &plan, limits, 1));
    EXPECT(OK, allanite_gyro_snapshot(&gyro, &test, stored, sizeof stored, &length));
    EXPECT(OK, allanite_gyro_restore(&gyro, &test, stored, length));
    EXPECT(OTHER_PARTS, allanite_gyro_restore(&gyro, NULL, stored, length));
    EXPECT(NULL_POINTER, allanite_gyro_restore(&gyro, &test, NULL, length));
    for (size_t i = 0; i < length; i++) {
        memcpy(damaged, stored, length);
        damaged[i] ^= (uint8_t)(1u << (i % 8u));
        AllaniteStatus status = allanite_gyro_restore(&gyro, &test, damaged, length);
        if (status == ALLANITE_STATUS_OK) {
            EXPECT(CORRUPT, status);
        }
        if (i % 64u == 0u) {
            EXPECT(CORRUPT, allanite_gyro_restore(&gyro, &test, stored, i));
        }
        EXPECT(OK, make_test(&test, &plan, limits, 1));
    }
    EXPECT(OK, allanite_gyro_restore(&gyro, &test, stored, length));
}

/* Memory with any content holds no value, except with the mark of one. */
static void with_rubbish(void) {
    uint32_t seed = 1;
    for (int round = 0; round < 200; round++) {
        uint8_t *at = (uint8_t *)&other;
        for (size_t i = 0; i < sizeof other; i++) {
            seed = seed * 1664525u + 1013904223u;
            at[i] = (uint8_t)(seed >> 24);
        }
        EXPECT(NOT_INITIALISED, allanite_gyro_push(&other, counts, 0));
        EXPECT(NOT_INITIALISED, allanite_gyro_merge(&gyro, &other));
    }
    /* A value of another type is no value of this one. */
    EXPECT(NOT_INITIALISED, allanite_gyro_push((AllaniteGyro *)(void *)&diagnosis, counts, 0));
}

/* A record of noise of this size. */
static void noise(AllaniteGyro *of, int32_t size) {
    uint32_t seed = (uint32_t)size;
    EXPECT(OK, allanite_gyro_init(of, sizeof *of, 100.0f));
    for (int i = 0; i < 10000; i++) {
        int32_t sample[3];
        for (int axis = 0; axis < 3; axis++) {
            seed = seed * 1664525u + 1013904223u;
            sample[axis] = (int32_t)(seed >> 16) % size;
        }
        EXPECT(OK, allanite_gyro_push(of, sample, 0));
    }
    EXPECT(OK, allanite_gyro_release(of));
}

/* Records of two gyros, or of two ranges of one. */
static void with_another_sensor(void) {
    noise(&gyro, 100);
    noise(&other, 103);
    EXPECT(OK, allanite_gyro_merge(&gyro, &other));
    noise(&other, 200);
    EXPECT(OTHER_SENSOR, allanite_gyro_merge(&gyro, &other));
    uint64_t samples;
    EXPECT(OK, allanite_gyro_samples(&gyro, &samples, NULL));
    if (samples != 20000) {
        leave(1);
    }
}

/* One axis alone. */
static void with_one_axis(void) {
    static AllaniteAxis axis;
    static AllaniteFiveTerms terms;
    static AllanitePoint points[ALLANITE_OCTAVES];
    const float most[ALLANITE_TERMS] = {1.0f, 1.0f, 1.0f, 1.0f, 1.0f};
    AllaniteChecked checked;
    size_t number, place;
    EXPECT(NULL_POINTER, allanite_axis_init(NULL, sizeof axis));
    EXPECT(WRONG_SIZE, allanite_axis_init(&axis, sizeof axis - 8));
    EXPECT(NOT_INITIALISED, allanite_axis_push(&axis, counts, 3));
    EXPECT(NOT_INITIALISED, allanite_axis_lost(&axis, 1));
    EXPECT(NOT_INITIALISED, allanite_axis_curve(&axis, 1.0f, 100.0f, points, ALLANITE_OCTAVES, &number));
    EXPECT(NOT_INITIALISED, allanite_axis_fit(&axis, 1.0f, 100.0f, &terms));
    EXPECT(OK, allanite_axis_init(&axis, sizeof axis));
    EXPECT(NULL_POINTER, allanite_axis_push(&axis, NULL, 3));
    EXPECT(OK, allanite_axis_push(&axis, NULL, 0));
    EXPECT(TOO_SHORT, allanite_axis_fit(&axis, 1.0f, 100.0f, &terms));
    for (int i = 0; i < 1000; i++) {
        EXPECT(OK, allanite_axis_push(&axis, counts, 3));
    }
    EXPECT(INVALID_ARGUMENT, allanite_axis_fit(&axis, 0.0f, 100.0f, &terms));
    EXPECT(INVALID_ARGUMENT, allanite_axis_fit(&axis, 1.0f, NAN, &terms));
    EXPECT(NULL_POINTER, allanite_axis_fit(&axis, 1.0f, 100.0f, NULL));
    EXPECT(OK, allanite_axis_curve(&axis, 1.0f, 100.0f, points, ALLANITE_OCTAVES, &number));
    EXPECT(BUFFER_TOO_SMALL, allanite_axis_curve(&axis, 1.0f, 100.0f, points, number - 1, &number));
    EXPECT(NULL_POINTER, allanite_axis_curve(&axis, 1.0f, 100.0f, NULL, ALLANITE_OCTAVES, &number));
    EXPECT(NULL_POINTER, allanite_axis_check(&axis, 1.0f, 100.0f, NULL, &checked, &place));
    EXPECT(NULL_POINTER, allanite_axis_check(&axis, 1.0f, 100.0f, most, NULL, &place));
    EXPECT(NOT_INITIALISED, allanite_axis_push((AllaniteAxis *)(void *)&gyro, counts, 3));
    EXPECT(NULL_POINTER, allanite_record_curve(&record, NULL, ALLANITE_OCTAVES, &number));
    EXPECT(OK, allanite_record_curve(&record, points, ALLANITE_OCTAVES, &number));
}

void product(void) {
    without_values();
    with_values();
    with_damage();
    with_rubbish();
    with_another_sensor();
    with_one_axis();
    print("refused as they should be\n");
}
