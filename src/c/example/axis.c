/* The smallest product in C: it records one axis, fits the five terms of IEEE Std 952 to its Allan curve, and checks them
 * against limits. It prints the bits of what it finds. */

#include "allanite.h"

#define SAMPLES 16384u

void print(const char *text);
void leave(int status);

static AllaniteAxis axis;
static AllanitePoint points[ALLANITE_OCTAVES];
static AllaniteFiveTerms terms;

static int32_t noise(void) {
    static uint32_t seed;
    int32_t sum = 0;
    for (int i = 0; i < 4; i++) {
        seed = seed * 1664525u + 1013904223u;
        sum += (int32_t)(seed >> 25);
    }
    return sum;
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

static void check(AllaniteStatus status) {
    if (status != ALLANITE_STATUS_OK) {
        print(allanite_status_text(status));
        leave(1);
    }
}

void product(void) {
    const float scale = 1.0f / 131, rate = 100.0f, infinite = 1e30f;
    check(allanite_axis_init(&axis, sizeof axis));
    for (uint32_t n = 0; n < SAMPLES; n++) {
        int32_t count = noise();
        if (n % 4096u == 4095u) {
            check(allanite_axis_lost(&axis, 2));
        }
        check(allanite_axis_push(&axis, &count, 1));
    }
    size_t number, place;
    check(allanite_axis_curve(&axis, scale, rate, points, ALLANITE_OCTAVES, &number));
    print("curve");
    for (size_t i = 0; i < number; i++) {
        print_bits(points[i].variance);
    }
    print("\n");
    check(allanite_axis_fit(&axis, scale, rate, &terms));
    for (int i = 0; i < ALLANITE_TERMS; i++) {
        const AllaniteCoefficient *of = &terms.coefficients[i];
        const char *const states[] = {"measured", "bound", "not observable"};
        print(states[of->state]);
        print_bits(of->value);
        print_bits(of->lower);
        print_bits(of->upper);
        print("\n");
    }
    const float most[ALLANITE_TERMS] = {infinite, 2.0f * terms.coefficients[1].value, infinite, infinite, infinite};
    AllaniteChecked checked;
    check(allanite_axis_check(&axis, scale, rate, most, &checked, &place));
    print(checked == ALLANITE_CHECKED_PASS ? "pass\n" : "no pass\n");
}
