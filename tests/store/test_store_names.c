/* Different spellings of names: which are the same lens or camera, and above all which are not. */
#include "store_fixture.h"

#include "store/names/names.h"

static void test_scores(void **state) {
    static const struct {
        const char *a, *b;
        double score;
    } cases[] = {
        {"Canon EF 50mm f/1.8", " canon EF 50MM F/1.8 ", 1.0},
        {"Canon EF 50mm f/1.8", "Canon EF50mm F1.8", 0.9},
        {"EF 50mm f/1.8", "CANON INC. EF50mm F1.8", 0.8},
        {"NIKON CORPORATION NIKON D90", "Nikon D90", 0.8},
        {"OLYMPUS IMAGING CORP. E-M5", "OM Digital Solutions E-M5", 0.8},
        {"Panasonic Lumix G 20mm F1.7", "LUMIX G 20mm f/1.7", 0.8},
        {"Fuji XF 23mm F2 R WR", "FUJINON XF23mmF2 R WR", 0.8},
        {"LEICA CAMERA AG M10", "Leica M10", 0.8},
        {"EASTMAN KODAK COMPANY DC290", "Kodak DC290", 0.8},
        {"SAMSUNG TECHWIN NX10", "NX10", 0.8},
        {"Canon EOS REBEL T3i", "EOS 600D", 0.8},
        {"Canon EOS Kiss X5", "Canon EOS REBEL T3i", 0.8},
        {"Canon EOS REBEL T3", "EOS 600D", 0.0},
        {"Sigma 50mm f/1.4", "Sony 50mm f/1.4", 0.0},
        {"Canon EF 50mm f/1.8", "EF 50mm f/1.4", 0.0},
        {"Canon", "", 0.0},
        {"Canon", "Nikon", 0.0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int turned = 0; turned < 2; turned++) {
            const double score = turned ? lp_name_score(cases[i].b, cases[i].a) : lp_name_score(cases[i].a, cases[i].b);
            if (score != cases[i].score) fail_msg("%s, %s: %g", cases[i].a, cases[i].b, score);
        }
}

static void test_words(void **state) {
    static const struct {
        const char *a, *b, *camera_maker;
        int same;
    } cases[] = {
        {"Canon EF 24-70mm f/2.8L II USM", "24-70mm f/2.8 EF L USM II", "Canon", 1},
        {"Canon EF 24-70mm f/2.8L II USM", "Canon Lens EF 24-70mm 1:2.8 L Mark II USM", "", 1},
        {"Sigma 35mm F1.4 DG HSM Art", "Sigma Art 35mm f/1.4 DG HSM for Canon EF", "Canon", 1},
        {"Zeiss 50.0mm f/2.0 Planar", "Carl Zeiss Planar 50mm f/2", "", 1},
        {"Tamron 17-50mm f/2.8 MkII", "TAMRON 17-50mm II F2.8", "", 1},
        {"Canon EF 24-70mm f/2.8L USM", "EF USM 24-105mm f/2.8L", "Canon", 0},
        {"Canon EF 70-200mm f/2.8L USM", "EF L USM 70-200mm f/4", "Canon", 0},
        {"Canon EF 24-70mm f/2.8L II USM", "EF L USM 24-70mm f/2.8", "Canon", 0},
        {"Canon EF 24-70mm f/2.8L II USM", "EF L III USM 24-70mm f/2.8", "Canon", 0},
        {"Canon EF 70-200mm f/4L IS USM", "EF L USM 70-200mm f/4", "Canon", 0},
        {"Sigma 50mm f/1.4 EX", "Sony EX 50mm f/1.4", "", 0},
        {"Canon EF 85mm f/1.8 USM", "USM EF 85mm f/1.8", "NIKON CORPORATION", 0},
        {"Canon EF 85mm f/1.8 USM", "USM EF 85mm f/1.8", "CANON INC.", 1},
        {"Canon EF 85mm f/1.8 USM", "USM EF 85mm f/1.8", "Unheard Of", 0},
        {"Kit lens", "lens Kit", "", 0}, /* without a number, not specific enough */
        {"50 20 mm", "502 0 mm", "", 0},
        {"", "", "", 0},
        {"50mm f/1.8", "50mm f/1.8", "", 0}, /* no maker */
        {"LUMIX G 20/F1.7", "Panasonic Lumix G 20mm f/1.7", "Panasonic", 1},
        {"Summicron TL 1:2 23 ASPH.", "Summicron-TL 1:2/23 ASPH.", "LEICA CAMERA AG", 1},
        {"ZEISS Batis 2/25", "Zeiss Batis 25mm f/2", "SONY", 1},
        {"Tamron 14-150mm Di III", "Tamron 14-150mm DiIII", "", 1},
        {"8mm Fisheye", "8mm Fish-Eye", "", 1},
        {"SIGMA 18-35mm F1.8 DC HSM | A", "Sigma 18-35mm f/1.8 DC HSM [Art]", "Canon", 1},
        {"35mm F1.2 DG DN", "Sigma 35mm f/1.2 DG DN", "SONY", 1}, /* made for other makers' cameras */
        {"AF 35mm f/2.8", "Samyang AF 35mm f/2.8", "SONY", 0},
        {"EF 35mm f/2 IS", "Canon EF 35mm f/2 IS", "SONY", 0},
        {"Tamron E 28-75mm F2.8-2.8", "Tamron E 28-75mm F2.8", "", 0},
        {"Canon EF 200mm f/2.8 + 1.4x", "Canon EF 200mm f/2.8", "", 0},
        {"Canon EF 200mm f/2.8 + 2x II", "Canon EF 200mm f/2.8 II + 2x", "", 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int turned = 0; turned < 2; turned++) {
            const double score = lp_words_score(turned ? cases[i].b : cases[i].a, turned ? cases[i].a : cases[i].b,
                                                cases[i].camera_maker);
            if (score != (cases[i].same ? 0.6 : 0.0)) fail_msg("%s, %s: %g", cases[i].a, cases[i].b, score);
        }
    char longest[128];
    memset(longest, 0, sizeof longest);
    for (size_t i = 0; i + 1 < sizeof longest; i++) longest[i] = i % 2 ? '7' : 'x'; /* more words than are compared */
    assert_close(lp_words_score(longest, longest, ""), 0.0, 0.0);
    memset(longest, '7', sizeof longest - 1);
    assert_close(lp_words_score(longest, longest, longest), 0.0, 0.0); /* only a number */
    memcpy(longest, "ef ", 3);
    assert_close(lp_words_score(longest, longest, longest), 0.6, 0.0);
}

static void test_words_that_may_be_missing(void **state) {
    static const struct {
        const char *a, *b, *camera_maker;
        uint32_t apart; /* 0 = not the same */
    } cases[] = {
        {"OLYMPUS M.25mm F1.8", "Olympus M.Zuiko Digital 25mm f/1.8", "OLYMPUS CORPORATION", 2},
        {"OLYMPUS M.12-100mm F4.0", "Olympus M.Zuiko Digital ED 12-100mm f/4.0 IS Pro", "OLYMPUS CORPORATION", 5},
        {"OLYMPUS M.9-18mm F4.0-5.6", "Olympus Zuiko Digital ED 9-18mm f/4.0-5.6", "OLYMPUS CORPORATION", 0},
        {"LUMIX G VARIO 12-32/F3.5-5.6", "Lumix G Vario 12-32mm f/3.5-5.6 Asph. Mega OIS", "Panasonic", 3},
        {"LUMIX G VARIO 14-42/F3.5-5.6II", "Lumix G Vario 14-42mm f/3.5-5.6 II Asph.", "Panasonic", 1},
        {"LUMIX G VARIO 14-42/F3.5-5.6", "Lumix G Vario 14-42mm f/3.5-5.6 II Asph.", "Panasonic", 0},
        {"XF18-55mmF2.8-4", "XF18-55mmF2.8-4 R LM OIS", "FUJIFILM", 0}, /* for other makers OIS is distinctive */
        {"LEICA DG ELMARIT 12-60/F2.8-4.0", "Leica DG 12-60mm f/2.8-4.0", "Panasonic", 1},
        {"LEICA DG ELMARIT 45/F2.8", "Leica DG SUMMILUX 45mm f/2.8", "Panasonic", 0},
        {"AF-S NIKKOR 24-70mm f/2.8G ED", "Nikon AF-S Zoom-Nikkor 24-70mm f/2.8G", "NIKON CORPORATION", 2},
        {"AF Nikkor 28mm f/2.8D", "Nikon AF Nikkor 28mm f/2.8D 62", "NIKON CORPORATION", 1},
        {"Nikon AF Nikkor 28mm f/2.8D 61", "Nikon AF Nikkor 28mm f/2.8D 62", "", 0},
        {"DT 18-55mm F3.5-5.6 SAM", "Sony DT 18-55mm f/3.5-5.6 SAM (SAL1855)", "SONY", 1},
        {"E 20mm F2.8 F050", "Sony E 20mm F2.8", "SONY", 0}, /* a code of another maker */
        {"TAMRON SP 35mm F/1.4 Di USD F045", "Tamron 35mm f/1.4 Di USD", "Canon", 2},
        {"TAMRON SP 15-30mm F/2.8 Di VC USD A012", "Tamron SP 15-30mm f/2.8 Di VC USD (A041)", "Canon", 0},
        {"TAMRON SP 15-30mm F/2.8 Di VC USD", "Tamron SP 15-30mm f/2.8 Di VC USD G2", "Canon", 0},
        {"Tamron SP 60mm f/2 Macro 1:1", "Tamron 60mm f/2 Macro", "", 1},
        {"30mm F1.4 DC DN | Contemporary 016", "Sigma 30mm f/1.4 DC DN | C", "SONY", 1},
        {"150-600mm F5-6.3 DG OS HSM | Sports 014", "Sigma 150-600mm f/5-6.3 DG OS HSM | C", "Canon", 0},
        {"smc PENTAX-DA 18-55mm F3.5-5.6 AL WR", "smc Pentax-DA 18-55mm f/3.5-5.6 AL II/L/WR", "PENTAX", 3},
        {"smc PENTAX-DA 18-55mm F3.5-5.6 AL II", "smc Pentax-DA 18-55mm f/3.5-5.6 AL II L WR", "PENTAX", 3},
        {"smc PENTAX-DA 18-55mm F3.5-5.6 AL", "smc Pentax-DA 18-55mm f/3.5-5.6 AL II L WR", "PENTAX", 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int turned = 0; turned < 2; turned++) {
            const char *asked = turned ? cases[i].b : cases[i].a, *stored = turned ? cases[i].a : cases[i].b;
            lp_words words;
            uint32_t apart;
            assert_true(lp_split_words(asked, &words));
            const double score = lp_words_match(&words, stored, cases[i].camera_maker, &apart);
            if (score != (cases[i].apart ? 0.5 : 0.0) || (score > 0.0 && apart != cases[i].apart))
                fail_msg("%s, %s: %g, %u apart", asked, stored, score, apart);
            if (score > 0.0) assert_true(lp_may_match(&words, stored));
        }
}

static lensprof_profile profile = {.struct_size = sizeof profile};
static lensprof_lookup how = {.struct_size = sizeof how};

static int64_t put(lensprof_store *store, const char *maker, const char *camera, const char *lens, double focal,
                   double aperture) {
    lensprof_profile_init(&profile);
    strcpy(profile.key.camera_maker, maker);
    strcpy(profile.key.camera_model, camera);
    strcpy(profile.key.lens, lens);
    profile.key.focal_mm = focal, profile.key.aperture = aperture;
    profile.vignetting[0].k[0] = -0.6 / aperture;
    return put_at(store, &profile);
}

static lensprof_status ask(lensprof_store *store, const char *maker, const char *camera, const char *lens, double focal,
                           double aperture) {
    lensprof_lookup_options options;
    lensprof_profile_key key;
    lensprof_error error;
    lensprof_lookup_options_init(&options);
    lensprof_profile_key_init(&key);
    strcpy(key.camera_maker, maker);
    strcpy(key.camera_model, camera);
    strcpy(key.lens, lens);
    key.focal_mm = focal, key.aperture = aperture;
    lensprof_lookup_init(&how);
    return lensprof_store_lookup(store, &key, &options, &profile, &how, &error);
}

static void test_lenses_found_by_other_names(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    const int64_t canon = put(store, "", "", "Canon EF 24-70mm f/2.8L II USM", 24, 2.8);
    const int64_t fuji = put(store, "", "", "Fujinon XF 23mm F2 R WR", 23, 2);
    const int64_t nikkor = put(store, "", "", "Nikon Nikkor Z 50mm f/1.8 S", 50, 1.8);
    const struct {
        const char *maker, *lens;
        double focal, aperture, score;
        int64_t id;
    } cases[] = {
        {"Canon", "EF24-70mm f/2.8L II USM", 24, 2.8, 0.8, canon},
        {"Canon", "EF24-70mm f/2.8L USM II lens", 24, 2.8, 0.6, canon},
        {"FUJIFILM", "XF23mmF2 R WR", 23, 2, 0.8, fuji},
        {"", "Fujifilm XF23mm F2 R WR", 23, 2, 0.8, fuji},
        {"NIKON CORPORATION", "NIKKOR Z 50mm f/1.8 S", 50, 1.8, 0.8, nikkor},
        {"NIKON CORPORATION", "Z 50mm f/1.8 S for Nikon Z", 50, 1.8, 0.6, nikkor},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (ask(store, cases[i].maker, "", cases[i].lens, cases[i].focal, cases[i].aperture) != LENSPROF_OK)
            fail_msg("%s: %s", cases[i].lens, how.reason);
        assert_int_equal(how.id[0], cases[i].id);
        assert_close(how.name_score, cases[i].score, 0.0);
        assert_int_equal(strstr(how.reason, "words") != NULL, cases[i].score < 0.7);
        assert_int_equal(how.reason_code[0] == LENSPROF_REASON_LOOKUP_BY_WORDS, cases[i].score < 0.7);
    }
    assert_int_equal(ask(store, "Canon", "", "EF USM II L 24-105mm f/2.8", 24, 2.8), LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(ask(store, "Canon", "", "EF USM II L 24-70mm f/4", 24, 2.8), LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(ask(store, "Canon", "", "EF USM L 24-70mm f/2.8", 24, 2.8), LENSPROF_ERROR_NOT_FOUND);
    lensprof_store_close(store);
}

static void test_fixed_lenses(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    const int64_t phone = put(store, "Apple", "iPhone 7", "", 4.2, 1.8);
    put(store, "Canon", "PowerShot G7", "Canon PowerShot G7 & compatibles", 7.4, 2.8);
    put(store, "Canon", "EOS 5D", "Canon EF 50mm", 50, 2);
    put(store, "Canon", "EOS 5D", "Canon EF 85mm", 85, 2);
    assert_ok(ask(store, "Apple", "iphone 7", "", 4.25, 1.8));
    assert_int_equal(how.id[0], phone);
    assert_int_equal(how.exact, 1);
    assert_close(how.name_score, 1.0, 0.0);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_FOCAL_ROUNDED, "rounded"));
    assert_ok(ask(store, "", "Apple iPhone 7", " ", 4.3, 1.8));
    assert_close(how.name_score, 0.8, 0.0);
    assert_ok(ask(store, "", "iPhone 7", "", 4.2, 1.8));
    assert_string_equal(how.reason, "");
    assert_int_equal(how.reason_code[0], LENSPROF_REASON_NONE);
    assert_ok(ask(store, "", "iPhone 7", "", 4.25, 2.0)); /* predicted, from the rounded one */
    assert_int_equal(how.exact, 0);
    assert_int_equal(ask(store, "", "iPhone 7", "", 6.0, 1.8), LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(ask(store, "", "iPhone 7 Plus", "", 4.2, 1.8), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_NO_CAMERA, "no profile of this camera"));
    assert_ok(ask(store, "Canon", "PowerShot G7", "", 7.5, 2.8)); /* its only lens */
    assert_int_equal(how.exact, 1);
    assert_int_equal(ask(store, "Canon", "EOS 5D", "", 50, 2), LENSPROF_ERROR_NOT_FOUND);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_SEVERAL_LENSES, "several lenses; specify the lens"));
    assert_ok(ask(store, "Canon", "EOS 5D", "Canon EF 50mm", 51, 2)); /* a lens with its own name: not rounded */
    assert_int_equal(how.exact, 0);
    assert_int_equal(ask(store, "Canon", "", "", 50, 2), LENSPROF_ERROR_NOT_FOUND);
    lensprof_store_close(store);
}

static void put_camera(lensprof_store *store, const char *model, const char *lens, uint32_t fixed) {
    lensprof_camera_model camera;
    lensprof_camera_model_init(&camera);
    strcpy(camera.maker, "Sony");
    strcpy(camera.model, model);
    strcpy(camera.lens, lens);
    camera.fixed_lens = fixed;
    strcpy(camera.mount, fixed ? "own" : "Sony E");
    assert_ok(lensprof_store_put_camera(store, &camera, NULL));
}

static void test_fixed_lenses_by_the_table_of_cameras(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    const int64_t id = put(store, "", "", "Sony DSC-RX100 III & compatibles", 8.8, 1.8);
    put(store, "", "", "Sony E 35mm f/1.8 OSS", 35, 1.8);
    put_camera(store, "DSC-RX100M4", "Sony DSC-RX100 III & compatibles", 1);
    put_camera(store, "DSC-RX9", "Sony gone", 1);
    put_camera(store, "ILCE-6000", "Sony E 35mm f/1.8 OSS", 0); /* a lens, but interchangeable */
    assert_ok(ask(store, "SONY", "DSC-RX100M4", "24-70mm F1.8-2.8", 8.8, 1.8));
    assert_int_equal(how.id[0], id);
    assert_close(how.name_score, 0.6, 0.0);
    assert_true(has_reason(&how, LENSPROF_REASON_LOOKUP_BUILT_IN, "built-in"));
    assert_ok(ask(store, "SONY", "DSC-RX100M4", "", 8.8, 1.8));
    assert_int_equal(how.id[0], id);
    assert_int_equal(ask(store, "SONY", "DSC-RX100M3", "24-70mm F1.8-2.8", 8.8, 1.8), LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(ask(store, "SONY", "DSC-RX9", "", 8.8, 1.8), LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(ask(store, "SONY", "ILCE-6000", "E 35mm F1.4", 35, 1.8), LENSPROF_ERROR_NOT_FOUND);
    assert_int_equal(ask(store, "SONY", "ILCE-6000", "", 35, 1.8), LENSPROF_ERROR_NOT_FOUND);
    put(store, "Sony", "ILCE-6000", "Sony ILCE-6000 kit", 35, 1.8); /* named after the camera, but not built in */
    assert_int_equal(ask(store, "SONY", "ILCE-6000", "E 35mm F1.4", 35, 1.8), LENSPROF_ERROR_NOT_FOUND);
    lensprof_store_close(store);
}

static void test_standard_of_several(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put(store, "Fujifilm", "X100V", "Fujifilm X100V & compatibles, with TCL-X100", 23, 2);
    const int64_t id = put(store, "Fujifilm", "X100V", "Fujifilm X100V & compatibles (Standard)", 23, 2);
    put(store, "Fujifilm", "X100V", "Fujifilm X100V & compatibles, with WCL-X100", 23, 2);
    assert_ok(ask(store, "FUJIFILM", "X100V", "", 23, 2));
    assert_int_equal(how.id[0], id);
    lensprof_store_close(store);
}

static void test_the_nearest_of_several(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    put(store, "", "", "Tamron 17-50mm f/2.8 XR Di II LD", 17, 2.8);
    const int64_t id = put(store, "", "", "Tamron SP AF 17-50mm f/2.8 XR Di II LD Aspherical (IF)", 17, 2.8);
    put(store, "", "", "Tamron 90mm f/2.8 Di (A)", 90, 2.8);
    put(store, "", "", "Tamron 90mm f/2.8 Di (B)", 90, 2.8);
    assert_ok(ask(store, "Canon", "", "TAMRON SP AF 17-50mm F/2.8 Di II LD Aspherical (IF)", 17, 2.8));
    assert_int_equal(how.id[0], id); /* has more in common */
    assert_close(how.name_score, 0.5, 0.0);
    assert_int_equal(ask(store, "Canon", "", "TAMRON 90mm F/2.8 Di", 90, 2.8), LENSPROF_ERROR_NOT_FOUND); /* A or B */
    assert_ok(ask(store, "Canon", "", "TAMRON 90mm F/2.8 Di (B)", 90, 2.8));
    lensprof_store_close(store);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scores),
        cmocka_unit_test(test_words),
        cmocka_unit_test(test_words_that_may_be_missing),
        store_test(test_lenses_found_by_other_names),
        store_test(test_fixed_lenses),
        store_test(test_fixed_lenses_by_the_table_of_cameras),
        store_test(test_standard_of_several),
        store_test(test_the_nearest_of_several),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
