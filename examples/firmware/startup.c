/* Vector table and start-up of a Cortex-M: memory, floating-point unit, main. No vendor's kit. */
#include <stdint.h>

#include "board.h"

int main(void);
void reset(void);

extern uint32_t data_source[], data_start[], data_end[], bss_start[], bss_end[], stack_limit[], stack_top[];

static void fault(void) {
    put_text("fault\n");
    stop(1);
}

__attribute__((section(".vectors"), used)) static void (*const vectors[16])(void) = {
    (void (*)(void))(uintptr_t)stack_top, reset, fault, fault, fault, fault, fault};

#define PAINT 0x5AA5C33Cu

/* What is below the stack pointer is painted, to see later how far the stack came. */
void paint_stack(void) {
    uintptr_t here;
    __asm__ volatile("mov %0, sp" : "=r"(here));
    for (volatile uint32_t *p = stack_limit; (uintptr_t)p < here - 32; p++) *p = PAINT;
}

uint32_t deepest_stack(void) {
    const uint32_t *p = stack_limit;
    while (*p == PAINT) p++;
    return (uint32_t)((uintptr_t)stack_top - (uintptr_t)p);
}

#define SYSTICK ((volatile uint32_t *)0xE000E010) /* control, reload, current */

uint32_t clock_ticks(void) { return SYSTICK[2]; }

void reset(void) {
    const uint32_t *from = data_source;
    for (uint32_t *p = data_start; p < data_end; p++) *p = *from++;
    for (uint32_t *p = bss_start; p < bss_end; p++) *p = 0;
#if defined(__ARM_FP)
    *(volatile uint32_t *)0xE000ED88 |= 0xFu << 20; /* CPACR: full access to the coprocessors 10 and 11 */
    __asm__ volatile("dsb\n isb");
#endif
    SYSTICK[1] = 0xFFFFFF;
    SYSTICK[2] = 0;
    SYSTICK[0] = 5; /* count the processor's clock, no interrupt */
    stop(main());
}

/* The C library's logarithms and powers store error numbers; this spares its kilobyte of per-thread data. */
int *__errno(void);
int *__errno(void) {
    static int number;
    return &number;
}
