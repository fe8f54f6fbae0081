#include "formats/falloff/import.hpp"

#include <cstdio>

#include "formats/falloff/falloff_doubt.hpp"
#include "formats/text/text.hpp"

namespace lensprof {
namespace {

constexpr double kRemarkFrom = 0.01;  // relative error of a refit that is reported

}  // namespace

void set_import_provenance(lensprof_profile &profile, const char *source, std::string_view origin) {
    lensprof_provenance &provenance = profile.provenance;
    put_text(provenance.method, sizeof provenance.method, "import");
    put_text(provenance.software, sizeof provenance.software, std::string("lensprof ") + lensprof_version());
    char name[sizeof provenance.source - 40];  // leaves room for the origin
    put_name(name, sizeof name, source);
    std::string text = name;
    if (!text.empty() && !origin.empty()) text += "; ";
    put_text(provenance.source, sizeof provenance.source, text + std::string(origin));
}

lensprof_status visit_entry(lensprof_profile &profile, const std::string &remark, lensprof_import_visitor visit,
                            void *user) {
    FalloffDoubt doubt{true, remark};
    for (uint32_t c = 0; c < profile.vignettings && doubt.usable; c++) {
        const FalloffDoubt found = find_doubt(profile.vignetting[c]);
        if (!found.usable || doubt.text.empty()) doubt = found;
    }
    put_text(profile.provenance.doubt, sizeof profile.provenance.doubt, doubt.text);
    const lensprof_import_entry entry = {&profile, doubt.usable, 0, 0.0};
    return visit(user, &entry);
}

std::string refit_remark(double worst) {
    if (!(worst > kRemarkFrom)) return "";
    char text[64];
    std::snprintf(text, sizeof text, "its refit is off by up to %.3g %%", 100.0 * worst);
    return text;
}

}  // namespace lensprof
