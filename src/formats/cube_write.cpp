// Responses to one-dimensional cubes.
#include "formats/each_format.h"

#include "formats/code/code_text.hpp"
#include "formats/responses.hpp"

namespace lensprof {
namespace {

constexpr double kLeast = 1e-40;  // smaller numbers become 0, so that a row is shorter than the format's 250 characters
constexpr size_t kTitle = 200;    // bytes

// A title is ASCII without quotes.
std::string title_of(const lensprof_profile_key &key, bool is_inverse) {
    std::string title = std::string("lensprof: ") + (is_inverse ? "grey values into light" : "light into grey values");
    const std::string of = name_of_profile(key);
    if (!of.empty()) title += ", " + of;
    for (char &c : title)
        if (c < ' ' || c > '~' || c == '"') c = '_';
    return title.substr(0, kTitle);
}

std::string cube_text(const lensprof_profile &profile, uint32_t curve, uint32_t rows) {
    check_cube_curve(curve);
    std::vector<std::vector<double>> columns;
    for (uint32_t c = 0; c < profile.responses; c++) {
        check_response(profile.response[c], "response " + std::to_string(c));
        columns.push_back(curve == LENSPROF_CURVE_INVERSE ? irradiances_of(profile.response[c], rows)
                                                          : greys_of(profile.response[c], rows));
    }
    std::string text = "TITLE \"" + title_of(profile.key, curve == LENSPROF_CURVE_INVERSE) + "\"\nLUT_1D_SIZE "
                       + std::to_string(rows) + "\nDOMAIN_MIN 0 0 0\nDOMAIN_MAX 1 1 1\n";
    for (uint32_t i = 0; i < rows; i++)
        for (uint32_t c = 0; c < 3; c++) {
            const double value = columns[profile.responses == 3 ? c : 0][i];
            text += fixed_text(value < kLeast ? 0.0 : value) + (c < 2 ? " " : "\n");
        }
    return text;
}

}  // namespace
}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_cube_write(const lensprof_profile *profile, uint32_t curve, uint32_t rows, void *data,
                              size_t capacity, size_t *count, lensprof_error *error) {
    if (!profile || (profile->responses != 1 && profile->responses != 3) || curve > LENSPROF_CURVE_FORWARD || rows < 2
        || rows > kMaxCurveRows || (!data && capacity)) {
        set_error(error,
                  "lensprof_export: give a profile with 1 or 3 responses, a lensprof_curve, 2 to 65536 rows and a "
                  "buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return cube_text(*profile, curve, rows); });
}
