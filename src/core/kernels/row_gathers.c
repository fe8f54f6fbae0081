/* AVX-512 where gathers are faster than single loads and stores past the caches are slow (best.c). */
#define FAST_GATHERS
#include "core/kernels/lanes_avx512.h"

#define ROW_KERNEL lp_row_gathers
#include "core/kernels/row.h"
