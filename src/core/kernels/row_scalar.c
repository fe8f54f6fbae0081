#include "core/kernels/lanes_scalar.h"

#define ROW_KERNEL lp_row_scalar
#include "core/kernels/row.h"
