// Where the coefficients of a JPEG wait that do not all fit in memory.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include <jpeglib.h>

namespace lensprof {

namespace codec {

// The best Huffman tables are known when all blocks are, so that libjpeg keeps the coefficients of the whole picture,
// in "virtual arrays" which are all in memory as libjpeg is commonly built. Here those of a picture that has more
// than jpeg_memory_bytes of them are in a file without a name, but for a few rows.
class CoefficientFile {
public:
    // `beside`: a path in the folder that the file is made in.
    explicit CoefficientFile(const std::string &beside) : beside_(beside) {}
    ~CoefficientFile();
    CoefficientFile(const CoefficientFile &) = delete;
    CoefficientFile &operator=(const CoefficientFile &) = delete;

    // Before jpeg_start_compress, all else being set. `info` must not outlive this object's use; errors leave by its
    // error_exit.
    void attach(jpeg_compress_struct &info);

private:
    struct Array;

    static jvirt_barray_ptr request(j_common_ptr info, int pool, boolean pre_zero, JDIMENSION columns, JDIMENSION rows,
                                    JDIMENSION most_rows);
    static JBLOCKARRAY access(j_common_ptr info, jvirt_barray_ptr array, JDIMENSION start, JDIMENSION count,
                              boolean writable);
    void store(j_common_ptr info, Array &array);
    void load(j_common_ptr info, Array &array, JDIMENSION start);

    std::string beside_;
    int file_ = -1;
    uint64_t end_ = 0;  // bytes that the arrays so far take in the file
};

}  // namespace codec

}  // namespace lensprof
