#include "photo/pictures/coefficient_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <jerror.h>

#include "photo/base/output_file.hpp"
#include "photo/pictures/picture.hpp"
#include "photo/system/system.hpp"

namespace lensprof {

namespace codec {

namespace {

// Bytes of the rows of blocks held in memory.
constexpr size_t window_bytes = size_t(1) << 20;

// Bytes of the coefficients of all components.
uint64_t coefficient_bytes(const jpeg_compress_struct &info) {
    uint64_t samples = 0, widest = 1, highest = 1;
    for (int i = 0; i < info.num_components; ++i) {
        widest = std::max<uint64_t>(widest, static_cast<uint64_t>(info.comp_info[i].h_samp_factor));
        highest = std::max<uint64_t>(highest, static_cast<uint64_t>(info.comp_info[i].v_samp_factor));
    }
    for (int i = 0; i < info.num_components; ++i)
        samples += uint64_t(info.image_width) * static_cast<uint64_t>(info.comp_info[i].h_samp_factor) / widest
                   * info.image_height * static_cast<uint64_t>(info.comp_info[i].v_samp_factor) / highest;
    return samples * sizeof(JCOEF);
}

}  // namespace

// In libjpeg's memory pool, which ends with the picture. Rows from window_start on are in the window.
struct CoefficientFile::Array {
    JDIMENSION rows, window_rows, window_start;
    JDIMENSION stored;  // rows from here on are not in the file: zero
    boolean changed;
    size_t row_bytes;
    uint64_t place;  // in the file
    JBLOCKARRAY window;
};

CoefficientFile::~CoefficientFile() {
    if (file_ >= 0) system::close_file(file_);
}

void CoefficientFile::attach(jpeg_compress_struct &info) {
    if (coefficient_bytes(info) <= jpeg_memory_bytes) return;
    errno = 0;
    file_ = open_unnamed(neighbour_);
    if (file_ < 0) ERREXIT(&info, JERR_FILE_WRITE);
    info.client_data = this;
    info.mem->request_virt_barray = request;
    info.mem->access_virt_barray = access;
}

jvirt_barray_ptr CoefficientFile::request(j_common_ptr info, int pool, boolean, JDIMENSION columns, JDIMENSION rows,
                                          JDIMENSION most_rows) {
    CoefficientFile &self = *static_cast<CoefficientFile *>(info->client_data);
    Array *array = static_cast<Array *>(info->mem->alloc_small(info, pool, sizeof(Array)));
    array->rows = rows;
    array->stored = 0;
    array->row_bytes = columns * sizeof(JBLOCK);
    array->place = self.end_;
    array->window_rows = std::min(rows, std::max(most_rows, static_cast<JDIMENSION>(window_bytes / array->row_bytes)));
    array->window = info->mem->alloc_barray(info, pool, columns, array->window_rows);
    for (JDIMENSION y = 0; y < array->window_rows; ++y) std::memset(array->window[y], 0, array->row_bytes);
    array->window_start = 0;
    array->changed = FALSE;
    self.end_ += uint64_t(rows) * array->row_bytes;
    return reinterpret_cast<jvirt_barray_ptr>(array);
}

void CoefficientFile::store(j_common_ptr info, Array &array) {
    const JDIMENSION count = std::min(array.window_rows, array.rows - array.window_start);
    for (JDIMENSION y = 0; y < count; ++y) {
        const uint64_t place = array.place + (array.window_start + uint64_t(y)) * array.row_bytes;
        if (!system::write_bytes_at(file_, place, array.window[y], array.row_bytes)) ERREXIT(info, JERR_FILE_WRITE);
    }
    array.stored = std::max(array.stored, array.window_start + count);
}

void CoefficientFile::load(j_common_ptr info, Array &array, JDIMENSION start) {
    array.window_start = start;
    const JDIMENSION count = std::min(array.window_rows, array.rows - start);
    for (JDIMENSION y = 0; y < count; ++y) {
        const uint64_t place = array.place + (start + uint64_t(y)) * array.row_bytes;
        if (start + y >= array.stored)
            std::memset(array.window[y], 0, array.row_bytes);
        else if (!system::read_bytes_at(file_, place, array.window[y], array.row_bytes))
            ERREXIT(info, JERR_FILE_READ);
    }
}

JBLOCKARRAY CoefficientFile::access(j_common_ptr info, jvirt_barray_ptr handle, JDIMENSION start, JDIMENSION count,
                                    boolean writable) {
    CoefficientFile &self = *static_cast<CoefficientFile *>(info->client_data);
    Array &array = *reinterpret_cast<Array *>(handle);
    if (count > array.window_rows || start + count > array.rows) ERREXIT(info, JERR_BAD_VIRTUAL_ACCESS);
    if (start < array.window_start || start + count > array.window_start + array.window_rows) {
        if (array.changed) self.store(info, array);
        array.changed = FALSE;
        self.load(info, array, start);
    }
    if (writable) array.changed = TRUE;
    return array.window + (start - array.window_start);
}

}  // namespace codec

}  // namespace lensprof
