// Settings of pictures in a table: a CSV file with a header.
#pragma once

#include <string>
#include <vector>

#include <lensprof/profile.h>

namespace lensprof {

// Columns: file, and any of maker, camera, lens, focal (58 or 58 mm), aperture (2.8 or f/2.8), distance (10, 10 m or
// inf), temperature (2850, 2850K); separated by commas, semicolons or tabs; empty cells state nothing. `file` is the
// name of a picture, or its path from the end, and may have * and ?; the first row that fits a picture counts.
class SettingTable {
public:
    // Failure (READ) that names the line.
    explicit SettingTable(const std::string &path);

    // Replaces in `key` what the table states about a picture.
    void apply(const std::string &file, lensprof_profile_key &key);

    // The row of a picture that cannot be read counts as used.
    void use(const std::string &file);

    // Rows that no picture has used: their `file`.
    std::vector<std::string> unused() const;

private:
    struct Row {
        std::string file;
        lensprof_profile_key key;
        bool is_used = false;
    };
    Row *row_of(const std::string &file);

    std::vector<Row> rows_;
};

}  // namespace lensprof
