// What the caller of a long task learns while it runs, and the caller's way to end it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <lensprof/reason.h>

namespace lensprof {

// Threads: all methods may be called by any thread.
class Events {
public:
    virtual ~Events() = default;

    // A step, the share of it that is done, and details of the state.
    virtual void update(const std::string &step, double fraction, const std::string &detail = {});
    virtual void clear();                             // the step has ended
    virtual void finish(const std::string &summary);  // the same, with its numbers

    // The same for items of equal size.
    virtual void update_items(const std::string &step, uint32_t done, uint32_t count);

    // A message about the input `item`; `severity` is LENSPROF_SEVERITY_WARNING or _NOTE.
    virtual void notice(uint32_t severity, const std::string &item, const std::string &text);
    void warn(const std::string &item, const std::string &text) { notice(LENSPROF_SEVERITY_WARNING, item, text); }
    void note(const std::string &item, const std::string &text) { notice(LENSPROF_SEVERITY_NOTE, item, text); }

    virtual bool is_cancelled();

    // What the caller calls an option in messages; here its name in quotes. `name` is that of the library.
    virtual std::string option_name(const std::string &name);

    // What the caller can do in a situation, as the rest of a sentence; nothing by default.
    virtual std::string advice(const std::string &situation);
};

// Passes everything on; a derived class changes a part.
class ForwardedEvents : public Events {
public:
    explicit ForwardedEvents(Events &to) : to_(to) {}

    void update(const std::string &step, double fraction, const std::string &detail) override;
    void clear() override;
    void finish(const std::string &summary) override;
    void update_items(const std::string &step, uint32_t done, uint32_t count) override;
    void notice(uint32_t severity, const std::string &item, const std::string &text) override;
    bool is_cancelled() override;
    std::string option_name(const std::string &name) override;
    std::string advice(const std::string &situation) override;

private:
    Events &to_;
};

struct Notice {
    uint32_t severity;
    std::string item, text;

    std::string line() const { return item.empty() ? text : item + ": " + text; }
};

// Keeps notices instead of passing them on.
struct NoticeList : Events {
    void notice(uint32_t severity, const std::string &item, const std::string &text) override {
        list.push_back({severity, item, text});
    }
    std::vector<Notice> list;
};

// While this object lives, `events` can end what runs on this thread, and names the options in its failures. The most
// recent object counts.
class CallerScope {
public:
    explicit CallerScope(Events *events);
    ~CallerScope();
    CallerScope(const CallerScope &) = delete;
    CallerScope &operator=(const CallerScope &) = delete;

    static Events *of_thread();  // for other threads that take part; may be NULL

private:
    Events *const before_;
};

// By the caller of this thread.
std::string option_name(const std::string &name);
std::string advice(const std::string &situation);
bool is_cancelled();

// Throws Failure (CANCELLED) if the caller wants the task to end.
void stop_if_cancelled();

}  // namespace lensprof
