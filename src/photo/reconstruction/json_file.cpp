#include "photo/reconstruction/json_file.hpp"

#include <charconv>
#include <cmath>

#include "photo/base/failure.hpp"
#include "photo/base/input_file.hpp"

namespace lensprof {

SceneJson read_json_file(const std::string &path) {
    constexpr uint64_t most_bytes = uint64_t(2) << 30;
    try {
        return SceneJson::parse(read_text(path, most_bytes));
    } catch (const SceneJson::parse_error &error) {
        throw Failure(LENSPROF_ERROR_READ,
                      path + ": not valid JSON at byte " + std::to_string(error.byte) + "; give an intact file");
    } catch (const SceneJson::exception &) {
        throw Failure(LENSPROF_ERROR_READ, path + ": has a number that is too large; give an intact file");
    }
}

double real_of(const SceneJson &value) {
    if (value.is_number()) return value.get<double>();
    if (!value.is_string()) return NAN;
    const auto &text = value.get_ref<const std::string &>();
    double number = NAN;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? number : NAN;
}

int64_t whole_at(const SceneJson &object, const char *name) {
    if (!object.is_object() || !object.contains(name)) return -1;
    const double number = real_of(object[name]);
    return number >= 0.0 && number < 9e15 && number == std::floor(number) ? static_cast<int64_t>(number) : -1;
}

std::string text_at(const SceneJson &object, const char *name) {
    if (!object.is_object() || !object.contains(name)) return {};
    const SceneJson &value = object[name];
    if (value.is_string()) return value.get<std::string>();
    return value.is_number_integer() ? value.dump() : std::string();
}

std::array<double, 3> vector_at(const SceneJson &object, const char *name) {
    std::array<double, 3> vector = {NAN, NAN, NAN};
    const SceneJson &list = list_at(object, name);
    for (size_t d = 0; d < vector.size() && d < list.size(); d++) vector[d] = real_of(list[d]);
    return vector;
}

const SceneJson &object_at(const SceneJson &object, const char *name) {
    static const SceneJson empty = SceneJson::object();
    return object.is_object() && object.contains(name) && object[name].is_object() ? object[name] : empty;
}

const SceneJson &list_at(const SceneJson &object, const char *name) {
    static const SceneJson empty = SceneJson::array();
    return object.is_object() && object.contains(name) && object[name].is_array() ? object[name] : empty;
}

}  // namespace lensprof
