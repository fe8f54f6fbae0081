// What the readers of falloffs share: provenance, the doubt about an entry, and its visit.
#pragma once

#include <string>
#include <string_view>

#include <lensprof/formats.h>

namespace lensprof {

// Method "import", this software, and as source the caller's name of the file (may be NULL; control characters as '?',
// none where it is not UTF-8) and `origin`, both or the one that there is.
void set_import_provenance(lensprof_profile &profile, const char *source, std::string_view origin);

// Visits a falloff. provenance.doubt becomes what makes it unusable, else `remark`, else what is suspicious about its
// shape; cut to fit.
lensprof_status visit_entry(lensprof_profile &profile, const std::string &remark, lensprof_import_visitor visit,
                            void *user);

// "its refit is off by up to 3.1 %" where that is more than 1 %, else empty.
std::string refit_remark(double worst);

}  // namespace lensprof
