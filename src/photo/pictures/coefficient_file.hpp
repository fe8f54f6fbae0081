// Storage for JPEG coefficients that do not all fit in memory.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include <jpeglib.h>

namespace lensprof {

namespace codec {

// Optimal Huffman tables require all blocks, so libjpeg keeps the coefficients of the whole picture in "virtual
// arrays", which common builds of libjpeg hold entirely in memory. Here the coefficients of a picture with more than
// jpeg_memory_bytes of them are kept in an unnamed file, except for a few rows.
class CoefficientFile {
public:
    // `neighbour`: a path in the folder where the file is created.
    explicit CoefficientFile(const std::string &neighbour) : neighbour_(neighbour) {}
    ~CoefficientFile();
    CoefficientFile(const CoefficientFile &) = delete;
    CoefficientFile &operator=(const CoefficientFile &) = delete;

    // Call before jpeg_start_compress, with all else set. `info` must not outlive this object's use; errors leave
    // through its error_exit.
    void attach(jpeg_compress_struct &info);

private:
    struct Array;

    static jvirt_barray_ptr request(j_common_ptr info, int pool, boolean pre_zero, JDIMENSION columns, JDIMENSION rows,
                                    JDIMENSION most_rows);
    static JBLOCKARRAY access(j_common_ptr info, jvirt_barray_ptr array, JDIMENSION start, JDIMENSION count,
                              boolean writable);
    void store(j_common_ptr info, Array &array);
    void load(j_common_ptr info, Array &array, JDIMENSION start);

    std::string neighbour_;
    int file_ = -1;
    uint64_t end_ = 0;  // bytes used so far by the arrays in the file
};

}  // namespace codec

}  // namespace lensprof
