// The reader of TIFF directories: what it reads in both byte orders, and which malformed files it refuses.
#include "picture_files.hpp"

#include <climits>

#include "photo/pictures/tiff_directory.hpp"

using namespace picture_files;

namespace {

// Writes the bytes of a TIFF as numbers of 2 and 4 bytes.
class Writer {
public:
    explicit Writer(bool big) {
        order_.big = big;
        bytes = big ? Bytes{'M', 'M'} : Bytes{'I', 'I'};
        put(42, 2);
    }

    Writer &put(uint32_t value, size_t size) {
        bytes.resize(bytes.size() + size);
        order_.put(&bytes[bytes.size() - size], size, value);
        return *this;
    }
    Writer &entry(uint32_t tag, uint32_t type, uint32_t count, uint32_t value) {
        return put(tag, 2).put(type, 2).put(count, 4).put(value, 4);
    }

    Bytes bytes;

private:
    TiffByteOrder order_;
};

// The header and a directory with one entry, followed by 8 bytes from 26 to 34.
Writer with_entry(bool big, uint32_t tag, uint32_t type, uint32_t count, uint32_t value) {
    Writer tiff(big);
    tiff.put(8, 4).put(1, 2).entry(tag, type, count, value).put(0, 4);
    tiff.put(0x11112222, 4).put(0x33334444, 4);
    return tiff;
}

TiffReader reader_of(const Bytes &bytes) {
    return TiffReader(bytes.size(), [&bytes](uint64_t offset, uint8_t *to, size_t count) {
        assert_true(offset <= bytes.size() && count <= bytes.size() - offset && count > 0);  // guaranteed by the reader
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), count, to);
    });
}

void assert_defect(const Bytes &bytes, TiffDefect expected, const std::function<void(TiffReader &)> &use) {
    try {
        TiffReader reader = reader_of(bytes);
        use(reader);
    } catch (const std::exception &error) {  // which the program's last handler also catches
        const auto *unusable = dynamic_cast<const UnusableTiff *>(&error);
        assert_non_null(unusable);
        assert_int_equal(static_cast<int>(unusable->defect), static_cast<int>(expected));
        return;
    }
    fail_msg("no defect");
}

void read_first(TiffReader &reader) { reader.first(); }

void test_headers(void **) {
    assert_defect({}, TiffDefect::not_tiff, read_first);
    assert_defect({'I', 'I', 42, 0, 8, 0, 0}, TiffDefect::not_tiff, read_first);
    assert_defect({'I', 'M', 42, 0, 8, 0, 0, 0}, TiffDefect::not_tiff, read_first);
    assert_defect({'M', 'M', 42, 0, 0, 0, 0, 8}, TiffDefect::not_tiff, read_first);
    assert_defect({'I', 'I', 43, 0, 8, 0, 0, 0}, TiffDefect::big_tiff, read_first);
    assert_defect({'M', 'M', 0, 43, 0, 8, 0, 0}, TiffDefect::big_tiff, read_first);
    assert_defect({'I', 'I', 42, 0, 0, 0, 0, 0}, TiffDefect::no_directory, read_first);
}

// Also with offsets and sizes near 2^32, whose sums must not wrap.
void test_cut_off(void **) {
    for (bool big : {false, true}) {
        for (uint32_t offset : {7u, 8u, 9u, UINT_MAX - 1, UINT_MAX})
            assert_defect(Writer(big).put(offset, 4).bytes, TiffDefect::cut_off, read_first);
        assert_defect(Writer(big).put(8, 4).put(65535, 2).put(0, 4).bytes, TiffDefect::cut_off, read_first);
        const Bytes whole = with_entry(big, 256, tiff_long, 1, 7).bytes;
        for (size_t size = 8; size < 26; ++size)
            assert_defect(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), TiffDefect::cut_off,
                          read_first);
        const struct {
            uint32_t type, count, place;
        } beyond[] = {{tiff_byte, 5, 30}, {tiff_short, 4, 27},           {tiff_long, 2, UINT_MAX},  {5, 1, 27},
                      {12, UINT_MAX, 26}, {tiff_undefined, UINT_MAX, 1}, {tiff_long, 1u << 30, 26}, {12, 1u << 29, 26},
                      {tiff_byte, 9, 26}};
        for (const auto &one : beyond) {
            const Bytes bytes = with_entry(big, 700, one.type, one.count, one.place).bytes;
            assert_defect(bytes, TiffDefect::cut_off, [](TiffReader &reader) { reader.check_values(reader.first()); });
            assert_defect(bytes, TiffDefect::cut_off,
                          [](TiffReader &reader) { reader.bytes(reader.first().entries.at(0)); });
        }
    }
}

// A directory that refers to itself as the next or as a child, and too many SubIFDs.
void test_circles(void **) {
    const auto walk = [](TiffReader &reader) {
        for (uint64_t pointer = 4; pointer;) {
            const TiffDirectory directory = reader.directory(pointer);
            for (uint64_t child : reader.children(directory)) reader.directory(child);
            pointer = directory.next ? directory.next_pointer() : 0;
        }
    };
    for (bool big : {false, true}) {
        assert_defect(Writer(big).put(8, 4).put(0, 2).put(8, 4).bytes, TiffDefect::circle, walk);
        assert_defect(Writer(big).put(8, 4).put(1, 2).entry(330, tiff_long, 1, 8).put(8, 4).bytes, TiffDefect::circle,
                      walk);
        Writer many(big);
        many.put(8, 4).put(1, 2).entry(330, tiff_ifd, 257, 26).put(0, 4);
        for (int i = 0; i < 257; ++i) many.put(8, 4);
        assert_defect(many.bytes, TiffDefect::circle, walk);
        assert_defect(with_entry(big, 330, tiff_long, UINT_MAX, 26).bytes, TiffDefect::circle, walk);
        assert_defect(with_entry(big, 330, tiff_long, 3, 26).bytes, TiffDefect::cut_off, walk);
        assert_defect(with_entry(big, 330, tiff_long, 1, 33).bytes, TiffDefect::cut_off, walk);
    }
}

void test_blocks(void **) {
    for (bool big : {false, true})
        for (uint32_t tag : {273u, 324u}) {
            const auto make = [&](uint32_t start, uint32_t bytes) {
                return Writer(big)
                    .put(8, 4)
                    .put(2, 2)
                    .entry(tag, tiff_long, 1, start)
                    .entry(tag == 273 ? 279 : 325, tiff_long, 1, bytes)
                    .put(0, 4)
                    .bytes;
            };
            const auto check = [](TiffReader &reader) { reader.check_blocks(reader.first()); };
            for (const auto &[start, bytes] :
                 {std::pair(38u, 1u), std::pair(30u, 9u), std::pair(UINT_MAX, UINT_MAX), std::pair(2u, UINT_MAX)})
                assert_defect(make(start, bytes), TiffDefect::pixels_cut_off, check);
            const Bytes whole = make(30, 8);
            TiffReader reader = reader_of(whole);
            check(reader);
        }
}

void test_values(void **) {
    using Numbers = std::vector<uint32_t>;
    for (bool big : {false, true}) {
        const auto numbers = [&](uint32_t type, uint32_t count, uint32_t value, uint32_t most) {
            const Bytes bytes = with_entry(big, 700, type, count, value).bytes;
            TiffReader reader = reader_of(bytes);
            return reader.numbers(reader.first(), 700, most);
        };
        assert_true(numbers(tiff_long, 1, 0x01020304, 9) == Numbers{0x01020304});
        assert_true(numbers(tiff_long, 2, 26, 9) == Numbers({0x11112222, 0x33334444}));
        assert_true(numbers(tiff_long, 2, 26, 1) == Numbers{0x11112222});
        assert_true(numbers(tiff_ifd, 1, 5, 9) == Numbers{5});
        assert_true(numbers(tiff_short, 1, big ? 7u << 16 : 7, 9) == Numbers{7});
        assert_true(numbers(tiff_byte, 2, big ? 0x07080000 : 0x0807, 9) == Numbers({7, 8}));
        assert_true(numbers(tiff_long, 0, 5, 9).empty());
        for (uint32_t type : {0u, 2u, 5u, 12u, 14u, 65535u}) assert_true(numbers(type, 1, 26, 9).empty());
        const Bytes bytes = with_entry(big, 700, tiff_undefined, 8, 26).bytes;
        TiffReader reader = reader_of(bytes);
        const TiffDirectory directory = reader.first();
        assert_true(reader.bytes(*directory.find(700)) == Bytes(bytes.end() - 8, bytes.end()));
        assert_null(directory.find(701));
        assert_int_equal(reader.number(directory, 701, 3), 3);
        assert_int_equal(directory.next_pointer(), 22);
        assert_int_equal(directory.entries[0].field, 18);
        assert_int_equal(reader.place(directory.entries[0]), 26);
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {cmocka_unit_test(test_headers), cmocka_unit_test(test_cut_off),
                                cmocka_unit_test(test_circles), cmocka_unit_test(test_blocks),
                                cmocka_unit_test(test_values)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
