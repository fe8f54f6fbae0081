#include "photo/pictures/xmp_packet.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <sstream>

namespace lensprof {

namespace {

constexpr char rdf[] = "http://www.w3.org/1999/02/22-rdf-syntax-ns#";
constexpr size_t max_packet_bytes = size_t(16) << 20;
constexpr int max_depth = 64;

std::string prefix_of(const char *name) {
    const char *colon = std::strchr(name, ':');
    return colon ? std::string(name, colon) : std::string();
}

std::string local_name(const char *name) {
    const char *colon = std::strchr(name, ':');
    return colon ? colon + 1 : name;
}

bool is_declaration(const pugi::xml_attribute &attribute) {
    return prefix_of(attribute.name()) == "xmlns" || std::strcmp(attribute.name(), "xmlns") == 0;
}

// What a prefix means at an element.
std::string namespace_at(pugi::xml_node node, const std::string &prefix) {
    const std::string declaration = prefix.empty() ? "xmlns" : "xmlns:" + prefix;
    for (; node; node = node.parent())
        if (const pugi::xml_attribute found = node.attribute(declaration.c_str())) return found.value();
    return {};
}

bool is_rdf(const pugi::xml_node &node, const char *name) {
    return local_name(node.name()) == name && namespace_at(node, prefix_of(node.name())) == rdf;
}

// With ">" in values of attributes escaped, which XML permits there but some readers take for the end of the element.
std::string escaped(const std::string &text) {
    std::string all;
    bool in_tag = false, in_value = false;  // pugixml writes values in double quotes and escapes these in them
    for (size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (!in_tag && text.compare(at, 9, "<![CDATA[") == 0) {
            const size_t end = text.find("]]>", at) + 3;
            all.append(text, at, end - at);
            at = end - 1;
            continue;
        }
        if (in_tag && c == '"') in_value = !in_value;
        if (!in_value && (c == '<' || c == '>')) in_tag = c == '<';
        all += in_value && c == '>' ? "&gt;" : std::string(1, c);
    }
    return all;
}

struct DepthCheck : pugi::xml_tree_walker {
    bool for_each(pugi::xml_node &) override { return depth() < max_depth; }
};

struct UsedPrefixes : pugi::xml_tree_walker {
    bool for_each(pugi::xml_node &node) override {
        prefixes.insert(prefix_of(node.name()));
        for (const pugi::xml_attribute &attribute : node.attributes()) prefixes.insert(prefix_of(attribute.name()));
        return true;
    }

    std::set<std::string> prefixes;
};

struct RemoveDeclarations : pugi::xml_tree_walker {
    explicit RemoveDeclarations(const std::set<std::string> &all) : used(all) {}

    bool for_each(pugi::xml_node &node) override {
        for (pugi::xml_attribute attribute = node.first_attribute(); attribute;) {
            const pugi::xml_attribute next = attribute.next_attribute();
            if (prefix_of(attribute.name()) == "xmlns" && !used.count(local_name(attribute.name())))
                node.remove_attribute(attribute);
            attribute = next;
        }
        return true;
    }

    const std::set<std::string> &used;
};

}  // namespace

Xmp::Xmp(const std::string &packet) {
    DepthCheck check;
    if (packet.empty() || packet.size() > max_packet_bytes
        || !document_.load_buffer(packet.data(), packet.size(), pugi::parse_default) || !document_.traverse(check))
        document_.reset();
}

pugi::xml_node Xmp::descriptions() const {
    for (const pugi::xml_node &top : document_.children()) {
        if (is_rdf(top, "RDF")) return top;
        for (const pugi::xml_node &node : top.children())
            if (is_rdf(node, "RDF")) return node;
    }
    return {};
}

std::vector<Xmp::Property> Xmp::properties() const {
    std::vector<Property> all;
    for (const pugi::xml_node &description : descriptions().children()) {
        if (!is_rdf(description, "Description")) continue;
        for (const pugi::xml_attribute &attribute : description.attributes()) {
            const std::string prefix = prefix_of(attribute.name());
            if (is_declaration(attribute) || prefix.empty()) continue;
            const std::string space = namespace_at(description, prefix);
            if (space != rdf) all.push_back({description, {}, attribute, space, local_name(attribute.name())});
        }
        for (const pugi::xml_node &element : description.children())
            if (element.type() == pugi::node_element)
                all.push_back({description,
                               element,
                               {},
                               namespace_at(element, prefix_of(element.name())),
                               local_name(element.name())});
    }
    return all;
}

std::string Xmp::text(const std::string &space, const std::string &name) const {
    for (const Property &property : properties()) {
        if (property.space != space || property.name != name) continue;
        if (property.attribute) return property.attribute.value();
        pugi::xml_node node = property.element;
        for (int level = 0; level < 2; ++level)  // a list, and its first item
            if (const pugi::xml_node child =
                    node.find_child([](const pugi::xml_node &inner) { return inner.type() == pugi::node_element; }))
                node = child;
        return node.text().get();
    }
    return {};
}

bool Xmp::has(const std::string &space, const std::string &name) const {
    const auto all = properties();
    return std::any_of(all.begin(), all.end(),
                       [&](const Property &property) { return property.space == space && property.name == name; });
}

void Xmp::replace(const std::string &space, const std::string &name, const std::string &value) {
    for (Property &property : properties()) {
        if (property.space != space || property.name != name) continue;
        if (property.attribute)
            property.attribute.set_value(value.c_str());
        else
            property.element.remove_children(), property.element.text().set(value.c_str());
    }
}

void Xmp::remove_if(const std::function<bool(const std::string &, const std::string &)> &is_removed) {
    for (Property &property : properties()) {
        if (!is_removed(property.space, property.name)) continue;
        if (property.attribute)
            property.description.remove_attribute(property.attribute);
        else
            property.description.remove_child(property.element);
    }
    remove_unused_prefixes();
}

void Xmp::remove_unused_prefixes() {
    UsedPrefixes used;
    document_.traverse(used);
    RemoveDeclarations remove(used.prefixes);
    document_.traverse(remove);
}

void Xmp::add(const std::string &space, const std::string &prefix,
              const std::vector<std::pair<std::string, std::string>> &texts) {
    pugi::xml_node all = descriptions();
    if (!all) {
        document_.reset();
        pugi::xml_node top = document_.append_child("x:xmpmeta");
        top.append_attribute("xmlns:x") = "adobe:ns:meta/";
        all = top.append_child("rdf:RDF");
        all.append_attribute("xmlns:rdf") = rdf;
    }
    const std::string rdf_prefix = prefix_of(all.name()), mark = rdf_prefix.empty() ? "" : rdf_prefix + ":";
    const std::string about = all.first_child().attribute((mark + "about").c_str()).value();
    pugi::xml_node description = all.append_child((mark + "Description").c_str());
    description.append_attribute("rdf:about") = about.c_str();
    if (mark != "rdf:") description.append_attribute("xmlns:rdf") = rdf;
    description.append_attribute(("xmlns:" + prefix).c_str()) = space.c_str();
    for (const auto &[name, value] : texts) description.append_attribute((prefix + ":" + name).c_str()) = value.c_str();
}

std::string Xmp::packet() const {
    if (properties().empty()) return {};
    std::ostringstream text;
    document_.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
    return "<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n" + escaped(text.str())
           + "\n<?xpacket end=\"w\"?>";
}

}  // namespace lensprof
