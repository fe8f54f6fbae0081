#include "core/kernels/lanes_avx512.h"

#define ROW_KERNEL lp_row_avx512
#include "core/kernels/row.h"
