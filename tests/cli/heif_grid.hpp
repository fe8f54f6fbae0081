// An HEIC picture composed of tiles, as phones write them. Needed because libheif's encoder in Debian 12 cannot write
// tiles.
#pragma once

#include <initializer_list>
#include <string>

#include "picture_files.hpp"

namespace heif_grid {

using picture_files::Bytes;

inline Bytes number(uint64_t value, int bytes) {
    Bytes all;
    for (int i = bytes; i-- > 0;) all.push_back(static_cast<uint8_t>(value >> 8 * i));
    return all;
}

inline Bytes text(const std::string &characters) { return {characters.begin(), characters.end()}; }

inline Bytes joined(std::initializer_list<Bytes> parts) {
    Bytes all;
    for (const Bytes &part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

// ISO/IEC 14496-12, 4.2.
inline Bytes box(const char *type, const Bytes &content) {
    return joined({number(content.size() + 8, 4), text(type), content});
}
inline Bytes full_box(const char *type, unsigned version, const Bytes &content) {
    return box(type, joined({number(uint64_t(version) << 24, 4), content}));
}

// The content of the first box of a type, found by its name in a file with a single picture.
inline Bytes content_of(const Bytes &file, const char *type) {
    const std::string name = type;
    const auto at = std::search(file.begin(), file.end(), name.begin(), name.end());
    assert_true(at != file.end());
    size_t size = 0;
    for (int i = 4; i > 0; i--) size = size << 8 | at[-i];
    return {at + 4, at - 4 + static_cast<ptrdiff_t>(size)};
}

struct Grid {
    unsigned columns, rows, tile, width, height;  // the last two: the visible part of all tiles
    unsigned quarters;                            // quarter turns anticlockwise
};

// ISO/IEC 23008-12: items 1 to n are the tiles, with the same coding, and the next item is their grid (6.6.2.3).
inline Bytes bytes_of(const std::vector<Bytes> &tiles, const Grid &grid) {
    const uint64_t count = tiles.size(), own = count + 1;
    Bytes data, tile_ids, infos, properties, sizes;
    std::vector<Bytes> items;
    for (const Bytes &tile : tiles) items.push_back(content_of(tile, "mdat"));
    items.push_back(joined({number(0, 2), number(grid.rows - 1, 1), number(grid.columns - 1, 1), number(grid.width, 2),
                            number(grid.height, 2)}));
    for (uint64_t id = 1; id <= own; id++) {
        const bool is_grid = id == own;
        if (!is_grid) tile_ids = joined({tile_ids, number(id, 2)});
        infos = joined(
            {infos, full_box("infe", 2,
                             joined({number(id, 2), number(0, 2), text(is_grid ? "grid" : "hvc1"), number(0, 1)}))});
        properties = joined(
            {properties, number(id, 2), number(2, 1), number(is_grid ? 3 : 0x81, 1), number(is_grid ? 0x84 : 2, 1)});
    }
    const Bytes ipco = box("ipco", joined({box("hvcC", content_of(tiles[0], "hvcC")),
                                           full_box("ispe", 0, joined({number(grid.tile, 4), number(grid.tile, 4)})),
                                           full_box("ispe", 0, joined({number(grid.width, 4), number(grid.height, 4)})),
                                           box("irot", number(grid.quarters, 1))}));
    const Bytes ftyp = box("ftyp", joined({text("heic"), number(0, 4), text("mif1heic")}));
    const auto meta = [&](uint64_t start) {
        Bytes places;
        for (uint64_t id = 1; id <= own; start += items[id - 1].size(), id++)
            places = joined(
                {places, number(id, 2), number(0, 2), number(1, 2), number(start, 4), number(items[id - 1].size(), 4)});
        return full_box(
            "meta", 0,
            joined({full_box("hdlr", 0, joined({number(0, 4), text("pict"), Bytes(13, 0)})),
                    full_box("pitm", 0, number(own, 2)),
                    full_box("iloc", 0, joined({number(0x4400, 2), number(own, 2), places})),
                    full_box("iinf", 0, joined({number(own, 2), infos})),
                    full_box("iref", 0, box("dimg", joined({number(own, 2), number(count, 2), tile_ids}))),
                    box("iprp", joined({ipco, full_box("ipma", 0, joined({number(own, 4), properties}))}))}));
    };
    for (const Bytes &item : items) data = joined({data, item});
    return joined({ftyp, meta(ftyp.size() + meta(0).size() + 8), box("mdat", data)});
}

}  // namespace heif_grid
