// FITS through cfitsio (FITS Standard 4.0). A picture is one plane of the images in the file: its first two axes.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fitsio.h>

#include "photo/base/format.hpp"
#include "photo/pictures/coded_file.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

constexpr int most_axes = 9;
constexpr uint32_t most_planes = 1u << 20;

// The image of the file that has a plane, and where it is.
struct Plane {
    int hdu = 0, axes = 0;
    std::array<long, most_axes> size{}, first{};  // pixels along the axes; of the first pixel, counted from 1
};

class FitsFile {
public:
    explicit FitsFile(const std::string &path) : path_(path) {
        fits_open_diskfile(&handle_, path.c_str(), READONLY, &status_);  // a name without cfitsio's filters
        check();
    }
    ~FitsFile() {
        int ignored = 0;
        if (handle_) fits_close_file(handle_, &ignored);
    }
    FitsFile(const FitsFile &) = delete;
    FitsFile &operator=(const FitsFile &) = delete;

    // Calls accept(plane, its number) for the planes of all images, the first of them 0, until it returns false.
    template <class Accept>
    void each_plane(const Accept &accept) {
        uint32_t number = 0;
        for (int hdu = 1; move_to(hdu); hdu++) {
            Plane plane = image_of(hdu);
            if (plane.axes < 2) continue;
            uint64_t count = 1;
            for (int axis = 2; axis < plane.axes; axis++) count *= static_cast<uint64_t>(plane.size[size_t(axis)]);
            for (uint64_t i = 0; i < count; i++, number++) {
                if (number >= most_planes) fail_damaged(path_, "more than a million planes");
                if (!accept(plane, number)) return;
                next(plane);
            }
        }
    }

    // Whether bytes follow the last part that could be found, other than a padding with zeros: after each_plane, which
    // ended there.
    bool has_rest() {
        int count = 0;
        LONGLONG head = 0, data = 0, end = 0;
        fits_get_num_hdus(handle_, &count, &status_);
        if (move_to(count)) fits_get_hduaddrll(handle_, &head, &data, &end, &status_);
        check();
        const File file = open_for_reading(path_);
        std::array<char, 2880> block;
        if (!system::seek(file.get(), static_cast<int64_t>(end), SEEK_SET)) return false;
        while (const size_t read = std::fread(block.data(), 1, block.size(), file.get()))
            if (std::any_of(block.begin(), block.begin() + read, [](char c) { return c != 0; })) return true;
        return false;
    }

    fitsfile *handle() { return handle_; }
    int &status() { return status_; }

    void check() const {
        if (!status_) return;
        char text[FLEN_STATUS] = "";
        fits_get_errstatus(status_, text);
        fail_damaged(path_, text);
    }

private:
    // False after the last part of the file. Parts are counted from 1.
    bool move_to(int hdu) {
        fits_movabs_hdu(handle_, hdu, &kind_, &status_);
        if (status_ && hdu > 1) {
            status_ = 0;
            fits_clear_errmsg();
            return false;
        }
        check();
        return true;
    }

    // Of the present part. Without axes: it is a table.
    Plane image_of(int hdu) {
        int bits = 0;
        Plane plane;
        if (kind_ != IMAGE_HDU) return plane;
        fits_get_img_param(handle_, most_axes, &bits, &plane.axes, plane.size.data(), &status_);
        check();
        if (plane.axes > most_axes) fail_unsupported(path_, "has more than 9 axes; save its planes first");
        for (int axis = 0; axis < plane.axes; axis++)
            if (plane.size[size_t(axis)] < 1) plane.axes = 0;
        plane.hdu = hdu, plane.first.fill(1);
        return plane;
    }

    static void next(Plane &plane) {
        for (size_t axis = 2; axis < size_t(plane.axes); axis++) {
            if (++plane.first[axis] <= plane.size[axis]) return;
            plane.first[axis] = 1;
        }
    }

    std::string path_;
    fitsfile *handle_ = nullptr;
    int status_ = 0;
    int kind_ = 0;  // of the present part
};

// The sample that holds all values of an image: its integers if they are of 8 or 16 bit, without sign and all defined.
uint32_t sample_of(FitsFile &file) {
    int type = 0;
    fits_get_img_equivtype(file.handle(), &type, &file.status());
    file.check();
    long blank = 0;
    int missing = 0;
    fits_read_key(file.handle(), TLONG, "BLANK", &blank, nullptr, &missing);
    if (missing == 0) return LENSPROF_SAMPLE_F32;
    return type == BYTE_IMG ? LENSPROF_SAMPLE_U8 : type == USHORT_IMG ? LENSPROF_SAMPLE_U16 : LENSPROF_SAMPLE_F32;
}

class FitsSource final : public RowSource {
public:
    explicit FitsSource(const ReadRequest &request) : path_(request.path), file_(request.path) {
        file_.each_plane([&](const Plane &plane, uint32_t number) {
            if (number == request.page) plane_ = plane;
            return number != request.page;
        });
        if (plane_.axes == 0) fail_unsupported(path_, "is a FITS file without a picture of this number; give another");
        if (plane_.size[0] > long(picture_max_side) || plane_.size[1] > long(picture_max_side))
            fail_damaged(path_, "a side of more than a million pixels");
        header_.traits.format = FileFormat::fits;
        header_.sample = sample_of(file_);
        header_.layout = LENSPROF_LAYOUT_GREY;
        const auto width = static_cast<uint32_t>(plane_.size[0]), height = static_cast<uint32_t>(plane_.size[1]);
        set_coded_frame(header_, width, height, request);
    }

    void read(uint8_t *row) override {
        float undefined = NAN;
        const int type = header_.sample == LENSPROF_SAMPLE_U8    ? TBYTE
                         : header_.sample == LENSPROF_SAMPLE_U16 ? TUSHORT
                                                                 : TFLOAT;
        int any = 0;
        fits_read_pix(file_.handle(), type, plane_.first.data(), plane_.size[0], type == TFLOAT ? &undefined : nullptr,
                      row, &any, &file_.status());
        file_.check();
        plane_.first[1]++;
    }

private:
    std::string path_;
    FitsFile file_;
    Plane plane_;  // its first pixel is that of the next row
};

}  // namespace

std::unique_ptr<RowSource> open_fits(const ReadRequest &request) { return std::make_unique<FitsSource>(request); }

CodedMetadata fits_metadata(const std::string &path) {
    const FitsSource first({path, 0, nullptr, 0});
    CodedMetadata metadata;
    metadata.width = first.header().frame_width, metadata.height = first.header().frame_height;
    return metadata;
}

FitsPlanes fits_planes(const std::string &path) {
    FitsFile file(path);
    FitsPlanes planes;
    std::array<long, 2> size{};
    int other = 0;  // the part named last
    file.each_plane([&](const Plane &plane, uint32_t number) {
        const std::array<long, 2> own{plane.size[0], plane.size[1]};
        if (number == 0) size = own;
        if (own == size)
            planes.numbers.push_back(number);
        else if (std::exchange(other, plane.hdu) != plane.hdu)
            planes.others.push_back(format("part %d, %ld x %ld px", plane.hdu, own[0], own[1]));
        return true;
    });
    planes.is_damaged = file.has_rest();
    return planes;
}

}  // namespace codec

bool can_read_fits() { return true; }

}  // namespace lensprof
