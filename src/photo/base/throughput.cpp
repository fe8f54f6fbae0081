#include "photo/base/throughput.hpp"

#include <algorithm>

#include "photo/base/format.hpp"

namespace lensprof {
namespace {

double since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Throughput::Throughput(Events &events, const std::string &what, uint32_t pictures, uint64_t pixels)
    : events_(events), what_(what), pictures_(pictures), pixels_(pixels), begin_(std::chrono::steady_clock::now()) {
    show();
}

void Throughput::add_pixels(uint64_t pixels) {
    std::lock_guard<std::mutex> lock(mutex_);
    pixels_done_ += pixels;
    show();
}

void Throughput::add_picture() {
    std::lock_guard<std::mutex> lock(mutex_);
    pictures_done_++;
    show();
}

double Throughput::seconds() const { return since(begin_); }

double Throughput::megapixels() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return 1e-6 * static_cast<double>(pixels_done_);
}

void Throughput::show() {
    double s = std::max(seconds(), 1e-6), done = static_cast<double>(pixels_done_);
    std::string detail = format(", %u of %u pictures", pictures_done_, pictures_);
    if (pixels_done_ > 0) detail += format(", %.1f pictures/s, %.1f megapixels/s", pictures_done_ / s, 1e-6 * done / s);
    events_.update(what_, done / static_cast<double>(std::max<uint64_t>(pixels_, 1)), detail);
}

std::string Throughput::summary() const {
    double s = std::max(seconds(), 1e-6), megapixel_count = megapixels();
    return format("%u pictures, %.1f megapixels in %.1f s: %.1f pictures/s, %.1f megapixels/s", pictures_done_,
                  megapixel_count, s, pictures_done_ / s, megapixel_count / s);
}

}  // namespace lensprof
