#include "photo/cards/card_units.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <regex>
#include <set>

#include "photo/base/format.hpp"
#include "photo/base/paths.hpp"

namespace lensprof {
namespace {

namespace fs = std::filesystem;

constexpr const char *unit_mark = "{unit}";

// The folder of the unit: that given, or its subfolder; empty for a picture directly in the only folder given.
std::string unit_folder(const NamedPicture &named, bool is_only_folder) {
    fs::path folder = fs::path(named.file).parent_path();
    if (!named.in_folder) return folder.lexically_normal().string();
    if (named.subfolder.empty()) return is_only_folder ? std::string() : folder.lexically_normal().string();
    const fs::path subfolder(named.subfolder);
    for (auto deeper = std::next(subfolder.begin()); deeper != subfolder.end(); ++deeper) folder = folder.parent_path();
    return folder.lexically_normal().string();
}

// The folder that was given, of a picture in it or in its subfolders.
std::string given_folder(const NamedPicture &named) {
    fs::path folder = fs::path(named.file).parent_path();
    const fs::path subfolder(named.subfolder);
    for (const fs::path &part : subfolder) folder = part.empty() ? folder : folder.parent_path();
    return folder.string();
}

// The name of a folder, or its path where another has the same name.
std::string folder_name(const std::string &folder, const std::set<std::string> &folders) {
    const fs::path name = fs::path(folder).filename();
    const auto alike = std::count_if(folders.begin(), folders.end(),
                                     [&](const std::string &other) { return fs::path(other).filename() == name; });
    return alike == 1 ? name.string() : folder;
}

std::set<std::string> given_folders(const std::vector<NamedPicture> &named) {
    std::set<std::string> given;
    for (const NamedPicture &one : named)
        if (one.in_folder) given.insert(given_folder(one));
    return given;
}

// Units per file by their folders. Several folders given are a unit each; subfolders would be mixed with them.
std::vector<std::string> units_by_folder(const std::vector<NamedPicture> &named) {
    const std::set<std::string> given = given_folders(named);
    std::set<std::string> folders;
    std::vector<std::string> of_file;
    for (const NamedPicture &one : named) {
        if (given.size() > 1 && !one.subfolder.empty())
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          one.file + ": of several folders given, each is a unit, and has no subfolders; give the one "
                                     "folder whose subfolders are the units");
        of_file.push_back(unit_folder(one, given.size() == 1));
        if (!of_file.back().empty()) folders.insert(of_file.back());
    }
    for (std::string &folder : of_file)
        if (!folder.empty()) folder = folder_name(folder, folders);
    return of_file;
}

// A serial number too long for its field may be that of two units.
std::string serial_of(const CardPicture &picture) {
    const std::vector<std::string> &cut = picture.metadata.cut;
    return std::find(cut.begin(), cut.end(), "unit") == cut.end() ? picture.metadata.key.unit : "";
}

std::regex regex_of(const std::string &pattern) {
    std::string text;
    for (size_t i = 0; i < pattern.size(); i++) {
        if (pattern.compare(i, std::char_traits<char>::length(unit_mark), unit_mark) == 0)
            text += "(.+)", i += std::char_traits<char>::length(unit_mark) - 1;
        else if (pattern[i] == '*')
            text += ".*";
        else if (pattern[i] == '?')
            text += '.';
        else
            text += std::string(std::isalnum(static_cast<unsigned char>(pattern[i])) ? "" : "\\") + pattern[i];
    }
    return std::regex(text);
}

// The longest text that fits: a name that may be read in two ways splits a unit, which is seen, and mixes none.
std::string unit_in_name(const std::regex &pattern, const std::string &file) {
    std::smatch parts;
    const std::string name = fs::path(file).filename().string(), stem = fs::path(file).stem().string();
    if (std::regex_match(name, parts, pattern) || std::regex_match(stem, parts, pattern)) return parts[1];
    return {};
}

const char *missing_text(UnitRule::By by) {
    switch (by) {
    case UnitRule::By::folder:
        return ": is not in a folder of a unit, but directly in that of all; move it to the unit's";
    case UnitRule::By::serial:
        return ": EXIF states no serial number, so its unit is unknown; sort the pictures in a folder per unit";
    default: return ": its name does not fit the pattern of units; rename it, or change the pattern";
    }
}

// The automatic choice: serial numbers or folders, whichever all pictures have; with both, they must agree.
UnitRule::By choice_of(const std::vector<CardPicture> &pictures, const std::vector<std::string> &folders) {
    const auto has_serial = [](const CardPicture &picture) { return !serial_of(picture).empty(); };
    const auto has_folder = [&](const CardPicture &picture) { return !folders[picture.index].empty(); };
    const bool have_serials = std::all_of(pictures.begin(), pictures.end(), has_serial),
               have_folders = std::all_of(pictures.begin(), pictures.end(), has_folder);
    if (!have_serials && !have_folders)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      "neither folders nor serial numbers tell the units of all pictures apart; give each unit a "
                      "folder, or state where names have it: "
                          + option_name("units_by_name"));
    if (!have_serials) return UnitRule::By::folder;
    if (!have_folders) return UnitRule::By::serial;
    std::map<std::string, std::string> serials, folders_of;
    for (const CardPicture &picture : pictures) {
        const std::string serial = serial_of(picture), &folder = folders[picture.index];
        if (serials.emplace(folder, serial).first->second != serial
            || folders_of.emplace(serial, folder).first->second != folder)
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          picture.file + ": folders and serial numbers state different units; choose with "
                              + option_name("units_by"));
    }
    return UnitRule::By::folder;
}

// Units whose pictures state two serial numbers are two cameras, and are not measured.
void drop_mixed(std::vector<CardPicture> &pictures, std::vector<LeftOutCard> &left_out) {
    std::map<std::string, const CardPicture *> first;
    std::map<std::string, std::string> mixed;
    for (const CardPicture &picture : pictures) {
        if (serial_of(picture).empty()) continue;
        const CardPicture &other = *first.emplace(picture.unit, &picture).first->second;
        if (serial_of(other) != serial_of(picture))
            mixed[picture.unit] = "unit " + picture.unit + " has the serial numbers " + serial_of(other) + " ("
                                  + other.file + ") and " + serial_of(picture) + " (" + picture.file
                                  + "); sort the pictures of two cameras";
    }
    const auto is_kept = [&](const CardPicture &picture) { return mixed.count(picture.unit) == 0; };
    const auto end = std::stable_partition(pictures.begin(), pictures.end(), is_kept);
    for (auto picture = end; picture != pictures.end(); ++picture)
        left_out.push_back({picture->file, mixed[picture->unit]});
    pictures.erase(end, pictures.end());
}

// A serial number in two units, or a unit in two folders: measured by the rule, which the note repeats.
void note_doubles(UnitRule::By by, const std::vector<CardPicture> &pictures, Events &events) {
    std::map<std::string, std::string> first;
    std::set<std::string> noted;
    for (const CardPicture &picture : pictures) {
        const std::string serial = serial_of(picture), folder = fs::path(picture.file).parent_path().string();
        if (serial.empty()) continue;
        const std::string &own = by == UnitRule::By::serial ? folder : picture.unit,
                          &other = first.emplace(serial, own).first->second;
        if (other == own || !noted.insert(serial).second) continue;
        events.note("", "serial number " + serial + " is that of pictures in " + other + " and " + own
                            + (by == UnitRule::By::serial ? ": measured as one unit" : ": measured as two units"));
    }
}

std::string without_end(const fs::path &folder) {
    const fs::path normal = folder.lexically_normal();
    return (normal.has_filename() ? normal : normal.parent_path()).string();
}

// The folders of units: the subfolders of the only folder, or the folders given.
std::set<std::string> unit_folders(const std::vector<std::string> &names) {
    std::set<std::string> given, folders;
    for (const std::string &name : names)
        if (is_folder(name)) given.insert(without_end(name));
    if (given.size() != 1) return given;
    std::error_code ignored;  // a folder that cannot be listed was reported when its pictures were looked for
    for (const fs::directory_entry &entry : fs::directory_iterator(*given.begin(), ignored))
        if (is_folder(entry.path().string()) && entry.path().filename().string().front() != '.')
            folders.insert(without_end(entry.path()));
    return folders;
}

}  // namespace

std::vector<UnitWithoutPictures> units_without_pictures(const UnitRule &rule, const std::vector<std::string> &names,
                                                        const std::vector<CardPicture> &pictures,
                                                        const std::vector<LeftOutCard> &left_out) {
    std::vector<UnitWithoutPictures> missing;
    if (rule.by != UnitRule::By::folder && rule.by != UnitRule::By::automatic) return missing;
    std::set<std::string> units;
    for (const CardPicture &picture : pictures) units.insert(picture.unit);
    const std::set<std::string> folders = unit_folders(names);
    const auto is_unit = [&](const std::string &folder) { return units.count(folder_name(folder, folders)) > 0; };
    if (std::none_of(folders.begin(), folders.end(), is_unit)) return missing;  // serial numbers
    for (const std::string &folder : folders) {
        if (is_unit(folder)) continue;
        const auto is_below = [&](const LeftOutCard &card) {
            const std::string path = fs::path(card.file).lexically_normal().string();
            return path == folder || path.rfind(folder + "/", 0) == 0;
        };
        const auto first = std::find_if(left_out.begin(), left_out.end(), is_below);
        missing.push_back(
            {folder_name(folder, folders), first == left_out.end() ? folder + ": no picture in it" : first->reason});
    }
    return missing;
}

bool is_unit_pattern(const std::string &pattern) {
    const size_t mark = pattern.find(unit_mark);
    return mark != std::string::npos && pattern.find(unit_mark, mark + 1) == std::string::npos
           && pattern.find('/') == std::string::npos;
}

std::vector<std::string> paths_without_units(const UnitRule &rule, const std::vector<NamedPicture> &named) {
    const bool is_only_folder = given_folders(named).size() == 1;
    std::vector<std::string> paths;
    for (const NamedPicture &one : named) {
        const fs::path file = fs::path(one.file).lexically_normal();
        const std::string folder = unit_folder(one, is_only_folder);
        const std::string name = file.filename().string();
        if (rule.by == UnitRule::By::serial || (rule.by != UnitRule::By::name && folder.empty()))
            paths.push_back(one.file);
        else if (rule.by != UnitRule::By::name)
            paths.push_back((fs::path(folder).parent_path() / "-" / file.lexically_relative(folder)).string());
        else if (const std::string unit = unit_in_name(regex_of(rule.pattern), one.file); !unit.empty())
            paths.push_back(
                (file.parent_path() / std::string(name).replace(name.find(unit), unit.size(), "-")).string());
        else
            paths.push_back(one.file);
    }
    return paths;
}

std::vector<LeftOutCard> assign_units(const UnitRule &rule, const std::vector<NamedPicture> &named,
                                      std::vector<CardPicture> &pictures, Events &events) {
    const bool needs_folders = rule.by == UnitRule::By::folder || rule.by == UnitRule::By::automatic;
    const std::vector<std::string> folders = needs_folders ? units_by_folder(named) : std::vector<std::string>();
    const UnitRule::By by = rule.by == UnitRule::By::automatic ? choice_of(pictures, folders) : rule.by;
    const std::regex pattern = by == UnitRule::By::name ? regex_of(rule.pattern) : std::regex();
    if (rule.by == UnitRule::By::automatic)
        events.note("", by == UnitRule::By::serial ? "units by the serial numbers in EXIF" : "units by their folders");
    std::vector<LeftOutCard> left_out;
    for (CardPicture &picture : pictures) {
        picture.unit = by == UnitRule::By::folder   ? folders[picture.index]
                       : by == UnitRule::By::serial ? serial_of(picture)
                                                    : unit_in_name(pattern, picture.file);
        if (picture.unit.empty()) left_out.push_back({picture.file, picture.file + missing_text(by)});
    }
    pictures.erase(std::remove_if(pictures.begin(), pictures.end(),
                                  [](const CardPicture &picture) { return picture.unit.empty(); }),
                   pictures.end());
    drop_mixed(pictures, left_out);
    note_doubles(by, pictures, events);
    return left_out;
}

}  // namespace lensprof
