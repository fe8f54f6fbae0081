#include "core/kernels/lanes_neon.h"

#define ROW_KERNEL lp_row_neon
#include "core/kernels/row.h"
