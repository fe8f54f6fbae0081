#include "cli/correct/exposure_limits.hpp"

#include "cli/program/message.hpp"
#include "photo/base/format.hpp"

namespace lensprof {

void warn_of_limits(const std::string &file, double own_ev, double wanted_ev, double white, Streams &streams) {
    constexpr double darker = -0.1, much_brighter = 3.0, min_reported_share = 0.002;  // EV; share
    const double change = wanted_ev - own_ev;
    if (change < darker && white > min_reported_share)
        warn(streams,
             file
                 + format(": %.1f %% of it is clipped in some channel and turns grey or coloured, because it becomes "
                          "%.1f EV darker; use --to brightest to keep white",
                          100.0 * white, -change));
    if (change > much_brighter)
        warn(streams, file + format(": becomes %.1f EV brighter, which amplifies the noise of its dark parts", change));
}

}  // namespace lensprof
