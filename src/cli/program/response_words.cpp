#include "cli/program/response_words.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "cli/program/numbers.hpp"

namespace lensprof {

// A film-like S: toe and shoulder (Naka-Rushton), with f(0) = 0 and f(1) = 1.
static double film(double x) {
    const double p = 0.95, s = std::pow(0.28, p), at_one = 1.0 / (1.0 + s),
                 y = std::pow(x, p) / (std::pow(x, p) + s) / at_one;
    return y - 0.04 * std::sin(6.283185307179586 * y);
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
    } else {
        throw std::invalid_argument(word + ": use linear, srgb, film, gamma:G or emor:a,b,...");
    }
    if (status != LENSPROF_OK)
        throw std::invalid_argument(word + ": is not a monotonic response; use linear, srgb, "
                                                                  "film, gamma:G or emor:a,b,...");
    return response;
}

}  // namespace lensprof
