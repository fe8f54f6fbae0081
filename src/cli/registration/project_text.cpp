#include "cli/registration/project_text.hpp"

#include "cli/program/format.hpp"

namespace lensprof {
namespace {

uint32_t first_of_lens(const std::vector<ProjectImage> &images, uint32_t lens) {
    for (uint32_t i = 0; i < images.size(); i++)
        if (images[i].lens == lens) return i;
    return 0;
}

// ` a0.1`, or ` a=3` where the value is that of image 3.
std::string shared(const char *name, double value, bool is_first, uint32_t first) {
    return is_first ? format(" %s%.17g", name, value) : format(" %s=%u", name, first);
}

std::string image_line(const ProjectImage &image, uint32_t i, uint32_t first) {
    const lensprof_camera &c = image.camera;
    const bool own = i == first;
    std::string line = format("i w%u h%u f%u", c.width, c.height, c.projection) + shared("v", c.hfov_deg, own, first);
    for (const char *name : {"Ra", "Rb", "Rc", "Rd", "Re"}) line += shared(name, 0.0, own, first);
    line += format(" Eev0 Er1 Eb1 r%.17g p%.17g y%.17g TrX%.17g TrY%.17g TrZ%.17g Tpy%.17g Tpp%.17g j0", c.roll_deg,
                   c.pitch_deg, c.yaw_deg, c.translation[0], c.translation[1], c.translation[2], c.plane_deg[0],
                   c.plane_deg[1]);
    const std::pair<const char *, double> lens[] = {
        {"a", c.radial[0]},   {"b", c.radial[1]},   {"c", c.radial[2]}, {"d", c.shift_px[0]}, {"e", c.shift_px[1]},
        {"g", c.shear_px[0]}, {"t", c.shear_px[1]}, {"Va", 1.0},        {"Vb", 0.0},          {"Vc", 0.0},
        {"Vd", 0.0},          {"Vx", 0.0},          {"Vy", 0.0}};
    for (const auto &[name, value] : lens) line += shared(name, value, own, first);
    return line + " Vm5 n\"" + image.name + "\"\n";
}

}  // namespace

std::string new_project_text(const std::string &comment, const std::vector<ProjectImage> &images,
                             const std::vector<ControlPoint> &points) {
    std::string text =
        "# " + comment + "\np f2 w3000 h1500 v360  E0 R0 n\"TIFF_m c:LZW\"\nm g1 i0 f0 m2 p0.00784314\n\n";
    std::string asked;
    for (uint32_t i = 0; i < images.size(); i++) {
        const uint32_t first = first_of_lens(images, images[i].lens);
        text += image_line(images[i], i, first);
        if (i == first)
            asked += format("v Ra%u Rb%u Rc%u Rd%u Re%u\nv Vb%u Vc%u Vd%u Vx%u Vy%u\n", i, i, i, i, i, i, i, i, i, i);
        if (i > 0) asked += format("v Eev%u Er%u Eb%u\n", i, i, i);
    }
    text += "\n" + asked + "v\n";
    for (const ControlPoint &p : points)
        text += format("c n%u N%u x%.3f y%.3f X%.3f Y%.3f t0\n", p.image[0], p.image[1], p.xy[0][0], p.xy[0][1],
                       p.xy[1][0], p.xy[1][1]);
    return text;
}

}  // namespace lensprof
