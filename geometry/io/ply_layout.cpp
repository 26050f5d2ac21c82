#include "geometry/io/ply_layout.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>

namespace cutterflow::geometry {
namespace {

struct Property {
    std::size_t size = 0;        // of a value, or of an entry of the list
    std::size_t count_size = 0;  // of the list's length; 0: no list
};

struct Element {
    std::string name;
    std::size_t count = 0;
    std::vector<Property> properties;
};

enum class Format { none, ascii, little_endian, big_endian };

struct Header {
    Format format = Format::none;
    std::vector<Element> elements;
    std::size_t end = 0;  // where the data start; 0: the header has no end
    std::string defect;
};

/// 0 for an unknown type.
std::size_t size_of(const std::string& type) {
    static const std::map<std::string, std::size_t> sizes{
        {"char", 1}, {"uchar", 1}, {"int8", 1},  {"uint8", 1},  {"short", 2}, {"ushort", 2},  {"int16", 2},  {"uint16", 2},
        {"int", 4},  {"uint", 4},  {"int32", 4}, {"uint32", 4}, {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
    const auto found = sizes.find(type);
    return found == sizes.end() ? 0 : found->second;
}

void read_property(std::istringstream& words, Header& header) {
    std::string type;
    words >> type;
    Property property;
    if (type == "list") {
        std::string count_type;
        words >> count_type >> type;
        property.count_size = size_of(count_type);
        if (property.count_size == 0 || property.count_size > 4)
            header.defect = fmt::format("a list has the length type \"{}\"", count_type);
    }
    property.size = size_of(type);
    if (property.size == 0) header.defect = fmt::format("a property has the unknown type \"{}\"", type);
    if (header.elements.empty()) {
        header.defect = "a property stands before any element";
        return;
    }
    header.elements.back().properties.push_back(property);
}

Header read_header(const std::string& content) {
    Header header;
    std::size_t at = 0;
    while (header.end == 0 && at < content.size()) {
        const std::size_t line_end = std::min(content.find('\n', at), content.size());
        std::istringstream words(content.substr(at, line_end - at));
        at = line_end + 1;
        std::string word;
        words >> word;
        if (word == "format") {
            std::string name;
            words >> name;
            if (name == "ascii") header.format = Format::ascii;
            if (name == "binary_little_endian") header.format = Format::little_endian;
            if (name == "binary_big_endian") header.format = Format::big_endian;
        } else if (word == "element") {
            header.elements.emplace_back();
            words >> header.elements.back().name >> header.elements.back().count;
        } else if (word == "property") {
            read_property(words, header);
        } else if (word == "end_header") {
            header.end = std::min(at, content.size());
        }
    }
    return header;
}

std::string ascii_defect(const Header& header, const std::string& content) {
    std::size_t announced = 0;
    for (const Element& element : header.elements) announced += element.count;
    std::istringstream in(content.substr(header.end));
    std::size_t lines = 0;
    std::string line;
    while (std::getline(in, line))
        if (line.find_first_not_of(" \t\r") != std::string::npos) ++lines;
    if (lines >= announced) return "";
    return fmt::format("the file is truncated: {} lines follow its header, which announces {} elements", lines, announced);
}

std::size_t list_length(const std::string& content, std::size_t at, std::size_t size, Format format) {
    std::size_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const std::size_t byte = format == Format::big_endian ? at + i : at + size - 1 - i;
        value = 256 * value + static_cast<std::uint8_t>(content[byte]);
    }
    return value;
}

/// Walks over the data as the header describes them.
std::string binary_defect(const Header& header, const std::string& content) {
    std::size_t at = header.end;
    for (const Element& element : header.elements)
        for (std::size_t i = 0; i < element.count; ++i)
            for (const Property& property : element.properties) {
                std::size_t need = property.size;
                if (property.count_size > 0 && at + property.count_size <= content.size())
                    need = property.count_size + property.size * list_length(content, at, property.count_size, header.format);
                at += need;
                if (at > content.size())
                    return fmt::format("the file is truncated: its data end within {} {} of {}", element.name, i + 1, element.count);
            }
    return "";
}

}  // namespace

std::string ply_defect(const std::string& content) {
    if (content.compare(0, 3, "ply") != 0) return "the file does not start with \"ply\"";
    const Header header = read_header(content);
    if (!header.defect.empty()) return header.defect;
    if (header.end == 0) return "the header has no end";
    if (header.format == Format::none) return "the header names no known format";
    return header.format == Format::ascii ? ascii_defect(header, content) : binary_defect(header, content);
}

}  // namespace cutterflow::geometry
