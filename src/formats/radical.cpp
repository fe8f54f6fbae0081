// radical's response (.crf) and vignetting (.vgn) files: OpenCV matrices, little-endian, blue first, the latter after a
// line of text.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <memory>
#include <vector>

#include "formats/each_format.h"

#include "formats/falloff/curve_table.hpp"
#include "formats/falloff/map.hpp"
#include "formats/responses.hpp"

namespace lensprof {
namespace {

constexpr uint32_t kMagic = 0xC4A1FDD9;
constexpr uint32_t kFloat3 = 21, kDouble3 = 22;  // OpenCV's CV_32FC3 and CV_64FC3
constexpr uint32_t kGreys = 256;
constexpr uint32_t kTerms = 5;        // centre x, y, and coefficients of r^2, r^4, r^6, r in px
constexpr double kSameCenter = 1e-6;  // px
constexpr const char *kPolynomial = "PolynomialVignettingModel", *kMap = "NonparametricVignettingModel";

[[noreturn]] void fail(const std::string &text, lensprof_status status = LENSPROF_ERROR_SYNTAX) {
    throw FormatFailure{status, text};
}

uint32_t take_u32(std::string_view &data) {
    if (data.size() < 4) fail("the matrix is truncated; give the whole file");
    uint32_t value = 0;
    for (size_t i = 0; i < 4; i++) value |= uint32_t{static_cast<unsigned char>(data[i])} << (8 * i);
    data.remove_prefix(4);
    return value;
}

struct Matrix {
    uint32_t type, rows, columns;
    std::string_view bytes;

    // Numbers of the matrix, which is of floats or doubles.
    template <typename Number>
    std::vector<Number> numbers() const {
        std::vector<Number> values(bytes.size() / sizeof(Number));
        for (size_t i = 0; i < values.size(); i++) {
            std::array<unsigned char, sizeof(Number)> raw;
            std::memcpy(raw.data(), bytes.data() + i * sizeof(Number), sizeof(Number));
            if (!is_little_endian()) std::reverse(raw.begin(), raw.end());
            std::memcpy(&values[i], raw.data(), sizeof(Number));
        }
        return values;
    }

    static bool is_little_endian() {
        const uint16_t probe = 1;
        unsigned char first;
        std::memcpy(&first, &probe, 1);
        return first == 1;
    }
};

Matrix take_matrix(std::string_view data, uint32_t type) {
    if (take_u32(data) != kMagic) fail("not a radical file (its magic number is missing); give a .crf or .vgn");
    Matrix matrix{};
    matrix.type = take_u32(data);
    const uint32_t dimensions = take_u32(data);
    matrix.rows = take_u32(data), matrix.columns = take_u32(data);
    if (matrix.type != type || dimensions > 2)
        fail("a matrix of type " + std::to_string(matrix.type) + " with " + std::to_string(dimensions)
                 + " dimensions, not of type " + std::to_string(type) + "; give another file",
             LENSPROF_ERROR_UNSUPPORTED);
    const uint64_t pixel = type == kFloat3 ? 12 : 24;
    if (matrix.rows > 65536 || matrix.columns > 65536)
        fail("a matrix side of over 65536; give another file", LENSPROF_ERROR_SIZE);
    if (data.size() != uint64_t{matrix.rows} * matrix.columns * pixel)
        fail("a matrix of " + std::to_string(matrix.columns) + " x " + std::to_string(matrix.rows) + " in "
             + std::to_string(data.size()) + " bytes; give the whole file");
    matrix.bytes = data;
    return matrix;
}

void put_u32(std::string &data, uint32_t value) {
    for (int i = 0; i < 4; i++) data += static_cast<char>(value >> (8 * i) & 0xFF);
}

template <typename Number>
void put_matrix(std::string &data, uint32_t type, uint32_t rows, uint32_t columns, const std::vector<Number> &values) {
    for (uint32_t word : {kMagic, type, uint32_t{2}, rows, columns}) put_u32(data, word);
    for (Number value : values) {
        std::array<char, sizeof value> raw;
        std::memcpy(raw.data(), &value, sizeof value);
        if (!Matrix::is_little_endian()) std::reverse(raw.begin(), raw.end());
        data.append(raw.data(), raw.size());
    }
}

std::string responses_data(const lensprof_response *responses, uint32_t count) {
    std::vector<float> values(3 * kGreys);
    for (uint32_t c = 0; c < 3; c++) {
        const lensprof_response &response = responses[count == 3 ? c : 0];
        check_response(response, "response " + std::to_string(count == 3 ? c : 0));
        const std::vector<double> greys = irradiances_of(response, kGreys);
        for (size_t i = 0; i < kGreys; i++) values[3 * i + 2 - c] = static_cast<float>(std::max(greys[i], kDarkest));
    }
    std::string data;
    put_matrix(data, kFloat3, kGreys, 1, values);
    return data;
}

// Centre in px and coefficients in px of red, green and blue.
using Polynomials = std::array<std::array<double, kTerms>, 3>;

// One centre: the same polynomial, rescaled.
void set_falloffs(const Polynomials &terms, uint32_t width, uint32_t height, lensprof_profile &profile) {
    const double rho = lensprof_half_diagonal(width, height);
    profile.vignettings = 3;
    for (size_t c = 0; c < 3; c++) {
        lensprof_vignetting &v = profile.vignetting[c];
        v.center[0] = (terms[0][0] - (width - 1.0) / 2.0) / rho;
        v.center[1] = (terms[0][1] - (height - 1.0) / 2.0) / rho;
        for (size_t n = 0; n < 3; n++) v.k[n] = terms[c][n + 2] * std::pow(rho, 2.0 * (double(n) + 1.0));
        const lensprof_status status = lensprof_vignetting_validate(&v);
        if (status != LENSPROF_OK) fail("the falloff is not above 0 on the whole frame; calibrate again", status);
    }
    lensprof_gain_grid_init(&profile.grid);
}

// A centre a channel: the surfaces, refitted with one.
double refit_falloffs(const Polynomials &terms, uint32_t width, uint32_t height, lensprof_profile &profile) {
    return fit_map(sampled_map(width, height, 3,
                               [&](double column, double row, uint32_t channel) {
                                   const std::array<double, kTerms> &t = terms[channel];
                                   const double x = column - t[0], y = row - t[1], r2 = x * x + y * y;
                                   return std::max(1.0 + r2 * (t[2] + r2 * (t[3] + r2 * t[4])), 0.0);
                               }),
                   profile);
}

double read_polynomial(std::string_view header, std::string_view data, lensprof_profile &profile) {
    double size[3];
    for (double &value : size)
        if (!read_whole(next_word(header), 1, 65536, value))
            fail("line 1: degree, width and height are missing; give the whole file");
    if (size[0] != 3.0)
        fail("line 1: a polynomial of degree " + number_text(size[0]) + ", not 3", LENSPROF_ERROR_UNSUPPORTED);
    const Matrix matrix = take_matrix(data, kDouble3);
    if (uint64_t{matrix.rows} * matrix.columns != kTerms) fail("a polynomial without 5 rows; give another file");
    const std::vector<double> values = matrix.numbers<double>();
    Polynomials terms;
    for (size_t i = 0; i < values.size(); i++) {
        if (!std::isfinite(values[i])) fail("a coefficient is not finite; calibrate again", LENSPROF_ERROR_NOT_FINITE);
        terms[2 - i % 3][i / 3] = values[i];
    }
    const auto width = static_cast<uint32_t>(size[1]), height = static_cast<uint32_t>(size[2]);
    check_frame(width, height);
    bool one_center = true;
    for (size_t c = 1; c < 3; c++)
        for (size_t d = 0; d < 2; d++) one_center = one_center && std::fabs(terms[c][d] - terms[0][d]) <= kSameCenter;
    if (!one_center) return refit_falloffs(terms, width, height, profile);
    set_falloffs(terms, width, height, profile);
    return 0.0;
}

double read_vignetting(std::string_view data, lensprof_profile &profile) {
    const size_t end = data.substr(0, 100).find('\n');
    if (end == std::string_view::npos) fail("no line of text at the beginning; give a .vgn file of radical");
    std::string_view header = data.substr(0, end);
    const std::string_view name = next_word(header);
    data.remove_prefix(end + 1);
    double worst;
    if (name == kPolynomial) {
        worst = read_polynomial(header, data, profile);
    } else if (name == kMap) {
        const Matrix matrix = take_matrix(data, kFloat3);
        const std::vector<float> values = matrix.numbers<float>();
        worst = fit_values({matrix.columns, matrix.rows, 3, false, {2, 1, 0}}, values.data(), matrix.columns,
                           matrix.rows, profile);
    } else {
        fail("line 1: " + in_quotes(name) + " is not a vignetting model of radical; give another file",
             LENSPROF_ERROR_UNSUPPORTED);
    }
    profile.covariance_size = 0;
    std::fill(std::begin(profile.covariance), std::end(profile.covariance), 0.0);
    return worst;
}

std::string vignetting_data(const lensprof_profile &profile, uint32_t width, uint32_t height) {
    check_profile(profile);
    check_frame(width, height);
    std::string data;
    if (profile.grid.columns) {
        const std::vector<double> all = attenuations_of(profile, width, height, width, height, 3);
        const size_t pixels = size_t(width) * height;
        std::vector<float> values(3 * pixels);
        for (size_t i = 0; i < 3 * pixels; i++) values[3 * (i % pixels) + 2 - i / pixels] = static_cast<float>(all[i]);
        data = std::string(kMap) + "\n";
        put_matrix(data, kFloat3, height, width, values);
        return data;
    }
    const double rho = lensprof_half_diagonal(width, height);
    std::vector<double> values(3 * kTerms);
    for (size_t c = 0; c < 3; c++) {
        const lensprof_vignetting &v = profile.vignetting[profile.vignettings == 3 ? c : 0];
        values[2 - c] = (width - 1.0) / 2.0 + rho * v.center[0];
        values[3 + 2 - c] = (height - 1.0) / 2.0 + rho * v.center[1];
        for (size_t n = 0; n < 3; n++) values[3 * (n + 2) + 2 - c] = v.k[n] * std::pow(rho, -2.0 * (double(n) + 1.0));
    }
    data = std::string(kPolynomial) + " 3 " + std::to_string(width) + " " + std::to_string(height) + "\n";
    put_matrix(data, kDouble3, kTerms, 1, values);
    return data;
}

}  // namespace

void read_radical_responses(std::string_view data, Repair &repair, lensprof_response *responses) {
    const Matrix matrix = take_matrix(data, kFloat3);
    if (uint64_t{matrix.rows} * matrix.columns != kGreys)
        fail("a response of " + std::to_string(uint64_t{matrix.rows} * matrix.columns)
             + " grey values, not 256; give another file");
    const std::vector<float> values = matrix.numbers<float>();
    static constexpr const char *kNames[3] = {"red", "green", "blue"};
    for (size_t c = 0; c < 3; c++) {
        std::vector<double> greys;
        for (size_t i = 0; i < kGreys; i++) greys.push_back(double(values[3 * i + 2 - c]));
        for (size_t i = 0; i < kGreys; i++)
            if (!std::isfinite(greys[i]) || greys[i] < 0.0)
                fail(std::string("grey ") + std::to_string(i) + " of " + kNames[c]
                         + " is not an irradiance; calibrate again",
                     LENSPROF_ERROR_RESPONSE);
        const size_t fall = find_fall(greys, false);
        if (fall < kGreys && repair.is_allowed)
            make_increasing(greys, 0.0, repair);
        else if (fall < kGreys || !(greys.back() > greys.front()))
            fail("grey " + std::to_string(std::min<size_t>(fall, kGreys - 1)) + " of " + kNames[c]
                     + " is darker than the one before; smooth it, or calibrate again",
                 LENSPROF_ERROR_RESPONSE);
        responses[c] = response_of_irradiances(greys);
    }
}

}  // namespace lensprof

using namespace lensprof;

lensprof_status lp_radical_response_read(const void *data, size_t size, lensprof_response *responses,
                                         lensprof_error *error) {
    if ((!data && size) || !responses) {
        set_error(error, "lensprof_import: data or responses is NULL; pass a buffer and 3 responses");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        auto found = std::make_unique<std::array<lensprof_response, 3>>();
        Repair none;
        read_radical_responses(view_of(data, size), none, found->data());
        std::copy(found->begin(), found->end(), responses);
    });
}

lensprof_status lp_radical_response_write(const lensprof_response *responses, uint32_t response_count, void *data,
                                          size_t capacity, size_t *count, lensprof_error *error) {
    if (!responses || (response_count != 1 && response_count != 3) || (!data && capacity)) {
        set_error(error, "lensprof_export: give 1 or 3 responses and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return responses_data(responses, response_count); });
}

lensprof_status lp_radical_vignetting_read(const void *data, size_t size, lensprof_profile *profile, double *worst,
                                           lensprof_error *error) {
    if ((!data && size) || !profile) {
        set_error(error, "lensprof_import: data or profile is NULL; pass a buffer and a profile");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return at_boundary(error, [&] {
        double error_found = 0.0;
        change_profile(profile,
                       [&](lensprof_profile &target) { error_found = read_vignetting(view_of(data, size), target); });
        if (worst) *worst = error_found;
    });
}

lensprof_status lp_radical_vignetting_write(const lensprof_profile *profile, uint32_t width, uint32_t height,
                                            void *data, size_t capacity, size_t *count, lensprof_error *error) {
    if (!profile || (!data && capacity)) {
        set_error(error, "lensprof_export: give a profile and a buffer");
        return LENSPROF_ERROR_ARGUMENT;
    }
    return write_at_boundary(data, capacity, count, error, [&] { return vignetting_data(*profile, width, height); });
}
