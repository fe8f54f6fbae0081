// The properties of an XMP packet (ISO 16684-1): of a picture as a whole, with the names and namespaces that they have.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <pugixml.hpp>

namespace lensprof {

namespace xmp_names {

constexpr char adobe_lens[] = "http://ns.adobe.com/exif/1.0/aux/",
               camera_raw[] = "http://ns.adobe.com/camera-raw-settings/1.0/",
               dublin_core[] = "http://purl.org/dc/elements/1.1/", exif[] = "http://ns.adobe.com/exif/1.0/",
               exif_2[] = "http://cipa.jp/exif/1.0/", extension[] = "http://ns.adobe.com/xmp/note/",
               tiff[] = "http://ns.adobe.com/tiff/1.0/", xmp[] = "http://ns.adobe.com/xap/1.0/";

}  // namespace xmp_names

class Xmp {
public:
    // Without properties if the packet is empty, damaged or nested too deeply.
    explicit Xmp(const std::string &packet = "");

    // Of a text, or the first item of a list; empty if missing.
    std::string text(const std::string &space, const std::string &name) const;
    bool has(const std::string &space, const std::string &name) const;

    // Replaces the value of an existing property.
    void replace(const std::string &space, const std::string &name, const std::string &value);

    // Removes properties, with the declarations of namespaces that no property has any more.
    void remove_if(const std::function<bool(const std::string &space, const std::string &name)> &is_removed);

    // Adds texts of a namespace that has no properties.
    void add(const std::string &space, const std::string &prefix,
             const std::vector<std::pair<std::string, std::string>> &texts);

    // Empty without properties.
    std::string packet() const;

private:
    struct Property {
        pugi::xml_node description, element;
        pugi::xml_attribute attribute;  // instead of an element
        std::string space, name;
    };

    pugi::xml_node descriptions() const;  // the element rdf:RDF; empty if missing
    std::vector<Property> properties() const;
    void remove_unused_prefixes();

    pugi::xml_document document_;
};

}  // namespace lensprof
