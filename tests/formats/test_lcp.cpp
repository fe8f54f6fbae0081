// Adobe lens profiles: reading and writing.
#include <cstring>
#include <functional>

#include "import_support.hpp"

namespace {

// As in Adobe's own files: the same property as an attribute, as an element, in a resource and in a description.
const std::string kHead = R"(<x:xmpmeta xmlns:x="adobe:ns:meta/" x:xmptk="Adobe XMP Core">
 <rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
  <rdf:Description rdf:about="" xmlns:photoshop="http://ns.adobe.com/photoshop/1.0/"
    xmlns:stCamera="http://ns.adobe.com/photoshop/1.0/camera-profile">
   <photoshop:CameraProfiles>
    <rdf:Seq>)";
const std::string kTail = R"(
    </rdf:Seq>
   </photoshop:CameraProfiles>
  </rdf:Description>
 </rdf:RDF>
</x:xmpmeta>
)";
const std::string kElements = R"(
     <rdf:li rdf:parseType="Resource">
      <stCamera:Author>Acme</stCamera:Author>
      <stCamera:Make>Canon</stCamera:Make>
      <stCamera:Model>Canon EOS 5D Mark II</stCamera:Model>
      <stCamera:CameraRawProfile>True</stCamera:CameraRawProfile>
      <stCamera:Lens>EF35mm f/1.4L USM</stCamera:Lens>
      <stCamera:LensPrettyName>Canon EF 35mm f/1.4L USM</stCamera:LensPrettyName>
      <stCamera:SensorFormatFactor>1.0</stCamera:SensorFormatFactor>
      <stCamera:ImageWidth>4000</stCamera:ImageWidth>
      <stCamera:ImageLength>3000</stCamera:ImageLength>
      <stCamera:FocalLength>35</stCamera:FocalLength>
      <stCamera:FocusDistance>3</stCamera:FocusDistance>
      <stCamera:ApertureValue>0.970854</stCamera:ApertureValue>
      <stCamera:PerspectiveModel rdf:parseType="Resource">
       <stCamera:Version>2</stCamera:Version>
       <stCamera:FocalLengthX>0.9</stCamera:FocalLengthX>
       <stCamera:VignetteModel rdf:parseType="Resource">
        <stCamera:FocalLengthX>0.5</stCamera:FocalLengthX>
        <stCamera:FocalLengthY>0.5</stCamera:FocalLengthY>
        <stCamera:ImageXCenter>0.55</stCamera:ImageXCenter>
        <stCamera:ImageYCenter>0.4</stCamera:ImageYCenter>
        <stCamera:VignetteModelParam1>-0.2</stCamera:VignetteModelParam1>
        <stCamera:VignetteModelParam2>0.04</stCamera:VignetteModelParam2>
        <stCamera:VignetteModelParam3>-0.016</stCamera:VignetteModelParam3>
       </stCamera:VignetteModel>
      </stCamera:PerspectiveModel>
     </rdf:li>)";
const std::string kAttributes = R"(
     <rdf:li>
      <rdf:Description stCamera:FocalLength="35" stCamera:FocusDistance="999999995904" stCamera:ApertureValue="4">
       <stCamera:FisheyeModel>
        <rdf:Description stCamera:Version="2">
         <stCamera:VignetteModel stCamera:FocalLengthX="0.5" stCamera:VignetteModelParam1="-0.2"
           stCamera:VignetteModelParam2="0.04"/>
        </rdf:Description>
       </stCamera:FisheyeModel>
      </rdf:Description>
     </rdf:li>)";

Imported read(const std::string &text, const char *source = "my.lcp") {
    Imported imported{};
    lensprof_error error;
    const std::vector<char> exact(text.begin(), text.end());
    imported.status = lp_lcp_read(exact.data(), exact.size(), source, keep_entry, &imported, &error);
    imported.error = error.text;
    return imported;
}

Imported read_entry(const std::string &entries) { return read(kHead + entries + kTail); }

std::string replaced(std::string text, const std::string &from, const std::string &to) {
    const size_t at = text.find(from);
    assert_true(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

void test_golden(void **) {
    const Imported imported =
        read_entry(kElements + kAttributes + "<rdf:li><stCamera:Make>Acme</stCamera:Make></rdf:li>");
    assert_string_equal(imported.error.c_str(), "");
    assert_ok(imported.status);
    assert_int_equal(imported.profiles.size(), 2);  // the third has no falloff
    const lensprof_profile &first = *imported.profiles[0], &second = *imported.profiles[1];
    for (const lensprof_profile *p : {&first, &second}) {  // the second inherits missing values from the first
        assert_string_equal(p->key.camera_maker, "Canon");
        assert_string_equal(p->key.camera_model, "Canon EOS 5D Mark II");
        assert_string_equal(p->key.lens, "EF35mm f/1.4L USM");
        assert_true(p->key.crop_factor == 1 && p->key.focal_mm == 35);
        assert_int_equal(p->key.processing, LENSPROF_PROCESSING_RAW);
        assert_string_equal(p->provenance.source, "my.lcp; Adobe lens profile");
        assert_string_equal(p->provenance.doubt, "");
    }
    assert_true(first.key.aperture == 1.4 && second.key.aperture == 4.0);
    assert_true(first.key.distance_m == 3 && std::isinf(second.key.distance_m));
    // Half the diagonal of 4000 x 3000 is 2500 and the focal length 0.5 * 4000, so r in focal lengths is 1.25 in the
    // corner.
    const double s = 1.25 * 1.25;
    const double k[3] = {-0.2 * s, 0.04 * s * s, -0.016 * s * s * s};
    for (int n = 0; n < 3; n++) assert_close(first.vignetting[0].k[n], k[n], 1e-14);
    assert_close(first.vignetting[0].center[0], 0.05 * 4000 / 2500, 1e-14);
    assert_close(first.vignetting[0].center[1], -0.1 * 3000 / 2500, 1e-14);
    assert_close(second.vignetting[0].k[1], k[1], 1e-14);
    assert_true(second.vignetting[0].k[2] == 0 && second.vignetting[0].center[0] == 0);
}

void test_what_may_be_missing(void **) {
    std::string text = replaced(kElements, "<stCamera:ImageWidth>4000</stCamera:ImageWidth>", "");
    text = replaced(text, "<stCamera:Lens>EF35mm f/1.4L USM</stCamera:Lens>", "");
    text = replaced(text, "<stCamera:FocusDistance>3</stCamera:FocusDistance>", "");
    text = replaced(text, "<stCamera:ApertureValue>0.970854</stCamera:ApertureValue>", "");
    text = replaced(text, "True", "False");
    const Imported imported = read_entry(text);
    const lensprof_profile &p = *imported.profiles.at(0);
    assert_string_equal(p.key.lens, "Canon EF 35mm f/1.4L USM");
    assert_true(p.key.distance_m == LENSPROF_UNKNOWN && p.key.aperture == LENSPROF_UNKNOWN);
    assert_int_equal(p.key.processing, LENSPROF_PROCESSING_JPEG);
    // 3:2: rho / longer side = hypot(3, 2) / 2 / 3
    assert_close(p.vignetting[0].k[0], -0.2 * 13.0 / 36 / 0.25, 1e-14);
    // Without FocalLengthX: 35 mm on a full frame are 35 / 35.
    text = replaced(kElements, "<stCamera:FocalLengthX>0.5</stCamera:FocalLengthX>", "");
    text = replaced(text, "<stCamera:FocalLengthY>0.5</stCamera:FocalLengthY>", "");
    assert_close(read_entry(text).profiles.at(0)->vignetting[0].k[0], -0.2 * 0.625 * 0.625, 1e-14);
    const Imported none =
        read_entry(replaced(text, "SensorFormatFactor>1.0</stCamera:SensorFormatFactor", "X>1</stCamera:X"));
    assert_int_equal(none.status, LENSPROF_ERROR_SYNTAX);
    assert_non_null(strstr(none.error.c_str(), "without FocalLengthX"));
}

// Knots of radius and attenuation with straight lines between them, instead of the three coefficients.
void test_piecewise(void **) {
    std::string knots = "<stCamera:VignetteModelPiecewiseParam><rdf:Seq>";
    for (int i = 0; i <= 20; i++) {
        const double r = 0.08 * i;
        knots += "<rdf:li>" + std::to_string(r) + ", " + std::to_string(1 / (1 + 0.2 * r * r)) + "</rdf:li>";
    }
    knots += "</rdf:Seq></stCamera:VignetteModelPiecewiseParam>";
    const std::string text = replaced(kElements, "</stCamera:VignetteModel>", knots + "</stCamera:VignetteModel>");
    const Imported imported = read_entry(text);
    assert_string_equal(imported.error.c_str(), "");
    const lensprof_profile &p = *imported.profiles.at(0);
    assert_close(p.vignetting[0].center[0], 0.08, 1e-14);
    for (const double r : {0.2, 0.6, 0.9, 1.0}) {  // half diagonals of 1.25 focal lengths
        const double m = lensprof_vignetting_eval(&p.vignetting[0], r * r, nullptr);
        assert_close(m * (1 + 0.2 * r * r * 1.25 * 1.25), 1.0, 3e-3);
    }
    // Knots far from any such polynomial make the profile doubtful; invalid attenuations give no falloff.
    std::string step =
        "<stCamera:VignetteModelPiecewiseParam><rdf:Seq><rdf:li>0, 1</rdf:li><rdf:li>0.7, 1</rdf:li>"
        "<rdf:li>0.71, 0.6</rdf:li></rdf:Seq></stCamera:VignetteModelPiecewiseParam>";
    const auto with = [&](const std::string &list) {
        return read_entry(replaced(kElements, "</stCamera:VignetteModel>", list + "</stCamera:VignetteModel>"));
    };
    const Imported off = with(step);
    assert_int_equal(off.usable.at(0), 1);
    assert_non_null(strstr(off.profiles[0]->provenance.doubt, "its refit is off by up to"));
    const Imported zero = with(replaced(step, "0.71, 0.6", "0.71, -0.6"));
    assert_ok(zero.status);
    assert_int_equal(zero.usable.at(0), 0);
    assert_non_null(strstr(zero.profiles[0]->provenance.doubt, "not above 0"));
    for (const char *wrong : {"0.71", "0.71, x", "0.7, 0.5", "-1, 0.5", ", "})
        assert_int_equal(with(replaced(step, "0.71, 0.6", wrong)).status, LENSPROF_ERROR_SYNTAX);
}

// Knots of curves that r^6 does not hold, on a frame of 4000 x 3000 with the middle at (2200, 1200): a gain grid holds
// them within 1 % of the straight lines between the knots, or the remaining error is stated.
void test_steep_knots(void **) {
    const std::function<double(double)> curves[] = {
        [](double r) { return exp2(-4 * pow(r, 2.2)); },
        [](double r) { return pow(1 + 1.4 * r * r, -2.0); },
        [](double r) { return r < .7 ? 1 - .1 * r : .93 - 1.2 * (r - .7); },
        [](double r) { return 1 / (1 + exp(9 * (r - .95))); },
        [](double r) { return 1 - .5 * pow(r, 9); },
        [](double r) { return .35 + .65 * exp(-9 * r * r); },
    };
    for (const auto &curve : curves) {
        std::vector<double> values;
        std::string knots = "<stCamera:VignetteModelPiecewiseParam><rdf:Seq>";
        for (int i = 0; i <= 32; i++) {
            const double r = i / 20.0;  // focal lengths: the farthest corner is at 1.42
            values.push_back(std::max(curve(r / 1.42), .02));
            knots += "<rdf:li>" + std::to_string(r) + ", " + std::to_string(values.back()) + "</rdf:li>";
        }
        knots += "</rdf:Seq></stCamera:VignetteModelPiecewiseParam></stCamera:VignetteModel>";
        const Imported imported = read_entry(replaced(kElements, "</stCamera:VignetteModel>", knots));
        assert_string_equal(imported.error.c_str(), "");
        assert_int_equal(imported.usable.at(0), 1);
        const lensprof_profile &p = *imported.profiles.at(0);
        const auto truth = [&](double x, double y) {
            const double r = 20 * hypot(x + 0.5 - 2200, y + 0.5 - 1200) / 2000;
            const size_t below = static_cast<size_t>(r);
            return values[below] + (r - double(below)) * (values[below + 1] - values[below]);
        };
        const double unit = attenuation_at(p, 4000, 3000, 2199.5, 1199.5) / truth(2199.5, 1199.5);
        double worst = 0;
        for (int y = 0; y < 3000; y += 37)
            for (int x = 0; x < 4000; x += 37)
                worst = fmax(worst, fabs(attenuation_at(p, 4000, 3000, x, y) / unit / truth(x, y) - 1));
        double stated = 1;
        if (*p.provenance.doubt) sscanf(p.provenance.doubt, "its refit is off by up to %lf", &stated);
        assert_true(curve(0.5) < .5 || 100 * worst < 1.3);  // the last one is a peak in the middle
        if (100 * worst > 1.3 * stated) fail_msg("off by %g, stated %g", worst, stated);
    }
}

// Different focal lengths: ellipses, which a gain grid represents.
void test_two_focal_lengths(void **) {
    std::string text = replaced(kElements, "<stCamera:FocalLengthY>0.5<", "<stCamera:FocalLengthY>0.55<");
    const Imported imported = read_entry(text);
    const lensprof_profile &p = *imported.profiles.at(0);
    assert_true(p.grid.columns > 0);
    const auto exact = [](double x, double y) {
        const double u = (x + 0.5 - 2200) / 2000, v = (y + 0.5 - 1200) / 2200, r2 = u * u + v * v;
        return 1 - 0.2 * r2 + 0.04 * r2 * r2 - 0.016 * r2 * r2 * r2;
    };
    const double scale = attenuation_at(p, 4000, 3000, 2199.5, 1199.5);
    for (double y = 0; y < 3000; y += 428)
        for (double x = 0; x < 4000; x += 571)
            assert_close(attenuation_at(p, 4000, 3000, x, y) / scale / exact(x, y), 1.0, 5e-3);
    text = replaced(text, "Param1>-0.2<", "Param1>-2<");
    assert_int_equal(read_entry(text).usable.at(0), 0);
}

std::string write(const std::vector<lensprof_profile> &profiles, uint32_t width = 6000, uint32_t height = 4000,
                  lensprof_status expected = LENSPROF_OK, const char *why = "") {
    std::vector<const lensprof_profile *> pointers;
    for (const lensprof_profile &profile : profiles) pointers.push_back(&profile);
    const auto count = static_cast<uint32_t>(profiles.size());
    size_t needed = 0;
    lensprof_error error;
    lensprof_status status = lp_lcp_write(pointers.data(), count, width, height, nullptr, 0, &needed, &error);
    std::string text(needed, '\0');
    if (status == LENSPROF_OK)
        status = lp_lcp_write(pointers.data(), count, width, height, text.data(), needed, &needed, &error);
    assert_int_equal(status, expected);
    assert_non_null(strstr(error.text, why));
    return status == LENSPROF_OK ? text : "";
}

lensprof_profile lens_profile(double focal, double aperture, double distance) {
    lensprof_profile p = *profile_of(-0.3, 0.1, -0.05, 0.04, -0.03);
    strcpy(p.key.camera_maker, "Acme");
    strcpy(p.key.camera_model, "Acme <One> & \"Two\"");
    strcpy(p.key.lens, "Acme 24-70mm f/2.8 \xC3\xA9");
    p.key.crop_factor = 1.523, p.key.focal_mm = focal, p.key.aperture = aperture, p.key.distance_m = distance;
    p.key.processing = LENSPROF_PROCESSING_RAW;
    return p;
}

void test_written_golden(void **) {
    lensprof_profile p = lens_profile(36, 2.8284271247461903, 2.5);
    p.key.crop_factor = 1;
    strcpy(p.key.camera_model, "One");
    strcpy(p.key.lens, "A");
    p.vignetting[0] = {{-0.25, 0, 0}, {0, 0}};
    const std::string text = write({p}, 3600, 2400);
    const char *const expected[] = {"<x:xmpmeta xmlns:x=\"adobe:ns:meta/\">",
                                    "xmlns:stCamera=\"http://ns.adobe.com/photoshop/1.0/camera-profile\"",
                                    "<rdf:li rdf:parseType=\"Resource\">",
                                    "<stCamera:Make>Acme</stCamera:Make>",
                                    "<stCamera:Model>One</stCamera:Model>",
                                    "<stCamera:CameraRawProfile>True</stCamera:CameraRawProfile>",
                                    "<stCamera:Lens>A</stCamera:Lens>",
                                    "<stCamera:SensorFormatFactor>1</stCamera:SensorFormatFactor>",
                                    "<stCamera:ImageWidth>3600</stCamera:ImageWidth>",
                                    "<stCamera:FocalLength>36</stCamera:FocalLength>",
                                    "<stCamera:FocusDistance>2.5</stCamera:FocusDistance>",
                                    "<stCamera:ApertureValue>3</stCamera:ApertureValue>",
                                    "<stCamera:VignetteModel rdf:parseType=\"Resource\">",
                                    "<stCamera:ImageXCenter>0.5</stCamera:ImageXCenter>"};
    size_t at = 0;
    for (const char *piece : expected) {
        at = text.find(piece, at);
        if (at == std::string::npos) fail_msg("missing: %s in %s", piece, text.c_str());
    }
    // 36 mm is the longer side: the focal length is 1 of it, and -0.25 per half diagonal squared is -0.25 (36 /
    // 21.633)^2.
    const auto number = [&](const std::string &name) {
        return std::stod(text.substr(text.rfind("<" + name + ">") + name.size() + 2));
    };
    assert_close(number("stCamera:FocalLengthX"), 1.0, 1e-12);
    assert_close(number("stCamera:VignetteModelParam1"), -0.25 * 36 * 36 / 468, 1e-12);
}

void test_round_trip(void **) {
    std::vector<lensprof_profile> profiles;
    for (const double focal : {24.0, 51.3})
        for (const double aperture : {1.4, 2.8, 3.7771})
            for (const double distance : {0.45, 7.123456789, double(INFINITY), LENSPROF_UNKNOWN})
                profiles.push_back(lens_profile(focal, aperture, distance));
    for (const bool known : {true, false}) {
        const Imported back = read(write(profiles, known ? 6001 : 0, known ? 4003 : 0));
        assert_string_equal(back.error.c_str(), "");
        assert_int_equal(back.profiles.size(), profiles.size());
        for (size_t i = 0; i < profiles.size(); i++) {
            const lensprof_profile &a = profiles[i], &b = *back.profiles[i];
            assert_string_equal(a.key.lens, b.key.lens);
            assert_string_equal(a.key.camera_model, b.key.camera_model);
            assert_true(a.key.focal_mm == b.key.focal_mm && a.key.distance_m == b.key.distance_m);
            assert_true(a.key.crop_factor == b.key.crop_factor && a.key.processing == b.key.processing);
            assert_close(a.key.aperture, b.key.aperture, 1e-14);
            for (int n = 0; n < 3; n++) assert_close(a.vignetting[0].k[n], b.vignetting[0].k[n], 1e-12);
            for (int n = 0; n < 2; n++) assert_close(a.vignetting[0].center[n], b.vignetting[0].center[n], 1e-12);
        }
    }
    assert_int_equal(read(write({})).profiles.size(), 0);
}

void test_mean_of_channels(void **) {
    lensprof_profile p = lens_profile(24, 2, 1);
    p.vignettings = 3;
    for (uint32_t c = 0; c < 3; c++) p.vignetting[c] = {{-0.3 - 0.1 * c, 0.1, -0.05}, {0.04, -0.03}};
    assert_close(read(write({p})).profiles.at(0)->vignetting[0].k[0], -0.4, 1e-12);
}

void test_write_refused(void **) {
    const lensprof_profile good = lens_profile(24, 2, 1);
    const auto refused = [&](void (*change)(lensprof_profile &), lensprof_status status, const char *why) {
        lensprof_profile bad = lens_profile(24, 4, 1);
        change(bad);
        write({good, bad}, 0, 0, status, why);
    };
    using P = lensprof_profile &;
    refused([](P p) { p.key.lens[0] = 0; }, LENSPROF_ERROR_ARGUMENT, "profile 1: its lens is unknown");
    refused([](P p) { p.key.aperture = LENSPROF_UNKNOWN; }, LENSPROF_ERROR_ARGUMENT, "aperture");
    refused([](P p) { p.key.focal_mm = LENSPROF_UNKNOWN; }, LENSPROF_ERROR_ARGUMENT, "focal length");
    refused([](P p) { p.key.crop_factor = LENSPROF_UNKNOWN; }, LENSPROF_ERROR_ARGUMENT, "crop factor");
    refused([](P p) { p.key.aperture = 2; }, LENSPROF_ERROR_ARGUMENT, "same setting as an earlier profile");
    refused([](P p) { p.key.lens[0] = 'B'; }, LENSPROF_ERROR_ARGUMENT, "a lens profile holds only one");
    refused([](P p) { p.key.camera_model[0] = 'B'; }, LENSPROF_ERROR_ARGUMENT, "a lens profile holds only one");
    refused([](P p) { p.key.processing = LENSPROF_PROCESSING_JPEG; }, LENSPROF_ERROR_ARGUMENT,
            "a lens profile holds only one");
    refused([](P p) { p.key.processing = LENSPROF_PROCESSING_CORRECTED; }, LENSPROF_ERROR_UNSUPPORTED, "in camera");
    refused([](P p) { strcpy(p.key.camera_maker, "\xFF"); }, LENSPROF_ERROR_ARGUMENT, "UTF-8");
    refused([](P p) { strcpy(p.key.lens, "\xFF"); }, LENSPROF_ERROR_ARGUMENT, "UTF-8");
    refused([](P p) { p.vignetting[0].k[0] = -3; }, LENSPROF_ERROR_VIGNETTING, "is invalid");
    refused(
        [](P p) {
            p.grid.columns = p.grid.rows = 2, p.grid.channels = 1;
            for (int i = 0; i < 4; i++) p.grid.attenuation[i] = 1;
        },
        LENSPROF_ERROR_UNSUPPORTED, "gain grid");
    write({good}, 100, 0, LENSPROF_ERROR_ARGUMENT, "only one side");
    write({good}, 2000000, 100, LENSPROF_ERROR_SIZE, "million");
    const lensprof_profile *none = nullptr;
    assert_int_equal(lp_lcp_write(&none, 1, 0, 0, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_lcp_write(nullptr, 1, 0, 0, nullptr, 0, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
}

void test_read_refused(void **) {
    const auto refused = [](const std::string &text, lensprof_status status, const char *why) {
        const Imported imported = read(text);
        assert_int_equal(imported.status, status);
        if (imported.error.find(why) == std::string::npos) fail_msg("%s", imported.error.c_str());
        assert_int_equal(imported.profiles.size(), 0);
    };
    const auto with = [](const std::string &from, const std::string &to) {
        return kHead + kElements + replaced(kElements, from, to) + kTail;
    };
    refused("", LENSPROF_ERROR_SYNTAX, "not well-formed");
    refused("<html/>", LENSPROF_ERROR_SYNTAX, "x:xmpmeta");
    refused("<x:xmpmeta><rdf:RDF/></x:xmpmeta>", LENSPROF_ERROR_SYNTAX, "no photoshop:CameraProfiles");
    refused(with("Param1>-0.2", "Param1>x"), LENSPROF_ERROR_SYNTAX, "VignetteModelParam1 is \"x\"");
    refused(with("Param2>0.04", "Param2>nan"), LENSPROF_ERROR_SYNTAX, "not a number");
    refused(with("FocalLengthX>0.5", "FocalLengthX>-1"), LENSPROF_ERROR_SYNTAX, "FocalLengthX");
    refused(with("XCenter>0.55", "XCenter>55"), LENSPROF_ERROR_SYNTAX, "ImageXCenter");
    refused(with("ApertureValue>0.970854", "ApertureValue>1e9"), LENSPROF_ERROR_SYNTAX, "ApertureValue");
    refused(with("<stCamera:Make>Canon", "<stCamera:Make>" + std::string(64, 'x')), LENSPROF_ERROR_SYNTAX,
            "longer than 63");
    refused(with("<stCamera:Make>Canon", "<stCamera:Make>&#1;"), LENSPROF_ERROR_SYNTAX, "control characters");
    const std::string all = kHead + kElements + kAttributes + kTail;
    for (size_t size = 0; size + 2 < all.size(); size += 7) refused(all.substr(0, size), LENSPROF_ERROR_SYNTAX, "");
    std::string many;
    for (int i = 0; i < 20001; i++) many += "<rdf:li/>";
    refused(kHead + many + kTail, LENSPROF_ERROR_SIZE, "over 20000 entries");
    assert_int_equal(lp_lcp_read(all.data(), all.size(), nullptr, refuse_entry, nullptr, nullptr),
                     LENSPROF_ERROR_CANCELLED);
    assert_int_equal(lp_lcp_read(nullptr, 1, nullptr, refuse_entry, nullptr, nullptr), LENSPROF_ERROR_ARGUMENT);
}

}  // namespace

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_golden),
        cmocka_unit_test(test_what_may_be_missing),
        cmocka_unit_test(test_piecewise),
        cmocka_unit_test(test_steep_knots),
        cmocka_unit_test(test_two_focal_lengths),
        cmocka_unit_test(test_written_golden),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_mean_of_channels),
        cmocka_unit_test(test_write_refused),
        cmocka_unit_test(test_read_refused),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
