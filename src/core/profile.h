/* The checks of a profile's parts that lensprof_profile_validate makes, for blobs. */
#ifndef LENSPROF_CORE_PROFILE_H
#define LENSPROF_CORE_PROFILE_H

#include <lensprof/profile.h>

lensprof_status lp_provenance_validate(const lensprof_provenance *provenance);

#endif
