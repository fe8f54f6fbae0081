// Metadata in the chunks of a PNG (PNG 3rd edition, chapter 11): EXIF in eXIf, XMP and the comment in iTXt; also the
// hexadecimal text chunks in which older programs store EXIF and XMP, and all programs IPTC.
#include <algorithm>
#include <cctype>
#include <cstring>
#include <stdexcept>

#include <zlib.h>

#include "photo/pictures/coded_file.hpp"
#include "photo/pictures/exif_layout.hpp"
#include "photo/pictures/file_boxes.hpp"
#include "photo/pictures/photoshop_block.hpp"
#include "photo/pictures/picture_blocks.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr size_t png_signature_bytes = 8, max_text_bytes = size_t(64) << 20;
constexpr char xmp_keyword[] = "XML:com.adobe.xmp", comment_keyword[] = "Description",
               raw_profile[] = "Raw profile type ";

struct Chunk {
    std::string type;
    uint64_t start = 0, bytes = 0;  // of the whole chunk
};

// Calls `visit` for every chunk up to the end of the picture.
void each_chunk(const ReadAt &read, const std::function<void(const Chunk &)> &visit) {
    std::vector<uint8_t> head;
    for (uint64_t at = png_signature_bytes; read(at, 8, head);) {
        const Chunk chunk{std::string(head.begin() + 4, head.begin() + 8), at, 12 + big_endian(head.data(), 4)};
        if (!read(at + chunk.bytes - 4, 4, head)) break;
        visit(chunk);
        if (chunk.type == "IEND") return;
        at += chunk.bytes;
    }
    throw std::runtime_error("the PNG is truncated");
}

std::vector<uint8_t> content_of(const ReadAt &read, const Chunk &chunk) {
    std::vector<uint8_t> content;
    if (chunk.bytes - 12 > max_text_bytes || !read(chunk.start + 8, static_cast<size_t>(chunk.bytes - 12), content))
        content.clear();
    return content;
}

// Empty if the data are damaged or too large.
std::string inflate_text(const uint8_t *bytes, size_t count) {
    z_stream stream = {};
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    stream.next_in = const_cast<Bytef *>(bytes);
    stream.avail_in = static_cast<uInt>(count);
    std::string text;
    int state = Z_OK;
    while (state == Z_OK && text.size() < max_text_bytes) {
        char block[4096];
        stream.next_out = reinterpret_cast<Bytef *>(block);
        stream.avail_out = sizeof block;
        state = inflate(&stream, Z_NO_FLUSH);
        text.append(block, sizeof block - stream.avail_out);
    }
    inflateEnd(&stream);
    return state == Z_STREAM_END ? text : std::string();
}

struct TextChunk {
    std::string keyword, text;
};

// tEXt, zTXt, iTXt and iCCP: keyword, then flags and names, then text.
TextChunk read_text_chunk(const std::string &type, const std::vector<uint8_t> &content) {
    const auto past_nul = [&](size_t from) {
        const auto nul =
            std::find(content.begin() + static_cast<std::ptrdiff_t>(std::min(from, content.size())), content.end(), 0);
        return nul == content.end() ? content.size() : static_cast<size_t>(nul - content.begin()) + 1;
    };
    size_t start = past_nul(0);
    TextChunk chunk{std::string(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(start)), {}};
    if (!chunk.keyword.empty() && chunk.keyword.back() == '\0') chunk.keyword.pop_back();
    bool is_compressed = type == "zTXt" || type == "iCCP";
    if (type == "iTXt") {
        is_compressed = start < content.size() && content[start] == 1;
        start = past_nul(past_nul(start + 2));
    } else if (is_compressed) {
        start += 1;
    }
    if (start >= content.size()) return chunk;
    chunk.text = is_compressed ? inflate_text(&content[start], content.size() - start)
                               : std::string(content.begin() + static_cast<std::ptrdiff_t>(start), content.end());
    return chunk;
}

// "\nexif\n    1234\n" and hexadecimal digits in lines.
std::vector<uint8_t> bytes_of_profile(const std::string &text) {
    std::vector<uint8_t> bytes;
    size_t at = text.find_first_not_of('\n');
    for (int line = 0; line < 2 && at < text.size(); ++line) at = std::min(text.find('\n', at), text.size() - 1) + 1;
    int high = -1;
    for (; at < text.size(); ++at) {
        const unsigned char c = static_cast<unsigned char>(text[at]);
        if (!std::isxdigit(c)) continue;
        const int digit = std::isdigit(c) ? c - '0' : std::tolower(c) - 'a' + 10;
        if (high >= 0) bytes.push_back(static_cast<uint8_t>(high << 4 | digit));
        high = high >= 0 ? -1 : digit;
    }
    return bytes;
}

// The name of a hexadecimal profile in a text chunk; empty for other texts.
std::string name_of_profile(const std::string &keyword) {
    return keyword.compare(0, sizeof raw_profile - 1, raw_profile) == 0 ? keyword.substr(sizeof raw_profile - 1)
                                                                        : std::string();
}

// The standard chunk of EXIF counts, whatever the order.
void take_text(const TextChunk &chunk, PictureBlocks &blocks) {
    const std::string profile = name_of_profile(chunk.keyword);
    if (chunk.keyword == xmp_keyword) blocks.xmp = chunk.text;
    if (chunk.keyword == comment_keyword) blocks.comment = chunk.text;
    if (profile.empty()) return;
    const std::vector<uint8_t> bytes = bytes_of_profile(chunk.text);
    if (profile == "iptc") blocks.iptc = iptc_of(bytes);
    if (profile == "xmp" && blocks.xmp.empty()) blocks.xmp.assign(bytes.begin(), bytes.end());
    if ((profile == "exif" || profile == "APP1") && blocks.exif_block.empty())
        blocks.exif_block = without_exif_mark(bytes.data(), bytes.size());
}

class PngBytes {
public:
    void add(const char *type, const std::vector<uint8_t> &content) {
        put(static_cast<uint32_t>(content.size()));
        const size_t start = bytes.size();
        bytes.insert(bytes.end(), type, type + 4);
        bytes.insert(bytes.end(), content.begin(), content.end());
        put(static_cast<uint32_t>(crc32(0, &bytes[start], static_cast<uInt>(bytes.size() - start))));
    }

    void add_text(const char *keyword, const std::string &text) {  // UTF-8, uncompressed
        std::vector<uint8_t> content(keyword, keyword + std::strlen(keyword));
        content.insert(content.end(), 5, 0);
        content.insert(content.end(), text.begin(), text.end());
        add("iTXt", content);
    }

    void add_iptc(const std::vector<uint8_t> &iptc) {
        const std::vector<uint8_t> resources = with_iptc({}, iptc);
        std::string text = std::string(raw_profile) + "iptc" + '\0' + "\niptc\n" + std::to_string(resources.size());
        for (size_t i = 0; i < resources.size(); ++i) {
            if (i % 36 == 0) text += '\n';
            text += "0123456789abcdef"[resources[i] >> 4];
            text += "0123456789abcdef"[resources[i] & 15];
        }
        add("tEXt", {text.begin(), text.end()});
    }

    std::vector<uint8_t> bytes;

private:
    void put(uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<uint8_t>(value >> shift));
    }
};

bool is_text(const std::string &type) { return type == "tEXt" || type == "zTXt" || type == "iTXt"; }

bool is_metadata(const Chunk &chunk, const ReadAt &read, bool has_comment) {
    if (chunk.type == "eXIf") return true;
    if (!is_text(chunk.type)) return false;
    const std::vector<uint8_t> content = content_of(read, chunk);
    const std::string keyword(content.begin(), std::find(content.begin(), content.end(), 0));
    const std::string profile = name_of_profile(keyword);
    return keyword == xmp_keyword || profile == "exif" || profile == "APP1" || profile == "iptc" || profile == "xmp"
           || (has_comment && keyword == comment_keyword);
}

}  // namespace

PictureBlocks read_png_blocks(const ReadAt &read) {
    PictureBlocks blocks;
    blocks.mime_type = "image/png";
    std::vector<uint8_t> standard;
    each_chunk(read, [&](const Chunk &chunk) {
        if (chunk.type == "IHDR" && chunk.bytes >= 12 + 8) {
            const std::vector<uint8_t> header = content_of(read, chunk);
            if (header.size() < 8) return;
            blocks.width = static_cast<uint32_t>(big_endian(&header[0], 4));
            blocks.height = static_cast<uint32_t>(big_endian(&header[4], 4));
        }
        if (chunk.type == "eXIf") standard = content_of(read, chunk);
        if (is_text(chunk.type)) take_text(read_text_chunk(chunk.type, content_of(read, chunk)), blocks);
        if (chunk.type == "iCCP") {
            const std::string profile = read_text_chunk(chunk.type, content_of(read, chunk)).text;
            blocks.icc.assign(profile.begin(), profile.end());
        }
    });
    if (!standard.empty()) blocks.exif_block = without_exif_mark(standard.data(), standard.size());
    blocks.exif = read_exif(blocks.exif_block);
    return blocks;
}

std::vector<uint8_t> png_with(const std::vector<uint8_t> &file, const PictureBlocks &blocks) {
    const ReadAt read = [&](uint64_t offset, size_t count, std::vector<uint8_t> &part) {
        if (offset > file.size() || count > file.size() - offset) return false;
        part.assign(file.begin() + static_cast<std::ptrdiff_t>(offset),
                    file.begin() + static_cast<std::ptrdiff_t>(offset + count));
        return true;
    };
    PngBytes png{{file.begin(), file.begin() + png_signature_bytes}};
    const std::vector<uint8_t> exif = exif_block(blocks.exif);
    bool has_header = false;
    each_chunk(read, [&](const Chunk &chunk) {
        if (is_metadata(chunk, read, !blocks.comment.empty())) return;
        const auto start = file.begin() + static_cast<std::ptrdiff_t>(chunk.start);
        png.bytes.insert(png.bytes.end(), start, start + static_cast<std::ptrdiff_t>(chunk.bytes));
        if (chunk.type != "IHDR" || has_header) return;
        has_header = true;
        if (!exif.empty()) png.add("eXIf", exif);
        if (!blocks.xmp.empty()) png.add_text(xmp_keyword, blocks.xmp);
        if (!blocks.iptc.empty()) png.add_iptc(blocks.iptc);
        if (!blocks.comment.empty()) png.add_text(comment_keyword, blocks.comment);
    });
    if (!has_header) throw std::runtime_error("the PNG has no header");
    return png.bytes;
}

}  // namespace codec

}  // namespace lensprof
