// Small files of structure-from-motion programs, written according to the descriptions of their formats, independent of
// the program.
#pragma once

#include <array>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include <sqlite3.h>

#include "photo/reconstruction/readers.hpp"

#include "picture_files.hpp"

namespace reconstruction_files {

using namespace picture_files;

// Replaces an existing file. Truncating and rewriting it instead would flush it to the disk immediately, which is slow.
inline void save_anew(const std::string &path, const Bytes &bytes) {
    fs::remove(path);
    save(path, bytes);
}

inline void save_text(const std::string &path, const std::string &text) {
    save_anew(path, Bytes(text.begin(), text.end()));
}

inline std::string text_of(const std::string &path) {
    const Bytes bytes = load(path);
    return std::string(bytes.begin(), bytes.end());
}

inline std::string replaced(std::string text, const std::string &part, const std::string &by) {
    const size_t at = text.find(part);
    if (at == std::string::npos) fail_msg("nothing has '%s'", part.c_str());
    return text.replace(at, part.size(), by);
}

inline std::string with_crlf(const std::string &text) {
    std::string out;
    for (const char c : text) out += c == '\n' ? std::string("\r\n") : std::string(1, c);
    return out;
}

// A database that stays open until this object is destroyed.
class OpenDatabase {
public:
    explicit OpenDatabase(const std::string &path) {
        assert_int_equal(sqlite3_open(path.c_str(), &database_), SQLITE_OK);
        run("PRAGMA synchronous=OFF");
    }
    OpenDatabase(const OpenDatabase &) = delete;
    OpenDatabase &operator=(const OpenDatabase &) = delete;
    ~OpenDatabase() { sqlite3_close(database_); }

    void run(const std::string &sql) {
        char *message = nullptr;
        if (sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, &message) != SQLITE_OK)
            fail_msg("%s: %s", sql.c_str(), message);
    }

private:
    sqlite3 *database_ = nullptr;
};

inline void run_sql(const std::string &path, const std::string &sql) { OpenDatabase(path).run(sql); }

// Little-endian numbers as an SQL literal.
template <class Number>
std::string blob_of(const std::vector<Number> &numbers) {
    std::string text = "x'";
    for (const Number &number : numbers) {
        uint8_t bytes[sizeof number];
        std::memcpy(bytes, &number, sizeof number);
        for (const uint8_t byte : bytes) {
            text += "0123456789abcdef"[byte >> 4];
            text += "0123456789abcdef"[byte & 15];
        }
    }
    return text + "'";
}

inline std::string keypoints_sql(int image, int columns, const std::vector<float> &values) {
    return "INSERT INTO keypoints VALUES(" + std::to_string(image) + ","
           + std::to_string(values.size() / size_t(columns)) + "," + std::to_string(columns) + "," + blob_of(values)
           + ");";
}

// Matches between the images of smaller and larger number, by the numbers of their features.
inline std::string matches_sql(int64_t smaller, int64_t larger, int configuration,
                               const std::vector<uint32_t> &features) {
    return "INSERT INTO two_view_geometries(pair_id,rows,cols,data,config) VALUES("
           + std::to_string(smaller * 2147483647 + larger) + "," + std::to_string(features.size() / 2) + ",2,"
           + blob_of(features) + "," + std::to_string(configuration) + ");";
}

// The tables of COLMAP 3.12, with rigs and frames.
constexpr const char *colmap_schema =
    "CREATE TABLE rigs(rig_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, ref_sensor_id INTEGER NOT NULL,"
    " ref_sensor_type INTEGER NOT NULL);"
    "CREATE TABLE frames(frame_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, rig_id INTEGER NOT NULL);"
    "CREATE TABLE cameras(camera_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, model INTEGER NOT NULL,"
    " width INTEGER NOT NULL, height INTEGER NOT NULL, params BLOB, prior_focal_length INTEGER NOT NULL);"
    "CREATE TABLE images(image_id INTEGER PRIMARY KEY AUTOINCREMENT NOT NULL, name TEXT NOT NULL,"
    " camera_id INTEGER NOT NULL, CONSTRAINT image_id_check CHECK(image_id >= 0 and image_id < 2147483647));"
    "CREATE TABLE keypoints(image_id INTEGER NOT NULL, rows INTEGER NOT NULL, cols INTEGER NOT NULL, data BLOB);"
    "CREATE TABLE two_view_geometries(pair_id INTEGER PRIMARY KEY NOT NULL, rows INTEGER NOT NULL,"
    " cols INTEGER NOT NULL, data BLOB, config INTEGER NOT NULL, F BLOB, E BLOB, H BLOB, qvec BLOB, tvec BLOB);";

// Four images. Track A: 3:0, 7:0 and 9:0, by two pairs. Track B: 3:1, 7:1, 9:1 and 7:2, twice in one image. Features 2
// of 3 and 0 of 4 are a watermark.
inline std::string colmap_rows() {
    return "INSERT INTO cameras VALUES(1,17,320,240,NULL,0),(2,2,100,200,NULL,1);"
           "INSERT INTO images VALUES(7,'b b.png',1),(3,'a.png',2),(9,'../c.png',1),(4,'d.png',1);"
           + keypoints_sql(3, 4, {10.5f, 20.5f, 2.0f, 1.57079633f, 30, 40, 1, 0, 50, 60, 1, 0})
           + keypoints_sql(7, 6, {100.5f, 110.5f, 1, 2, 3, 4, 5, 5, 1, 0, 0, 1, 6, 6, 1, 0, 0, 1})
           + keypoints_sql(9, 2, {200.75f, 210.25f, 7, 7}) + keypoints_sql(4, 2, {9, 9})
           + matches_sql(3, 7, 2, {0, 0, 1, 1}) + matches_sql(7, 9, 9, {0, 0, 2, 1}) + matches_sql(3, 9, 3, {1, 1})
           + matches_sql(3, 4, 7, {2, 0});
}

inline std::string make_database(const std::string &name, const std::string &more = {}) {
    const std::string path = in_folder(name);
    fs::remove(path);
    OpenDatabase database(path);
    database.run(colmap_schema);
    database.run(colmap_rows());
    if (!more.empty()) database.run(more);
    return path;
}

// Numbers of a binary model, one after the other.
class BinaryFile {
public:
    template <class Number>
    BinaryFile &put(Number number) {
        const size_t at = bytes_.size();
        bytes_.resize(at + sizeof number);
        std::memcpy(bytes_.data() + at, &number, sizeof number);
        return *this;
    }
    BinaryFile &reals(std::initializer_list<double> numbers) {
        for (const double number : numbers) put(number);
        return *this;
    }
    BinaryFile &text(const std::string &text) {
        bytes_.insert(bytes_.end(), text.begin(), text.end());
        return put('\0');
    }
    void write(const std::string &path) const { save(path, bytes_); }

private:
    Bytes bytes_;
};

// A camera at (1, 2, 3) that is rotated by 90 degrees about the z axis: its quaternion, rotation and -R C.
constexpr double half_root = 0.70710678118654752;
constexpr const char *quarter_turn = "0.70710678118654752 0 0 0.70710678118654752 2 -1 -3";

// Two images and one point, and a camera of every model.
inline std::string make_binary_model(const std::string &name) {
    const std::string model = in_folder(name);
    fs::create_directory(model);
    const std::vector<int> parameters = {3, 4, 4, 5, 8, 8, 12, 5, 4, 5, 12, 16, 4, 5, 3, 4, 6, 2};
    BinaryFile cameras;
    cameras.put(uint64_t{parameters.size()});
    for (uint32_t kind = 0; kind < parameters.size(); kind++) {
        cameras.put(kind + 10).put(int32_t(kind)).put(uint64_t{320} + kind).put(uint64_t{240});
        for (int n = 0; n < parameters[kind]; n++) cameras.put(1.0);
    }
    cameras.write(model + "/cameras.bin");
    BinaryFile images;
    images.put(uint64_t{2});
    images.put(uint32_t{8}).reals({2 * half_root, 0, 0, 2 * half_root, 2, -1, -3}).put(uint32_t{27}).text("z z.png");
    images.put(uint64_t{2}).reals({5, 6}).put(~uint64_t{0}).reals({10.5, 20.5}).put(uint64_t{77});
    images.put(uint32_t{5}).reals({1, 0, 0, 0, -4, -5, -6}).put(uint32_t{10}).text("sub/y.png");
    images.put(uint64_t{1}).reals({30.5, 40.5}).put(uint64_t{77});
    images.write(model + "/images.bin");
    BinaryFile points;
    points.put(uint64_t{1}).put(uint64_t{77}).reals({7, 8, 9}).put('\1').put('\2').put('\3').put(0.5);
    points.put(uint64_t{2}).put(uint32_t{8}).put(uint32_t{1}).put(uint32_t{5}).put(uint32_t{0});
    points.write(model + "/points3D.bin");
    return model;
}

// The same as text.
inline std::string make_text_model(const std::string &name, bool is_crlf = false) {
    const std::string model = in_folder(name);
    fs::create_directory(model);
    const auto write = [&](const char *file, const std::string &text) {
        save_text(model + "/" + file, is_crlf ? with_crlf(text) : text);
    };
    write("cameras.txt", "# Camera list\n10 SIMPLE_PINHOLE 320 240 1 2 3\n27 EQUIRECTANGULAR 337 240 337 240\n");
    write("images.txt", std::string("# Image list\n8 ") + quarter_turn
                            + " 27 z z.png\n5 6 -1 10.5 20.5 77\n5 1 0 0 0 -4 -5 -6 10 sub/y.png\n30.5 40.5 77\n"
                              "6 1 0 0 0 0 0 0 10 without features.png\n\n");
    write("points3D.txt", "# Point list\n77 7 8 9 1 2 3 nan 8 1 5 0\n");
    return model;
}

}  // namespace reconstruction_files
