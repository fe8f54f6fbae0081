// Invariants of a reconstruction that was read, and of the failure if it cannot be read.
#pragma once

#include "reconstruction_files.hpp"

namespace reconstruction_checks {

using namespace reconstruction_files;

using Read = std::function<Reconstruction()>;

inline void assert_place(const TrackObservation &own, double x, double y) {
    assert_close(own.xy[0], x, 1e-5);
    assert_close(own.xy[1], y, 1e-5);
}

inline void assert_shape(const TrackObservation &own, std::array<double, 4> shape) {
    for (size_t n = 0; n < 4; n++) assert_close(own.shape[n / 2][n % 2], shape[n], 1e-5);
}

inline void assert_centre(const ReconstructionImage &image, double x, double y, double z) {
    assert_true(image.has_centre);
    assert_close(image.centre[0], x, 1e-12);
    assert_close(image.centre[1], y, 1e-12);
    assert_close(image.centre[2], z, 1e-12);
}

inline void assert_unreadable(const std::string &path, const std::string &part, const Read &read) {
    const std::string text = failure_of(LENSPROF_ERROR_READ, [&] { read(); });
    if (text.find(path) == std::string::npos) fail_msg("'%s' does not name %s", text.c_str(), path.c_str());
    if (text.find(part) == std::string::npos) fail_msg("'%s' does not contain '%s'", text.c_str(), part.c_str());
}

// Cuts a file at every `step`-th byte: the result must be valid, or a Failure that names its folder.
inline void cut_everywhere(const std::string &path, size_t step, const Read &read) {
    const Bytes whole = load(path);
    size_t failures = 0;
    for (size_t bytes = 0; bytes < whole.size(); bytes += step) {
        save_anew(path, Bytes(whole.begin(), whole.begin() + long(bytes)));
        try {
            read();
        } catch (const Failure &failure) {
            failures++;
            if (failure.group() != LENSPROF_ERROR_READ && failure.group() != LENSPROF_ERROR_NOT_USABLE)
                fail_msg("status %d: %s", int(failure.status), failure.what());
            if (!std::strstr(failure.what(), folder.c_str())) fail_msg("no file name in: %s", failure.what());
        }
    }
    assert_true(failures * 2 > whole.size() / step);
    save_anew(path, whole);
    read();
}

}  // namespace reconstruction_checks
