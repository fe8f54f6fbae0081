#include "lanes_scalar.h"

#define ROW_KERNEL lp_row_scalar
#include "row.h"
