// Camera raw files: rows of linear light in camera colours.
#include "photo/pictures/codec.hpp"
#include "photo/pictures/raw_file.hpp"
#include "photo/pictures/raw_kind.hpp"

namespace lensprof {

namespace codec {

namespace {

class RawSource final : public RowSource {
public:
    RawSource(const ReadRequest &request, const std::string &kind) : raw_(request.path, kind) {
        header_.traits.format = FileFormat::raw;
        header_.traits.orientation = static_cast<uint16_t>(raw_.orientation());
        header_.sample = LENSPROF_SAMPLE_U16;
        header_.layout = raw_.channels() == 1 ? LENSPROF_LAYOUT_GREY : LENSPROF_LAYOUT_RGB;
        set_frame(header_, raw_.width(), raw_.height(), request);
    }

    uint32_t halved() const override { return raw_.is_mosaic() && header_.reduction > 1 ? 2 : 1; }
    uint32_t row_count() const override { return header_.frame_height / halved(); }
    uint32_t row_width() const override { return header_.frame_width / halved(); }

    void read(uint8_t *row) override {
        if (next_ == 0) decode();
        auto *samples = reinterpret_cast<uint16_t *>(row);
        halved() == 2 ? raw_.halved_row(next_++, samples) : raw_.full_row(next_++, samples);
    }

private:
    void decode() {
        raw_.unpack();
        if (halved() == 1) raw_.demosaic();
    }

    RawFile raw_;
    uint32_t next_ = 0;
};

}  // namespace

std::unique_ptr<RowSource> open_raw(const ReadRequest &request, const std::string &kind) {
    return std::make_unique<RawSource>(request, kind);
}

}  // namespace codec

bool can_read_raw() { return true; }

}  // namespace lensprof
