#include "formats/text/rdf.hpp"

#include "formats/text/xml.hpp"

namespace lensprof {
namespace {

constexpr int kMaxLevels = 64;

}  // namespace

std::string_view local_name(std::string_view qualified) {
    const size_t colon = qualified.rfind(':');
    return colon == std::string_view::npos ? qualified : qualified.substr(colon + 1);
}

std::string_view namespace_of(const pugi::xml_node &node, std::string_view qualified) {
    const size_t colon = qualified.rfind(':');
    const std::string declaration =
        colon == std::string_view::npos ? "xmlns" : "xmlns:" + std::string(qualified.substr(0, colon));
    pugi::xml_node ancestor = node;
    for (int level = 0; ancestor && level < kMaxLevels; level++, ancestor = ancestor.parent())
        if (const pugi::xml_attribute found = ancestor.attribute(declaration.c_str())) return found.value();
    return {};
}

pugi::xml_node local_child(const pugi::xml_node &parent, std::string_view name) {
    for (pugi::xml_node child : parent.children())
        if (local_name(child.name()) == name) return child;
    return {};
}

std::vector<pugi::xml_node> rdf_items(const pugi::xml_node &node) {
    std::vector<pugi::xml_node> items;
    for (pugi::xml_node list : node.children()) {
        const std::string_view kind = local_name(list.name());
        if (kind != "Seq" && kind != "Bag" && kind != "Alt") continue;
        for (pugi::xml_node item : list.children())
            if (local_name(item.name()) == "li") items.push_back(item);
        break;
    }
    return items;
}

pugi::xml_node RdfResource::property(std::string_view name) const {
    if (const pugi::xml_node child = local_child(node_, name)) return child;
    return local_child(local_child(node_, "Description"), name);
}

std::string RdfResource::text(std::string_view name) const {
    for (const pugi::xml_node &holder : {node_, local_child(node_, "Description")})
        for (const pugi::xml_attribute &attribute : holder.attributes())
            if (local_name(attribute.name()) == name) return one_line(attribute.value());
    return one_line(property(name).child_value());
}

RdfResource RdfResource::resource(std::string_view name) const { return RdfResource(property(name)); }

std::vector<std::string> RdfResource::items(std::string_view name) const {
    std::vector<std::string> texts;
    for (const pugi::xml_node &item : rdf_items(property(name))) texts.push_back(one_line(item.child_value()));
    return texts;
}

}  // namespace lensprof
