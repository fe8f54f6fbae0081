#include "photo/registration/project_text.hpp"

#include "photo/base/format.hpp"

namespace lensprof {
namespace {

// The first image with the same `number` as image i.
uint32_t first_of(const std::vector<ProjectImage> &images, uint32_t ProjectImage::*number, uint32_t i) {
    uint32_t first = 0;
    while (images[first].*number != images[i].*number) first++;
    return first;
}

// ` a0.1`, or ` a=3` if the value is linked to image 3.
std::string shared(const char *name, double value, uint32_t i, uint32_t first) {
    return i == first ? format(" %s%.17g", name, value) : format(" %s=%u", name, first);
}

std::string image_line(const std::vector<ProjectImage> &images, uint32_t i) {
    const ProjectImage &image = images[i];
    const uint32_t of_lens = first_of(images, &ProjectImage::lens, i),
                   of_optics = first_of(images, &ProjectImage::optics, i);
    const lensprof_camera &c = image.camera;
    std::string line = format("i w%u h%u f%u", c.width, c.height, c.projection) + shared("v", c.hfov_deg, i, of_optics);
    for (const char *name : {"Ra", "Rb", "Rc", "Rd", "Re"}) line += shared(name, 0.0, i, of_lens);
    line += format(" Eev0 Er1 Eb1 r%.17g p%.17g y%.17g TrX%.17g TrY%.17g TrZ%.17g Tpy%.17g Tpp%.17g j0", c.roll_deg,
                   c.pitch_deg, c.yaw_deg, c.translation[0], c.translation[1], c.translation[2], c.plane_deg[0],
                   c.plane_deg[1]);
    const std::pair<const char *, double> optics[] = {{"a", c.radial[0]},   {"b", c.radial[1]},   {"c", c.radial[2]},
                                                      {"d", c.shift_px[0]}, {"e", c.shift_px[1]}, {"g", c.shear_px[0]},
                                                      {"t", c.shear_px[1]}};
    for (const auto &[name, value] : optics) line += shared(name, value, i, of_optics);
    for (const char *name : {"Va", "Vb", "Vc", "Vd", "Vx", "Vy"}) line += shared(name, name[1] == 'a', i, of_lens);
    return line + " Vm5 n\"" + image.name + "\"\n";
}

}  // namespace

std::string new_project_text(const std::string &comment, const std::vector<ProjectImage> &images,
                             const std::vector<ControlPoint> &points) {
    std::string text =
        "# " + comment + "\np f2 w3000 h1500 v360  E0 R0 n\"TIFF_m c:LZW\"\nm g1 i0 f0 m2 p0.00784314\n\n";
    std::string asked;
    for (uint32_t i = 0; i < images.size(); i++) {
        text += image_line(images, i);
        if (i == first_of(images, &ProjectImage::lens, i))
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
