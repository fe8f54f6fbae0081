/* What the demonstration needs of a board, or of a PC. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

void put_text(const char *text);
void stop(int status);

void paint_stack(void);
uint32_t deepest_stack(void); /* bytes from the top of the stack to the lowest one touched since; 0 on a PC */

#endif
