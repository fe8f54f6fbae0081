// Reports as one HTML file that needs no network: data as JSON, pictures as data URLs, charts drawn by its own script.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "cli/pictures/picture.hpp"

namespace lensprof {

extern const char *const page_html, *const page_style, *const page_script;  // page.html, style.css, chart.js, report.js

// The frame of every page: kind ("fit", "profile", "database"), title, subtitle, program, and the command that made it.
nlohmann::ordered_json new_page(const std::string &kind, const std::string &title, const std::string &subtitle,
                                const std::string &command);

// The verdict of a result: the text of its verdict, unless a warning repeats it, and the warnings. A result that is not
// usable may still correct its own pictures (`evens`).
nlohmann::ordered_json page_verdict(bool usable, bool evens, const std::string &text,
                                    const std::vector<std::string> &warnings);

// The bytes of the page; `page` is what report.js reads.
std::string page_of(const nlohmann::ordered_json &page);

// A JPEG of an 8 bit grey or RGB picture, as a data URL.
std::string data_url(const Picture &picture, int quality);

// Failure (usage) unless the name ends in .html or .htm, and if it is of an existing file that is not a report.
void check_page_name(const std::string &path);

}  // namespace lensprof
