// RGBA frames from standard input to standard output, corrected by Lensfun: the loop that a video program without our
// plug-in would write. usage: lensfun_frames WIDTH HEIGHT K1 K2 K3
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <lensfun.h>

int main(int count, char **words) {
    if (count != 6) return std::fputs("usage: lensfun_frames WIDTH HEIGHT K1 K2 K3\n", stderr), 1;
    const int width = std::atoi(words[1]), height = std::atoi(words[2]);
    lfLens *lens = lf_lens_new();
    lens->Type = LF_RECTILINEAR;
    lens->CropFactor = 1.0f;
    lfLensCalibVignetting falloff{};
    falloff.Model = LF_VIGNETTING_MODEL_PA;
    falloff.Focal = 50.0f, falloff.Aperture = 2.8f, falloff.Distance = 1000.0f;
    for (int i = 0; i < 3; i++) falloff.Terms[i] = static_cast<float>(std::atof(words[3 + i]));
    lf_lens_add_calib_vignetting(lens, &falloff);
    lfModifier *modifier = lf_modifier_new(lens, 1.0f, width, height);
    lf_modifier_initialize(modifier, lens, LF_PF_U8, 50.0f, 2.8f, 1000.0f, 1.0f, LF_RECTILINEAR, LF_MODIFY_VIGNETTING,
                           0);
    std::vector<unsigned char> frame(size_t(width) * size_t(height) * 4);
    while (std::fread(frame.data(), 1, frame.size(), stdin) == frame.size()) {
        lf_modifier_apply_color_modification(modifier, frame.data(), 0, 0, width, height,
                                             LF_CR_4(RED, GREEN, BLUE, UNKNOWN), width * 4);
        std::fwrite(frame.data(), 1, frame.size(), stdout);
    }
    lf_modifier_destroy(modifier);
    lf_lens_destroy(lens);
}
