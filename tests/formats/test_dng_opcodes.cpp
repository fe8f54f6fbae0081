// DNG opcode lists: reading and writing.
#include <cstring>

#include "import_support.hpp"

namespace {

using Bytes = std::vector<uint8_t>;

void put(Bytes &bytes, uint64_t value, int size) {
    while (size-- > 0) bytes.push_back(static_cast<uint8_t>(value >> (8 * size)));
}

void put_f64(Bytes &bytes, double value) {
    uint64_t bits;
    std::memcpy(&bits, &value, 8);
    put(bytes, bits, 8);
}

void put_f32(Bytes &bytes, float value) {
    uint32_t bits;
    std::memcpy(&bits, &value, 4);
    put(bytes, bits, 4);
}

Bytes opcode(uint32_t id, uint32_t flags, const Bytes &payload) {
    Bytes bytes;
    for (uint32_t value : {id, 0x01030000u, flags, uint32_t(payload.size())}) put(bytes, value, 4);
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return bytes;
}

Bytes list_of(const std::vector<Bytes> &opcodes) {
    Bytes bytes;
    put(bytes, opcodes.size(), 4);
    for (const Bytes &one : opcodes) bytes.insert(bytes.end(), one.begin(), one.end());
    return bytes;
}

Bytes radial(const std::vector<double> &k, double cx = 0.5, double cy = 0.5) {
    Bytes payload;
    for (double value : k) put_f64(payload, value);
    put_f64(payload, cx), put_f64(payload, cy);
    return opcode(3, 1, payload);
}

struct MapArea {
    uint32_t top = 0, left = 0, bottom = 400, right = 600, plane = 0, planes = 1, row_pitch = 1, column_pitch = 1;
    double spacing = 1.0, origin = 0.0;
};

Bytes gain_map(const MapArea &a, uint32_t rows, uint32_t columns, uint32_t planes, const std::vector<float> &gains) {
    Bytes payload;
    for (uint32_t value :
         {a.top, a.left, a.bottom, a.right, a.plane, a.planes, a.row_pitch, a.column_pitch, rows, columns})
        put(payload, value, 4);
    for (double value : {a.spacing, a.spacing, a.origin, a.origin}) put_f64(payload, value);
    put(payload, planes, 4);
    for (float gain : gains) put_f32(payload, gain);
    return opcode(9, 1, payload);
}

// In memory of exactly its size, so that the address sanitizer detects reads beyond the end.
Imported read(const Bytes &bytes, uint32_t layout = LENSPROF_LAYOUT_RGB, uint32_t width = 600, uint32_t height = 400) {
    Imported imported{};
    lensprof_error error;
    const Bytes exact(bytes.begin(), bytes.end());
    imported.status =
        lp_dng_opcodes_read(exact.data(), exact.size(), width, height, layout, "a.dng", keep_entry, &imported, &error);
    imported.error = error.text;
    return imported;
}

void assert_refused(const Imported &imported, lensprof_status status, const char *text) {
    assert_int_equal(imported.status, status);
    assert_non_null(strstr(imported.error.c_str(), text));
    assert_int_equal(imported.profiles.size(), 0);
}

Bytes write(const lensprof_profile &profile, uint32_t layout, uint32_t form, double *worst = nullptr,
            uint32_t width = 600, uint32_t height = 400) {
    size_t needed = 0;
    assert_ok(lp_dng_opcodes_write(&profile, width, height, layout, form, nullptr, 0, &needed, nullptr, nullptr));
    Bytes bytes(needed);
    assert_ok(
        lp_dng_opcodes_write(&profile, width, height, layout, form, bytes.data(), needed, &needed, worst, nullptr));
    return bytes;
}

// The list of a single FixVignetteRadial with gain 1 + r^2 / 2 about the middle, byte by byte: 0.5 is 3FE0 0000 0000
// 0000.
void test_golden_radial(void **) {
    Bytes golden = {0, 0, 0, 1, 0, 0, 0, 3, 1, 3, 0, 0, 0, 0, 0, 1, 0, 0, 0, 56};
    for (int number = 0; number < 7; number++) {
        const bool half = number == 0 || number >= 5;
        for (int byte = 0; byte < 8; byte++) golden.push_back(half ? (byte == 0 ? 0x3F : byte == 1 ? 0xE0 : 0) : 0);
    }
    assert_true(golden == list_of({radial({0.5, 0, 0, 0, 0})}));
    const Imported imported = read(golden);
    assert_string_equal(imported.error.c_str(), "");
    assert_ok(imported.status);
    const lensprof_profile &p = *imported.profiles.at(0);
    assert_string_equal(p.provenance.source, "a.dng; DNG opcodes");
    assert_string_equal(p.provenance.method, "import");
    assert_string_equal(p.provenance.doubt, "");
    assert_int_equal(p.key.processing, LENSPROF_PROCESSING_RAW);
    assert_true(p.vignettings == 1 && p.grid.columns == 0 && p.vignetting[0].center[0] == 0);
    // 1 / (1 + r^2 / 2) is 2/3 in the corner and 0.8 at r^2 = 1/2; the polynomial is within 0.2 %.
    assert_close(lensprof_vignetting_eval(&p.vignetting[0], 1.0, nullptr), 2.0 / 3.0, 2e-3);
    assert_close(lensprof_vignetting_eval(&p.vignetting[0], 0.5, nullptr), 0.8, 2e-3);
}

// The centre of a falloff in pixels, and the farthest corner: (150, 300) of 600 x 400, so r = 1 at hypot(450, 300).
void test_radial_about_another_centre(void **) {
    const Imported imported = read(list_of({radial({0.25, 0.0625, 0, 0, 0}, 0.25, 0.75)}));
    assert_ok(imported.status);
    const lensprof_profile &p = *imported.profiles.at(0);
    const double rho = std::hypot(600, 400) / 2;
    assert_close(p.vignetting[0].center[0], -150 / rho, 1e-14);
    assert_close(p.vignetting[0].center[1], 100 / rho, 1e-14);
    for (const double along : {0.0, 0.3, 0.7, 1.0}) {
        const double r2 = along * along, gain = 1 + 0.25 * r2 + 0.0625 * r2 * r2;
        const double m = attenuation_at(p, 600, 400, 149.5 + 450 * along, 299.5 - 300 * along);
        assert_close(m * gain, 1.0, 2e-3);
    }
}

void test_opcodes_multiply(void **) {
    const Bytes first = radial({0.3, 0, 0, 0, 0}), second = radial({0.2, 0, 0, 0, 0});
    const Imported both = read(list_of({first, opcode(1, 0, Bytes(20)), second, opcode(4711, 1, {})}));
    assert_ok(both.status);
    assert_string_equal(both.profiles[0]->provenance.doubt, "left out: WarpRectilinear, id 4711");
    const Imported product = read(list_of({radial({0.5, 0.06, 0, 0, 0})}));
    assert_true(largest_difference(*both.profiles[0], *product.profiles.at(0), 600, 400, 1) < 1e-12);
    // The same by two different centres, for which the frame is sampled.
    const Imported two = read(list_of({first, radial({0.2, 0, 0, 0, 0}, 0.5, 0.5000001)}));
    assert_ok(two.status);
    assert_true(largest_difference(*two.profiles.at(0), *product.profiles[0], 600, 400, 1) < 0.004);
}

// A map of 2 x 2 points whose origin and spacing put them at 1/4 and 3/4 of the frame: bilinear in between, constant
// beyond.
void test_map_semantics(void **) {
    MapArea area;
    area.planes = 3, area.spacing = 0.5, area.origin = 0.25;
    const Imported imported = read(list_of({gain_map(area, 2, 2, 1, {1.0f, 1.2f, 1.1f, 1.3f})}));
    assert_ok(imported.status);
    const lensprof_profile &p = *imported.profiles.at(0);
    assert_int_equal(p.vignettings, 1);
    assert_int_equal(p.grid.channels, 1);
    const auto gain = [](double x, double y) {
        const double u = std::min(1.0, std::max(0.0, ((x + 0.5) / 600 - 0.25) / 0.5));
        const double v = std::min(1.0, std::max(0.0, ((y + 0.5) / 400 - 0.25) / 0.5));
        return 1.0 + 0.2 * u + 0.1 * v;
    };
    double scale = 0.0, worst = 0.0;
    for (int pass = 0; pass < 2; pass++)
        for (double y = 20; y < 400; y += 30)
            for (double x = 20; x < 600; x += 30) {
                const double product = attenuation_at(p, 600, 400, x, y) * gain(x, y);
                if (pass == 0)
                    scale += product / (13 * 20);
                else
                    worst = std::max(worst, std::fabs(product / scale - 1.0));
            }
    assert_true(worst < 0.006);  // the map has kinks
}

// Three planes of one map; if there are fewer planes, the last one also counts for those above it. A smooth gain, a
// quarter of r^2.
void test_map_planes(void **) {
    const auto smooth = [](uint32_t planes, const std::vector<double> &strengths) {
        std::vector<float> gains;
        for (int j = 0; j <= 24; j++)
            for (int i = 0; i <= 32; i++)
                for (uint32_t c = 0; c < planes; c++) {
                    const double x = i / 32.0 - 0.5, y = j / 24.0 - 0.5;
                    gains.push_back(static_cast<float>(1 + strengths[c] * (x * x * 9 + y * y * 4) / 3.25));
                }
        return gains;
    };
    MapArea area;
    area.planes = 3;
    const auto map = [&](uint32_t planes, const std::vector<double> &strengths) {
        Bytes bytes = gain_map(area, 25, 33, planes, smooth(planes, strengths));
        const size_t spacing = 16 + 40;
        Bytes numbers;
        put_f64(numbers, 1 / 24.0), put_f64(numbers, 1 / 32.0);
        std::copy(numbers.begin(), numbers.end(), bytes.begin() + spacing);
        return bytes;
    };
    const Imported three = read(list_of({map(3, {0.3, 0.4, 0.5})}));
    assert_ok(three.status);
    assert_int_equal(three.profiles.at(0)->vignettings, 3);
    for (uint32_t c = 0; c < 3; c++) {
        const double corner = attenuation_at(*three.profiles[0], 600, 400, -0.5, -0.5, c);
        assert_close(corner, 1 / (1 + (0.3 + 0.1 * c)), 4e-3);
    }
    const Imported two = read(list_of({map(2, {0.3, 0.4})}));
    const lensprof_profile &p = *two.profiles.at(0);
    for (uint32_t c = 0; c < 3; c++)
        assert_close(attenuation_at(p, 600, 400, -0.5, -0.5, c), 1 / (1.3 + 0.1 * std::min(c, 1u)), 4e-3);
    // A map for the green plane only.
    area.plane = 1, area.planes = 1;
    const Imported green = read(list_of({map(1, {0.4})}));
    for (uint32_t c = 0; c < 3; c++)
        assert_close(attenuation_at(*green.profiles.at(0), 600, 400, -0.5, -0.5, c), c == 1 ? 1 / 1.4 : 1.0, 4e-3);
    // One map for all planes is one falloff.
    area.plane = 0, area.planes = 3;
    assert_int_equal(read(list_of({map(1, {0.4})})).profiles.at(0)->vignettings, 1);
}

void test_written_bytes(void **) {
    // Gain 1 exactly: no falloff, five coefficients 0, the centre 0.5.
    const Bytes flat = write(*profile_of(0, 0, 0), LENSPROF_LAYOUT_RGB, LENSPROF_DNG_RADIAL);
    assert_true(flat == list_of({radial({0, 0, 0, 0, 0})}));
    const Bytes map = write(*profile_of(0, 0, 0), LENSPROF_LAYOUT_RGB, LENSPROF_DNG_GAIN_MAP);
    assert_int_equal(map.size(), 4 + 16 + 76 + 4 * 33 * 22);
    MapArea area;
    area.planes = 3;
    Bytes expected = list_of({gain_map(area, 22, 33, 1, std::vector<float>(33 * 22, 1.0f))});
    Bytes spacing;
    put_f64(spacing, 1.0 / 21), put_f64(spacing, 1.0 / 32);
    std::copy(spacing.begin(), spacing.end(), expected.begin() + 20 + 40);
    assert_true(map == expected);
}

void test_round_trips(void **) {
    const struct {
        double k1, k2, k3, x, y, radial, map;
    } cases[] = {{-0.3, 0.1, -0.05, 0, 0, 2e-5, 6e-4},
                 {-0.8, 0.3, -0.1, 0.05, -0.08, 4e-3, 7e-3},
                 {-1.1, 0.7, -0.3, 0, 0.1, 2e-2, 2e-2}};
    for (const auto &c : cases) {
        const auto profile = profile_of(c.k1, c.k2, c.k3, c.x, c.y);
        for (const uint32_t form : {LENSPROF_DNG_RADIAL, LENSPROF_DNG_GAIN_MAP}) {
            double worst = 1.0;
            const Imported back = read(write(*profile, LENSPROF_LAYOUT_RGB, form, &worst));
            assert_ok(back.status);
            const double difference = largest_difference(*back.profiles.at(0), *profile, 600, 400, 1);
            print_message("k %g %g %g, form %u: written within %.2g, read back within %.2g\n", c.k1, c.k2, c.k3, form,
                          worst, difference);
            assert_true(worst < (form == LENSPROF_DNG_RADIAL ? c.radial : c.map));
            assert_true(difference < 2 * (form == LENSPROF_DNG_RADIAL ? c.radial : c.map) + 1e-3);
        }
    }
}

// Falloffs per channel: three planes of one map, or a map per site of a mosaic's square, for every order of colours.
void test_channels_round_trip(void **) {
    const auto profile = profile_of(-0.4, 0.1, -0.05, 0.03, 0.02);
    profile->vignettings = 3;
    profile->vignetting[1] = {{-0.5, 0.1, -0.05}, {0.03, 0.02}};
    profile->vignetting[2] = {{-0.6, 0.1, -0.02}, {0.03, 0.02}};
    for (const uint32_t layout : {LENSPROF_LAYOUT_RGB, LENSPROF_LAYOUT_RGGB, LENSPROF_LAYOUT_GRBG, LENSPROF_LAYOUT_GBRG,
                                  LENSPROF_LAYOUT_BGGR}) {
        double worst = 1.0;
        const Bytes bytes = write(*profile, layout, LENSPROF_DNG_GAIN_MAP, &worst);
        assert_int_equal(bytes[3], layout == LENSPROF_LAYOUT_RGB ? 1 : 4);
        const Imported back = read(bytes, layout);
        assert_ok(back.status);
        assert_true(worst < 5e-3);
        assert_true(largest_difference(*back.profiles.at(0), *profile, 600, 400, 3) < 3e-3);
        // Read for the other order of colours, red and blue are swapped.
        if (layout != LENSPROF_LAYOUT_RGGB) continue;
        const Imported other = read(bytes, LENSPROF_LAYOUT_BGGR);
        assert_true(attenuation_at(*other.profiles.at(0), 600, 400, 0, 0, 0)
                    < attenuation_at(*other.profiles[0], 600, 400, 0, 0, 2) - 0.05);
        assert_refused(read(bytes, LENSPROF_LAYOUT_RGB), LENSPROF_ERROR_UNSUPPORTED, "every 2th pixel");
    }
}

void test_grid_is_written_as_map(void **) {
    const auto profile = profile_of(-0.4, 0.1, -0.05);
    profile->grid.columns = profile->grid.rows = 5, profile->grid.channels = 1;
    for (int i = 0; i < 25; i++) profile->grid.attenuation[i] = 1.0f + 0.01f * static_cast<float>(i % 5);
    const Imported back = read(write(*profile, LENSPROF_LAYOUT_RGGB, LENSPROF_DNG_GAIN_MAP), LENSPROF_LAYOUT_RGGB);
    assert_ok(back.status);
    const double scale =
        attenuation_at(*back.profiles.at(0), 600, 400, 299.5, 199.5) / attenuation_at(*profile, 600, 400, 299.5, 199.5);
    for (const double x : {0.0, 150.0, 450.0, 599.0})
        assert_close(
            attenuation_at(*back.profiles[0], 600, 400, x, 100) / (scale * attenuation_at(*profile, 600, 400, x, 100)),
            1.0, 4e-3);
}

void test_write_refused(void **) {
    const auto fails = [](const lensprof_profile &profile, uint32_t layout, uint32_t form, lensprof_status status,
                          const char *text) {
        lensprof_error error;
        uint8_t bytes[8] = {7};
        size_t needed = 99;
        assert_int_equal(
            lp_dng_opcodes_write(&profile, 600, 400, layout, form, bytes, sizeof bytes, &needed, nullptr, &error),
            status);
        assert_non_null(strstr(error.text, text));
        assert_int_equal(bytes[0], 7);
        assert_true(needed == 99 || status == LENSPROF_ERROR_CAPACITY);
    };
    auto profile = profile_of(-0.3, 0, 0);
    fails(*profile, LENSPROF_LAYOUT_RGB, 2, LENSPROF_ERROR_ARGUMENT, "form");
    fails(*profile, LENSPROF_LAYOUT_RGBA, 0, LENSPROF_ERROR_ARGUMENT, "layout");
    fails(*profile, LENSPROF_LAYOUT_RGB, 0, LENSPROF_ERROR_CAPACITY, "buffer is too small");
    profile->vignettings = 3;
    fails(*profile, LENSPROF_LAYOUT_RGB, 0, LENSPROF_ERROR_UNSUPPORTED, "write GainMap");
    fails(*profile, LENSPROF_LAYOUT_GREY, 1, LENSPROF_ERROR_UNSUPPORTED, "pictures with one");
    profile = profile_of(-0.3, 0, 0);
    profile->grid.columns = profile->grid.rows = 2, profile->grid.channels = 1;
    for (int i = 0; i < 4; i++) profile->grid.attenuation[i] = 1;
    fails(*profile, LENSPROF_LAYOUT_RGB, 0, LENSPROF_ERROR_UNSUPPORTED, "gain grid");
    fails(*profile_of(-0.1, 0, 0, 0.9, 0), LENSPROF_LAYOUT_RGB, 0, LENSPROF_ERROR_UNSUPPORTED, "centre");
    fails(*profile_of(-2, 0, 0), LENSPROF_LAYOUT_RGB, 0, LENSPROF_ERROR_VIGNETTING, "invalid");
    profile = profile_of(-0.3, 0, 0);
    profile->key.processing = LENSPROF_PROCESSING_CORRECTED;
    fails(*profile, LENSPROF_LAYOUT_RGB, 1, LENSPROF_ERROR_UNSUPPORTED, "corrected in camera");
    assert_int_equal(lp_dng_opcodes_write(nullptr, 6, 4, 2, 0, nullptr, 0, nullptr, nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_dng_opcodes_write(profile.get(), 0, 4, 2, 0, nullptr, 0, nullptr, nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
}

void test_read_refused(void **) {
    const Bytes good = radial({0.5, 0, 0, 0, 0});
    assert_refused(read({}), LENSPROF_ERROR_SYNTAX, "number of opcodes");
    assert_refused(read({0, 0, 0, 0}), LENSPROF_ERROR_NOT_FOUND, "among 0 opcodes");
    assert_refused(read(list_of({opcode(1, 0, Bytes(8))})), LENSPROF_ERROR_NOT_FOUND, "1 opcodes (WarpRectilinear)");
    assert_refused(read({0xFF, 0xFF, 0xFF, 0xFF, 0}), LENSPROF_ERROR_SYNTAX, "fewer bytes");
    assert_refused(read(list_of({good, opcode(15, 0, {})})), LENSPROF_ERROR_UNSUPPORTED, "opcode 1 (id 15)");
    assert_refused(read(list_of({opcode(6, 0, Bytes(16)), good})), LENSPROF_ERROR_UNSUPPORTED, "TrimBounds");
    assert_ok(read(list_of({good, opcode(6, 0, Bytes(16))})).status);
    assert_refused(read(list_of({radial({NAN, 0, 0, 0, 0})})), LENSPROF_ERROR_SYNTAX, "not finite");
    assert_refused(read(list_of({radial({0, 0, 0, 0, 0}, 1.5)})), LENSPROF_ERROR_SYNTAX, "outside the frame");
    assert_refused(read(list_of({radial({0, 0, 0, 0})})), LENSPROF_ERROR_SYNTAX, "ends within");
    assert_refused(read(list_of({radial({0, 0, 0, 0, 0, 0})})), LENSPROF_ERROR_SYNTAX, "after its 7 numbers");
    assert_refused(read(list_of({radial({-1.5, 0, 0, 0, 0})})), LENSPROF_ERROR_VIGNETTING, "not above 0");
    assert_refused(read(list_of(std::vector<Bytes>(65, good))), LENSPROF_ERROR_SIZE, "over 64 gains");
    assert_ok(read(list_of(std::vector<Bytes>(2, radial({0.1, 0, 0, 0, 0})))).status);
    Bytes beyond = list_of({good});
    beyond.push_back(0);
    assert_refused(read(beyond), LENSPROF_ERROR_SYNTAX, "after the last opcode");
    assert_refused(read(list_of({good}), LENSPROF_LAYOUT_RGBA), LENSPROF_ERROR_ARGUMENT, "layout");
    assert_refused(read(list_of({good}), LENSPROF_LAYOUT_RGB, 0), LENSPROF_ERROR_ARGUMENT, "frame");
    assert_int_equal(lp_dng_opcodes_read(nullptr, 4, 6, 4, 2, nullptr, keep_entry, nullptr, nullptr),
                     LENSPROF_ERROR_ARGUMENT);
    const Bytes list = list_of({good});
    assert_int_equal(lp_dng_opcodes_read(list.data(), list.size(), 6, 4, 2, nullptr, refuse_entry, nullptr, nullptr),
                     LENSPROF_ERROR_CANCELLED);
}

void test_maps_refused(void **) {
    const MapArea area;
    const std::vector<float> four = {1, 1, 1, 1};
    const auto with = [&](size_t offset, uint32_t value) {  // changes a number of the payload
        Bytes bytes = gain_map(area, 2, 2, 1, four), number;
        put(number, value, 4);
        std::copy(number.begin(), number.end(), bytes.begin() + 16 + static_cast<std::ptrdiff_t>(offset));
        return read(list_of({bytes}));
    };
    assert_refused(with(20, 0), LENSPROF_ERROR_SYNTAX, "planes or pitch is 0");
    assert_refused(with(24, 0), LENSPROF_ERROR_SYNTAX, "planes or pitch is 0");
    assert_refused(with(32, 0), LENSPROF_ERROR_SYNTAX, "without points");
    assert_refused(with(36, 3), LENSPROF_ERROR_SYNTAX, "the number of gains differs");
    assert_refused(with(32, 0xFFFFFFFF), LENSPROF_ERROR_SIZE, "over 1 Mi points");
    assert_refused(with(72, 0xFFFFFFFF), LENSPROF_ERROR_SIZE, "over 1 Mi points");
    assert_refused(with(40, 0xBFF00000), LENSPROF_ERROR_SYNTAX, "spacing");
    assert_refused(with(76, 0xBF800000), LENSPROF_ERROR_VIGNETTING, "not above 0");
    assert_refused(with(76, 0x7F800000), LENSPROF_ERROR_SYNTAX, "not finite");
    assert_refused(with(28, 3), LENSPROF_ERROR_UNSUPPORTED, "every 3th pixel");
    assert_ok(with(40, 0x3FF80000).status);
}

// A list cut anywhere is refused; a list with any byte changed gives a result or a reason.
void test_cuts_and_mutations(void **) {
    Bytes list = list_of({radial({0.5, 0.1, 0, 0, 0}), opcode(1, 0, Bytes(5)), radial({0.1, 0, 0, 0, 0})});
    for (size_t size = 0; size < list.size(); size++)
        assert_refused(read(Bytes(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(size))),
                       LENSPROF_ERROR_SYNTAX, "");
    for (size_t at = 0; at < list.size(); at++)
        for (const uint8_t change : {0x01, 0x80, 0xFF}) {
            list[at] ^= change;
            const Imported imported = read(list);
            assert_true((imported.status == LENSPROF_OK) == (imported.profiles.size() == 1));
            assert_true((imported.status == LENSPROF_OK) == imported.error.empty());
            list[at] ^= change;
        }
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_golden_radial),
        cmocka_unit_test(test_radial_about_another_centre),
        cmocka_unit_test(test_opcodes_multiply),
        cmocka_unit_test(test_map_semantics),
        cmocka_unit_test(test_map_planes),
        cmocka_unit_test(test_written_bytes),
        cmocka_unit_test(test_round_trips),
        cmocka_unit_test(test_channels_round_trip),
        cmocka_unit_test(test_grid_is_written_as_map),
        cmocka_unit_test(test_write_refused),
        cmocka_unit_test(test_read_refused),
        cmocka_unit_test(test_maps_refused),
        cmocka_unit_test(test_cuts_and_mutations),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
