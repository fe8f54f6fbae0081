#include "core/kernels/lanes_avx512.h"

#define ROW_KERNEL guessed_row_avx512
#include "guessed_row.h"
