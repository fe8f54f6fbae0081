// Reports as one HTML file that needs no network: data as JSON, pictures as data URLs, charts drawn by its own script.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "photo/pictures/picture.hpp"
#include "photo/report/verdict.hpp"

namespace lensprof {

extern const char *const page_html, *const page_style, *const page_script;  // page.html, style.css, chart.js, report.js

// The frame of every page: kind ("fit", "card", "folder", "profile", "database"), title, subtitle, program, and the
// command that made it.
nlohmann::ordered_json new_page(const std::string &kind, const std::string &title, const std::string &subtitle,
                                const std::string &command);

// The verdict of a result: its refusals and warnings, unless one of `warnings`, which the command printed, repeats
// them; these; and the notes. A result that is not usable may still correct its own pictures (`equalizes`).
nlohmann::ordered_json page_verdict(bool usable, bool equalizes, const Verdict &verdict,
                                    const std::vector<std::string> &warnings);

// The bytes of the page; `page` is what report.js reads.
std::string page_of(const nlohmann::ordered_json &page);

// A picture before and after correction, both 8 bit grey or RGB.
nlohmann::ordered_json view_json(const std::string &name, const Picture &before, const Picture &after);

// The longer side in pixels of each view on a page of so many pictures; a page has at most `max_views`. 2000 textured
// pictures take 13 MB.
uint32_t view_side(size_t pictures);
constexpr size_t max_views = 2000;

// What a page states if it shows only some of the pictures.
std::string views_note(size_t shown_count, size_t picture_count);

// Failure (usage) unless the name ends in .html or .htm, and if it is of an existing file that is not a report.
void check_page_name(const std::string &path);

}  // namespace lensprof
