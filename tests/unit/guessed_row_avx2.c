#include "core/kernels/lanes_avx2.h"

#define ROW_KERNEL guessed_row_avx2
#include "guessed_row.h"
