#include "photo/pictures/jpeg_bytes.hpp"

#include <cstdlib>
#include <memory>
#include <new>

#include <jpeglib.h>

#include "photo/pictures/codec.hpp"

namespace lensprof {
namespace {

struct Encoder {
    Encoder() {
        info.err = jpeg_std_error(&manager);
        manager.error_exit = [](j_common_ptr any) {
            std::longjmp(reinterpret_cast<Encoder *>(any->client_data)->jump, 1);
        };
        info.client_data = this;
    }
    ~Encoder() {
        jpeg_destroy_compress(&info);
        std::free(bytes);
    }
    Encoder(const Encoder &) = delete;
    Encoder &operator=(const Encoder &) = delete;

    jpeg_error_mgr manager{};
    jpeg_compress_struct info{};
    std::jmp_buf jump;
    unsigned char *bytes = nullptr;
    unsigned long count = 0;
};

void encode(Encoder &encoder, const Picture &picture, int quality) {
    jpeg_compress_struct &info = encoder.info;
    void *client = info.client_data;
    jpeg_create_compress(&info);
    info.client_data = client;
    jpeg_mem_dest(&info, &encoder.bytes, &encoder.count);
    const bool grey = picture.layout == LENSPROF_LAYOUT_GREY;
    info.image_width = picture.width, info.image_height = picture.height;
    info.input_components = grey ? 1 : 3;
    info.in_color_space = grey ? JCS_GRAYSCALE : JCS_RGB;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, quality, TRUE);
    jpeg_start_compress(&info, TRUE);
    for (uint32_t y = 0; y < picture.height; y++) {
        JSAMPROW row = const_cast<JSAMPROW>(picture.pixels.data() + y * picture.row_bytes);
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
}

}  // namespace

std::vector<uint8_t> jpeg_bytes(const Picture &picture, int quality) {
    auto encoder = std::make_unique<Encoder>();
    // Valid pictures in memory: what fails is memory alone.
    if (!codec::guarded(encoder->jump, [&] { encode(*encoder, picture, quality); })) throw std::bad_alloc();
    return {encoder->bytes, encoder->bytes + encoder->count};
}

}  // namespace lensprof
