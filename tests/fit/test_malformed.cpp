// Thousands of malformed and degenerate problems at the C boundary of the fit: no crash, no hang, no NaN in a result,
// and no output touched if an error is returned.
//
// A case is a well-formed problem changed by one to three rows of the table of mutations. Its random numbers depend on
// its number alone: `test_malformed N` runs case N by itself and prints the mutations and the outcome.
#include <csignal>
#include <ctime>

#include <unistd.h>

#include "campaign.h"
#include "malformed.hpp"

using namespace malformed;

namespace {

const uint32_t kCases = static_cast<uint32_t>(campaign_runs(10000));
constexpr double kSlowest = 20.0;  // seconds per call, under sanitizers and other load; 0.5 is typical
constexpr unsigned kHang = 540;    // seconds for the whole test

std::string text_of(const lensprof_exposure &e) {
    char text[128];
    std::snprintf(text, sizeof text, "%g EV, %g %g %g", e.ev, e.white_balance[0], e.white_balance[1],
                  e.white_balance[2]);
    return text;
}

// What is wrong with a result that was returned with OK; empty if nothing is.
std::string fault_of_result(const Case &c) {
    const auto &r = c.result;
    if (r.usable > 1 || r.converged > 1) return "usable or converged is neither 0 nor 1";
    if (!std::memchr(r.first.text, 0, sizeof r.first.text)) return "the reason does not end";
    if (!r.usable && r.first.text[0] == 0) return "not usable without a reason";
    if (lensprof_response_validate(&r.response) != LENSPROF_OK) return "the response is not monotone from 0 to 1";
    for (const auto &v : r.vignetting)
        if (lensprof_vignetting_validate(&v) != LENSPROF_OK) return "a vignetting is not positive and finite";
    if ((r.vignettings != 1 && r.vignettings != 3) || r.gamma_from < LENSPROF_GAMMA_PRIOR
        || r.gamma_from > LENSPROF_GAMMA_NONE || !(r.gamma_sigma >= -1.0 && r.gamma_sigma < 1e9))
        return "falloff curves or gamma";
    for (const auto &q : c.quality)
        for (double v : {q.ev_sigma, q.white_balance_sigma[0], q.white_balance_sigma[2], q.median_residual,
                         q.known_ev_residual, q.radius, q.grey_low, q.grey_high})
            if (!std::isfinite(v)) return "the quality of an image is not finite";
    uint32_t left_out = 0;
    for (size_t i = 0; i < c.exposures.size(); i++) {
        const bool is_left_out = std::isnan(c.exposures[i].ev);
        left_out += is_left_out;
        if (!is_left_out && lensprof_exposure_validate(&c.exposures[i]) != LENSPROF_OK)
            return "exposure " + std::to_string(i) + " is out of range: " + text_of(c.exposures[i]);
        if (c.quality[i].joined == is_left_out) return "joined contradicts the exposure";
    }
    if (left_out != r.left_out || r.reference >= c.exposures.size() || std::isnan(c.exposures[r.reference].ev))
        return "images left out, or the reference";
    if (r.equalizes > 1 || r.response_from > LENSPROF_FIT_RESPONSE_PROFILE || !(r.irradiance_spread_ev >= 0.0))
        return "equalizes, response_from or irradiance_spread_ev";
    for (double v : {r.before_rms, r.noise_levels, r.inlier_share, r.frame_share, r.image_share, r.seconds})
        if (!(v >= 0.0 && v < 1e9)) return "a figure of the residual is " + std::to_string(v);
    for (double v : {r.heldout_rms, r.heldout_median})
        if (!((v >= 0.0 && v <= 255.0) || v == LENSPROF_UNKNOWN)) return "a held-out figure is " + std::to_string(v);
    if (r.inlier_share > 1.0) return "the share of inliers is above 1";
    if (r.pairs > c.s.pairs.size() || r.components < 1 || r.components > c.exposures.size()) return "counts";
    if (r.covariance_size > LENSPROF_COVARIANCE_MAX) return "size of the covariance";
    for (uint32_t i = 0; i < r.covariance_size; i++) {
        for (uint32_t j = 0; j < r.covariance_size; j++)
            if (!std::isfinite(r.covariance[i * r.covariance_size + j])) return "the covariance is not finite";
        if (r.covariance[i * r.covariance_size + i] < 0.0) return "a variance is negative";
    }
    return {};
}

// The exposure of the reference, and of images that are fixed and not linked, must be returned unchanged.
std::string fault_of_gauge(const Case &c) {
    for (uint32_t i = 0; i < c.exposures.size(); i++) {
        const auto &image = c.s.fit_images[i];
        if (std::isnan(c.exposures[i].ev)) continue;  // left out
        bool fixed = image.ev_of == i && (i == c.options.reference || !(image.free & LENSPROF_FREE_EV));
        if (fixed && std::abs(c.exposures[i].ev - image.exposure.ev) > 1e-9)
            return "the fixed exposure of image " + std::to_string(i) + " was " + std::to_string(image.exposure.ev)
                   + " EV and is " + std::to_string(c.exposures[i].ev);
    }
    return {};
}

volatile uint32_t g_case;

void hang(int) {
    char text[64];
    int length = std::snprintf(text, sizeof text, "case %u hangs\n", g_case);
    if (write(STDERR_FILENO, text, static_cast<size_t>(length)) < 0) _exit(3);
    _exit(2);
}

double seconds_now() {
    timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// Runs one case; returns what is wrong, or an empty text.
std::string fault_of_case(uint32_t number, lensprof_status &status, Case &c, double &seconds) {
    g_case = number;
    mutate(c);
    c.error.text[0] = 0;
    double began = seconds_now();
    status = c.run();  // fills the outputs with impossible values
    seconds = seconds_now() - began;
    if (seconds > kSlowest) return "takes too long";
    if (status != LENSPROF_OK) {
        if (!c.null_error && c.error.text[0] == 0) return "an error without words";
        for (const auto &e : c.exposures)
            for (size_t b = 0; b < sizeof e; b++)
                if (reinterpret_cast<const unsigned char *>(&e)[b] != 0xFF) return "an error, but exposures changed";
        return c.held ? "an error, but a fit" : "";
    }
    std::string fault = fault_of_result(c);
    return fault.empty() ? fault_of_gauge(c) : fault;
}

void test_malformed_problems(void **) {
    std::signal(SIGALRM, hang);
    alarm(kHang);
    uint32_t faults = 0, fitted = 0;
    double total = 0.0, slowest = 0.0;
    for (uint32_t number = 0; number < kCases; number++) {
        Case c(number);
        lensprof_status status;
        double seconds = 0.0;
        std::string fault = fault_of_case(number, status, c, seconds);
        fitted += status == LENSPROF_OK;
        total += seconds;
        slowest = std::max(slowest, seconds);
        if (!fault.empty() && ++faults <= 40) print_error("case %u (%s): %s\n", number, c.what.c_str(), fault.c_str());
    }
    alarm(0);
    print_message("fitted %u of %u problems in %.1f s; slowest %.2f s; %u faults\n", fitted, kCases, total, slowest,
                  faults);
    assert_int_equal(faults, 0);
    assert_in_range(fitted, kCases / 3, kCases - kCases / 10);  // both outcomes are frequent
}

// Same input, same bytes, whatever the input.
void test_malformed_problems_repeat(void **) {
    for (uint32_t number = 0; number < kCases; number += 97) {
        Case a(number), b(number);
        mutate(a), mutate(b);
        const lensprof_status status = a.run();
        assert_int_equal(status, b.run());
        if (status != LENSPROF_OK) continue;
        a.result.seconds = b.result.seconds = 0.0;
        assert_memory_equal(&a.result, &b.result, sizeof a.result);
        assert_memory_equal(a.exposures.data(), b.exposures.data(), a.exposures.size() * sizeof a.exposures[0]);
    }
}

int tell(uint32_t number) {
    Case c(number);
    lensprof_status status;
    double seconds = 0.0;
    std::string fault = fault_of_case(number, status, c, seconds);
    std::printf("case %u: %s\n%zu images, %zu pairs; status %d %s, %.3f s\n", number, c.what.c_str(),
                c.s.fit_images.size(), c.s.pairs.size(), static_cast<int>(status), c.error.text, seconds);
    if (status == LENSPROF_OK)
        std::printf("usable %u %s, %u iterations, residual %g, noise %g\n", c.result.usable, c.result.first.text,
                    c.result.iterations, c.result.heldout_rms, c.result.noise_levels);
    std::printf("%s\n", fault.empty() ? "no fault" : fault.c_str());
    return fault.empty() ? 0 : 1;
}

}  // namespace

int main(int count, char **words) {
    if (count > 1) return tell(static_cast<uint32_t>(std::strtoul(words[1], nullptr, 10)));
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_malformed_problems),
        cmocka_unit_test(test_malformed_problems_repeat),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
