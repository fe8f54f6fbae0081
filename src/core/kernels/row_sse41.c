#include "core/kernels/lanes_sse41.h"

#define ROW_KERNEL lp_row_sse41
#include "core/kernels/row.h"
