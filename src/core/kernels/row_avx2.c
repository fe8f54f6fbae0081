#include "lanes_avx2.h"

#define ROW_KERNEL lp_row_avx2
#include "row.h"
