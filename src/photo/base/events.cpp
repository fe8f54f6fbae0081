#include "photo/base/events.hpp"

#include "photo/base/failure.hpp"

namespace lensprof {
namespace {

thread_local Events *events_of_thread = nullptr;
Events unheard;

}  // namespace

void Events::update(const std::string &, double, const std::string &) {}
void Events::clear() {}
void Events::finish(const std::string &) {}
void Events::update_items(const std::string &step, uint32_t done, uint32_t count) {
    update(step, count ? double(done) / count : 1.0);
}
void Events::notice(uint32_t, const std::string &, const std::string &) {}
bool Events::is_cancelled() { return false; }
std::string Events::advice(const std::string &) { return {}; }
std::string Events::option_name(const std::string &name) { return "`" + name + "`"; }

void ForwardedEvents::update(const std::string &step, double fraction, const std::string &detail) {
    to_.update(step, fraction, detail);
}
void ForwardedEvents::clear() { to_.clear(); }
void ForwardedEvents::finish(const std::string &summary) { to_.finish(summary); }
void ForwardedEvents::update_items(const std::string &step, uint32_t done, uint32_t count) {
    to_.update_items(step, done, count);
}
void ForwardedEvents::notice(uint32_t severity, const std::string &item, const std::string &text) {
    to_.notice(severity, item, text);
}
bool ForwardedEvents::is_cancelled() { return to_.is_cancelled(); }
std::string ForwardedEvents::option_name(const std::string &name) { return to_.option_name(name); }
std::string ForwardedEvents::advice(const std::string &situation) { return to_.advice(situation); }

CallerScope::CallerScope(Events *events) : before_(events_of_thread) { events_of_thread = events; }
CallerScope::~CallerScope() { events_of_thread = before_; }
Events *CallerScope::of_thread() { return events_of_thread; }

std::string option_name(const std::string &name) {
    return (events_of_thread ? *events_of_thread : unheard).option_name(name);
}

std::string advice(const std::string &situation) {
    return (events_of_thread ? *events_of_thread : unheard).advice(situation);
}

bool is_cancelled() { return events_of_thread && events_of_thread->is_cancelled(); }

void stop_if_cancelled() {
    if (is_cancelled()) throw Failure(LENSPROF_ERROR_CANCELLED, "interrupted");
}

}  // namespace lensprof
