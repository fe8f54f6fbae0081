/* What the demonstration needs of a board, or of a PC. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

void put_text(const char *text);
void stop(int status);

void paint_stack(void);
uint32_t deepest_stack(void); /* bytes from the top of the stack to the lowest one touched since; 0 on a PC */

/* Of the processor's clock, 24 bits, counting down; 0 on a PC. QEMU with -icount shift=0 takes a nanosecond an
 * instruction. */
uint32_t clock_ticks(void);

#endif
