/* A device that judges what it is sent: it records counts of three axes, in the byte order of the core, until no more come, and
 * prints how many samples its gate left out and the reason of each axis. */

#include "allanite.h"

void print(const char *text);
void leave(int status);
size_t take(void *to, size_t bytes);

static AllaniteGyro gyro;
static AllaniteRecord record;
static int32_t counts[256][ALLANITE_AXES];

static void print_number(uint64_t number) {
    char text[22];
    int at = 21;
    text[at] = '\0';
    do {
        text[--at] = (char)('0' + number % 10u);
        number /= 10u;
    } while (number > 0u);
    print(&text[at]);
}

static void check(AllaniteStatus status) {
    if (status != ALLANITE_STATUS_OK) {
        print(allanite_status_text(status));
        print("\n");
        leave(1);
    }
}

void product(void) {
    check(allanite_gyro_init(&gyro, sizeof gyro, 100.0f));
    size_t bytes;
    do {
        bytes = take(counts, sizeof counts);
        for (size_t n = 0; n < bytes / sizeof counts[0]; n++) {
            check(allanite_gyro_push(&gyro, counts[n], 0));
        }
    } while (bytes == sizeof counts);
    check(allanite_gyro_release(&gyro));
    uint64_t kept, left_out;
    check(allanite_gyro_samples(&gyro, &kept, &left_out));
    print_number(left_out);
    print("\n");
    for (size_t axis = 0; axis < ALLANITE_AXES; axis++) {
        AllaniteReason reason;
        check(allanite_record_take(&record, sizeof record, &gyro, axis, 0.01f, 100.0f, 1.0f));
        check(allanite_record_summary(&record, NULL, &reason));
        print_number((uint64_t)reason);
        print("\n");
    }
}
