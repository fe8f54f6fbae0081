// Reports as one HTML file that needs no network: data as JSON, pictures as data URLs, charts drawn by its own script.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "cli/pictures/picture.hpp"

namespace lensprof {

extern const char *const page_html, *const page_style, *const page_script;  // page.html, style.css, chart.js, report.js

// The bytes of the page; `data` is what report.js reads.
std::string page_of(const std::string &title, const nlohmann::ordered_json &data);

// A JPEG of an 8 bit grey or RGB picture, as a data URL.
std::string data_url(const Picture &picture, int quality);

// Failure (usage) unless the name ends in .html or .htm, and if it is of an existing file that is not a report.
void check_page_name(const std::string &path);

}  // namespace lensprof
