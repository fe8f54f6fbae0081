// Corrects a tile of 8 bit or a frame of 16 bit RGB, packs a blob again, or looks a profile up.
//
// usage: correct tile BLOB FRAME_WIDTH FRAME_HEIGHT X Y WIDTH HEIGHT <pixels >corrected
//        correct frame BLOB WIDTH HEIGHT <pixels >corrected
//        correct repack BLOB >blob
//        correct lookup DATABASE MAKER MODEL LENS FOCAL_MM APERTURE
#include "lensprof.hpp"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>

namespace {

std::vector<uint8_t> all_of(std::istream &file) { return {std::istreambuf_iterator<char>(file), {}}; }

std::vector<uint8_t> read_file(const std::string &name) {
    std::ifstream file(name, std::ios::binary);
    if (!file) throw std::runtime_error(name + ": cannot be read");
    return all_of(file);
}

void correct_tile(const std::vector<std::string> &arguments) {
    const std::vector<uint8_t> blob = read_file(arguments[1]);
    const auto number = [&](int i) { return static_cast<uint32_t>(std::stoul(arguments[i])); };
    const lensprof::Plan<uint8_t> plan(blob, LENSPROF_LAYOUT_RGB, number(2), number(3));
    std::vector<uint8_t> pixels = all_of(std::cin);
    plan.apply(pixels, {number(4), number(5), number(6), number(7)});
    std::fwrite(pixels.data(), 1, pixels.size(), stdout);
}

void correct_frame(const std::vector<std::string> &arguments) {
    const lensprof::Profile profile = lensprof::Profile::unpack(read_file(arguments[1]));
    const auto width = static_cast<uint32_t>(std::stoul(arguments[2]));
    const auto height = static_cast<uint32_t>(std::stoul(arguments[3]));
    const std::vector<uint8_t> bytes = all_of(std::cin);
    std::vector<uint16_t> pixels(bytes.size() / sizeof(uint16_t));
    std::memcpy(pixels.data(), bytes.data(), pixels.size() * sizeof(uint16_t));
    lensprof::Plan<uint16_t>(profile, LENSPROF_LAYOUT_RGB, width, height).apply(pixels, {0, 0, width, height});
    std::fwrite(pixels.data(), sizeof(uint16_t), pixels.size(), stdout);
}

void repack(const std::vector<std::string> &arguments) {
    const std::vector<uint8_t> blob = lensprof::Profile::unpack(read_file(arguments[1])).pack();
    std::fwrite(blob.data(), 1, blob.size(), stdout);
}

void look_up(const std::vector<std::string> &arguments) {
    const lensprof::Store store(arguments[1]);
    lensprof::Key key;
    key.camera_maker = arguments[2], key.camera_model = arguments[3], key.lens = arguments[4];
    key.focal_mm = std::stod(arguments[5]), key.aperture = std::stod(arguments[6]);
    const lensprof::Found found = store.lookup(key);
    const lensprof_profile_key &of = found.profile->key;
    std::printf("%s, %.1f mm, f/%.1f: corner %.4f, profiles %u, exact %u\n", of.lens, of.focal_mm, of.aperture,
                found.profile.corner_falloff(), found.how.rows, found.how.exact);
}

}  // namespace

int main(int argc, char **argv) {
    const std::vector<std::string> arguments(argv + 1, argv + argc);
    try {
        if (arguments.size() == 8 && arguments[0] == "tile") {
            correct_tile(arguments);
        } else if (arguments.size() == 4 && arguments[0] == "frame") {
            correct_frame(arguments);
        } else if (arguments.size() == 2 && arguments[0] == "repack") {
            repack(arguments);
        } else if (arguments.size() == 7 && arguments[0] == "lookup") {
            look_up(arguments);
        } else {
            throw std::runtime_error("usage: correct tile|frame|repack|lookup ...; see the head of correct.cpp");
        }
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
