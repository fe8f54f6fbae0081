// Properties of XMP packets: as attributes, as elements, in an rdf:Description within or with rdf:parseType.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

namespace lensprof {

// "Lens" of "stCamera:Lens".
std::string_view local_name(std::string_view qualified);

// The namespace of a name's prefix at its place; empty if it is not declared within 64 levels.
std::string_view namespace_of(const pugi::xml_node &node, std::string_view qualified);

// A resource with properties, which are looked up by their local names: an element with an rdf:Description within, or
// with the properties on itself.
class RdfResource {
public:
    explicit RdfResource(pugi::xml_node node) : node_(node) {}

    explicit operator bool() const { return bool(node_); }
    pugi::xml_node node() const { return node_; }

    // The value of a property without blanks at its ends; empty if it is missing.
    std::string text(std::string_view name) const;

    // The resource that a property is.
    RdfResource resource(std::string_view name) const;

    // The items of a property that is an rdf:Seq, rdf:Bag or rdf:Alt.
    std::vector<std::string> items(std::string_view name) const;

private:
    pugi::xml_node property(std::string_view name) const;

    pugi::xml_node node_;
};

// The first child with this local name.
pugi::xml_node local_child(const pugi::xml_node &parent, std::string_view name);

// Items of an rdf:Seq, rdf:Bag or rdf:Alt within an element.
std::vector<pugi::xml_node> rdf_items(const pugi::xml_node &node);

}  // namespace lensprof
