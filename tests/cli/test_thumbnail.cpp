// Small copies of pictures and contact sheets of them.
#include <cstring>

#include "picture_files.hpp"

#include "photo/pictures/contact_sheet.hpp"
#include "photo/pictures/thumbnail.hpp"

using namespace picture_files;

namespace {

// value(x, y, channel) is 0..1.
template <class Sample, class Value>
Picture made(uint32_t width, uint32_t height, uint32_t sample, uint32_t layout, double scale, const Value &value) {
    Picture picture;
    picture.width = picture.frame_width = width, picture.height = picture.frame_height = height;
    picture.sample = sample, picture.layout = layout;
    const uint32_t samples = lensprof_layout_samples(layout);
    picture.row_bytes = size_t(width) * samples * sizeof(Sample);
    picture.pixels.resize(picture.row_bytes * height);
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            for (uint32_t c = 0; c < samples; c++) {
                const auto stored = static_cast<Sample>(scale * value(x, y, c));
                std::memcpy(&picture.pixels[y * picture.row_bytes + (size_t(x) * samples + c) * sizeof(Sample)],
                            &stored, sizeof stored);
            }
    return picture;
}

double ramp(uint32_t x, uint32_t y, uint32_t c) { return 0.1 + 0.0008 * x + 0.0005 * y + 0.05 * c; }

// The longer side is exact, and each pixel is the mean of its box.
void test_means(void **) {
    Picture picture = made<float>(641, 480, LENSPROF_SAMPLE_F32, LENSPROF_LAYOUT_RGB, 1.0, ramp);
    const Picture copy = upright_copy(picture, 1, 320);
    assert_int_equal(copy.width, 320);
    assert_int_equal(copy.height, 480 * 320 / 641);
    for (uint32_t y = 0; y < copy.height; y++)
        for (uint32_t x = 0; x < copy.width; x++)
            for (uint32_t c = 0; c < 3; c++) {
                const double middle_x = (x + 0.5) * 641 / copy.width - 0.5,
                             middle_y = (y + 0.5) * 480 / copy.height - 0.5;
                const double wanted = 255.0 * (0.1 + 0.0008 * middle_x + 0.0005 * middle_y + 0.05 * c);
                assert_close(copy.pixels[y * copy.row_bytes + 3 * x + c], wanted, 1.0);
            }
    const Picture same = upright_copy(picture, 1, 1000);
    assert_true(same.width == 641 && same.height == 480);
}

// Sample types, layouts and strips of rows make no difference.
void test_any_rows(void **) {
    const auto steps = [](uint32_t x, uint32_t y, uint32_t) { return ((7 * x + 13 * y) % 256) / 255.0; };
    Picture bytes = made<uint8_t>(100, 37, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, 255.01, steps);
    const Picture wanted = upright_copy(bytes, 1, 30);
    Picture words = made<uint16_t>(100, 37, LENSPROF_SAMPLE_U16, LENSPROF_LAYOUT_RGB, 65535.01, steps),
            grey = made<uint8_t>(100, 37, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_GREY, 255.01, steps),
            alpha = made<uint8_t>(100, 37, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGBA, 255.01, steps);
    for (Picture *picture : {&words, &grey, &alpha}) {
        const Picture copy = upright_copy(*picture, 1, 30);
        assert_true(copy.width == wanted.width && copy.height == wanted.height && copy.pixels == wanted.pixels);
    }
    for (uint32_t rows : {1u, 5u, 36u}) {
        Thumbnail thumbnail(100, 37, 30);
        for (uint32_t first = 0; first < 37; first += rows) {
            lensprof_image strip = bytes.view();
            strip.data = bytes.pixels.data() + first * bytes.row_bytes;
            strip.height = std::min(rows, 37 - first);
            thumbnail.add(strip);
        }
        assert_true(thumbnail.upright(1).pixels == wanted.pixels);
    }
    const auto even = [](uint32_t, uint32_t, uint32_t) { return 0.5; };
    for (auto [width, height] : {std::pair(1u, 1u), std::pair(3000u, 1u), std::pair(1u, 3000u)}) {
        Picture thin = made<uint8_t>(width, height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, 255.0, even);
        const Picture copy = upright_copy(thin, 1, 64);
        assert_true(copy.width == std::min(width, 64u) && copy.height == std::min(height, 64u));
    }
}

// Exif 2.32, tag 0x0112: which stored corner is at the upper left of the upright picture, and what is right of it.
void test_orientations(void **) {
    // Stored: 0 1 2
    //         3 4 5
    Picture stored = made<uint8_t>(3, 2, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, 1.0,
                                   [](uint32_t x, uint32_t y, uint32_t) { return 3.0 * y + x; });
    const struct {
        uint16_t orientation;
        uint32_t width;
        std::vector<uint8_t> upright;
    } cases[] = {
        {1, 3, {0, 1, 2, 3, 4, 5}}, {2, 3, {2, 1, 0, 5, 4, 3}}, {3, 3, {5, 4, 3, 2, 1, 0}}, {4, 3, {3, 4, 5, 0, 1, 2}},
        {5, 2, {0, 3, 1, 4, 2, 5}}, {6, 2, {3, 0, 4, 1, 5, 2}}, {7, 2, {5, 2, 4, 1, 3, 0}}, {8, 2, {2, 5, 1, 4, 0, 3}},
        {0, 3, {0, 1, 2, 3, 4, 5}}, {9, 3, {0, 1, 2, 3, 4, 5}},
    };
    for (const auto &wanted : cases) {
        const Picture copy = upright_copy(stored, wanted.orientation, 10);
        assert_int_equal(copy.width, wanted.width);
        for (size_t i = 0; i < 6; i++) assert_int_equal(copy.pixels[3 * i], wanted.upright[i]);
    }
}

// Red, as no text is.
Picture plain(uint32_t width, uint32_t height, uint8_t value) {
    return made<uint8_t>(width, height, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB, value,
                         [](uint32_t, uint32_t, uint32_t c) { return c == 0 ? 1.0 : 0.0; });
}

size_t pixels_of(const Picture &sheet, uint8_t red, uint8_t other = 0) {
    size_t count = 0;
    for (uint32_t y = 0; y < sheet.height; y++)
        for (uint32_t x = 0; x < sheet.width; x++) {
            const uint8_t *pixel = &sheet.pixels[y * sheet.row_bytes + size_t(3) * x];
            count += pixel[0] == red && pixel[1] == other && pixel[2] == other;
        }
    return count;
}

// Few pictures are large, many are small; every picture is on the sheet as a whole, and labels are drawn.
void test_sheets(void **) {
    uint32_t last = 1000;
    for (size_t pictures : {1, 2, 4, 9, 20, 60, 400, 5000, 20000}) {
        const uint32_t side = ContactSheet(pictures).side();
        assert_true(side <= last && side >= 140 && (pictures > 2 || side >= 900));
        last = side;
    }
    for (uint32_t count : {1u, 3u, 8u}) {
        ContactSheet sheet(count);
        for (uint32_t i = 0; i < count; i++)
            sheet.put(i, {plain(100, 50, 200), plain(100, 70, 210),
                          "\xff\x01 a name that is much too long for a cell.jpg", "note"});
        sheet.write(in_folder("sheet.png"));
        const Picture written = read_picture(in_folder("sheet.png"));
        assert_true(written.width <= 1950 && pixels_of(written, 200) == count * 5000
                    && pixels_of(written, 210) == count * 7000);
        const size_t text = size_t(written.width) * written.height - pixels_of(written, 40, 40) - count * 12000;
        assert_true(text > 200 * count);
    }
    ContactSheet unreadable(2);  // one copy was edited since
    unreadable.put(0, {plain(100, 50, 200), {}, "a.jpg", ""});
    unreadable.put(1, {{}, {}, "b.jpg", ""});
    unreadable.write(in_folder("gap.png"));
    assert_int_equal(pixels_of(read_picture(in_folder("gap.png")), 200), 5000);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_means),
        cmocka_unit_test(test_any_rows),
        cmocka_unit_test(test_orientations),
        cmocka_unit_test(test_sheets),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
