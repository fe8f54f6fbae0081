/* The board that is a PC. */
#include <stdio.h>
#include <stdlib.h>

#include "board.h"

void put_text(const char *text) { fputs(text, stdout); }
void stop(int status) { exit(status); }
void paint_stack(void) {}
uint32_t deepest_stack(void) { return 0; }
uint32_t clock_ticks(void) { return 0; }
