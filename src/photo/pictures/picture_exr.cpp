// OpenEXR, write only: 32 bit float, one part of scan lines.
#include <array>
#include <exception>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTestFile.h>

#include "photo/base/failure.hpp"
#include "photo/base/paths.hpp"
#include "photo/pictures/codec.hpp"

namespace lensprof {

namespace codec {

namespace {

using Names = std::vector<const char *>;

// Per sample of a pixel.
Names channel_names(uint32_t layout) {
    switch (layout) {
    case LENSPROF_LAYOUT_GREY: return {"Y"};
    case LENSPROF_LAYOUT_GREY_ALPHA: return {"Y", "A"};
    case LENSPROF_LAYOUT_RGBA: return {"R", "G", "B", "A"};
    default: return {"R", "G", "B"};
    }
}

constexpr const char *xmp_attribute = "xmp";

Imf::Header header_of(const Picture &picture, const Names &names, const std::string &xmp) {
    Imf::Header header(static_cast<int>(picture.width), static_cast<int>(picture.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    for (const char *name : names) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    if (!xmp.empty()) header.insert(xmp_attribute, Imf::StringAttribute(xmp));
    return header;
}

class ExrSink final : public RowSink {
public:
    ExrSink(const std::string &path, const Picture &header, const std::string &xmp)
        : path_(path), names_(channel_names(header.layout)), width_(header.width) {
        run([&] { file_ = std::make_unique<Imf::OutputFile>(path.c_str(), header_of(header, names_, xmp)); });
    }

    // The library addresses a pixel by its position in the whole picture: the pointer is shifted so that the row lies
    // at its own y; no other row is accessed.
    void write(const uint8_t *row) override {
        Imf::FrameBuffer rows;
        const size_t pixel = names_.size() * sizeof(float);
        const bool has_alpha = names_.size() % 2 == 0;
        if (has_alpha) row = premultiplied(row);
        for (size_t c = 0; c < names_.size(); c++) {
            char *first = const_cast<char *>(reinterpret_cast<const char *>(row)) + c * sizeof(float);
            rows.insert(names_[c], Imf::Slice(Imf::FLOAT, first, pixel, 0));
        }
        run([&] {
            file_->setFrameBuffer(rows);
            file_->writePixels(1);
        });
    }

    void finish() override {
        run([&] { file_.reset(); });
        if (lensprof::file_bytes(path_) == 0) fail_to_write(path_, "it is empty", 0);
    }

private:
    // Colour times alpha, as stored in OpenEXR files.
    const uint8_t *premultiplied(const uint8_t *row) {
        const auto *values = reinterpret_cast<const float *>(row);
        const size_t samples = names_.size();
        row_.assign(values, values + width_ * samples);
        for (size_t n = 0; n < row_.size(); n++)
            if (n % samples != samples - 1) row_[n] *= row_[n - n % samples + samples - 1];
        return reinterpret_cast<const uint8_t *>(row_.data());
    }

    template <class Body>
    void run(const Body &body) {
        try {
            body();
        } catch (const std::bad_alloc &) {
            throw;
        } catch (const std::exception &failure) {
            fail_to_write(path_, failure.what(), 0);
        }
    }

    std::string path_;
    Names names_;
    const size_t width_;
    std::vector<float> row_;
    std::unique_ptr<Imf::OutputFile> file_;
};

}  // namespace

std::unique_ptr<RowSink> create_exr(const std::string &path, const Picture &header, const std::string &xmp) {
    if (header.sample != LENSPROF_SAMPLE_F32)
        fail_to_hold(path, "OpenEXR is written only for irradiance (32 bit float); give a name ending in .tif or .png");
    return std::make_unique<ExrSink>(path, header, xmp);
}

}  // namespace codec

bool can_write_exr() { return true; }

std::string exr_xmp_of(const std::string &path) {
    try {
        if (!Imf::isOpenExrFile(path.c_str())) return {};
        const Imf::InputFile file(path.c_str());
        const auto *xmp = file.header().findTypedAttribute<Imf::StringAttribute>(codec::xmp_attribute);
        return xmp ? xmp->value() : std::string();
    } catch (const std::exception &) {
        return {};  // missing or damaged file: no mark
    }
}

}  // namespace lensprof
