// COLMAP's database: features and verified matches (two_view_geometries) of its images.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <new>

#include <sqlite3.h>

#include "fit/base/joined_sets.hpp"
#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/input_file.hpp"
#include "photo/base/paths.hpp"
#include "photo/reconstruction/readers.hpp"

namespace lensprof {
namespace {

constexpr int64_t kPairBase = 2147483647;    // pair_id = kPairBase * smaller image_id + larger image_id
constexpr uint64_t kMaxFeatures = 1u << 30;  // of all images
// Verified configurations of TwoViewGeometry: all but undefined, degenerate (0, 1) and watermark (7).
constexpr const char *kVerified = "2, 3, 4, 5, 6, 8, 9";
constexpr int kWait_ms = 1000;  // waiting for a program that writes to it

// The rows of a query.
class Rows {
public:
    Rows(sqlite3 *database, const std::string &path, const std::string &query) : database_(database), path_(path) {
        check(sqlite3_prepare_v2(database, query.c_str(), -1, &statement_, nullptr) == SQLITE_OK);
    }
    ~Rows() { sqlite3_finalize(statement_); }
    Rows(const Rows &) = delete;
    Rows &operator=(const Rows &) = delete;

    bool next() {
        const int code = sqlite3_step(statement_);
        check(code == SQLITE_ROW || code == SQLITE_DONE);
        return code == SQLITE_ROW;
    }
    int64_t integer(int column) const { return sqlite3_column_int64(statement_, column); }
    std::string text(int column) const {
        const auto *text = reinterpret_cast<const char *>(sqlite3_column_text(statement_, column));
        return text ? std::string(text, static_cast<size_t>(sqlite3_column_bytes(statement_, column))) : std::string();
    }
    // An array of 4-byte numbers; NULL if it has no bytes.
    const uint8_t *bytes(int column, size_t &count) const {
        const void *blob = sqlite3_column_blob(statement_, column);
        count = static_cast<size_t>(sqlite3_column_bytes(statement_, column));
        return static_cast<const uint8_t *>(blob);
    }

private:
    void check(bool is_good) const {
        if (is_good) return;
        const int code = sqlite3_errcode(database_) & 0xFF;
        if (code == SQLITE_NOMEM) throw std::bad_alloc();
        if (code == SQLITE_BUSY || code == SQLITE_LOCKED)
            throw Failure(LENSPROF_ERROR_READ,
                          path_ + ": another program is writing to it; wait until it ends, or give a copy");
        if (code == SQLITE_CANTOPEN && path_exists(path_ + "-wal"))
            throw Failure(LENSPROF_ERROR_READ,
                          path_ + ": cannot read its changes in " + path_ + "-wal; copy both to a writable folder");
        throw Failure(LENSPROF_ERROR_READ, path_ + ": cannot be read as a COLMAP database (" + sqlite3_errmsg(database_)
                                               + "); give an intact copy");
    }

    sqlite3 *database_;
    std::string path_;
    sqlite3_stmt *statement_ = nullptr;
};

struct Close {
    void operator()(sqlite3 *database) const { sqlite3_close(database); }
};
using Database = std::unique_ptr<sqlite3, Close>;

// COLMAP leaves its databases in write-ahead log mode, in which SQLite creates two files next to a database even for
// reading. Without such a log nobody has the file open, and SQLite can treat it as immutable.
bool is_at_rest(const std::string &path) {
    constexpr size_t write_version = 18;  // byte of the header
    const std::string head = read_head(path, write_version + 1);
    return head.size() > write_version && head[write_version] == 2 && file_bytes(path + "-wal") == 0;
}

std::string address_of(const std::string &path) {
    std::string address = "file://";
    for (const char c : absolute_path(path))
        address += std::isalnum(static_cast<unsigned char>(c)) || c == '/'
                       ? std::string(1, c)
                       : format("%%%02X", unsigned(static_cast<unsigned char>(c)));
    return address + "?immutable=1";
}

// Read only, as a snapshot: a database that is still being written to is left alone.
Database open_database(const std::string &path) {
    sqlite3 *opened = nullptr;
    const int code = is_at_rest(path) ? sqlite3_open_v2(address_of(path).c_str(), &opened,
                                                        SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr)
                                      : sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READONLY, nullptr);
    Database database(opened);
    if (code != SQLITE_OK) throw Failure(LENSPROF_ERROR_READ, path + ": cannot be opened; give a readable file");
    sqlite3_busy_timeout(opened, kWait_ms);
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    Rows(opened, path, "BEGIN").next();
    return database;
}

[[noreturn]] void fail_database(const std::string &path, const std::string &problem) {
    throw Failure(LENSPROF_ERROR_READ, path + ": " + problem + "; give an intact COLMAP database");
}

struct Content {
    std::string path;
    Database database;
    Reconstruction found;
    std::map<int64_t, uint32_t> image_of;  // by image_id
    std::vector<uint64_t> first_feature;   // per image, and the end

    uint32_t image_at(int64_t id) const {
        const auto entry = image_of.find(id);
        if (entry == image_of.end())
            fail_database(path, format("refers to image %lld, which does not exist", (long long)id));
        return entry->second;
    }
    uint64_t feature_count(uint32_t image) const { return first_feature[image + 1] - first_feature[image]; }
};

void read_images(Content &content) {
    std::map<int64_t, uint32_t> camera_of;
    Rows cameras(content.database.get(), content.path, "SELECT camera_id, width, height FROM cameras");
    while (cameras.next()) {
        const int64_t width = cameras.integer(1), height = cameras.integer(2);
        if (width < 1 || height < 1 || width > max_image_side || height > max_image_side)
            fail_database(content.path,
                          "has a camera of " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
        if (!camera_of.emplace(cameras.integer(0), static_cast<uint32_t>(content.found.cameras.size())).second)
            fail_database(content.path, "has two cameras with the same id");
        content.found.cameras.push_back({static_cast<uint32_t>(width), static_cast<uint32_t>(height)});
    }
    Rows images(content.database.get(), content.path, "SELECT image_id, name, camera_id FROM images ORDER BY name");
    while (images.next()) {
        const auto camera = camera_of.find(images.integer(2));
        if (camera == camera_of.end()) fail_database(content.path, "has an image without a camera");
        if (content.found.images.size() == max_images) fail_database(content.path, "has too many images");
        if (!content.image_of.emplace(images.integer(0), static_cast<uint32_t>(content.found.images.size())).second)
            fail_database(content.path, "has two images with the same id");
        ReconstructionImage image;
        image.name = images.text(1), image.camera = camera->second;
        content.found.images.push_back(image);
    }
}

// Layout of keypoints: rows of 2 (position), 4 (position, scale, angle) or 6 floats (position, affine shape).
struct Keypoints {
    const uint8_t *bytes;
    size_t columns;

    void read(size_t row, TrackObservation &feature) const {
        float value[6] = {};
        std::memcpy(value, bytes + row * columns * sizeof(float), columns * sizeof(float));
        for (int d = 0; d < 2; d++)
            feature.xy[d] = value[d] - 0.5f;  // COLMAP: the centre of the first pixel is (.5,
                                              // .5)
        if (columns == 4) {
            const float c = value[2] * std::cos(value[3]), s = value[2] * std::sin(value[3]);
            feature.shape[0][0] = c, feature.shape[0][1] = -s, feature.shape[1][0] = s, feature.shape[1][1] = c;
        } else if (columns == 6) {
            std::memcpy(feature.shape, value + 2, sizeof feature.shape);
        }
        for (const float number : value)
            if (!std::isfinite(number)) std::fill_n(&feature.shape[0][0], 4, 0.0f);
    }
};

void check_table(const std::string &path, int64_t rows, int64_t columns, size_t bytes, const char *table) {
    if (rows < 0 || columns < 0 || rows > int64_t(kMaxFeatures) || columns > 64
        || uint64_t(rows) * uint64_t(columns) * 4 != bytes)
        fail_database(path, std::string("has ") + table + " that are truncated");
}

// Maximum content of the pages of a file; its log may add more.
uint64_t most_bytes(const std::string &path) { return file_bytes(path) + file_bytes(path + "-wal"); }

void count_features(Content &content) {
    std::vector<uint64_t> count(content.found.images.size());
    std::vector<bool> is_counted(count.size());
    uint64_t left = most_bytes(content.path);
    Rows rows(content.database.get(), content.path, "SELECT image_id, rows, cols, length(data) FROM keypoints");
    while (rows.next()) {
        check_table(content.path, rows.integer(1), rows.integer(2), static_cast<size_t>(rows.integer(3)), "keypoints");
        if (rows.integer(2) != 2 && rows.integer(2) != 4 && rows.integer(2) != 6 && rows.integer(1) > 0)
            fail_database(content.path, "has keypoints with " + std::to_string(rows.integer(2)) + " columns");
        const uint32_t image = content.image_at(rows.integer(0));
        if (is_counted[image]) fail_database(content.path, "has the keypoints of an image twice");
        const auto bytes = static_cast<uint64_t>(rows.integer(3));
        if (bytes > left) fail_database(content.path, "is too short for its keypoints");
        is_counted[image] = true, count[image] = static_cast<uint64_t>(rows.integer(1)), left -= bytes;
    }
    content.first_feature.assign(1, 0);
    for (const uint64_t features : count) content.first_feature.push_back(content.first_feature.back() + features);
    if (content.first_feature.back() > kMaxFeatures) fail_database(content.path, "has too many keypoints");
}

// Sets of features.
JoinedSets join_matches(const Content &content) {
    JoinedSets joined(content.first_feature.back());
    Rows rows(content.database.get(), content.path,
              format("SELECT pair_id, rows, cols, data FROM two_view_geometries WHERE rows > 0 AND config IN (%s)",
                     kVerified));
    while (rows.next()) {
        const int64_t id = rows.integer(0);
        const uint32_t image[2] = {content.image_at(id / kPairBase), content.image_at(id % kPairBase)};
        size_t bytes = 0;
        const uint8_t *data = rows.bytes(3, bytes);
        check_table(content.path, rows.integer(1), rows.integer(2), bytes, "matches");
        if (rows.integer(2) != 2) fail_database(content.path, "has matches that are not pairs");
        for (size_t row = 0; row < bytes / 8; row++) {
            uint32_t feature[2];
            std::memcpy(feature, data + 8 * row, 8);
            for (const int side : {0, 1})
                if (feature[side] >= content.feature_count(image[side]))
                    fail_database(content.path, "matches keypoint " + std::to_string(feature[side]) + " of "
                                                    + content.found.images[image[side]].name + ", which has "
                                                    + std::to_string(content.feature_count(image[side])));
            joined.join(static_cast<uint32_t>(content.first_feature[image[0]] + feature[0]),
                        static_cast<uint32_t>(content.first_feature[image[1]] + feature[1]));
        }
    }
    return joined;
}

// Reads the keypoints of a row of image_id, cols, data, already checked by count_features.
Keypoints keypoints_of(const Rows &rows, const Content &content) {
    size_t bytes = 0;
    const Keypoints keypoints{rows.bytes(2, bytes), static_cast<size_t>(rows.integer(1))};
    const uint64_t count = content.feature_count(content.image_at(rows.integer(0)));
    check_table(content.path, static_cast<int64_t>(count), rows.integer(1), bytes, "keypoints");
    return keypoints;
}

// Observations of every feature connected to another by a match; points are numbered by their first feature.
void take_tracks(Content &content, JoinedSets joined) {
    const size_t count = content.first_feature.back();
    std::vector<bool> is_matched(count);
    for (uint32_t n = 0; n < count; n++)
        if (const uint32_t root = joined.of(n); root != n) is_matched[root] = is_matched[n] = true;
    Rows rows(content.database.get(), content.path, "SELECT image_id, cols, data FROM keypoints");
    while (rows.next()) {
        const uint32_t image = content.image_at(rows.integer(0));
        const Keypoints keypoints = keypoints_of(rows, content);
        content.found.has_rotations = content.found.has_rotations || keypoints.columns > 2;
        for (uint64_t n = content.first_feature[image]; n < content.first_feature[image + 1]; n++) {
            if (!is_matched[n]) continue;
            if (content.found.observations.size() == max_observations)
                fail_database(content.path, "has too many matched keypoints");
            TrackObservation observation;
            observation.point = joined.of(static_cast<uint32_t>(n)), observation.image = image;
            observation.feature = static_cast<uint32_t>(n - content.first_feature[image]);
            keypoints.read(observation.feature, observation);
            content.found.observations.push_back(observation);
        }
    }
}

Content open_content(const std::string &path) {
    Content content{path, open_database(path), {}, {}, {}};
    read_images(content);
    count_features(content);
    return content;
}

}  // namespace

bool is_database(const std::string &path) { return is_regular_file(path) && read_head(path, 15) == "SQLite format 3"; }

bool is_colmap_database(const std::string &path) {
    if (!is_database(path)) return false;
    try {
        const Database database = open_database(path);
        Rows tables(database.get(), path,
                    "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name IN ('cameras', 'images', "
                    "'keypoints', 'two_view_geometries')");
        return tables.next() && tables.integer(0) == 4;
    } catch (const Failure &) {
        return true;  // possibly; reading it reports the error
    }
}

Reconstruction read_colmap_database(const std::string &path) {
    Content content = open_content(path);
    content.found.kind = "COLMAP database", content.found.path = path;
    take_tracks(content, join_matches(content));
    clean_tracks(content.found);
    return std::move(content.found);
}

bool take_shapes(const std::string &database, Reconstruction &model) {
    Content content = open_content(database);
    std::map<std::string, uint32_t> by_name;
    for (uint32_t i = 0; i < content.found.images.size(); i++) by_name[content.found.images[i].name] = i;
    std::vector<std::vector<size_t>> of_image(content.found.images.size());
    for (size_t n = 0; n < model.observations.size(); n++) {
        const auto image = by_name.find(model.images[model.observations[n].image].name);
        if (image == by_name.end()) return false;
        if (model.observations[n].feature >= content.feature_count(image->second)) return false;
        of_image[image->second].push_back(n);
    }
    std::vector<std::array<float, 4>> shapes(model.observations.size());
    Rows rows(content.database.get(), database, "SELECT image_id, cols, data FROM keypoints");
    bool has_shapes = false;
    while (rows.next()) {
        const Keypoints keypoints = keypoints_of(rows, content);
        has_shapes = has_shapes || keypoints.columns > 2;
        for (const size_t n : of_image[content.image_at(rows.integer(0))]) {
            TrackObservation feature;
            keypoints.read(model.observations[n].feature, feature);
            for (int d = 0; d < 2; d++)
                if (!(std::fabs(feature.xy[d] - model.observations[n].xy[d]) < 0.1f)) return false;
            std::memcpy(shapes[n].data(), feature.shape, sizeof feature.shape);
        }
    }
    for (size_t n = 0; n < shapes.size(); n++)
        std::memcpy(model.observations[n].shape, shapes[n].data(), sizeof shapes[n]);
    model.has_rotations = has_shapes;
    return true;
}

}  // namespace lensprof
