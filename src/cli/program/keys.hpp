// An option of KEY=VALUE pairs, such as --fit loss=huber,seed=3: repeatable and separated by commas. Help, pages and
// errors are made of its one table of keys.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "cli/program/declarations.hpp"

namespace lensprof {

struct KeyTable {
    struct Key {
        std::string name, type, about;
        Declarations::Read read;
    };
    std::string option;  // "--fit"
    std::string intro;   // what the keys are about
    std::string help;    // the command that prints the table
    std::vector<Key> keys;
    std::map<std::string, std::string> renamed{};  // keys that are options now
    std::set<std::string> given{};                 // keys of this command line

    const Key *find(const std::string &name) const;
    std::vector<std::string> names() const;

    // The intro with all names, and a line per key.
    std::string about() const;

    // Sets the values of a word; text after a comma without "=" belongs to the value before. Failure (usage).
    void read(const std::string &word);

private:
    void set(const std::string &pair);
};

// Declares the keys of an option of a command.
class Keys : public Declarations {
public:
    // `describe` receives the description of the option whenever it grows.
    Keys(std::shared_ptr<KeyTable> table, std::function<void(const std::string &)> describe)
        : table_(std::move(table)), describe_(std::move(describe)) {}

    void word(const char *name, const std::string &type, const Read &read, const std::string &about) override;
    void flag(const char *name, bool &value, const std::string &about) override;  // yes or no

    // A key of an earlier version that is an option now: it is refused, and the option is named.
    void renamed(const char *name, const char *option) { table_->renamed[name] = option; }

private:
    std::shared_ptr<KeyTable> table_;
    std::function<void(const std::string &)> describe_;
};

}  // namespace lensprof
