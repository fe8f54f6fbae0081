// The report of a folder as a web page (cli/page): what `calibrate --report` writes.
#pragma once

#include "photo/folder/corrections.hpp"

namespace lensprof {

// The bytes of the page. `summary` is calibrate.json, `command` the command line. A run that found everything done
// gives the same page.
std::string folder_page(const Inputs &inputs, const Panoramas &panoramas, const CorrectedPictures &pictures,
                        const Json &summary, const std::string &command, Events &progress);

}  // namespace lensprof
