// Common parts of the tests of `calibrate`.
#pragma once

#include "cli_runs.hpp"
#include "photo/registration/registration.hpp"

namespace calibrate_runs {

using namespace cli_runs;

inline void simulate(const std::string &name, const Words &more) {
    render(name, Words{"--set", "noise=1", "--size", "480x360", "--exif"} + more);
}

inline bool is_missing() {
    if (can_register()) return false;
    simulate("none", {"--images", "2"});
    const Outcome refused = run_words({"calibrate", work("none"), "-o", work("out"), "--no-store"});
    assert_int_equal(refused.code, usage);
    assert_true(contains(refused.err, "built without OpenCV"));
    assert_false(fs::exists(work("out")));
    return true;
}

inline Words calibrated(const std::string &input, const Words &more = {}) {
    return Words{"calibrate", input, "-o", work("out"), "--db", work("p.db"), "--json"} + more;
}

// Checks what this run did: registered, fitted, corrected.
inline void assert_now(const Json &json, bool registered, int fitted, int corrected) {
    const Json now = {{"registered", registered}, {"fitted", fitted}, {"corrected", corrected}};
    if (json["now"] != now) fail_msg("did %s, not %s", json["now"].dump().c_str(), now.dump().c_str());
}

}  // namespace calibrate_runs
