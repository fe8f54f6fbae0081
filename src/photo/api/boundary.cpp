#include "photo/api/boundary.hpp"

#include "photo/api/sized.hpp"
#include "photo/base/output_file.hpp"
#include "photo/base/utf8.hpp"

namespace lensprof {
namespace {

constexpr size_t first_events = LENSPROF_FIRST(lensprof_events, notice);

// Without the folders of a file that begins the text.
std::string without_folders(const std::string &text) {
    const size_t end = text.find(": "), slash = text.rfind('/', end);
    return end == std::string::npos || slash == std::string::npos ? text : text.substr(slash + 1);
}

}  // namespace

void CallerEvents::set(const lensprof_events *events) {
    lensprof_events none;
    lensprof_events_init(&none);
    events_ = taken(events, none, first_events, "events");
    is_cancelled_ = false;
}

void CallerEvents::update(const std::string &step, double fraction, const std::string &detail) {
    if (!events_.progress || is_cancelled_) return;
    std::lock_guard<std::mutex> lock(mutex_);
    if (!is_cancelled_ && events_.progress(step.c_str(), fraction, detail.c_str(), events_.user)) is_cancelled_ = true;
}

void CallerEvents::notice(uint32_t severity, const std::string &item, const std::string &text) {
    if (!events_.notice) return;
    const lensprof_notice notice{severity, 0, item.c_str(), text.c_str()};
    std::lock_guard<std::mutex> lock(mutex_);
    events_.notice(&notice, events_.user);
}

lensprof_status report_failure(lensprof_status status, const std::string &text, lensprof_error *error) {
    if (!error) return status;
    *error = lensprof_error{};
    const std::string shown = text.size() < sizeof error->text ? text : without_folders(text);
    std::memcpy(error->text, shown.data(), utf8_cut(shown, sizeof error->text - 1));
    return status;
}

void give_bytes(const void *bytes, size_t size, void *buffer, size_t capacity, size_t *count) {
    if (count) *count = size;
    if (!capacity) return;
    require(buffer, "buffer");
    if (capacity < size)
        throw Failure(LENSPROF_ERROR_CAPACITY, "buffer: " + std::to_string(capacity) + " bytes are too few; "
                                                   + std::to_string(size) + " are needed");
    if (size) std::memcpy(buffer, bytes, size);
}

void require(const void *pointer, const char *what) {
    if (!pointer) throw Failure(LENSPROF_ERROR_ARGUMENT, std::string(what) + ": is NULL");
}

void require_index(uint32_t index, size_t count, const char *what) {
    if (index >= count)
        throw Failure(LENSPROF_ERROR_ARGUMENT,
                      std::string(what) + " " + std::to_string(index) + ": there are only " + std::to_string(count));
}

void refuse_own_file(const std::string &path, const char *what, const Scene &scene) {
    for (const auto *own : {&scene.files, &scene.sources}) check_not_reserved(path, what, *own);
}

}  // namespace lensprof
