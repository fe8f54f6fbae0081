// A lens as one zip archive for an upload: report, numbers, the file for Lensfun and reduced pictures.
#include <zip.h>

#include <cctype>
#include <filesystem>
#include <memory>
#include <new>
#include <set>
#include <string_view>

#include <nlohmann/json.hpp>

#include "cli/fitting/lens_report.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/memory_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/pictures/thumbnail.hpp"

namespace lensprof {
namespace {

constexpr uint32_t picture_side = 800;
constexpr uint64_t most_bytes = uint64_t(1) << 24;  // of a reduced picture

// An archive in memory, whose entries have no time of their own.
class Archive {
public:
    Archive() : bytes_(zip_source_buffer_create(nullptr, 0, 0, nullptr)) {
        zip_ = bytes_ ? zip_open_from_source(bytes_, ZIP_TRUNCATE, nullptr) : nullptr;
        if (!zip_) throw std::bad_alloc();
        zip_source_keep(bytes_);
    }
    ~Archive() {
        if (zip_) zip_discard(zip_);
        zip_source_free(bytes_);
    }
    Archive(const Archive &) = delete;
    Archive &operator=(const Archive &) = delete;

    void add(const std::string &name, std::string bytes) {
        kept_.push_back(std::make_unique<std::string>(std::move(bytes)));
        zip_source_t *source = zip_source_buffer(zip_, kept_.back()->data(), kept_.back()->size(), 0);
        const zip_int64_t index = source ? zip_file_add(zip_, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
        if (index < 0) {
            zip_source_free(source);
            fail(name);
        }
        constexpr uint16_t first_day = (1 << 5) | 1;  // 1 January 1980, the earliest
        if (zip_file_set_dostime(zip_, static_cast<zip_uint64_t>(index), 0, first_day, 0) != 0) fail(name);
    }

    // Its bytes; nothing can be added then.
    std::string close() {
        if (zip_close(zip_) != 0) fail("the end");
        zip_ = nullptr;
        zip_stat_t state;
        if (zip_source_stat(bytes_, &state) != 0 || zip_source_open(bytes_) != 0) throw std::bad_alloc();
        std::string bytes(state.size, '\0');
        zip_source_read(bytes_, bytes.data(), bytes.size());
        zip_source_close(bytes_);
        return bytes;
    }

private:
    [[noreturn]] void fail(const std::string &name) {
        throw Failure(LENSPROF_ERROR_WRITE, name + ": cannot be put into the archive: " + zip_strerror(zip_));
    }

    zip_source_t *bytes_;
    zip_t *zip_;
    std::vector<std::unique_ptr<std::string>> kept_;  // until the archive is closed
};

std::string reduced_jpeg(const CardPicture &picture, const std::string &path) {
    ReadOptions read;
    read.max_side = picture_side;
    write_picture(path, upright_copy(read_picture(picture.file, read), 1, picture_side));
    return read_text(path, most_bytes);
}

// A name of its own for every picture, without folders, that every system can unpack.
std::string entry_name(const std::string &file, std::set<std::string> &used_names) {
    std::string stem = std::filesystem::path(file).stem().string(), lower;
    for (char &c : stem) {
        const auto code = static_cast<unsigned char>(c);
        if (code < 32 || code > 126 || std::string_view("<>:\"/\\|?*").find(c) != std::string_view::npos) c = '_';
        lower += static_cast<char>(std::tolower(code));
    }
    std::string more;
    for (int number = 2; !used_names.insert(lower + more).second; number++) more = "_" + std::to_string(number);
    return "pictures/" + stem + more + ".jpg";
}

}  // namespace

void check_bundle(const std::string &path) {
    if (lowercase_extension(path) != "zip")
        throw Failure(LENSPROF_ERROR_ARGUMENT, path + ": the bundle is a zip archive; give a name that ends in .zip");
    check_output_file(path);
}

void add_bundle(const std::string &path, LensCards cards, const std::string &command, Events &events,
                OutputFiles &outputs) {
    for (MeasuredSetting &setting : cards.settings)
        if (setting.fit) setting.fit->load_s = setting.fit->solve_s = 0.0;  // which differ between runs
    const TemporaryFolder folder;
    Archive archive;
    archive.add("report.html", lens_page(cards, command, {}));
    archive.add("lens.json", lens_json(cards).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
    archive.add("lens.csv", lens_csv(cards));
    if (!cards.lens_file_text.empty()) archive.add("lens.xml", cards.lens_file_text);
    std::set<std::string> used_names;
    uint32_t done = 0;
    for (const MeasuredSetting &setting : cards.settings)
        for (const CardPicture &picture : setting.of.pictures) {
            stop_if_cancelled();
            archive.add(entry_name(picture.file, used_names), reduced_jpeg(picture, folder.path() + "/picture.jpg"));
            events.update_items("reducing pictures", ++done, static_cast<uint32_t>(cards.given));
        }
    outputs.add(path, archive.close());
}

}  // namespace lensprof
