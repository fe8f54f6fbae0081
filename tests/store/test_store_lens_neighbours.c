/* Names of lenses that the database does not have, as cameras write them into EXIF: a neighbour is never found in their
 * place. */
#include "lens_names_fixture.h"

static const struct {
    const char *maker, *camera, *lens;
} unknown[] = {
    {"OM Digital Solutions", "OM-1", "OM 12-45mm F4.0"},
    {"Canon", "Canon EOS 6D", "EF50mm f/1.8"},
    {"Canon", "Canon EOS 6D", "EF50mm f/1.2L USM"},
    {"Canon", "Canon EOS 6D", "EF35mm f/1.4L II USM"},
    {"Canon", "Canon EOS 6D", "EF35mm f/2"},
    {"Canon", "Canon EOS 6D", "EF24-105mm f/4L IS II USM"},
    {"Canon", "Canon EOS 6D", "EF70-200mm f/4L USM"},
    {"Canon", "Canon EOS 6D", "EF70-200mm f/4L IS II USM"},
    {"Canon", "Canon EOS 6D", "EF70-200mm f/2.8L IS USM +1.4x"},
    {"Canon", "Canon EOS 6D", "EF70-200mm f/2.8L IS II USM +2x III"},
    {"Canon", "Canon EOS 6D", "EF16-35mm f/2.8L III USM"},
    {"Canon", "Canon EOS 6D", "EF14mm f/2.8L USM"},
    {"Canon", "Canon EOS 6D", "EF100mm f/2 USM"},
    {"Canon", "Canon EOS 6D", "EF100mm f/2.8 USM"},
    {"Canon", "Canon EOS R5", "RF24-105mm F4 L IS USM"},
    {"Canon", "Canon EOS R5", "RF24-105mm F4L IS USM"},
    {"Canon", "Canon EOS R5", "RF85mm F1.2L USM DS"},
    {"Canon", "Canon EOS R7", "RF-S18-45mm F4.5-6.3 IS STM"},
    {"Canon", "Canon EOS R5", "RF24-70mm F2.8L IS USM"},
    {"Canon", "Canon EOS R10", "RF-S18-150mm F3.5-6.3 IS STM"},
    {"Canon", "Canon EOS 600D", "EF-S18-55mm f/3.5-5.6 III"},
    {"Canon", "Canon EOS 600D", "EF-S18-55mm f/3.5-5.6"},
    {"Canon", "Canon EOS 600D", "EF-S18-55mm f/4-5.6 IS STM"},
    {"Canon", "Canon EOS 600D", "EF-S18-135mm f/3.5-5.6 IS"},
    {"Canon", "Canon EOS 6D", "TAMRON SP 24-70mm F/2.8 Di VC USD A007"},
    {"Canon", "Canon EOS 6D", "TAMRON SP 15-30mm F/2.8 Di VC USD G3 A099"},
    {"Canon", "Canon EOS 6D", "TAMRON SP 70-300mm F/4-5.6 Di VC USD A005"},
    {"Canon", "Canon EOS 6D", "150-600mm F5-6.3 DG OS HSM | Sports 014"},
    {"Canon", "Canon EOS 6D", "85mm F1.4 DG HSM | Art 016"},
    {"Canon", "Canon EOS 6D", "30mm F1.4 DC HSM | Art 013"},
    {"Canon", "Canon EOS 6D", "24mm F1.4 DG HSM | Art 015"},
    {"Canon", "Canon EOS 60D", "17-50mm"},
    {"Canon", "Canon EOS 60D", "50mm"},
    {"NIKON CORPORATION", "NIKON D700", "50.0 mm f/1.8"},
    {"NIKON CORPORATION", "NIKON D700", "24.0-70.0 mm f/2.8"},
    {"NIKON CORPORATION", "NIKON D700", "AF-S NIKKOR 35mm f/1.8G ED"},
    {"NIKON CORPORATION", "NIKON D700", "AF-S NIKKOR 24-70mm f/2.8E ED VR"},
    {"NIKON CORPORATION", "NIKON D700", "AF-S NIKKOR 70-200mm f/2.8E FL ED VR"},
    {"NIKON CORPORATION", "NIKON D700", "AF-S NIKKOR 70-200mm f/4G ED VR"},
    {"NIKON CORPORATION", "NIKON D700", "AF-S DX NIKKOR 18-55mm f/3.5-5.6G VR II"},
    {"NIKON CORPORATION", "NIKON D700", "AF-P DX NIKKOR 18-55mm f/3.5-5.6G"},
    {"NIKON CORPORATION", "NIKON D700", "AF-S DX Zoom-Nikkor 18-55mm f/3.5-5.6G ED"},
    {"NIKON CORPORATION", "NIKON D700", "AF Nikkor 85mm f/1.8D"},
    {"NIKON CORPORATION", "NIKON D700", "AF-P NIKKOR 70-300mm f/4.5-5.6E ED VR"},
    {"NIKON CORPORATION", "NIKON D700", "AF-S Micro NIKKOR 60mm f/2.8G ED"},
    {"NIKON CORPORATION", "NIKON Z 6", "NIKKOR Z 85mm f/1.2 S"},
    {"NIKON CORPORATION", "NIKON Z 6", "NIKKOR Z 24-120mm f/4 S"},
    {"NIKON CORPORATION", "NIKON Z 6", "NIKKOR Z 50mm f/1.8"},
    {"NIKON CORPORATION", "NIKON Z 6", "NIKKOR Z MC 50mm f/2.8"},
    {"SONY", "ILCE-7M3", "FE 24-70mm F2.8 GM II"},
    {"SONY", "ILCE-7M3", "FE 24-70mm F4 ZA OSS"},
    {"SONY", "ILCE-7M3", "FE 16-35mm F2.8 GM II"},
    {"SONY", "ILCE-7M3", "FE 50mm F1.8 OSS"},
    {"SONY", "ILCE-7M3", "FE 70-200mm F2.8 GM OSS"},
    {"SONY", "ILCE-7M3", "FE 70-200mm F4 Macro G OSS II"},
    {"SONY", "ILCE-7M3", "FE 28-70mm F2 GM"},
    {"SONY", "ILCE-6000", "E 18-200mm F3.5-6.3 OSS"},
    {"SONY", "ILCE-6000", "E PZ 16-50mm F3.5-5.6 OSS II"},
    {"SONY", "ILCE-6000", "E 30mm F3.5 Macro"},
    {"SONY", "ILCE-7M3", "28-70mm F2.8 DG DN | Contemporary 021"},
    {"SONY", "ILCE-7M3", "E 28-75mm F2.8 A063"},
    {"SONY", "SLT-A58", "DT 18-55mm F3.5-5.6 SAM II"},
    {"SONY", "SLT-A58", "AF 24mm F2.8"},
    {"SONY", "SLT-A58", "AF 35mm F2.8"},
    {"SONY", "SLT-A58", "DT 55-200mm F4-5.6"},
    {"FUJIFILM", "X-T30", "XF56mmF1.2 R"},
    {"FUJIFILM", "X-T30", "XF10-24mmF4 R OIS WR"},
    {"FUJIFILM", "X-T30", "XF27mmF2.8 R WR"},
    {"FUJIFILM", "X-T30", "XF18mmF1.4 R LM WR"},
    {"FUJIFILM", "X-T30", "XF23mmF1.4 R LM WR"},
    {"FUJIFILM", "X-T30", "XF18-55mmF2.8-4"},
    {"OLYMPUS CORPORATION", "E-M1MarkII", "OLYMPUS M.40-150mm F4.0-5.6 R"},
    {"OLYMPUS CORPORATION", "E-M1MarkII", "OLYMPUS M.12-40mm F2.8 II"},
    {"OLYMPUS CORPORATION", "E-M1MarkII", "OLYMPUS M.25mm F2.8"},
    {"OLYMPUS CORPORATION", "E-M1MarkII", "OLYMPUS M.14-42mm F3.5-5.6"},
    {"OLYMPUS CORPORATION", "E-M1MarkII", "OLYMPUS M.14-42mm F3.5-5.6 EZ"},
    {"OLYMPUS CORPORATION", "E-M1MarkII", "OLYMPUS M.40-150mm F2.8 + MC-14"},
    {"Panasonic", "DC-G9", "LUMIX G VARIO 100-300/F4.0-5.6II"},
    {"Panasonic", "DC-G9", "LUMIX G VARIO 14-42/F3.5-5.6"},
    {"Panasonic", "DC-G9", "LUMIX G MACRO 30/F2.8"},
    {"Panasonic", "DC-G9", "LUMIX G 42.5/F1.7"},
    {"Panasonic", "DC-S5", "LUMIX S 24-105/F4"},
    {"Panasonic", "DC-G9", "LEICA DG VARIO-ELMAR 100-400/F4.0-6.3 II"},
    {"PENTAX", "PENTAX K-5", "smc PENTAX-DA 50-200mm F4-5.6 ED WR"},
    {"PENTAX", "PENTAX K-5", "HD PENTAX-DA 35mm F2.8 Macro Limited"},
    {"PENTAX", "PENTAX K-5", "HD PENTAX-DA 55-300mm F4-5.8 ED WR"},
    {"PENTAX", "PENTAX K-5", "smc PENTAX-DA 40mm F2.8"},
    {"Canon", "Canon PowerShot G9 X", "10.2-30.6 mm"},
    {"Apple", "iPhone 13", "iPhone 13 back dual wide camera 5.1mm f/1.6"},
    {"Apple", "iPhone XS Max", "iPhone XS Max back dual camera 4.25mm f/1.8"},
    {"Google", "Pixel 4a", "Pixel 4a back camera 4.38mm f/1.73"},
    {"DJI", "FC330", ""},
    {"RICOH IMAGING COMPANY, LTD.", "GR II", ""},
    {"LEICA CAMERA AG", "LEICA Q (Typ 116)", "SUMMILUX 1:1.7/28 ASPH."},
    {"SONY", "DSC-RX100M6", "24-200mm F2.8-4.5"},
    {"SONY", "DSC-RX1R", ""},
    {"SONY", "DSC-RX10M3", "24-600mm F2.4-4.0"},
};

static void test_unknown_names(void **state) {
    lensprof_store *store = store_at(((place *)*state)->path, LENSPROF_STORE_CREATE);
    char name[128];
    fill_names(store);
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
        find_name(store, unknown[i].maker, unknown[i].camera, unknown[i].lens, name);
        if (*name) fail_msg("%s, %s: %s", unknown[i].camera, unknown[i].lens, name);
    }
    lensprof_store_close(store);
}

int main(void) {
    const struct CMUnitTest tests[] = {store_test(test_unknown_names)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
