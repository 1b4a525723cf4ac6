/* What the product needs on a Cortex-M in QEMU: a vector table, start-up code, and semihosting to print, to read and to leave. */

#include <stddef.h>
#include <stdint.h>

void product(void);
void reset(void);

extern uint32_t stack_top, data_start, data_end, data_load, bss_start, bss_end;

static uintptr_t semihost(uintptr_t operation, uintptr_t argument) {
    register uintptr_t r0 __asm__("r0") = operation;
    register uintptr_t r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

void print(const char *text) {
    semihost(0x04, (uintptr_t)text);
}

size_t take(void *to, size_t bytes) {
    /* SYS_OPEN of ":tt" to be read is the standard input, and SYS_READ returns how many bytes are left. */
    static const char name[] = ":tt";
    static uintptr_t input;
    size_t taken = 0, more;
    if (input == 0) {
        const uintptr_t file[3] = {(uintptr_t)name, 0, sizeof name - 1};
        input = semihost(0x01, (uintptr_t)file);
    }
    do {
        const uintptr_t place[3] = {input, (uintptr_t)to + taken, bytes - taken};
        more = bytes - taken - semihost(0x06, (uintptr_t)place);
        taken += more;
    } while (more > 0 && taken < bytes);
    return taken;
}

void leave(int status) {
    /* SYS_EXIT_EXTENDED: the application has stopped with a status. */
    const uintptr_t arguments[2] = {0x20026, (uintptr_t)status};
    semihost(0x20, (uintptr_t)arguments);
    for (;;) {
    }
}

static void fault(void) {
    print("fault\n");
    leave(101);
}

__attribute__((section(".vectors"), used)) static const uintptr_t vectors[16] = {
    (uintptr_t)&stack_top, (uintptr_t)reset, (uintptr_t)fault, (uintptr_t)fault,
    (uintptr_t)fault,      (uintptr_t)fault, (uintptr_t)fault,
};

void reset(void) {
    const uint32_t *from = &data_load;
    for (uint32_t *to = &data_start; to < &data_end; to++) {
        *to = *from++;
    }
    for (uint32_t *to = &bss_start; to < &bss_end; to++) {
        *to = 0;
    }
    /* Coprocessors 10 and 11 are the floating-point unit. */
    *(volatile uint32_t *)0xE000ED88u |= 0xFu << 20;
    __asm__ volatile("dsb\nisb");
    product();
    leave(0);
}
