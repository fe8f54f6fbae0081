// The room of the operating system, alone: the same test runs on POSIX and, as a program for Windows, in Wine.
#include <cerrno>
#include <filesystem>
#include <string>

#include "photo/system/system.hpp"

extern "C" {
#include "support.h"
}

using namespace lensprof;
using system::FileStatus;
using system::Lifetime;

namespace {

std::string folder;  // of this run

std::string in(const std::string &name) { return folder + "/" + name; }

void write(const std::string &path, const std::string &text) {
    std::FILE *file = system::open_stream(path, "wb");
    assert_non_null(file);
    assert_int_equal(std::fwrite(text.data(), 1, text.size(), file), text.size());
    assert_int_equal(std::fclose(file), 0);
}

std::string read(const std::string &path) {
    std::FILE *file = system::open_stream(path, "rb");
    if (!file) return "missing";
    char text[100];
    const std::string result(text, std::fread(text, 1, sizeof text, file));
    std::fclose(file);
    return result;
}

int make_folder(void **) {
    static int number = 0;
    do
        folder = system::temporary_folder() + "/lensprof-test-" + std::to_string(system::process_number()) + "-"
                 + std::to_string(++number);
    while (!system::create_private_folder(folder) && errno == EEXIST);
    return 0;
}

int remove_folder(void **) {
    std::error_code error;
    std::filesystem::remove_all(folder, error);
    return error ? 1 : 0;
}

void test_status(void **) {
    assert_true(system::status_of(in("none")).kind == FileStatus::Kind::missing);
    assert_true(system::status_of(in("none")).identity.empty());
    assert_true(system::status_of(folder).kind == FileStatus::Kind::folder);
    write(in("a"), "twelve bytes");
    write(in("b"), "");
    const FileStatus a = system::status_of(in("a"));
    assert_true(a.kind == FileStatus::Kind::file);
    assert_int_equal(a.bytes, 12);
    assert_true(a.modified_s > 1700000000 && a.modified_ns >= 0 && a.modified_ns < 1000000000);
    assert_true(a.identity == system::status_of(folder + "/./a").identity);
    assert_true(a.identity != system::status_of(in("b")).identity);
    std::FILE *file = system::open_stream(in("a"), "rb");
    assert_true(system::status_of(file).identity == a.identity);
    std::fclose(file);
}

void test_names_that_are_not_ascii(void **) {
    const std::string name = in("Größe 写真 é.txt");
    write(name, "light");
    assert_string_equal(read(name).c_str(), "light");
    assert_int_equal(system::status_of(name).bytes, 5);
    assert_true(system::resolve_links(name).find("写真") != std::string::npos);
    assert_true(system::replace_file(name, in("é.txt")));
    assert_true(system::remove_file(in("é.txt")));
    assert_false(system::remove_file(in("é.txt")));
    assert_int_equal(errno, ENOENT);
}

void test_new_files_replace_nothing(void **) {
    const int file = system::create_file(in("new"), 0666, Lifetime::kept);
    assert_true(file >= 0);
    system::close_file(file);
    assert_int_equal(system::create_file(in("new"), 0666, Lifetime::kept), -1);
    assert_int_equal(errno, EEXIST);
    assert_int_equal(system::create_file(in("none/new"), 0666, Lifetime::kept), -1);
    assert_int_equal(errno, ENOENT);
    assert_false(system::create_private_folder(folder));
    assert_int_equal(errno, EEXIST);
}

void test_bytes_at_a_place(void **) {
    for (const Lifetime lifetime : {Lifetime::kept, Lifetime::until_closed}) {
        const int file = system::create_file(in("bytes"), 0600, lifetime);
        assert_true(file >= 0);
        assert_true(system::write_bytes_at(file, 7, "middle", 6));
        assert_true(system::write_bytes_at(file, 0, "a start", 7));
        char text[20] = "";
        assert_true(system::read_bytes_at(file, 2, text, 11));
        assert_string_equal(text, "startmiddle");
        assert_false(system::read_bytes_at(file, 10, text, 10));  // the file ends
        assert_int_equal(errno, EIO);
        system::close_file(file);
        const bool is_left = system::status_of(in("bytes")).kind != FileStatus::Kind::missing;
        assert_int_equal(is_left, lifetime == Lifetime::kept);
        if (is_left) assert_true(system::remove_file(in("bytes")));
    }
}

void test_a_file_in_memory_has_a_path(void **) {
    std::string path;
    const int file = system::create_file_in_memory(path);
    if (file < 0) return;  // this system has no such files
    assert_true(system::write_bytes_at(file, 0, "light", 5));
    assert_string_equal(read(path).c_str(), "light");
    system::close_file(file);
    assert_string_equal(read(path).c_str(), "missing");
}

void test_a_file_is_replaced(void **) {
    write(in("old"), "old");
    write(in("new"), "new");
    assert_true(system::set_permissions(in("old"), 0444));
    assert_int_equal(system::status_of(in("old")).permissions & 0200, 0);
    assert_true(system::make_durable(in("new")));
    assert_true(system::replace_file(in("new"), in("old")));
    system::make_names_durable(folder);
    assert_string_equal(read(in("old")).c_str(), "new");
    assert_string_equal(read(in("new")).c_str(), "missing");
    assert_false(system::replace_file(in("new"), in("old")));
    assert_int_equal(errno, ENOENT);
    assert_string_equal(read(in("old")).c_str(), "new");
    assert_true(system::can_write_in(folder));
    assert_false(system::can_write_in(in("none")));
}

void test_streams(void **) {
    const char text[] = "0123456789";
    std::FILE *file = system::open_bytes(text, 10);
    assert_non_null(file);
    assert_true(system::seek(file, 4, SEEK_SET));
    assert_int_equal(std::fgetc(file), '4');
    assert_int_equal(system::tell(file), 5);
    assert_true(system::seek(file, 0, SEEK_END));
    assert_int_equal(system::tell(file), 10);
    std::fclose(file);
    // Places that 32 bits cannot hold.
    file = system::open_stream(in("far"), "wb");
    assert_non_null(file);
    const int64_t far = int64_t(5) << 30;
    assert_true(system::seek(file, far, SEEK_SET));
    assert_true(system::tell(file) == far);
    std::fclose(file);
    assert_null(system::open_stream(in("none"), "rb"));
    assert_int_equal(errno, ENOENT);
}

void test_patterns(void **) {
    const struct {
        const char *pattern, *name;
        bool fits;
    } cases[] = {{"*.jpg", "a.jpg", true},
                 {"*.jpg", "a.jpeg", false},
                 {"*", "", true},
                 {"img_?.png", "img_1.png", true},
                 {"img_?.png", "img_12.png", false},
                 {"*/b*", "a/bc", true},
                 {"[0-9]*", "7.tif", true},
                 {"[!0-9]*", "7.tif", false},
                 {"a+(b).c", "a+(b).c", true},
                 {"a.c", "abc", false},
                 {"*写*", "a写真", true},
                 {"[", "[", true}};
    for (const auto &c : cases) {
        if (system::fits_pattern(c.pattern, c.name) == c.fits) continue;
        print_error("%s, %s\n", c.pattern, c.name);
        fail();
    }
}

void test_a_folder_is_locked_once(void **) {
    system::FolderLock first;
    assert_true(first.acquire(folder));
    assert_true(first.acquire(folder));
    {
        system::FolderLock second;
        assert_false(second.acquire(folder));
    }
    system::FolderLock nowhere;
    assert_true(nowhere.acquire(in("none")));
    {
        system::FolderLock inner;
        assert_true(system::create_private_folder(in("inner")));
        assert_true(inner.acquire(in("inner")));
    }
    system::FolderLock again;
    assert_true(again.acquire(in("inner")));
}

void test_process_and_memory(void **) {
    assert_true(system::is_running(system::process_number()));
    assert_false(system::is_running(999999998));
    assert_true(system::available_memory_bytes() > 64u << 20);
    const uint64_t before = system::peak_memory_bytes();
    assert_true(before > 100000);
    std::string memory(64u << 20, 'x');
    assert_true(system::peak_memory_bytes() > before + (32u << 20) && memory[1000] == 'x');
    std::FILE *file = system::open_stream(in("plain"), "wb");
    assert_false(system::is_terminal(file));
    std::fclose(file);
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_status, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_names_that_are_not_ascii, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_new_files_replace_nothing, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_bytes_at_a_place, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_a_file_in_memory_has_a_path, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_a_file_is_replaced, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_streams, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_patterns, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_a_folder_is_locked_once, make_folder, remove_folder),
        cmocka_unit_test_setup_teardown(test_process_and_memory, make_folder, remove_folder),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
