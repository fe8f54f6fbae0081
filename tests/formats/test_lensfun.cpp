// Lensfun databases: reading and writing.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

#include <pugixml.hpp>

#include "core/profile.h"
#include "lensfun_support.hpp"

namespace {

const std::string kGolden = R"(<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE lensdatabase SYSTEM "lensfun-database.dtd" [<!ENTITY e "expanded">]>
<!-- <vignetting model="pa"/> -->
<lensdatabase version="2">
    <mount><name>Nikon F</name><compat>Generic</compat></mount>
    <camera><maker>Canon Inc.</maker><maker lang="en">Canon</maker><model>PowerShot X</model><mount>canonX</mount>
        <cropfactor>4.843</cropfactor></camera>
    <camera><maker>Casio</maker><model>One</model><mount>casioTwo</mount></camera>
    <camera><maker>Casio</maker><model>Two</model><mount>casioTwo</mount></camera>
    <lens>
        <maker>Nikon</maker>
        <model lang="de">anders</model>
        <model>Nikkor  50mm
            f/1.8 &amp; &e;</model>
        <model lang="en">english</model>
        <mount>Nikon F</mount>
        <cropfactor>1.523</cropfactor>
        <calibration>
            <distortion model="ptlens" focal="50" a="0" b="0" c="0"/>
            <vignetting model="pa" focal="50" aperture="1.8" distance="10" k1="-0.5" k2="0.25" k3="-0.125"/>
            <vignetting model="pa" focal="50" aperture="2.8" distance="1000" k1=" -.25 " k2='+1e-2'/>
        </calibration>
        <calibration cropfactor="1" aspect-ratio="4:3">
            <distortion model="ptlens" focal="35" real-focal="36.05551275463989" a="0"/>
            <vignetting model="acm" focal="35" aperture="4" distance="2000" alpha1="-0.5" alpha2="0.25" alpha3="-0.1"/>
            <vignetting model="acm" focal="50" aperture="4" distance="0.45" alpha1="-0.5"/>
        </calibration>
    </lens>
    <lens><model lang="en">CANON fixed</model><maker>Canon</maker><mount>canonX</mount><cropfactor>4.843</cropfactor>
        <aspect-ratio>4:3</aspect-ratio><center x="0.5" y="-0.25"/>
        <calibration><vignetting model="pa" focal="7" aperture="2" distance="1" k1="-0.3" k2="0" k3="0"/></calibration>
    </lens>
    <lens><maker>Casio</maker><model>&#70;ixed</model><mount>casioTwo</mount><cropfactor>5</cropfactor><calibration>
        <vignetting model="pa" focal="7" aperture="2" distance="1" k1="-0.5" k2="-1.0" k3="0.25"/>
        <vignetting model="pa" focal="7" aperture="4" distance="1" k1="-0.5" k2="0.75" k3="0"/>
        <vignetting model="pa" focal="7" aperture="8" distance="1" k1="-0.9995" k2="0" k3="0"/>
        <vignetting model="pa" focal="7" aperture="9" distance="1" k1="-2" k2="1e7" k3="0"/>
    </calibration></lens>
    <lens><model>without calibration, so without what it needs</model></lens>
</lensdatabase>
)";

void test_golden(void **) {
    const Database database = read_lensfun(kGolden, "dir/golden.xml");
    assert_string_equal(database.error.c_str(), "");
    assert_ok(database.status);
    const std::vector<Falloff> &all = database.entries;
    assert_int_equal(all.size(), 9);
    const char *nikkor = "Nikon Nikkor 50mm f/1.8 & &e;";
    for (int i = 0; i < 4; i++) assert_string_equal(all[i].key.lens, nikkor);
    assert_true(all[0].key.focal_mm == 50 && all[0].key.aperture == 1.8 && all[0].key.distance_m == 10);
    assert_true(all[0].vignetting.k[0] == -0.5 && all[0].vignetting.k[1] == 0.25 && all[0].vignetting.k[2] == -0.125);
    assert_true(all[1].vignetting.k[0] == -0.25 && all[1].vignetting.k[1] == 0.01 && all[1].vignetting.k[2] == 0);
    assert_true(std::isinf(all[1].key.distance_m) && all[2].key.distance_m == 2000 && all[3].key.distance_m == 0.45);
    assert_true(all[0].key.crop_factor == 1.523 && all[2].key.crop_factor == 1);
    assert_int_equal(all[0].key.processing, LENSPROF_PROCESSING_RAW);
    assert_string_equal(all[0].key.camera_model, "");
    assert_string_equal(all[0].provenance.method, "import");
    assert_string_equal(all[0].provenance.software, "lensprof 0.3.0");
    assert_string_equal(all[0].provenance.source, "dir/golden.xml; Lensfun database, CC BY-SA 3.0");
    assert_true(all[0].provenance.created_unix_s == 0 && all[0].provenance.heldout_rms == LENSPROF_UNKNOWN);
    for (const Falloff &entry : all) assert_true(entry.usable == (entry.valid == LENSPROF_OK));
    for (int i = 0; i < 4; i++) assert_string_equal(all[i].provenance.doubt, "");
}

// Half the diagonal of 36 x 24 is 21.633 = 6/10 of 36.0555, so r in focal lengths is 0.6 in the corner.
// Fixed lenses: the only lens of a mount; of several, the one without a converter; if ambiguous, none.
const std::string kCameras = R"(<lensdatabase version="2">
    <camera><maker>Canon Inc.</maker><maker lang="en">Canon</maker><model>Canon  PowerShot X</model>
        <model lang="en">PowerShot X</model><mount>canonX</mount><cropfactor> 4.843 </cropfactor></camera>
    <camera><maker>Casio</maker><model>One</model><variant>4:3</variant><mount>casioTwo</mount></camera>
    <camera><maker>Fujifilm</maker><model>X100V</model><mount>fujiX</mount><cropfactor>1.5</cropfactor></camera>
    <camera><maker>Sony</maker><model>ILCE-7M3</model><model lang="en">Alpha 7 III</model><mount>Sony E</mount>
        <cropfactor>1</cropfactor></camera>
    <camera><maker>Ricoh</maker><model>GR</model><mount>gr</mount><cropfactor>1.5</cropfactor></camera>
    <camera><maker>nobody</maker><mount>none</mount></camera>
    <lens><maker>Canon</maker><model>X (Standard)</model><mount>canonX</mount></lens>
    <lens><maker>Canon</maker><model>X, with W</model><mount>canonX</mount></lens>
    <lens><maker>Casio</maker><model>Lens</model><mount>casioTwo</mount></lens>
    <lens><model>a</model><mount>fujiX</mount></lens>
    <lens><model>b</model><mount>fujiX</mount></lens>
    <lens><model>GR &amp; compatibles</model><mount>gr</mount></lens>
    <lens><model>GR &amp; compatibles, with GW</model><mount>gr</mount></lens>
    <lens><maker>Sony</maker><model>FE 50</model><mount>Sony E</mount></lens>
</lensdatabase>)";

using Cameras = std::vector<lensprof_camera_model>;

lensprof_status keep_camera(void *user, const lensprof_camera_model *camera) {
    static_cast<Cameras *>(user)->push_back(*camera);
    return camera->model[0] == '!' ? LENSPROF_ERROR_CANCELLED : LENSPROF_OK;
}

lensprof_status read_cameras(const std::string &text, Cameras &cameras, lensprof_error &error) {
    cameras.clear();
    return lensprof_lensfun_read_cameras(text.data(), text.size(), "a.xml", keep_camera, &cameras, &error);
}

void test_cameras(void **) {
    Cameras all;
    lensprof_error error{};
    assert_ok(read_cameras(kCameras, all, error));
    assert_int_equal(all.size(), 5);
    for (const auto &camera : all) assert_ok(lp_camera_model_validate(&camera));
    assert_string_equal(all[0].maker, "Canon Inc.");
    assert_string_equal(all[0].other_maker, "Canon");
    assert_string_equal(all[0].model, "Canon PowerShot X");
    assert_string_equal(all[0].other_model, "PowerShot X");
    assert_string_equal(all[0].mount, "canonX");
    assert_string_equal(all[0].lens, "Canon X (Standard)");
    assert_string_equal(all[0].source, "a.xml; Lensfun database, CC BY-SA 3.0");
    assert_close(all[0].crop_factor, 4.843, 0);
    assert_int_equal(all[0].fixed_lens, 1);
    assert_string_equal(all[1].variant, "4:3");
    assert_string_equal(all[1].lens, "Casio Lens");
    assert_string_equal(all[1].other_model, "");
    assert_close(all[1].crop_factor, LENSPROF_UNKNOWN, 0);
    assert_string_equal(all[2].lens, "");
    assert_int_equal(all[2].fixed_lens, 1);
    assert_string_equal(all[3].lens, "");
    assert_int_equal(all[3].fixed_lens, 0);
    assert_string_equal(all[4].lens, "GR & compatibles");
}

void test_wrong_cameras(void **) {
    Cameras all;
    lensprof_error error{};
    const std::string start = "<lensdatabase><camera><maker>a</maker><model>!</model></camera>\n<camera><model>",
                      end = "</cropfactor></camera></lensdatabase>";
    const std::pair<std::string, const char *> wrong[] = {
        {start + "B</model><cropfactor>x" + end, "line 2: camera \"B\": cropfactor is \"x\", not a number above 0"},
        {start + "B</model><cropfactor>0" + end, "cropfactor is \"0\""},
        {start + "B</model><cropfactor>inf" + end, "cropfactor is \"inf\""},
        {start + std::string(64, 'B') + "</model><cropfactor>1" + end, "longer than 63 bytes"},
        {"<lensdatabase version=\"3\"/>", "version \"3\""},
        {"<lensdatabase><camera>", "line 1"}};
    for (const auto &one : wrong) {
        assert_true(read_cameras(one.first, all, error) != LENSPROF_OK);
        if (!strstr(error.text, one.second)) fail_msg("%s", error.text);
        assert_true(all.empty());  // everything is checked first
    }
    assert_int_equal(read_cameras("<lensdatabase><camera><model>!</model></camera></lensdatabase>", all, error),
                     LENSPROF_ERROR_CANCELLED);
    assert_int_equal(lensprof_lensfun_read_cameras(nullptr, 1, nullptr, keep_camera, &all, &error),
                     LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lensprof_lensfun_read_cameras("", 0, nullptr, nullptr, &all, &error), LENSPROF_ERROR_ARGUMENT);
}

void test_radius_conventions(void **) {
    const std::vector<Falloff> all = read_lensfun(kGolden).entries;
    assert_int_equal(all.size(), 9);
    assert_close(all[2].vignetting.k[0], -0.5 * 0.36, 1e-15);
    assert_close(all[2].vignetting.k[1], 0.25 * 0.36 * 0.36, 1e-15);
    assert_close(all[2].vignetting.k[2], -0.1 * 0.36 * 0.36 * 0.36, 1e-15);
    assert_close(all[3].vignetting.k[0], -0.5 * 468 / 2500, 1e-15);  // at 50 mm: no real-focal
    // 4:3: half the shorter side is 3/5 of half the diagonal.
    assert_close(all[4].vignetting.center[0], 0.3, 1e-15);
    assert_close(all[4].vignetting.center[1], -0.15, 1e-15);
    assert_true(all[5].vignetting.center[0] == 0);
}

void test_fixed_lenses_and_doubts(void **) {
    const std::vector<Falloff> all = read_lensfun(kGolden).entries;
    assert_int_equal(all.size(), 9);
    assert_string_equal(all[4].key.lens, "CANON fixed");
    assert_string_equal(all[4].key.camera_maker, "Canon Inc.");
    assert_string_equal(all[4].key.camera_model, "PowerShot X");
    assert_string_equal(all[5].key.lens, "Casio Fixed");
    assert_string_equal(all[5].key.camera_model, "");  // two cameras have this lens
    const struct {
        uint32_t usable;
        const char *doubt;
    } expected[5] = {{1, "start values of a fit that failed"},
                     {0, "M is negative at r = 0.92"},
                     {1, "M rises from 0.917 to 1.25 at r = 1.00"},
                     {0, "M falls below 0.001 at r = 1.00"},
                     {0, "a coefficient is too large"}};
    for (int i = 0; i < 5; i++) {
        assert_int_equal(all[4 + i].usable, expected[i].usable);
        assert_string_equal(all[4 + i].provenance.doubt, expected[i].doubt);
    }
}

void test_source(void **) {
    const struct {
        std::string source, shown;
    } cases[] = {{"", "Lensfun database, CC BY-SA 3.0"},
                 {"a\nb", "a?b; Lensfun database, CC BY-SA 3.0"},
                 {"\xFF", "Lensfun database, CC BY-SA 3.0"}};
    for (const auto &c : cases)
        assert_string_equal(read_lensfun(kGolden, c.source.c_str()).entries[0].provenance.source, c.shown.c_str());
    assert_string_equal(read_lensfun(kGolden, nullptr).entries[0].provenance.source, cases[0].shown.c_str());
    std::string lengthy;
    for (int i = 0; i < 200; i++) lengthy += "\u00e9";  // two bytes each: must not be cut in half
    for (const std::string &source : {lengthy, "x" + lengthy}) {
        const Database database = read_lensfun(kGolden, source.c_str());
        assert_int_equal(database.entries[0].valid, LENSPROF_OK);
        const std::string shown = database.entries[0].provenance.source;
        assert_true(shown.size() > 230);
        assert_int_equal(shown.find("; Lensfun database, CC BY-SA 3.0") % 2, source.size() % 2);
    }
}

lensprof_status stop_at_third(void *user, const lensprof_import_entry *) {
    return ++*static_cast<int *>(user) == 3 ? LENSPROF_ERROR_FULL : LENSPROF_OK;
}

void test_visitor_stops(void **) {
    int count = 0;
    lensprof_error error;
    assert_int_equal(lp_lensfun_read(kGolden.data(), kGolden.size(), "", stop_at_third, &count, &error),
                     LENSPROF_ERROR_FULL);
    assert_int_equal(count, 3);
    assert_string_equal(error.text, "");
}

void expect_error(const std::string &text, lensprof_status status, const char *words) {
    const Database database = read_lensfun(text);
    if (database.status != status || database.error.find(words) == std::string::npos
        || database.error.find(';') == std::string::npos)
        print_error("status %d, \"%s\", not %d with \"%s\"\n", database.status, database.error.c_str(), status, words);
    assert_int_equal(database.status, status);
    assert_non_null(strstr(database.error.c_str(), words));
    assert_non_null(strchr(database.error.c_str(), ';'));
    assert_int_equal(database.entries.size(), 0);  // a text with an error delivers no entries
}

std::string replaced(std::string text, const std::string &old_words, const std::string &new_words) {
    const size_t at = text.find(old_words);
    if (at == std::string::npos) return "the test does not hold " + old_words;
    return text.replace(at, old_words.size(), new_words);
}

void test_wrong_values(void **) {
    const struct {
        const char *old_words, *new_words, *error;
    } cases[] = {
        {"k1=\"-0.5\"", "k1=\"-0,5\"", "line 20: lens \"Nikon Nikkor 50mm f/1.8 & &e;\": k1 is \"-0,5\", not a finite"},
        {"k1=\"-0.5\"", "k1=\"nan\"", "k1 is \"nan\""},
        {"k1=\"-0.5\"", "k1=\"1e999\"", "k1 is \"1e999\""},
        {"k1=\"-0.5\"", "k1=\"\"", "k1 is \"\""},
        {"k1=\"-0.5\"", "", "line 20: lens \"Nikon Nikkor 50mm f/1.8 & &e;\": <vignetting> has no k1"},
        {"alpha1=\"-0.5\"", "alpha1=\"0x1p3\"", "alpha1 is \"0x1p3\""},
        {"alpha1=\"-0.5\"", "alpha1=\"1e300\" x=\"", "not well-formed XML"},
        {"real-focal=\"36.05551275463989\"", "real-focal=\"0\"", "real-focal is \"0\", not above 0"},
        {"real-focal=\"36.05551275463989\"", "real-focal=\"1e-200\"", "coefficients out of range"},
        {"focal=\"50\" aperture", "aperture", "has no focal"},
        {"focal=\"50\" aperture", "focal=\"-50\" aperture", "focal is \"-50\", not above 0"},
        {"aperture=\"1.8\"", "aperture=\"f/1.8\"", "aperture is \"f/1.8\""},
        {"aperture=\"1.8\"", "aperture=\"1e9\"", "aperture is \"1e9\", not above 0 and up to 10000"},
        {"distance=\"10\"", "distance=\"0\"", "distance is \"0\", not above 0"},
        {"distance=\"10\"", "distance=\"inf\"", "distance is \"inf\""},
        {"cropfactor>1.523<", "cropfactor><", "cropfactor is \"\""},
        {"cropfactor>1.523<", "cropfactor>0<", "cropfactor is \"0\", not above 0"},
        {"<cropfactor>1.523</cropfactor>", "", "no <cropfactor>"},
        {"cropfactor=\"1\"", "cropfactor=\"wide\"", "cropfactor is \"wide\""},
        {"<aspect-ratio>4:3", "<aspect-ratio>4:", "aspect ratio is \"\""},
        {"<aspect-ratio>4:3", "<aspect-ratio>4:0", "aspect ratio is \"0\""},
        {"x=\"0.5\"", "x=\"left\"", "x is \"left\""},
        {"<model>&#70;ixed</model>", "", "a <lens> without a <model>"},
        {"version=\"2\"", "version=\"new\"", "line 4: the version is \"new\""},
    };
    for (const auto &c : cases)
        expect_error(replaced(kGolden, c.old_words, c.new_words), LENSPROF_ERROR_SYNTAX, c.error);
    expect_error(replaced(kGolden, "version=\"2\"", "version=\"3\""), LENSPROF_ERROR_UNSUPPORTED, "version \"3\"");
    expect_error(replaced(kGolden, "model=\"acm\"", "model=\"poly\""), LENSPROF_ERROR_UNSUPPORTED, "model \"poly\"");
    expect_error(replaced(kGolden, "model=\"acm\"", ""), LENSPROF_ERROR_UNSUPPORTED, "model \"\"");
    const std::string lengthy(200, 'x');
    expect_error(replaced(kGolden, "&#70;ixed", lengthy), LENSPROF_ERROR_SYNTAX, "longer than 127 bytes");
    expect_error(replaced(kGolden, "PowerShot X", lengthy), LENSPROF_ERROR_SYNTAX, "longer than 63 bytes");
    expect_error(replaced(kGolden, "&#70;ixed", "a&#7;b"), LENSPROF_ERROR_SYNTAX, "control characters");
    expect_error(replaced(kGolden, "&#70;ixed", "a&#xD800;b"), LENSPROF_ERROR_SYNTAX, "invalid characters");
    assert_ok(read_lensfun(replaced(kGolden, " version=\"2\"", "")).status);
}

void test_not_xml(void **) {
    expect_error("", LENSPROF_ERROR_SYNTAX, "line 1: not well-formed XML");
    expect_error("P6 10 10 255\n", LENSPROF_ERROR_SYNTAX, "not well-formed XML");
    expect_error("<lcp/>", LENSPROF_ERROR_SYNTAX, "must be the only outermost element, not \"lcp\"");
    expect_error("<lensdatabase/>\n<lensdatabase/>", LENSPROF_ERROR_SYNTAX, "line 2: <lensdatabase> must be the only");
    expect_error(replaced(kGolden, "anders", "\xE4nders"), LENSPROF_ERROR_SYNTAX, "line 12: not UTF-8");
    expect_error(replaced(kGolden, "anders", std::string("an\0ders", 7)), LENSPROF_ERROR_SYNTAX, "line 12: not UTF-8");
    expect_error(kGolden + std::string(1, '\0'), LENSPROF_ERROR_SYNTAX, "not UTF-8");
    for (const char *bytes : {"\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF0\x80\x80\x80", "\xF4\x90\x80\x80",
                              "\xF5\x80\x80\x80", "\x80", "\xE2\x82", "\xFF\xFE<\xC3"})
        expect_error(bytes, LENSPROF_ERROR_SYNTAX, "not UTF-8");
    assert_ok(read_lensfun("\xEF\xBB\xBF<lensdatabase version=\"1\"/>").status);  // a byte order mark
    assert_ok(read_lensfun("<lensdatabase>\u00e4\u20ac\U0001F4F7</lensdatabase>").status);
}

// A file cut anywhere is an error and delivers nothing, unless the cut is after its last element.
void test_cut_anywhere(void **) {
    const size_t whole = kGolden.rfind('>') + 1;
    for (size_t bytes = 0; bytes < kGolden.size(); bytes++) {
        const Database database = read_lensfun(kGolden.substr(0, bytes));
        assert_int_equal(database.status, bytes < whole ? LENSPROF_ERROR_SYNTAX : LENSPROF_OK);
        assert_int_equal(database.entries.size(), bytes < whole ? 0 : 9);
    }
}

std::string repeated(const std::string &piece, size_t count) {
    std::string text;
    text.reserve(piece.size() * count);
    while (count--) text += piece;
    return text;
}

void test_bombs(void **) {
    expect_error(repeated("<a>", 300000), LENSPROF_ERROR_SYNTAX, "not well-formed");
    const std::string deep = repeated("<lens>", 300000) + repeated("</lens>", 300000);
    assert_ok(read_lensfun("<lensdatabase><mount>" + deep + "</mount></lensdatabase>").status);
    expect_error("<lensdatabase>" + repeated("<a/>", 2000001) + "</lensdatabase>", LENSPROF_ERROR_SIZE, "2 million");
    expect_error("<lensdatabase>" + repeated("=", 2000001) + "</lensdatabase>", LENSPROF_ERROR_SIZE, "2 million");
    expect_error(std::string((size_t{64} << 20) + 1, ' '), LENSPROF_ERROR_SIZE, "64 MiB");
    const std::string laughs =
        "<!DOCTYPE lensdatabase [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;\">"
        "<!ENTITY x SYSTEM \"file:///etc/passwd\">]><lensdatabase><lens><model>&b;&x;</model>"
        "<cropfactor>1</cropfactor><calibration><vignetting model=\"pa\" focal=\"1\" "
        "aperture=\"1\" distance=\"1\" k1=\"0\"/></calibration></lens></lensdatabase>";
    const Database database = read_lensfun(laughs);
    assert_ok(database.status);
    assert_string_equal(database.entries[0].key.lens, "&b;&x;");
}

const char *const kWritten = R"(<!-- written by lensprof 0.3.0 -->
<lensdatabase version="1">
    <lens>
        <maker>Zeiss</maker>
        <model>Carl Zeiss &lt;50mm&gt; &amp; "more"</model>
        <mount>Generic</mount>
        <cropfactor>1.5</cropfactor>
        <calibration>
            <vignetting model="pa" focal="50" aperture="1.8" distance="10" k1="-0.3000" k2="0.0000" k3="0.0000"/>
            <vignetting model="pa" focal="50" aperture="1.8" distance="1000" k1="-0.3000" k2="0.0000" k3="0.0000"/>
            <vignetting model="pa" focal="50" aperture="2" distance="0.45" k1="-0.2000" k2="0.1000" k3="0.0000"/>
        </calibration>
    </lens>
    <lens>
        <maker>Zeiss</maker>
        <model>Carl Zeiss &lt;50mm&gt; &amp; "more"</model>
        <mount>Generic</mount>
        <cropfactor>1</cropfactor>
        <calibration>
            <vignetting model="pa" focal="50" aperture="1.8" distance="10" k1="-0.5000" k2="0.0000" k3="0.0000"/>
            <vignetting model="pa" focal="50" aperture="1.8" distance="1000" k1="-0.5000" k2="0.0000" k3="0.0000"/>
        </calibration>
    </lens>
</lensdatabase>
)";

std::vector<lensprof_profile> three_profiles() {
    const char *lens = "Carl Zeiss <50mm> & \"more\"";
    std::vector<lensprof_profile> profiles = {lens_profile(lens, 1.5, 50, 1.8, LENSPROF_UNKNOWN, -0.1 - 0.2),
                                              lens_profile(lens, 1, 50, 1.8, INFINITY, -0.5),
                                              lens_profile(lens, 1.5, 50, 2, 0.45, -0.1, 0.1)};
    profiles[2].vignettings = 3;
    profiles[2].vignetting[1] = {{-0.2, 0.1, 0}, {0, 0}};
    profiles[2].vignetting[2] = {{-0.3, 0.1, 0}, {0, 0}};
    return profiles;
}

void test_written(void **) {
    assert_string_equal(write_lensfun(three_profiles()).c_str(), kWritten);
    const Database again = read_lensfun(kWritten);
    assert_ok(again.status);
    assert_int_equal(again.entries.size(), 5);
    assert_string_equal(again.entries[0].key.lens, "Zeiss Carl Zeiss <50mm> & \"more\"");
    assert_true(again.entries[3].key.crop_factor == 1 && again.entries[2].key.crop_factor == 1.5);
}

void test_capacity(void **) {
    const lensprof_profile profile = lens_profile("A lens", 1, 50, 2, 1, -0.1);
    const lensprof_profile *const pointer = &profile;
    const std::string whole = write_lensfun({profile});
    std::vector<char> text(whole.size() + 1, 'x');
    size_t needed = 0;
    lensprof_error error;
    assert_int_equal(lp_lensfun_write(&pointer, 1, nullptr, text.data(), whole.size() - 1, &needed, &error),
                     LENSPROF_ERROR_CAPACITY);
    assert_non_null(strchr(error.text, ';'));
    assert_int_equal(needed, whole.size());
    assert_true(text[0] == 'x');
    assert_ok(lp_lensfun_write(&pointer, 1, nullptr, text.data(), text.size(), nullptr, nullptr));
    assert_string_equal(text.data(), whole.c_str());
    assert_non_null(strstr(write_lensfun({}).c_str(), "<lensdatabase version=\"1\">"));
}

void expect_refused(const std::vector<lensprof_profile> &profiles, lensprof_status expected, const char *words) {
    lensprof_status status;
    std::string why;
    write_lensfun(profiles, &status, &why);
    if (why.find(words) == std::string::npos) print_error("\"%s\" does not hold \"%s\"\n", why.c_str(), words);
    assert_int_equal(status, expected);
    assert_non_null(strstr(why.c_str(), words));
    assert_non_null(strchr(why.c_str(), ';'));
}

void test_write_refuses(void **) {
    const std::vector<lensprof_profile> good = three_profiles();
    auto with = [&](auto change) {
        std::vector<lensprof_profile> profiles = good;
        change(profiles[2]);
        return profiles;
    };
    using P = lensprof_profile;
    const lensprof_status argument = LENSPROF_ERROR_ARGUMENT;
    expect_refused(with([](P &p) { p.key.lens[0] = 0; }), argument, "profile 2: its lens is unknown");
    expect_refused(with([](P &p) { p.key.lens[0] = '\xFF'; }), argument, "is not UTF-8");
    expect_refused(with([](P &p) { p.key.focal_mm = LENSPROF_UNKNOWN; }), argument, "focal length is unknown");
    expect_refused(with([](P &p) { p.key.aperture = LENSPROF_UNKNOWN; }), argument, "aperture is unknown");
    expect_refused(with([](P &p) { p.key.crop_factor = LENSPROF_UNKNOWN; }), argument, "crop factor is unknown");
    expect_refused(with([](P &p) { p.key.focal_mm = NAN; }), argument, "is invalid");
    expect_refused(with([](P &p) { p.vignetting[1].k[0] = -3; }), LENSPROF_ERROR_VIGNETTING, "is invalid");
    expect_refused(with([](P &p) { p.key.processing = LENSPROF_PROCESSING_CORRECTED; }), LENSPROF_ERROR_UNSUPPORTED,
                   "corrected in camera");
    expect_refused(with([](P &p) { p.key.aperture = 1.8, p.key.distance_m = INFINITY; }), argument, "earlier profile");
    const lensprof_profile *const none = nullptr;
    lensprof_error error;
    assert_int_equal(lp_lensfun_write(&none, 1, nullptr, nullptr, 0, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_non_null(strstr(error.text, "profile 0: is NULL"));
    assert_int_equal(lp_lensfun_write(nullptr, 1, nullptr, nullptr, 0, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_lensfun_write(&none, 0, nullptr, nullptr, 5, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
    std::vector<Falloff> entries;
    assert_int_equal(lp_lensfun_read(nullptr, 5, "", collect, &entries, &error), LENSPROF_ERROR_ARGUMENT);
    assert_int_equal(lp_lensfun_read(kGolden.data(), 5, "", nullptr, nullptr, &error), LENSPROF_ERROR_ARGUMENT);
}

void test_round_trip(void **) {
    std::vector<lensprof_profile> profiles;
    uint64_t seed = 5;
    for (int i = 0; i < 300; i++) {
        const std::string lens = "Maker Lens " + std::to_string(i / 10);
        profiles.push_back(lens_profile(lens.c_str(), 1 + i / 10 * 0.1, 10 + 90 * lp_random(&seed),
                                        1 + 10 * lp_random(&seed), i % 3 ? 0.1 + lp_random(&seed) : INFINITY,
                                        -0.4 * lp_random(&seed), 0.01 * lp_random(&seed), -0.1 * lp_random(&seed)));
    }
    const Database again = read_lensfun(write_lensfun(profiles));
    assert_ok(again.status);
    assert_int_equal(again.entries.size(), profiles.size() + 100);  // infinity is written at 10 m, too
    for (const lensprof_profile &profile : profiles) {
        const auto found = std::find_if(again.entries.begin(), again.entries.end(), [&](const Falloff &entry) {
            return !strcmp(entry.key.lens, profile.key.lens) && entry.key.focal_mm == profile.key.focal_mm
                   && entry.key.aperture == profile.key.aperture && entry.key.distance_m == profile.key.distance_m;
        });
        assert_true(found != again.entries.end());
        assert_close(found->key.crop_factor, profile.key.crop_factor, 5e-4);
        for (int n = 0; n < 3; n++) assert_close(found->vignetting.k[n], profile.vignetting[0].k[n], 5.001e-5);
    }
}

lensprof_camera_model body(const char *maker, const char *mount, double crop) {
    lensprof_camera_model camera;
    lensprof_camera_model_init(&camera);
    snprintf(camera.maker, sizeof camera.maker, "%s", maker);
    snprintf(camera.model, sizeof camera.model, "A body");
    snprintf(camera.mount, sizeof camera.mount, "%s", mount);
    camera.crop_factor = crop;
    return camera;
}

std::string export_lensfun(const lensprof_profile &profile, const lensprof_camera_model *camera,
                           const std::string *into, double *cost_ev, lensprof_error *error, lensprof_status *status) {
    lensprof_export_options options;
    lensprof_export_options_init(&options);
    options.camera = camera, options.cost_ev = cost_ev;
    if (into) options.into = into->data(), options.into_size = into->size();
    const lensprof_profile *const all[] = {&profile};
    size_t size = 0;
    *status = lp_lensfun_write(all, 1, &options, nullptr, 0, &size, error);
    std::string text(size, 0);
    if (*status == LENSPROF_OK) *status = lp_lensfun_write(all, 1, &options, text.data(), size, &size, error);
    return text;
}

void test_camera_and_names(void **) {
    const struct {
        const char *exif, *maker, *mount, *expected;
    } cases[] = {
        {"EF24-70mm f/2.8L USM", "Canon", "Canon EF-S",
         "<maker>Canon</maker>\n        <model>Canon EF 24-70mm f/2.8L USM</model>\n        <mount>Canon EF</mount>"},
        {"RF24-105mm F4 L IS USM", "Canon", "Canon RF", "<model>Canon RF 24-105mm F4L IS USM</model>"},
        {"FE 24-70mm F2.8 GM", "SONY", "Sony E", "<model>FE 24-70mm f/2.8 GM</model>\n        <mount>Sony E</mount>"},
        {"XF23mmF1.4 R", "FUJIFILM", "Fujifilm X", "<maker>Fujifilm</maker>\n        <model>XF23mmF1.4 R</model>"},
        {"AF-S DX NIKKOR 35mm f/1.8G", "NIKON CORPORATION", "Nikon F AF",
         "<model>Nikon AF-S DX Nikkor 35mm f/1.8G</model>"},
        {"17-50mm F2.8 EX DC OS HSM", "Canon", "Canon EF-S",
         "<maker>Sigma</maker>\n        <model>Sigma 17-50mm f/2.8 EX DC OS HSM</model>\n        <mount>Canon EF</mount>"},
    };
    for (const auto &c : cases) {
        const lensprof_camera_model camera = body(c.maker, c.mount, 1.005);
        lensprof_error error;
        lensprof_status status;
        const std::string text = export_lensfun(lens_profile(c.exif, 1, 24, 2.8, INFINITY, -0.5), &camera, nullptr,
                                                nullptr, &error, &status);
        assert_ok(status);
        if (text.find(c.expected) == std::string::npos) fail_msg("%s lacks %s", text.c_str(), c.expected);
        assert_non_null(strstr(text.c_str(), "<cropfactor>1.005</cropfactor>"));
    }
}

// A centre is left out, with its cost; a fall over the whole frame stays.
void test_refit_about_middle(void **) {
    lensprof_profile profile = lens_profile("Acme 35mm", 1, 35, 2, 1, -0.4, 0.1, -0.05);
    double cost = -1.0;
    lensprof_error error;
    lensprof_status status;
    export_lensfun(profile, nullptr, nullptr, &cost, &error, &status);
    assert_ok(status);
    assert_true(cost >= 0.0 && cost < 1e-3);
    profile.vignetting[0].center[0] = 0.08;
    const Database again = read_lensfun(export_lensfun(profile, nullptr, nullptr, &cost, &error, &status));
    assert_ok(status);
    assert_true(cost > 0.02 && cost < 0.5);
    assert_true(again.entries.size() == 1 && again.entries[0].usable && again.entries[0].vignetting.center[0] == 0.0);
}

// Four stops, which k1..k3 do not describe: plain least squares leave .19 EV in the corners.
void test_deep_falloff(void **) {
    lensprof_profile profile = lens_profile("Acme 8mm", 1, 8, 2, 1, -2.509, 2.498, -0.934);
    lensprof_gain_grid &grid = profile.grid;
    grid.columns = 31, grid.rows = 21, grid.channels = 1;
    for (uint32_t j = 0; j < grid.rows; j++)
        for (uint32_t i = 0; i < grid.columns; i++) {
            const double x = i * 2.0 / (grid.columns - 1) - 1.0, y = j * 2.0 / (grid.rows - 1) - 1.0;
            const double r2 = (9.0 * x * x + 4.0 * y * y) / 13.0;  // of 3:2
            grid.attenuation[j * grid.columns + i] = static_cast<float>(
                std::exp2(-4.0 * r2) / lensprof_vignetting_eval(&profile.vignetting[0], r2, nullptr));
        }
    double cost = -1.0;
    lensprof_error error;
    lensprof_status status;
    export_lensfun(profile, nullptr, nullptr, &cost, &error, &status);
    assert_ok(status);
    assert_true(cost >= 0.0 && cost < 0.03);
}

const std::string kInto = R"(<!-- a remark -->
<lensdatabase version="1">
    <lens>
        <maker>Sony</maker><model>FE 50mm f/1.8</model><mount>Sony E</mount>
        <cropfactor>1</cropfactor>
        <calibration>
            <!-- <vignetting> </calibration> -->
            <vignetting model="pa" focal="50" aperture="1.8" distance="10" k1="-1" k2="0" k3="0"/>
            <vignetting model="pa" focal="50" aperture="4" distance="10" k1="-2" k2="0" k3="0"></vignetting>
        </calibration>
    </lens>
</lensdatabase>
)";

void test_into(void **) {
    const lensprof_camera_model sony = body("SONY", "Sony E", 1);
    lensprof_error error;
    lensprof_status status;
    const auto add = [&](const lensprof_profile &profile, const std::string &into) {
        return export_lensfun(profile, &sony, &into, nullptr, &error, &status);
    };
    std::string expected = kInto;  // between the entries, in order
    expected.insert(expected.find("\n            <vignetting model=\"pa\" focal=\"50\" aperture=\"4\""),
                    "\n            <vignetting model=\"pa\" focal=\"50\" aperture=\"2\" distance=\"3\" k1=\"-0.2500\" "
                    "k2=\"0.0000\" k3=\"0.0000\"/>");
    assert_string_equal(add(lens_profile("FE 50mm F1.8", 1, 50, 2, 3, -0.25), kInto).c_str(), expected.c_str());
    // One is replaced, and one is added after the last.
    const std::string replaced_text = add(lens_profile("FE 50mm F1.8", 1, 50, 4, INFINITY, -0.25), kInto);
    assert_ok(status);
    assert_non_null(strstr(replaced_text.c_str(), "distance=\"1000\""));
    assert_null(strstr(replaced_text.c_str(), "k1=\"-2\""));
    assert_int_equal(read_lensfun(replaced_text).entries.size(), 3);
    // Measured at 10 m, or farther: Lensfun's two distances for far hold it.
    const auto far_from_10 = read_lensfun(add(lens_profile("FE 85mm F1.8", 1, 85, 4, 10, -0.25), kInto)).entries;
    assert_int_equal(far_from_10.size(), 4);
    const std::string with_new =
        add(lens_profile("FE 35mm F1.8", 1, 35, 4, 2, -0.25), kInto);  // a lens that is not there
    const size_t end = kInto.find("</lensdatabase>");
    assert_true(with_new.compare(0, end, kInto, 0, end) == 0);
    assert_non_null(strstr(with_new.c_str(), "<model>FE 35mm f/1.8</model>"));
    assert_int_equal(read_lensfun(with_new).entries.size(), 3);
    const struct {
        std::string into;
        lensprof_status status;
    } wrong[] = {{"no XML", LENSPROF_ERROR_SYNTAX},
                 {"<lensdatabase version=\"3\"></lensdatabase>", LENSPROF_ERROR_UNSUPPORTED},
                 {"<lensdatabase/>", LENSPROF_ERROR_UNSUPPORTED}};
    for (const auto &one : wrong) {
        add(lens_profile("FE 35mm F1.8", 1, 35, 4, 2, -0.25), one.into);
        assert_int_equal(status, one.status);
    }
}

// A file of the installed database gains lines and loses none.
void test_into_installed(void **) {
    std::ifstream file("/usr/share/lensfun/version_1/mil-sony.xml");
    if (!file) return;
    const std::string whole((std::istreambuf_iterator<char>(file)), {});
    const lensprof_camera_model sony = body("SONY", "Sony E", 1);
    lensprof_error error;
    lensprof_status status;
    const std::string text = export_lensfun(lens_profile("FE 24-70mm F2.8 GM", 1, 33.3, 2.8, INFINITY, -0.5), &sony,
                                            &whole, nullptr, &error, &status);
    assert_ok(status);
    size_t at = 0;
    while (at < whole.size() && text[at] == whole[at]) at++;
    const size_t added = text.size() - whole.size();
    assert_true(text.compare(at + added, std::string::npos, whole, at, std::string::npos) == 0);
    const std::string lines = text.substr(at, added);
    assert_int_equal(std::count(lines.begin(), lines.end(), '\n'), 2);
    assert_int_equal(read_lensfun(text).entries.size(), read_lensfun(whole).entries.size() + 2);
}

size_t count_of(const std::string &text, const std::string &word) {
    size_t count = 0;
    for (size_t at = 0; (at = text.find(word, at)) != std::string::npos; at += word.size()) count++;
    return count;
}

std::string without_comments(std::string text) {
    for (size_t at; (at = text.find("<!--")) != std::string::npos;) text.erase(at, text.find("-->", at) + 3 - at);
    return text;
}

long allocations_left = -1;

void *failing_allocation(size_t size) {
    if (allocations_left == 0) return nullptr;
    if (allocations_left > 0) allocations_left--;
    return std::malloc(size);
}

// Every allocation of pugixml fails once; test_formats_memory covers the allocations of lensprof.
void test_out_of_memory(void **) {
    const std::string lengthy(127, 'x');  // more than a page of pugixml
    std::vector<lensprof_profile> profiles;
    for (int i = 0; i < 120; i++) profiles.push_back(lens_profile(lengthy.c_str(), 1 + i, 50, 2, 1, -0.1));
    const std::string whole = write_lensfun(profiles);
    pugi::set_memory_management_functions(failing_allocation, std::free);
    lensprof_status status = LENSPROF_ERROR_MEMORY;
    long good = 0;
    for (; status != LENSPROF_OK && good < 1000; good++) {
        allocations_left = good;
        const Database database = read_lensfun(whole);
        status = database.status;
        assert_int_equal(database.entries.size(), status == LENSPROF_OK ? profiles.size() : 0);
        if (status != LENSPROF_OK) assert_int_equal(status, LENSPROF_ERROR_MEMORY);
    }
    assert_true(good > 2 && good < 1000);
    allocations_left = -1;
}

// Every installed file, and statistics of the contents.
void test_installed_database(void **) {
    const std::filesystem::path folder = "/usr/share/lensfun/version_1";
    if (!std::filesystem::is_directory(folder)) {
        print_message("package liblensfun-data-v1 is not installed\n");
        skip();
    }
    size_t entries = 0, cameras = 0, unusable = 0;
    std::map<std::string, size_t> doubts;
    for (const auto &file : std::filesystem::directory_iterator(folder)) {
        if (file.path().extension() != ".xml") continue;
        std::ifstream stream(file.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        const Database database = read_lensfun(text, file.path().c_str());
        if (database.status) print_error("%s: %s\n", file.path().c_str(), database.error.c_str());
        assert_ok(database.status);
        assert_int_equal(database.entries.size(), count_of(without_comments(text), "<vignetting "));
        entries += database.entries.size();
        for (const Falloff &entry : database.entries) {
            assert_true(entry.usable == (entry.valid == LENSPROF_OK));
            cameras += entry.key.camera_model[0] != 0;
            unusable += !entry.usable;
            const std::string doubt = entry.provenance.doubt;
            assert_true(entry.usable || !doubt.empty());
            doubts[doubt.substr(0, doubt.find_first_of("0123456789") == std::string::npos ? 99 : 8)]++;
        }
    }
    for (const auto &[doubt, count] : doubts) print_message("%6zu \"%s\"\n", count, doubt.c_str());
    print_message("%zu entries, %zu with a camera, %zu not usable\n", entries, cameras, unusable);
    assert_true(entries > 1000 && unusable > 0 && unusable < entries / 50 && cameras > 0);
    assert_true(doubts.size() >= 3 && doubts[""] > entries * 9 / 10);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_golden),
        cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_wrong_cameras),
        cmocka_unit_test(test_radius_conventions),
        cmocka_unit_test(test_fixed_lenses_and_doubts),
        cmocka_unit_test(test_source),
        cmocka_unit_test(test_visitor_stops),
        cmocka_unit_test(test_wrong_values),
        cmocka_unit_test(test_not_xml),
        cmocka_unit_test(test_cut_anywhere),
        cmocka_unit_test(test_bombs),
        cmocka_unit_test(test_written),
        cmocka_unit_test(test_capacity),
        cmocka_unit_test(test_write_refuses),
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_camera_and_names),
        cmocka_unit_test(test_refit_about_middle),
        cmocka_unit_test(test_deep_falloff),
        cmocka_unit_test(test_into),
        cmocka_unit_test(test_into_installed),
        cmocka_unit_test(test_out_of_memory),
        cmocka_unit_test(test_installed_database),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
