/* clipping.hpp - what a sensor did not record cannot be made like another exposure. */
#ifndef LENSPROF_CLI_CLIPPING_HPP
#define LENSPROF_CLI_CLIPPING_HPP

#include <string>

#include "picture.hpp"
#include "run.hpp"

namespace lensprof {

/* Share of the pixels that are white (above 250 of 255) in some channel. */
double white_share(const Picture &picture);

/* Warns of what no exposure brings back when a frame changes from its own exposure to the wanted one: white that becomes
 * grey, and noise of what was dark. */
void warn_of_limits(const std::string &file, double own_ev, double wanted_ev, double white_share, Streams &streams);

}  // namespace lensprof

#endif
