// The program and the operating system: another user's files, full disks, Ctrl-C, closed outputs.
#include <poll.h>

#include "program_runs.hpp"

using namespace cli_runs;

namespace {

Words build_quick(const Words &more) { return Words{"build", scene("pano.pto")} + quick + more; }

// Read-only files: root can write everywhere, so the child becomes nobody.

void become_nobody() {
    if (getuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(254);
}

// A read-only folder with a database, and a folder that everybody may write to.
void make_read_only() {
    fs::permissions(folder, fs::perms(0755));
    fs::create_directories(work("closed"));
    fs::create_directories(work("open"));
    must_exit(done, build_quick({"--db", work("closed/p.db")}));
    fs::permissions(work("closed/p.db"), fs::perms(0444));
    fs::permissions(work("closed"), fs::perms(0555));
    fs::permissions(work("open"), fs::perms(0777));
}

void test_read_only_database(void **) {
    make_read_only();
    const Disk before = disk();
    const Words outputs = {"--write", "points=" + work("open/left.txt"), "--write", "pto=" + work("open/left.pto")};
    Outcome outcome = run_child({"profile", "list", "--db", work("closed/p.db")}, become_nobody);
    if (outcome.code == 254) {
        print_message("skipped: root cannot change the user here\n");
        skip();
    }
    assert_int_equal(outcome.code, done);  // reading is allowed
    for (const std::string &db : {work("closed/p.db"), work("closed/new.db")}) {
        const Words words = build_quick(outputs + Words{"--db", db});
        assert_refusal(words, run_child(words, become_nobody), store_failed, {db}, before);
    }
    const Words remove = {"profile", "remove", "1", "--db", work("closed/p.db")};
    assert_refusal(remove, run_child(remove, become_nobody), store_failed, {work("closed/p.db")}, before);
    const Words apply = {"apply",        "--profile",        "1", "--db", work("closed/p.db"), "-o",
                         work("closed"), scene("img000.png")};
    assert_refusal(apply, run_child(apply, become_nobody), failed, {work("closed/img000.png")}, before);
    const Words pto = build_quick({"--no-store", "--write", "pto=" + work("closed/left.pto")});
    assert_refusal(pto, run_child(pto, become_nobody), failed, {work("closed/left.pto")}, before);
}

void test_unreadable_inputs(void **) {
    make_read_only();
    const std::string copy = copy_of("scene", "open/copy");
    fs::permissions(copy + "/img001.png", fs::perms(0));
    Disk before = disk();
    const Words build = Words{"build", copy + "/pano.pto", "--no-store"} + quick;
    Outcome outcome = run_child(build, become_nobody);
    if (outcome.code == 254) skip();
    assert_refusal(build, outcome, unreadable, {copy + "/img001.png"}, before);
    fs::permissions(copy + "/pano.pto", fs::perms(0));
    before = disk();  // unless root, unreadable files are empty here
    assert_refusal(build, run_child(build, become_nobody), unreadable, {copy + "/pano.pto"}, before);
    fs::permissions(copy + "/pano.pto", fs::perms(0644));
    fs::permissions(copy + "/img001.png", fs::perms(0644));
    fs::permissions(work("closed/p.db"), fs::perms(0));
    before = disk();
    const Words query = {"query", "--camera", "x", "--db", work("closed/p.db")};
    assert_refusal(query, run_child(query, become_nobody), store_failed, {work("closed/p.db")}, before);
}

// Teardown: only root could empty the folder otherwise.
int open_again(void **) {
    std::error_code none;
    fs::permissions(work("closed"), fs::perms(0755), none);
    return 0;
}

// A full disk: no file may grow beyond a limit.

std::function<void()> with_limit(rlim_t bytes) {
    return [bytes] {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit limit = {bytes, bytes};
        if (setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(254);
    };
}

void assert_refused_when_full(rlim_t bytes, const Words &words, int code, const std::string &named) {
    const Disk before = disk();
    const Outcome outcome = run_child(words, with_limit(bytes));
    assert_refusal(words, outcome, code, {named}, before);
}

void test_full_disk(void **) {
    must_exit(done, build_quick({"--db", work("p.db")}));
    assert_true(load(work("p.db")).size() > 20000);
    for (rlim_t bytes : {0, 512, 8192, 20000})
        assert_refused_when_full(bytes, build_quick({"--db", work("p.db")}), store_failed, work("p.db"));
    assert_refused_when_full(512, {"profile", "remove", "1", "--db", work("p.db")}, store_failed, work("p.db"));
    // There is room for the project, but not for the database: neither is created.
    assert_refused_when_full(20000, build_quick({"--db", work("p.db"), "--write", "pto=" + work("left.pto")}),
                             store_failed, work("p.db"));
    assert_refused_when_full(20000, build_quick({"--no-store", "--write", "points=" + work("left.txt")}), failed,
                             work("left.txt"));
    // There is room for the index of the database's log, 32 KiB.
    assert_refused_when_full(40000, build_quick({"--db", work("p.db"), "--write", "points=" + work("left.txt")}),
                             failed, work("left.txt"));
    assert_refused_when_full(100, build_quick({"--no-store", "--write", "pto=" + work("left.pto")}), failed,
                             work("left.pto"));
    assert_refused_when_full(20000,
                             {"apply", "--profile", "1", "--db", work("p.db"), "-o", work(""), scene("img000.png")},
                             failed, work("img000.png"));
    assert_refused_when_full(100, {"simulate", "-o", work(""), "--images", "2", "--size", "80x60"}, failed,
                             work("img00"));
    must_exit(done, build_quick({"--db", work("p.db")}));
    assert_int_equal(json_of({"profile", "list", "--json", "--db", work("p.db")})["profiles"].size(), 2);
}

void test_full_disk_for_a_new_database(void **) {
    for (rlim_t bytes : {0, 512, 8192, 20000})
        assert_refused_when_full(bytes, build_quick({"--db", work("new.db")}), store_failed, work("new.db"));
    save_text(work("lens.xml"), lensfun_text("50mm", {{50, 2, -0.4}}));
    for (rlim_t bytes : {512, 8192, 40000})  // the last is enough for the tables
        assert_refused_when_full(bytes, {"profile", "import", work("lens.xml"), "--db", work("new.db")}, store_failed,
                                 work("new.db"));
}

// The program itself, as a process.

using program_runs::Child;

Child start(const Words &words) {
    return program_runs::start_program(words, [] { signal(SIGINT, SIG_DFL); });
}

// Reads the child's output until `word` appears, or to the end if word is empty. False after a minute.
bool listen_for(Child &child, const std::string &word) {
    char buffer[4096];
    while (word.empty() || !contains(child.said, word)) {
        pollfd waiting = {child.err, POLLIN, 0};
        if (poll(&waiting, 1, 60000) != 1) return false;
        const ssize_t got = read(child.err, buffer, sizeof buffer);
        if (got <= 0) return word.empty();
        child.said.append(buffer, size_t(got));
    }
    return true;
}

int end_of(Child &child) {
    const bool quiet = listen_for(child, "");
    if (!quiet) kill(child.id, SIGKILL);
    close(child.err);
    int status = 0;
    waitpid(child.id, &status, 0);
    return !quiet ? -1 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

// Interrupts a command when it reports `stage`. Returns the seconds until it ended.
double interrupt_at(const std::string &stage, const Words &words, int number = SIGINT) {
    Child child = start(words);
    if (!listen_for(child, stage)) {
        kill(child.id, SIGKILL);
        fail_msg("%s: did not get to %s: %s", joined(words).c_str(), stage.c_str(), child.said.c_str());
    }
    timespec before, after;
    clock_gettime(CLOCK_MONOTONIC, &before);
    kill(child.id, number);
    const int code = end_of(child);
    clock_gettime(CLOCK_MONOTONIC, &after);
    if (code != stopped)
        fail_msg("%s: interrupted at %s: exit code %d: %s", joined(words).c_str(), stage.c_str(), code,
                 child.said.c_str());
    return double(after.tv_sec - before.tv_sec) + 1e-9 * double(after.tv_nsec - before.tv_nsec);
}

// About 15000 pairs: seconds of fitting.
std::string make_many_points() {
    must_exit(done,
              {"simulate", "-o", work("many"), "--set", "no-images=yes", "--images", "6", "--set", "points=15000"});
    return work("many/pano.pto");
}

void test_interrupted_build(void **) {
    const std::string pto = make_many_points();
    must_exit(done, build_quick({"--db", work("p.db")}));
    for (const std::string &db : {work("p.db"), work("new.db")})
        for (int number : {SIGINT, SIGTERM}) {
            const Disk before = disk();
            const double seconds = interrupt_at(
                "fitting",
                {"build", pto, "--points", work("many/points.txt"), "--camera", "X", "--db", db, "--fit", "modes=25",
                 "--progress", "--write", "pto=" + work("left.pto"), "--write", "points=" + work("left.txt")},
                number);
            const std::string changes = difference(before, disk());
            if (!changes.empty()) fail_msg("after the interrupt:%s", changes.c_str());
            if (seconds > 5) fail_msg("it took %.1f s to stop", seconds);
        }
}

// More pictures than can be read, sampled and fitted before the signal arrives, and more pairs than these pictures
// have.
void test_interrupted_with_pictures(void **) {
    must_exit(done, {"simulate", "-o", work("many"), "--images", "12", "--size", "320x240"});
    const Disk before = disk();
    for (const std::string stage : {"reading pictures", "sampling"}) {
        const double seconds =
            interrupt_at(stage, {"build", work("many/pano.pto"), "--db", work("p.db"), "--progress", "--fit",
                                 std::string("pairs=") + (stage == "sampling" ? "1000000" : "20000"), "--write",
                                 "pto=" + work("left.pto"), "--write", "points=" + work("left.txt")});
        const std::string changes = difference(before, disk());
        if (!changes.empty()) fail_msg("after the interrupt:%s", changes.c_str());
        if (seconds > 5) fail_msg("%s: it took %.1f s to stop", stage.c_str(), seconds);
    }
}

// Existing pictures are complete and have their final name.
void assert_complete_pictures(const std::string &place, size_t fewer_than) {
    size_t count = 0;
    for (const fs::directory_entry &entry : fs::directory_iterator(place)) {
        assert_false(entry.path().filename().string()[0] == '.');
        assert_int_equal(read_picture(entry.path().string()).height, 400);
        ++count;
    }
    assert_true(count < fewer_than);
}

void test_interrupted_apply(void **) {
    must_exit(done, build_quick({"--db", work("p.db")}));
    must_exit(done, {"simulate", "-o", work("one"), "--images", "2", "--size", "500x400"});
    fs::create_directory(work("many"));
    Words files;
    for (int i = 0; i < 60; ++i) {
        files.push_back(work("many/" + std::to_string(i) + ".png"));
        fs::copy(work("one/img000.png"), files.back());
    }
    for (const char *threads : {"1", "2", "5"}) {
        fs::remove_all(work("out"));
        const Words words = {"apply", "--profile", "1", "--db", work("p.db"), "--progress", "-o", work("out")};
        const double seconds = interrupt_at("correcting", words + Words{"--threads", threads} + files);
        assert_complete_pictures(work("out"), 60);
        assert_true(seconds < 2);
    }
}

// During a picture, on one thread and with one more that encodes.
void test_interrupted_in_a_picture(void **) {
    must_exit(done, build_quick({"--db", work("p.db")}));
    for (const char *name : {"a.png", "a.tif", "a.jpg"}) {
        write_picture(work(name), make_noise(3000, 2000, LENSPROF_SAMPLE_U8, LENSPROF_LAYOUT_RGB));
        for (const char *threads : {"1", "2"}) {
            const Disk before = disk();
            const Words words = {"apply", "--profile", "1", "--db", work("p.db"), "--progress", "-o", work("out")};
            const double seconds = interrupt_at("correcting 1", words + Words{"--threads", threads, work(name)});
            fs::remove(work("out"));
            const std::string changes = difference(before, disk());
            if (!changes.empty()) fail_msg("after the interrupt:%s", changes.c_str());
            assert_true(seconds < 2);
        }
        fs::remove(work(name));
    }
}

// Without a terminal, simulate prints nothing: the first picture shows that it is at work.
void test_interrupted_simulate(void **) {
    Child child = start({"simulate", "-o", work("out"), "--images", "60", "--size", "500x400"});
    for (int wait = 0; wait < 6000 && !fs::exists(work("out/img000.png")); ++wait) usleep(10000);
    kill(child.id, SIGINT);
    assert_int_equal(end_of(child), stopped);
    assert_true(contains(child.said, "interrupted"));
    assert_complete_pictures(work("out"), 60);
}

void test_full_standard_output(void **) {
    if (access("/dev/full", W_OK) != 0) skip();
    const pid_t child = fork();
    if (child == 0) {
        dup2(open("/dev/full", O_WRONLY), 1);
        dup2(open("/dev/null", O_WRONLY), 2);
        execl(LENSPROF_PROGRAM, LENSPROF_PROGRAM, "version", nullptr);
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), failed);
}

// `ulimit -f`: the system's signal does not end the process.
void test_file_size_limit(void **) {
    const pid_t child = fork();
    if (child == 0) {
        const rlimit limit = {100, 100};
        setrlimit(RLIMIT_FSIZE, &limit);
        signal(SIGXFSZ, SIG_DFL);
        dup2(open("/dev/null", O_WRONLY), 2);
        execl(LENSPROF_PROGRAM, LENSPROF_PROGRAM, "simulate", "-o", work("limited").c_str(), "--images", "2", "--size",
              "80x60", nullptr);
        _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), failed);
    assert_true(fs::is_empty(work("limited")));
}

void test_program_is_the_function(void **) {
    for (const Words &words :
         {Words{"version"}, Words{"frobnicate"}, Words{"profile", "list", "--db", work("none.db")}}) {
        Child child = start(words);
        const Outcome outcome = run_words(words);
        assert_int_equal(end_of(child), outcome.code);
        assert_string_equal(child.said.c_str(), outcome.err.c_str());
    }
}

}  // namespace

int main() {
    const CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_read_only_database, empty_work, open_again),
        cmocka_unit_test_setup_teardown(test_unreadable_inputs, empty_work, open_again),
        CLI_TEST(test_full_disk),
        CLI_TEST(test_full_disk_for_a_new_database),
        CLI_TEST(test_interrupted_build),
        CLI_TEST(test_interrupted_with_pictures),
        CLI_TEST(test_interrupted_apply),
        CLI_TEST(test_interrupted_in_a_picture),
        CLI_TEST(test_interrupted_simulate),
        CLI_TEST(test_full_standard_output),
        CLI_TEST(test_file_size_limit),
        CLI_TEST(test_program_is_the_function),
    };
    return cmocka_run_group_tests(tests, make_scene, remove_folder);
}
