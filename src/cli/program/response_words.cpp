#include "cli/program/response_words.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <lensprof/formats.h>

#include "cli/program/numbers.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/library.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {

// A film-like S: toe and shoulder (Naka-Rushton), with f(0) = 0 and f(1) = 1.
static double film(double x) {
    const double p = 0.95, s = std::pow(0.28, p), at_one = 1.0 / (1.0 + s),
                 y = std::pow(x, p) / (std::pow(x, p) + s) / at_one;
    return y - 0.04 * std::sin(6.283185307179586 * y);
}

// What a file of one response holds.
struct FoundResponse {
    lensprof_response response{};
    double change = 0.0;  // that made it increasing, levels
    bool is_one = false;
};

static lensprof_status take_response(void *user, const lensprof_import_entry *entry) {
    auto &found = *static_cast<FoundResponse *>(user);
    found.is_one = entry->holds == LENSPROF_HOLDS_RESPONSE && entry->profile->responses <= 1;
    found.response = entry->profile->response[0], found.change = entry->change;
    return LENSPROF_OK;
}

static lensprof_response response_of_file(const std::string &file) {
    constexpr double most_changed = 1.0;  // level, as `profile import` doubts
    const std::string bytes = read_text(file, max_text_bytes);
    lensprof_import_options options;
    lensprof_import_options_init(&options);
    options.name = file.c_str();
    FoundResponse found;
    lensprof_error error{};
    check(lensprof_import(bytes.data(), bytes.size(), &options, take_response, &found, &error), file, &error);
    if (!found.is_one)
        throw Failure(LENSPROF_ERROR_READ,
                      file + ": does not hold one response; give a pcalib.txt or a table of a curve");
    if (found.change > most_changed)
        throw Failure(
            LENSPROF_ERROR_READ,
            file + format(": its values decrease in places, by up to %.1f levels; give an intact file", found.change));
    return found.response;
}

lensprof_response response_of_word(const std::string &word) {
    lensprof_response response;
    const std::vector<std::string> parts = split(word, ':');
    lensprof_status status = LENSPROF_OK;
    if (word == "linear") {
        lensprof_response_set_linear(&response);
    } else if (word == "srgb") {
        lensprof_response_set_srgb(&response);
    } else if (word == "film") {
        std::vector<double> table;
        for (int j = 0; j < LENSPROF_RESPONSE_SAMPLES; j++) table.push_back(film(j / 1023.0));
        status = lensprof_response_set_table(&response, table.data(), static_cast<uint32_t>(table.size()));
    } else if (parts.size() == 2 && parts[0] == "gamma") {
        status = lensprof_response_set_gamma(&response, number_of(parts[1], any_number));
    } else if (parts.size() == 2 && parts[0] == "emor") {
        std::vector<double> emor;
        for (const auto &number : elements(parts[1])) emor.push_back(number_of(number, any_number));
        status = lensprof_response_set_emor(&response, emor.data(), static_cast<uint32_t>(emor.size()));
    } else if (path_exists(word)) {
        response = response_of_file(word);
    } else {
        throw std::invalid_argument(word + ": use linear, srgb, film, gamma:G, emor:a,b,... or an existing file");
    }
    if (status != LENSPROF_OK)
        throw std::invalid_argument(word + ": is not a monotonic response; use linear, srgb, "
                                                                  "film, gamma:G or emor:a,b,...");
    return response;
}

}  // namespace lensprof
