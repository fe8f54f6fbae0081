/* A row kernel that counts guessed values for tests. The including file first includes a lanes_*.h and defines
 * ROW_KERNEL. */
#ifndef LENSPROF_TESTS_GUESSED_ROW_H
#define LENSPROF_TESTS_GUESSED_ROW_H

#include "core/plan.h"

typedef struct guess_count {
    uint32_t guessed, lost; /* values */
} guess_count;

extern guess_count guess_counts;
lp_row_kernel guessed_row_avx2, guessed_row_avx512;

#ifdef ROW_KERNEL
#define COUNT_LOST(lost, count) (guess_counts.guessed += (count), guess_counts.lost += (lost))
#include "core/kernels/row.h"
#endif

#endif
