// The vignetting polynomials of MicaSense, Parrot, DJI and Sentera cameras.
#include <cstring>

#include "import_support.hpp"

namespace {

std::string packet(const std::string &attributes, const std::string &elements) {
    return "<?xpacket begin=\"\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">"
           "<rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
           "<rdf:Description rdf:about=\"\" xmlns:Camera=\"http://pix4d.com/camera/1.0\" "
           "xmlns:drone-dji=\"http://www.dji.com/drone-dji/1.0/\" xmlns:tiff=\"http://ns.adobe.com/tiff/1.0/\" "
           + attributes + ">" + elements + "</rdf:Description></rdf:RDF></x:xmpmeta><?xpacket end=\"w\"?>\n   \n";
}

std::string list(const std::string &name, const std::vector<double> &values) {
    std::string text = "<" + name + "><rdf:Seq>\n";
    char item[64];
    for (double value : values) {
        snprintf(item, sizeof item, "<rdf:li>%.17g</rdf:li>\n", value);
        text += item;
    }
    return text + "</rdf:Seq></" + name + ">";
}

Imported read(const std::string &text, uint32_t width = 1280, uint32_t height = 960) {
    Imported imported{};
    lensprof_error error;
    const std::vector<char> exact(text.begin(), text.end());
    imported.status =
        lp_drone_xmp_read(exact.data(), exact.size(), width, height, "a.tif", keep_entry, &imported, &error);
    imported.error = error.text;
    return imported;
}

// Compares the profile at some places with a correction by the polynomial, computed as in the maker's own software.
template <typename Attenuation>
void assert_same(const lensprof_profile &profile, uint32_t width, uint32_t height, double tolerance,
                 Attenuation exact) {
    const double x0 = width / 2, y0 = height / 2;
    const double scale = attenuation_at(profile, width, height, x0, y0) / exact(x0, y0);
    for (uint32_t y = 0; y < height; y += height / 7)
        for (uint32_t x = 0; x < width; x += width / 7)
            assert_close(attenuation_at(profile, width, height, x, y) / scale / exact(x, y), 1.0, tolerance);
}

double polynomial(const std::vector<double> &terms, double r) {
    double value = 1.0, power = r;
    for (double term : terms) value += term * power, power *= r;
    return value;
}

// Corrected = picture / (1 + c0 r + ... + c5 r^6), r in pixels from the centre. From a RedEdge: 0.64 in the corner.
const std::vector<double> kMicaSense = {-3.0e-5, -5.1e-7, 3.4e-10, -8.5e-13, 5.0e-16, -1.0e-19};

void test_micasense(void **) {
    const std::string elements =
        list("Camera:VignettingPolynomial", kMicaSense) + list("Camera:VignettingCenter", {623.6301, 464.4527});
    const Imported imported = read(packet("tiff:Make=\"MicaSense\" tiff:Model=\"RedEdge-M\"", elements));
    assert_string_equal(imported.error.c_str(), "");
    const lensprof_profile &p = *imported.profiles.at(0);
    assert_string_equal(p.key.camera_maker, "MicaSense");
    assert_string_equal(p.key.camera_model, "RedEdge-M");
    assert_int_equal(p.key.processing, LENSPROF_PROCESSING_RAW);
    assert_string_equal(p.provenance.source, "a.tif; XMP of a camera");
    assert_string_equal(p.provenance.doubt, "");
    assert_close(p.vignetting[0].center[0], (623.6301 - 639.5) / 800, 1e-12);
    assert_close(p.vignetting[0].center[1], (464.4527 - 479.5) / 800, 1e-12);
    assert_true(lensprof_vignetting_eval(&p.vignetting[0], 1.0, nullptr) < 0.7);
    assert_same(p, 1280, 960, 4e-3,
                [](double x, double y) { return polynomial(kMicaSense, std::hypot(x - 623.6301, y - 464.4527)); });
}

// Corrected = picture * (1 + k0 r + ... + k5 r^6). From a P4 Multispectral: a gain of 2.0 in the corner.
const std::vector<double> kDji = {2.18235e-4, 1.20722e-6, -2.8676e-9, 5.1742e-12, -4.16853e-15, 1.36962e-18};

void assert_dji(const Imported &imported, double x, double y) {
    assert_string_equal(imported.error.c_str(), "");
    const lensprof_profile &p = *imported.profiles.at(0);
    assert_string_equal(p.key.camera_maker, "DJI");
    assert_string_equal(p.provenance.source, "a.tif; XMP of DJI");
    assert_true(attenuation_at(p, 1600, 1300, 0, 0) < 0.6 * attenuation_at(p, 1600, 1300, 800, 650));
    assert_same(p, 1600, 1300, 1.4e-2,
                [=](double a, double b) { return 1.0 / polynomial(kDji, std::hypot(a - x, b - y)); });
}

void test_dji(void **) {
    const std::string own =
        "drone-dji:VignettingData=\"0.000218235, 1.20722E-06, -2.8676E-09, 5.1742E-12, -4.16853E-15, "
        "1.36962E-18\" ";
    const std::string center =
        "drone-dji:CalibratedOpticalCenterX=\"805\" drone-dji:CalibratedOpticalCenterY=\"640.5\" ";
    assert_dji(read(packet(own + center, ""), 1600, 1300), 805, 640.5);
    assert_dji(read(packet(own, ""), 1600, 1300), 799.5, 649.5);
    // The maker's other form of the same numbers is also a gain; its own form takes precedence.
    const std::string also = list("Camera:VignettingPolynomial", kDji) + list("Camera:VignettingCenter", {805, 640.5});
    assert_dji(read(packet("tiff:Make=\"DJI\" ", also), 1600, 1300), 805, 640.5);
    assert_dji(read(packet("drone-dji:Version=\"1.6\" ", also), 1600, 1300), 805, 640.5);
    assert_dji(read(packet(own + center, list("Camera:VignettingPolynomial", {9, 9, 9})), 1600, 1300), 805, 640.5);
    const Imported flagged = read(packet(own + "drone-dji:VignettingFlag=\"1\"", ""), 1600, 1300);
    assert_non_null(strstr(flagged.profiles.at(0)->provenance.doubt, "corrected this picture itself"));
    // As elements, and with another prefix.
    std::string text = packet("",
                              "<drone-dji:VignettingData>0.000218235,1.20722e-06,-2.8676e-09,5.1742e-12,-4.16853e-15,"
                              "1.36962e-18</drone-dji:VignettingData>");
    for (size_t at; (at = text.find("drone-dji:")) != std::string::npos;) text.replace(at, 10, "d:");
    text.replace(text.find("xmlns:drone-dji"), 15, "xmlns:d");
    assert_dji(read(text, 1600, 1300), 799.5, 649.5);
}

// Sentera writes the highest power first, which OpenDroneMap also assumes, under both of its names. The maker is
// identified by tiff:Make, by any property of its namespace, or by the key given to the import.
void test_sentera(void **) {
    const std::vector<double> reversed(kMicaSense.rbegin(), kMicaSense.rend());
    const std::string declared = "xmlns:Sentera=\"http://sentera.com/camera/1.0/\" ",
                      camera = list("Camera:VignettingPolynomial", reversed)
                               + list("Camera:VignettingCenter", {623.6301, 464.4527}),
                      own = list("Sentera:VignettingPolynomial", reversed)
                            + list("Sentera:VignettingCenter", {623.6301, 464.4527}),
                      blanks =
                          "<Sentera:VignettingPolynomial>-1.0e-19 5.0e-16 -8.5e-13 3.4e-10 -5.1e-7 -3.0e-5"
                          "</Sentera:VignettingPolynomial><Sentera:VignettingCenter>623.6301 464.4527"
                          "</Sentera:VignettingCenter>",
                      model = "tiff:Model=\"21214-00_3.2MP-GS-0001\" ", make = "tiff:Make=\"Sentera\" ";
    const auto assert_sentera = [](const Imported &imported) {
        assert_string_equal(imported.error.c_str(), "");
        const lensprof_profile &p = *imported.profiles.at(0);
        assert_string_equal(p.key.camera_maker, "Sentera");
        assert_string_equal(p.provenance.doubt, "");
        assert_same(p, 1280, 960, 4e-3,
                    [](double x, double y) { return polynomial(kMicaSense, std::hypot(x - 623.6301, y - 464.4527)); });
    };
    assert_sentera(read(packet(make + model, camera)));
    assert_sentera(read(packet(make + declared, own)));
    assert_sentera(read(packet(declared, own)));
    assert_sentera(read(packet(declared, blanks)));
    assert_sentera(read(packet(model, own)));  // an undeclared prefix
    assert_sentera(read(packet(declared + "Sentera:Session=\"2020-04-10\" ", camera)));
    assert_sentera(read(packet(make + declared, own + list("Camera:VignettingPolynomial", {9, 9, 9}))));
    // Another maker's numbers are not reversed: reversed they would not be a falloff.
    assert_int_equal(read(packet("tiff:Make=\"MicaSense\" ", camera)).status, LENSPROF_ERROR_VIGNETTING);

    // EXIF identifies the maker if the packet does not.
    lensprof_profile_key key;
    lensprof_profile_key_init(&key);
    std::snprintf(key.camera_maker, sizeof key.camera_maker, "Sentera");
    lensprof_import_options options;
    lensprof_import_options_init(&options);
    options.format = LENSPROF_FORMAT_DRONE_XMP;
    options.width = 1280, options.height = 960, options.key = &key;
    const std::string plain = packet("", camera);
    Imported imported{};
    lensprof_error error;
    imported.status = lensprof_import(plain.data(), plain.size(), &options, keep_entry, &imported, &error);
    imported.error = error.text;
    assert_sentera(imported);
}

// Corrected = picture / sum c (x / width)^i (y / height)^j. From a Sequoia, which writes all numbers in one list item.
const std::string k2d =
    "<Camera:VignettingPolynomial2DName><rdf:Seq><rdf:li>0,0,1,0,2,0,0,1,0,2,1,1</rdf:li>"
    "</rdf:Seq></Camera:VignettingPolynomial2DName><Camera:VignettingPolynomial2D><rdf:Seq>"
    "<rdf:li>0.6,0.9,-1.0,0.8,-0.9,0.1</rdf:li></rdf:Seq></Camera:VignettingPolynomial2D>";

void test_2d(void **) {
    const Imported imported = read(packet("tiff:Make=\"Parrot\"", k2d));
    assert_string_equal(imported.error.c_str(), "");
    assert_same(*imported.profiles.at(0), 1280, 960, 8e-3, [](double px, double py) {
        const double x = px / 1280, y = py / 960;
        return 0.6 + 0.9 * x - x * x + 0.8 * y - 0.9 * y * y + 0.1 * x * y;
    });
}

// In units of the frame, the polynomial is the same for frames of any size.
void test_huge_frames(void **) {
    const Imported small = read(packet("", k2d), 4000, 3000);
    const uint32_t sizes[][2] = {{40000000, 30000000}, {1u << 25, 3u << 23}, {UINT32_MAX, UINT32_MAX / 4 * 3}};
    for (const auto &size : sizes) {
        const Imported huge = read(packet("", k2d), size[0], size[1]);
        assert_string_equal(huge.error.c_str(), "");
        const lensprof_profile &p = *huge.profiles.at(0), &q = *small.profiles.at(0);
        assert_int_equal(p.grid.columns, q.grid.columns);
        for (int n = 0; n < 3; n++) assert_close(p.vignetting[0].k[n], q.vignetting[0].k[n], 5e-3);
    }
}

void test_refused(void **) {
    const auto refused = [](const std::string &text, lensprof_status status, const char *why, uint32_t width = 1280) {
        const Imported imported = read(text, width);
        assert_int_equal(imported.status, status);
        if (imported.error.find(why) == std::string::npos) fail_msg("%s", imported.error.c_str());
        assert_int_equal(imported.profiles.size(), 0);
    };
    const std::string good = list("Camera:VignettingPolynomial", kMicaSense);
    assert_ok(read(packet("", good)).status);
    refused(packet("", ""), LENSPROF_ERROR_NOT_FOUND, "no VignettingPolynomial");
    refused("", LENSPROF_ERROR_SYNTAX, "not well-formed");
    refused("<x:xmpmeta/>", LENSPROF_ERROR_SYNTAX, "rdf:RDF");
    refused(packet("", "<Camera:VignettingPolynomial>x</Camera:VignettingPolynomial>"), LENSPROF_ERROR_SYNTAX, "\"x\"");
    refused(packet("drone-dji:VignettingData=\"1,,2\"", ""), LENSPROF_ERROR_SYNTAX, "not a number");
    refused(packet("drone-dji:VignettingData=\"nan\"", ""), LENSPROF_ERROR_SYNTAX, "not a number");
    refused(packet("", list("Camera:VignettingPolynomial", std::vector<double>(17, 0.0))), LENSPROF_ERROR_SIZE,
            "over 16");
    refused(packet("", list("Camera:VignettingPolynomial", {-1e-2})), LENSPROF_ERROR_VIGNETTING, "not above 0");
    refused(packet("drone-dji:VignettingData=\"-1e-2\"", ""), LENSPROF_ERROR_VIGNETTING, "not above 0");
    refused(packet("", good + list("Camera:VignettingCenter", {1500, 20})), LENSPROF_ERROR_SYNTAX, "outside a frame");
    refused(packet("", good + list("Camera:VignettingCenter", {15})), LENSPROF_ERROR_SYNTAX, "two numbers");
    refused(
        packet("", list("Camera:VignettingPolynomial2D", {1, 2}) + list("Camera:VignettingPolynomial2DName", {0, 0})),
        LENSPROF_ERROR_SYNTAX, "two powers");
    refused(packet("", list("Camera:VignettingPolynomial2D", {1}) + list("Camera:VignettingPolynomial2DName", {0, -1})),
            LENSPROF_ERROR_SYNTAX, "integer power");
    refused(packet("", list("Camera:VignettingPolynomial2D", {-1}) + list("Camera:VignettingPolynomial2DName", {0, 0})),
            LENSPROF_ERROR_VIGNETTING, "not above 0");
    refused(packet("", good), LENSPROF_ERROR_ARGUMENT, "a side is 0", 0);
    // In another namespace, it is another property.
    std::string other = packet("", good);
    other.replace(other.find("http://pix4d.com/camera/1.0"), 27, "http://example.com/");
    refused(other, LENSPROF_ERROR_NOT_FOUND, "");
    const std::string all = packet("", good);
    for (size_t size = 0; size < all.rfind("</x:xmpmeta>"); size += 3)
        assert_int_equal(read(all.substr(0, size)).status, LENSPROF_ERROR_SYNTAX);
    assert_ok(read(all + std::string(5, '\0')).status);  // with padding, as TIFF writers add
    assert_int_equal(lp_drone_xmp_read(all.data(), all.size(), 1280, 960, nullptr, refuse_entry, nullptr, nullptr),
                     LENSPROF_ERROR_CANCELLED);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_micasense), cmocka_unit_test(test_dji),         cmocka_unit_test(test_2d),
        cmocka_unit_test(test_sentera),   cmocka_unit_test(test_huge_frames), cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
