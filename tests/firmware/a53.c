/* A Cortex-A53 without an operating system: start-up, output and clock of QEMU's board "virt". */
#include <stddef.h>
#include <stdint.h>

#include "board.h"

int main(void);

__asm__(
    ".section .text.start\n"
    ".global reset\n"
    "reset:\n"
    "    adrp x0, stack_top\n"
    "    add x0, x0, :lo12:stack_top\n"
    "    mov sp, x0\n"
    "    mov x0, #(3 << 20)\n" /* CPACR_EL1: floating point is not trapped */
    "    msr cpacr_el1, x0\n"
    "    isb\n"
    "    bl main\n"
    "    bl stop\n"
    ".text\n");

static long call(long operation, const void *argument) {
    register long x0 __asm__("x0") = operation;
    register const void *x1 __asm__("x1") = argument;
    __asm__ volatile("hlt #0xf000" : "+r"(x0) : "r"(x1) : "memory");
    return x0;
}

void put_text(const char *text) { call(0x04, text); } /* SYS_WRITE0 */

void stop(int status) {
    const uint64_t exited[2] = {0x20026, (uint64_t)status}; /* ADP_Stopped_ApplicationExit */
    call(0x18, exited);                                     /* SYS_EXIT */
    for (;;) {
    }
}

void paint_stack(void) {}
uint32_t deepest_stack(void) { return 0; }

/* The virtual counter runs at 62.5 MHz. */
uint32_t clock_ticks(void) {
    uint64_t now;
    __asm__ volatile("isb\n mrs %0, cntvct_el0" : "=r"(now));
    return (uint32_t)(0 - now) & 0xFFFFFF;
}

void *memcpy(void *restrict to, const void *restrict from, size_t count) {
    uint8_t *t = to;
    const uint8_t *f = from;
    for (; count >= 8 && !(((uintptr_t)t | (uintptr_t)f) & 7); count -= 8, t += 8, f += 8)
        *(uint64_t *)(void *)t = *(const uint64_t *)(const void *)f;
    while (count--) *t++ = *f++;
    return to;
}

void *memset(void *to, int value, size_t count) {
    for (uint8_t *t = to; count--;) *t++ = (uint8_t)value;
    return to;
}

void *memmove(void *to, const void *from, size_t count) {
    uint8_t *t = to;
    const uint8_t *f = from;
    if (t <= f) return memcpy(to, from, count);
    while (count--) t[count] = f[count];
    return to;
}

int memcmp(const void *a, const void *b, size_t count) {
    const uint8_t *x = a, *y = b;
    for (; count--; x++, y++)
        if (*x != *y) return *x - *y;
    return 0;
}
