#include "cli/page/page.hpp"

#include <algorithm>
#include <cctype>

#include <lensprof/base.h>
#include <nlohmann/json.hpp>

#include "photo/base/failure.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/jpeg_bytes.hpp"

namespace lensprof {
namespace {

using Json = nlohmann::ordered_json;

// The template with a text instead of each mark; marks within a text are text.
std::string filled(const std::string &page, const std::vector<std::pair<std::string, std::string>> &texts) {
    std::string out;
    for (size_t position = 0; position < page.size();) {
        const auto mark = std::find_if(texts.begin(), texts.end(), [&](const auto &text) {
            return page.compare(position, text.first.size(), text.first) == 0;
        });
        out += mark == texts.end() ? std::string(1, page[position]) : mark->second;
        position += mark == texts.end() ? 1 : mark->first.size();
    }
    return out;
}

std::string html_text(const std::string &text) {
    std::string escaped;
    for (const char c : text)
        escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '"' ? "&quot;" : std::string(1, c);
    return escaped;
}

// No text inside can end the script element: < stands in strings alone, where \u003c is the same.
std::string script_json(const Json &data) {
    const std::string text = data.dump(-1, ' ', true, Json::error_handler_t::replace);
    std::string escaped;
    escaped.reserve(text.size());
    for (const char c : text) escaped += c == '<' ? "\\u003c" : std::string(1, c);
    return escaped;
}

// RFC 4648.
std::string base64(const std::vector<uint8_t> &bytes) {
    constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t available = std::min<size_t>(3, bytes.size() - i);
        uint32_t group = 0;
        for (size_t k = 0; k < 3; k++) group = group << 8 | (k < available ? bytes[i + k] : 0u);
        for (size_t k = 0; k < 4; k++) text += k <= available ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

}  // namespace

Json new_page(const std::string &kind, const std::string &title, const std::string &subtitle,
              const std::string &command) {
    return {{"kind", kind},
            {"title", title},
            {"subtitle", subtitle},
            {"program", std::string("lensprof ") + lensprof_version()},
            {"command", command}};
}

Json page_verdict(bool usable, bool equalizes, const Verdict &verdict, const std::vector<std::string> &warnings) {
    Json details = Json::array();
    for (const uint32_t severity : {LENSPROF_SEVERITY_REFUSAL, LENSPROF_SEVERITY_WARNING})
        for (const std::string &text : verdict.texts(severity)) {
            const bool is_repeated = std::any_of(warnings.begin(), warnings.end(), [&](const std::string &warning) {
                return warning.find(text) != std::string::npos;
            });
            if (!is_repeated) details.push_back(text);
        }
    for (const std::string &warning : warnings) details.push_back(warning);
    const bool is_good = usable && details.empty();
    const char *headline = is_good  ? "Usable: a profile that later pictures can rely on."
                           : usable ? "Usable, with a warning."
                           : equalizes
                               ? "These pictures differ less after correction, but this is not a profile to store."
                               : "Not usable: do not correct pictures with this result.";
    return {{"level", is_good               ? "good"
                      : usable || equalizes ? "warn"
                                            : "bad"},
            {"headline", headline},
            {"details", details},
            {"notes", verdict.texts(LENSPROF_SEVERITY_NOTE)}};
}

std::string page_of(const Json &page) {
    const std::string title = page["title"].get<std::string>() + " – lensprof";
    const std::string name = Json::parse(Json(title).dump(-1, ' ', false, Json::error_handler_t::replace));  // UTF-8
    return filled(page_html, {{"@TITLE@", html_text(name)},
                              {"@STYLE@", page_style},
                              {"@SCRIPT@", page_script},
                              {"@DATA@", script_json(page)}});
}

Json view_json(const std::string &name, const Picture &before, const Picture &after) {
    constexpr int quality = 78;
    const auto url = [](const Picture &picture) {
        return "data:image/jpeg;base64," + base64(jpeg_bytes(picture, quality));
    };
    return {{"name", name}, {"before", url(before)}, {"after", url(after)}};
}

uint32_t view_side(size_t pictures) {
    return pictures <= 24 ? 720 : pictures <= 60 ? 480 : pictures <= 160 ? 280 : pictures <= 600 ? 150 : 96;
}

std::string views_note(size_t shown_count, size_t picture_count) {
    return std::to_string(shown_count) + " of " + std::to_string(picture_count) + " pictures, evenly spaced.";
}

void check_page_name(const std::string &path) {
    std::string end = path.substr(std::min(path.size(), path.find_last_of('.')));
    for (char &c : end) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (end != ".html" && end != ".htm")
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": a report is an HTML file; give a name that ends in .html");
    constexpr const char *generator = "content=\"lensprof\"";  // of page.html
    if (is_regular_file(path) && file_bytes(path) > 0 && read_head(path, 512).find(generator) == std::string::npos)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      path + ": already exists and is not a report of lensprof; give another name");
}

}  // namespace lensprof
