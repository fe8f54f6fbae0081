#include "photo/folder/noted_scene.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace lensprof {
namespace {

// A flat array of numbers: whole ones, and others.
class Writer {
public:
    explicit Writer(Json &list) : list_(list) { list_ = Json::array(); }
    void whole(uint32_t &number) { list_.push_back(number); }
    void real(double &number, double steps) {
        list_.push_back(steps > 0.0 ? std::round(steps * number) / steps : number);
    }

private:
    Json &list_;
};

class Reader {
public:
    explicit Reader(const Json &list) : next_(list.begin()) {}
    void whole(uint32_t &number) {
        if (is_valid_ &= next_->is_number_unsigned() && next_->get<uint64_t>() <= UINT32_MAX) next_->get_to(number);
        ++next_;
    }
    void real(double &number, double) {
        if (is_valid_ &= next_->is_number()) next_->get_to(number);
        ++next_;
    }
    bool is_valid() const { return is_valid_; }

private:
    Json::const_iterator next_;
    bool is_valid_ = true;
};

constexpr double exact = 0.0;

template <class Numbers>
void visit(Numbers &numbers, lensprof_camera &camera) {
    for (uint32_t *number : {&camera.projection, &camera.width, &camera.height}) numbers.whole(*number);
    for (double *number : {&camera.hfov_deg, &camera.yaw_deg, &camera.pitch_deg, &camera.roll_deg})
        numbers.real(*number, exact);
    for (double &number : camera.radial) numbers.real(number, exact);
    for (double &number : camera.shift_px) numbers.real(number, exact);
    for (double &number : camera.shear_px) numbers.real(number, exact);
    for (double &number : camera.translation) numbers.real(number, exact);
    for (double &number : camera.plane_deg) numbers.real(number, exact);
}

template <class Numbers>
void visit(Numbers &numbers, uint32_t &number) {
    numbers.whole(number);
}

template <class Numbers>
void visit(Numbers &numbers, ControlPoint &point) {
    for (uint32_t &image : point.image) numbers.whole(image);
    for (auto &xy : point.xy)
        for (double &coordinate : xy) numbers.real(coordinate, 1e3);
}

template <class Numbers>
void visit(Numbers &numbers, lensprof_match &match) {
    for (uint32_t &image : match.image) numbers.whole(image);
    for (auto &xy : match.xy)
        for (double &coordinate : xy) numbers.real(coordinate, 100.0);
    for (auto &row : match.map)
        for (double &coefficient : row) numbers.real(coefficient, 1e4);
}

template <class Item>
Json json_of_items(std::vector<Item> items) {
    Json list;
    Writer writer(list);
    for (Item &item : items) visit(writer, item);
    return list;
}

template <class Item>
bool read_items(const Json &json, const char *name, std::vector<Item> &items) {
    Json one;
    Writer counter(one);
    Item item{};
    visit(counter, item);
    const auto list = json.find(name);
    if (list == json.end() || !list->is_array() || list->size() % one.size()) return false;
    items.assign(list->size() / one.size(), Item{});
    Reader reader(*list);
    for (Item &next : items) visit(reader, next);
    return reader.is_valid();
}

bool are_valid(const FoundScene &found, size_t pictures) {
    const auto is_between_pictures = [&](const auto &item) {
        return item.image[0] < pictures && item.image[1] < pictures;
    };
    return found.cameras.size() == pictures && found.lenses.size() == pictures && found.camera_ids.size() == pictures
           && std::all_of(found.cameras.begin(), found.cameras.end(),
                          [](const auto &camera) { return lensprof_camera_validate(&camera) == LENSPROF_OK; })
           && std::all_of(found.points.begin(), found.points.end(), is_between_pictures)
           && std::all_of(found.matches.begin(), found.matches.end(), is_between_pictures);
}

}  // namespace

Json json_of(const FoundScene &found) {
    return {{"cameras", json_of_items(found.cameras)}, {"camera_ids", json_of_items(found.camera_ids)},
            {"lenses", json_of_items(found.lenses)},   {"points", json_of_items(found.points)},
            {"matches", json_of_items(found.matches)}, {"by_matches", found.by_matches}};
}

bool read_noted(const Json &json, size_t pictures, FoundScene &found) {
    if (!json.is_object() || !json.contains("by_matches") || !json["by_matches"].is_boolean()) return false;
    found.by_matches = json["by_matches"].get<bool>();
    return read_items(json, "cameras", found.cameras) && read_items(json, "camera_ids", found.camera_ids)
           && read_items(json, "lenses", found.lenses) && read_items(json, "points", found.points)
           && read_items(json, "matches", found.matches) && are_valid(found, pictures);
}

}  // namespace lensprof
