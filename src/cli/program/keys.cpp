#include "cli/program/keys.hpp"

#include <algorithm>
#include <stdexcept>

#include "photo/base/failure.hpp"
#include "photo/base/format.hpp"
#include "photo/base/nearest.hpp"

namespace lensprof {

const KeyTable::Key *KeyTable::find(const std::string &name) const {
    const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key &key) { return key.name == name; });
    return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> KeyTable::names() const {
    std::vector<std::string> all;
    for (const Key &key : keys) all.push_back(key.name);
    return all;
}

std::string KeyTable::about() const {
    std::string text = intro + ": " + joined(names(), ", ");
    for (const Key &key : keys) text += "\n" + key.name + "=" + key.type + ": " + key.about;
    return text;
}

void KeyTable::read(const std::string &word) {
    std::vector<std::string> pairs;
    for (std::string part : split(word)) {
        if (pairs.empty() && part.empty() && !word.empty())
            throw Failure(LENSPROF_ERROR_ARGUMENT,
                          option + ": a pair is missing before or after a comma in '" + word + "'");
        if (part.find('=') != std::string::npos) part.erase(0, part.find_first_not_of(' '));
        if (pairs.empty() || part.find('=') != std::string::npos)
            pairs.push_back(part);
        else
            pairs.back() += "," + part;
    }
    for (const std::string &pair : pairs) set(pair);
}

void KeyTable::set(const std::string &pair) {
    const size_t equal = pair.find('=');
    const std::string name = pair.substr(0, equal), key_name = option + " " + name;
    const Key *key = find(name);
    if (const auto now = renamed.find(name); now != renamed.end())
        throw Failure(LENSPROF_ERROR_ARGUMENT, key_name + " is now " + now->second + "; `" + help + "` explains it");
    if (!key) {
        const std::string nearest = did_you_mean(name, names());
        throw Failure(LENSPROF_ERROR_ARGUMENT, option + ": " + (name.empty() ? "''" : name) + " is not a key" + nearest
                                                   + (nearest.empty() ? "; keys: " : " Keys: ") + joined(names(), ", ")
                                                   + "; `" + help + "` explains them");
    }
    if (equal == std::string::npos)
        throw Failure(LENSPROF_ERROR_ARGUMENT, key_name + ": needs a value; give " + key_name + "=" + key->type);
    if (!given.insert(name).second)
        throw Failure(LENSPROF_ERROR_ARGUMENT, key_name + ": given more than once; give it once");
    const std::string value = pair.substr(equal + 1);
    try {
        if (value.empty()) throw std::invalid_argument("empty value; give " + key->type + ", or omit the key");
        key->read(value);
    } catch (const std::invalid_argument &error) {
        throw Failure(LENSPROF_ERROR_ARGUMENT, key_name + ": " + error.what());
    }
}

void Keys::word(const char *name, const std::string &type, const Read &read, const std::string &about) {
    table_->keys.push_back({name, type, about, read});
    describe_(table_->about());
}

void Keys::flag(const char *name, bool &value, const std::string &about) {
    choice<bool>(name, value, {{"yes", true}, {"no", false}}, about + "; default no");
}

}  // namespace lensprof
