#include "lanes_neon.h"

#define ROW_KERNEL lp_row_neon
#include "row.h"
