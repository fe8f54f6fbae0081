/* The EMoR tables; generated, see emor_table.c. */
#ifndef LENSPROF_CORE_EMOR_TABLE_H
#define LENSPROF_CORE_EMOR_TABLE_H

#include <lensprof/model.h>

extern const double lp_emor_table[1 + LENSPROF_EMOR_MODES][LENSPROF_RESPONSE_SAMPLES];

#endif
