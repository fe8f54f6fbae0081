#include "core/kernels/lanes_avx2.h"

#define ROW_KERNEL lp_row_avx2
#include "core/kernels/row.h"
