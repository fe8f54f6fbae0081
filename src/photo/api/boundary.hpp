// Where exceptions end, and the caller's events begin.
#pragma once

#include <atomic>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <vector>

#include <lensprof/photo.h>

#include "photo/base/events.hpp"
#include "photo/base/failure.hpp"
#include "photo/scene/scene.hpp"

namespace lensprof {

// Calls the caller's functions, one at a time. After progress has asked to stop, is_cancelled is true.
class CallerEvents : public Events {
public:
    CallerEvents() { lensprof_events_init(&events_); }

    // From now on `events`, or none.
    void set(const lensprof_events *events);

    void update(const std::string &step, double fraction, const std::string &detail) override;
    void notice(uint32_t severity, const std::string &item, const std::string &text) override;
    bool is_cancelled() override { return is_cancelled_; }

private:
    lensprof_events events_;
    std::mutex mutex_;
    std::atomic<bool> is_cancelled_{false};
};

// Fills the caller's error (may be NULL); a text that is too long loses the folders of its file first.
lensprof_status report_failure(lensprof_status status, const std::string &text, lensprof_error *error);

// Runs a function of the C interface with these events.
template <class Call>
lensprof_status photo_call(const char *what, Events &events, lensprof_error *error, Call call) {
    const CallerScope caller(&events);
    try {
        call();
        if (error) *error = lensprof_error{};
        return LENSPROF_OK;
    } catch (const Failure &failure) {
        return report_failure(failure.status, failure.what(), error);
    } catch (const std::bad_alloc &) {
        return report_failure(LENSPROF_ERROR_MEMORY, std::string(what) + ": out of memory", error);
    } catch (const std::exception &e) {
        return report_failure(LENSPROF_ERROR_INTERNAL, std::string(what) + ": " + e.what(), error);
    }
}

// The same without events.
template <class Call>
lensprof_status photo_call(const char *what, lensprof_error *error, Call call) {
    Events none;
    return photo_call(what, none, error, call);
}

// Bytes as base.h has it: with capacity 0 only their number; Failure (CAPACITY) for a buffer that is too small.
void give_bytes(const void *bytes, size_t size, void *buffer, size_t capacity, size_t *count);

// Failure (ARGUMENT) for NULL.
void require(const void *pointer, const char *what);
void require_index(uint32_t index, size_t count, const char *what);

// The paths of databases in options. Failure (ARGUMENT) for NULL.
template <class Options>
std::vector<std::string> databases_of(const Options &options) {
    std::vector<std::string> databases;
    for (uint32_t i = 0; i < options.database_count; i++) {
        require(options.databases, "databases"), require(options.databases[i], "database");
        databases.emplace_back(options.databases[i]);
    }
    return databases;
}

// Failure (ARGUMENT) for a path of one of the scene's own files, of which `what` would be written.
void refuse_own_file(const std::string &path, const char *what, const Scene &scene);

}  // namespace lensprof
