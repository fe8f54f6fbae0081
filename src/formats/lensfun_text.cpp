// Texts of Lensfun databases.
#include <algorithm>

#include "formats/lensfun.hpp"

namespace lensprof {
namespace {

bool begins_with(const std::string &text, const std::string &prefix) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    const auto same = [&](char a, char b) { return lower(a) == lower(b); };
    return text.size() >= prefix.size() && std::equal(prefix.begin(), prefix.end(), text.begin(), same)
           && (text.size() == prefix.size() || text[prefix.size()] == ' ' || prefix.empty());
}

}  // namespace

const char *lensfun_origin(std::string_view text) {
    return text.find(kLensfunRemark) == text.npos ? "Lensfun database, CC BY-SA 3.0" : "";
}

void check_lensfun_version(const XmlText &xml) {
    const pugi::xml_attribute version = xml.root().attribute("version");
    if (!version) return;  // the oldest databases do not have it
    double value = 0.0;
    const size_t line = xml.line_of(xml.root());
    if (!read_whole(version.value(), 0, 1e9, value))
        fail_at_line(line, "the version is " + in_quotes(version.value()) + ", not a number; correct the file");
    if (value > 2)
        fail_at_line(line, "a database of version " + in_quotes(version.value()) + "; lensprof reads versions up to 2",
                     LENSPROF_ERROR_UNSUPPORTED);
}

std::string lensfun_text(const pugi::xml_node &parent, const char *name) {
    pugi::xml_node best;
    int best_rank = 0;
    for (pugi::xml_node child : parent.children(name)) {
        const std::string_view lang = child.attribute("lang").value();
        const int rank = lang.empty() ? 3 : lang == "en" ? 2 : 1;
        if (rank > best_rank) best = child, best_rank = rank;
    }
    return one_line(best.child_value());
}

std::string lensfun_lens_name(const pugi::xml_node &lens) {
    const std::string maker = lensfun_text(lens, "maker"), model = lensfun_text(lens, "model");
    return model.empty() || maker.empty() || begins_with(model, maker) ? model : maker + " " + model;
}

bool is_fixed_mount(const std::string &mount) { return !mount.empty() && mount[0] >= 'a' && mount[0] <= 'z'; }

}  // namespace lensprof
