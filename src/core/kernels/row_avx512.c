#include "lanes_avx512.h"

#define ROW_KERNEL lp_row_avx512
#include "row.h"
