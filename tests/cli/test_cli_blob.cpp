// Profiles as blobs: `lensprof profile export ID --blob FILE`, `lensprof profile show --blob FILE`.
#include "cli_runs.hpp"

#include <lensprof/lensprof.h>

using namespace cli_runs;

// What fontconfig keeps for the life of the process is not a leak of lensprof; LeakSanitizer reads this list.
extern "C" const char *__lsan_default_suppressions();
extern "C" const char *__lsan_default_suppressions() { return "leak:libfontconfig"; }

namespace {

// Profile 1: an EMoR response, a gain grid and a covariance; profile 2: linear, with none of these.
std::unique_ptr<lensprof_profile> make_profile(bool is_rich) {
    auto p = std::make_unique<lensprof_profile>();
    lensprof_profile_init(p.get());
    std::strcpy(p->key.camera_model, is_rich ? "Camera" : "Plain");
    std::strcpy(p->key.lens, "Lens");
    std::strcpy(p->provenance.method, "transfer");
    std::strcpy(p->provenance.source, "/home/somebody/pictures/pano.pto");
    p->key.aperture = 2.8;
    if (!is_rich) return p;
    const double emor[2] = {0.8, -0.3};
    assert_ok(lensprof_response_set_emor(&p->response[0], emor, 2));
    p->vignetting[0] = {{-0.35, 0.12, -0.17}, {0.01, 0.02}};
    p->grid.columns = p->grid.rows = 2, p->grid.channels = 1;
    for (int i = 0; i < 4; i++) p->grid.attenuation[i] = 0.75f + 0.125f * float(i);
    p->covariance_size = 5;
    for (int i = 0; i < 5; i++) p->covariance[6 * i] = 1e-4;
    return p;
}

int make_db(void **state) {
    empty_work(state);
    lensprof_store *store = nullptr;
    assert_ok(lensprof_store_open(work("p.db").c_str(), LENSPROF_STORE_CREATE, &store, nullptr));
    for (bool is_rich : {true, false})
        assert_ok(lensprof_store_put(store, make_profile(is_rich).get(), nullptr, nullptr));
    lensprof_store_close(store);
    return 0;
}

Words export_of(const std::string &file, const std::string &id = "1") {
    return {"profile", "export", id, "-o", file, "--format", "blob", "--db", work("p.db")};
}

std::string crc_of(const Bytes &blob) {
    char text[9];
    const size_t end = blob.size();
    std::snprintf(text, sizeof text, "%02x%02x%02x%02x", blob[end - 1], blob[end - 2], blob[end - 3], blob[end - 4]);
    return text;
}

void test_export_is_what_the_library_packs(void **) {
    for (const char *id : {"1", "2"})
        for (bool with_covariance : {false, true}) {
            const auto profile = make_profile(*id == '1');
            size_t bytes = 0;
            Bytes expected(20000);
            assert_ok(lensprof_profile_pack(profile.get(), with_covariance ? LENSPROF_PACK_COVARIANCE : 0,
                                            expected.data(), expected.size(), &bytes));
            expected.resize(bytes);
            Words words = export_of(work("camera.blob"), id);
            if (with_covariance) words = words + Words{"--encoding", "covariance=yes"};
            const std::string text = must_exit(done, words);
            assert_true(load(work("camera.blob")) == expected);
            for (const std::string &part : {work("camera.blob"), "profile " + std::string(id),
                                            std::to_string(bytes) + " bytes", crc_of(expected)})
                assert_true(contains(text, part));
            assert_int_equal(contains(text, "no covariance stored"), with_covariance && *id == '2');
            const Json json = json_of(words + Words{"--json"});
            assert_int_equal(json["profile"].get<int>(), *id - '0');
            assert_int_equal(json["blob"]["bytes"].get<size_t>(), bytes);
            assert_string_equal(json["blob"]["crc32"].get<std::string>().c_str(), crc_of(expected).c_str());
            assert_string_equal(json["blob"]["file"].get<std::string>().c_str(), work("camera.blob").c_str());
            assert_int_equal(json["covariance_size"].get<int>(), with_covariance && *id == '1' ? 5 : 0);
        }
}

void test_show_is_that_of_the_database(void **) {
    must_exit(done, export_of(work("camera.blob")) + Words{"--encoding", "covariance=yes"});
    Json shown = json_of({"profile", "show", "--blob", work("camera.blob"), "--json"}),
         stored = json_of({"profile", "show", "1", "--db", work("p.db"), "--json"});
    assert_true(shown["id"].is_null());
    assert_string_equal(shown["blob"]["crc32"].get<std::string>().c_str(), crc_of(load(work("camera.blob"))).c_str());
    assert_string_equal(shown["provenance"]["source"].get<std::string>().c_str(), "");
    for (size_t j = 0; j < 1024; j++)  // single precision
        assert_close(shown["response"]["values"][0][j].get<double>(), stored["response"]["values"][0][j].get<double>(),
                     6e-8);
    for (Json *json : {&shown, &stored}) {
        json->erase("id"), json->erase("blob");
        (*json)["provenance"].erase("source");
        (*json)["response"].erase("values");
    }
    assert_string_equal(shown.dump().c_str(), stored.dump().c_str());
    const std::string text = must_exit(done, {"profile", "show", "--blob", work("camera.blob")});
    assert_true(contains(text, work("camera.blob")) && contains(text, crc_of(load(work("camera.blob")))));
    assert_true(contains(text, "profile   Camera, Lens, "));
    assert_false(contains(text, "profile   0"));
}

void test_chart_of_a_blob(void **) {
    must_exit(done, export_of(work("camera.blob")) + Words{"--encoding", "covariance=yes"});
    const Words show = {"profile", "show", "--blob", work("camera.blob")};
    Json of_blob = json_of(show + Words{"--chart", "--json"}),
         stored = json_of({"profile", "show", "1", "--db", work("p.db"), "--chart", "--json"});
    assert_true(of_blob["curves"][0]["id"].is_null());
    assert_string_equal(of_blob["curves"][0]["label"].get<std::string>().c_str(), "blob");
    assert_string_equal(of_blob["note"].get<std::string>().c_str(), "without the gain grid");
    assert_true(of_blob["curves"][0]["m"] == stored["curves"][0]["m"]);
    assert_true(of_blob["curves"][0]["sigma"] == stored["curves"][0]["sigma"]);
    must_exit(done, show + Words{"--chart-out", work("falloff.svg")});
    assert_true(fs::exists(work("falloff.svg")));
    fs::create_hard_link(work("camera.blob"), work("link.svg"));
    assert_refused(usage, show + Words{"--chart-out", work("link.svg")}, {work("link.svg"), "is the blob"});
}

void test_export_replaces_a_file_whole(void **) {
    save_text(work("camera.blob"), std::string(100000, 'x'));
    must_exit(done, export_of(work("camera.blob"), "2"));
    assert_true(load(work("camera.blob")).size() < 200);
    must_exit(done, {"profile", "show", "--blob", work("camera.blob")});
}

void test_export_refuses(void **) {
    assert_refused(not_found, export_of(work("camera.blob"), "7"), {work("p.db"), "7"});
    assert_refused(not_found, {"profile", "export", "1", "-o", work("b"), "--format", "blob", "--db", work("none.db")},
                   {work("none.db")});
    save_text(work("text.db"), std::string(300, 'x') + "\n");
    assert_refused(store_failed,
                   {"profile", "export", "1", "-o", work("b"), "--format", "blob", "--db", work("text.db")},
                   {work("text.db")});
    assert_refused(failed, export_of(work("none/camera.blob")), {work("none/camera.blob")});
    fs::create_directory(work("folder"));
    assert_refused(usage, export_of(work("folder")), {work("folder")});
    assert_refused(usage, export_of(work("p.db")), {work("p.db"), "is the profile database"});
    fs::create_symlink(work("p.db"), work("link.blob"));
    assert_refused(usage, export_of(work("link.blob")), {work("link.blob"), "is the profile database"});
}

// A full disk: the older file stays.
void test_export_to_a_full_disk(void **) {
    save_text(work("camera.blob"), "older");
    const Words words = export_of(work("camera.blob"));
    const Disk before = disk();
    const Outcome outcome = run_child(words, [] {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit = {1000, 1000};
        setrlimit(RLIMIT_FSIZE, &limit);
    });
    assert_refusal(words, outcome, failed, {work("camera.blob")}, before);
}

void test_show_refuses(void **) {
    must_exit(done, export_of(work("camera.blob")));
    const Bytes good = load(work("camera.blob"));
    const auto refuse = [](const Bytes &bytes, const char *reason) {
        save(work("bad.blob"), bytes);
        assert_refused(unreadable, {"profile", "show", "--blob", work("bad.blob")}, {work("bad.blob"), reason});
        assert_refused(unreadable, {"profile", "show", "--blob", work("bad.blob"), "--chart-out", work("c.svg")},
                       {work("bad.blob"), reason});
    };
    for (size_t at = 0; at < good.size(); at += 97) {
        Bytes bad = good;
        bad[at] ^= 0x10;
        refuse(bad, "export");
        refuse(Bytes(good.begin(), good.begin() + long(at)), "export");
    }
    Bytes longer = good;
    longer.push_back(0);
    refuse(longer, "export");
    refuse(load(work("p.db")), "export");
    Bytes newer = good;  // layout 5, sealed bit by bit
    newer[4] = 5;
    uint32_t crc = 0xFFFFFFFF;
    for (size_t i = 0; i + 4 < newer.size(); i++) {
        crc ^= newer[i];
        for (int bit = 0; bit < 8; bit++) crc = crc & 1 ? crc >> 1 ^ 0xEDB88320 : crc >> 1;
    }
    for (size_t i = 0; i < 4; i++) newer[newer.size() - 4 + i] = static_cast<unsigned char>(~crc >> 8 * i);
    refuse(newer, "newer lensprof");
    assert_refused(unreadable, {"profile", "show", "--blob", work("none.blob")}, {work("none.blob")});
    fs::create_directory(work("folder"));
    assert_refused(unreadable, {"profile", "show", "--blob", work("folder")}, {work("folder")});
    assert_refused(unreadable, {"profile", "show", "--blob", "/dev/zero"}, {"/dev/zero", "not a regular file"});
}

void test_options_that_do_not_fit(void **) {
    must_exit(done, export_of(work("camera.blob")));
    const std::string blob = work("camera.blob");
    const Words db = {"--db", work("p.db")};
    const Words wrong[] = {{"profile", "export"},
                           {"profile", "export", "1"},
                           {"profile", "export", "-o", blob},
                           {"profile", "export", "1", "2", "-o", blob},
                           {"profile", "export", "0", "-o", blob},
                           {"profile", "export", "1", "-o"},
                           {"profile", "export", "1", "-o", blob, "--chart"},
                           {"profile", "export", "1", "-o", blob, "--camera", "Camera"},
                           {"profile", "export", "1", "-o", work("other.json"), "--encoding", "covariance=yes"},
                           {"profile", "export", "1", "-o", work("other.unknown")},
                           {"profile", "export", "1", "-o", work("other.xmp")},
                           {"profile", "export", "1", "--all", "-o", work("other.json")},
                           {"profile", "list", "--blob", blob},
                           {"profile", "remove", "1", "--blob", blob},
                           {"profile", "list", "--encoding", "covariance=yes"},
                           {"profile", "show", "1", "--encoding", "covariance=yes"},
                           {"profile", "remove", "1", "--encoding", "covariance=yes"},
                           {"profile", "show", "1", "--blob", blob},
                           {"profile", "show", "--lens", "Lens", "--blob", blob},
                           {"profile", "show", "--blob", blob}};
    for (const Words &words : wrong) assert_refused(usage, words + db, {"lensprof: "});
}

}  // namespace

int main() {
#define BLOB_TEST(name) cmocka_unit_test_setup(name, make_db)
    const CMUnitTest tests[] = {
        BLOB_TEST(test_export_is_what_the_library_packs),
        BLOB_TEST(test_show_is_that_of_the_database),
        BLOB_TEST(test_chart_of_a_blob),
        BLOB_TEST(test_export_replaces_a_file_whole),
        BLOB_TEST(test_export_refuses),
        BLOB_TEST(test_export_to_a_full_disk),
        BLOB_TEST(test_show_refuses),
        BLOB_TEST(test_options_that_do_not_fit),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
