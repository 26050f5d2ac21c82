#include "geometry/io/ply_layout.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>

namespace cutterflow::geometry {
namespace {

constexpr std::size_t k_shown = 40;  // characters of a wrong word in a message

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
    std::size_t lines = 0;
    std::optional<PlyDefect> defect;  // the first

    void refuse(const std::string& what) {
        if (!defect) defect = PlyDefect{what, lines};
    }
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
            header.refuse(fmt::format("a list has the length type \"{}\"", count_type));
    }
    property.size = size_of(type);
    if (property.size == 0) header.refuse(fmt::format("a property has the unknown type \"{}\"", type));
    if (header.elements.empty()) {
        header.refuse("a property stands before any element");
        return;
    }
    header.elements.back().properties.push_back(property);
}

void read_element(std::istringstream& words, Header& header) {
    Element element;
    std::string count;
    words >> element.name >> count;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size() || element.count > std::numeric_limits<std::uint32_t>::max())
        header.refuse(fmt::format("the number of elements \"{}\" is \"{}\"", element.name, count));
    header.elements.push_back(element);
}

void read_header_line(const std::string& line, Header& header) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "format") {
        std::string name;
        words >> name;
        if (name == "ascii") header.format = Format::ascii;
        if (name == "binary_little_endian") header.format = Format::little_endian;
        if (name == "binary_big_endian") header.format = Format::big_endian;
    } else if (word == "element") {
        read_element(words, header);
    } else if (word == "property") {
        read_property(words, header);
    } else if (header.lines > 1 && word != "comment" && word != "obj_info" && word != "end_header" && !word.empty()) {
        header.refuse(fmt::format("the header has a line that begins with \"{}\"", word.substr(0, k_shown)));
    }
}

Header read_header(const std::string& content) {
    Header header;
    std::size_t at = 0;
    while (header.end == 0 && at < content.size()) {
        const std::size_t line_end = std::min(content.find('\n', at), content.size());
        const std::string line = content.substr(at, line_end - at);
        at = line_end + 1;
        ++header.lines;
        read_header_line(line, header);
        if (line.rfind("end_header", 0) == 0) header.end = std::min(at, content.size());
    }
    return header;
}

/// A face bounds a surface with three points; assimp aborts on one without any.
std::string face_defect(const Element& element, std::size_t index, std::size_t points) {
    if (element.name != "face" || points > 0) return "";
    return fmt::format("face {} of {} has no points", index + 1, element.count);
}

/// The values of one element in ASCII.
std::string line_defect(const Element& element, std::size_t index, const std::string& line) {
    std::istringstream words(line);
    std::string word;
    for (const Property& property : element.properties) {
        std::size_t values = 1;
        if (property.count_size > 0) {
            words >> word;
            const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), values);
            if (!words || error != std::errc() || end != word.data() + word.size())
                return fmt::format("the length of a list of {} {} of {} is \"{}\"", element.name, index + 1, element.count,
                                   word.substr(0, k_shown));
            const std::string defect = face_defect(element, index, values);
            if (!defect.empty()) return defect;
        }
        for (std::size_t i = 0; i < values; ++i)
            if (!(words >> word))
                return fmt::format("the file is truncated or damaged: {} {} of {} has too few values", element.name, index + 1,
                                   element.count);
    }
    return "";
}

std::optional<PlyDefect> ascii_defect(const Header& header, const std::string& content) {
    std::istringstream in(content.substr(header.end));
    std::size_t number = header.lines;
    std::string line;
    for (const Element& element : header.elements)
        for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i) {
            do {
                ++number;
                if (!std::getline(in, line))
                    return PlyDefect{fmt::format("the file is truncated: it ends before {} {} of {}", element.name, i + 1, element.count),
                                     number};
            } while (line.find_first_not_of(" \t\r") == std::string::npos);
            const std::string defect = line_defect(element, i, line);
            if (!defect.empty()) return PlyDefect{defect, number};
        }
    return std::nullopt;
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
std::optional<PlyDefect> binary_defect(const Header& header, const std::string& content) {
    std::size_t at = header.end;
    for (const Element& element : header.elements)
        for (std::size_t i = 0; i < element.count && !element.properties.empty(); ++i)
            for (const Property& property : element.properties) {
                std::size_t need = property.size;
                if (property.count_size > 0 && at + property.count_size <= content.size()) {
                    const std::size_t length = list_length(content, at, property.count_size, header.format);
                    const std::string defect = face_defect(element, i, length);
                    if (!defect.empty()) return PlyDefect{defect, 0};
                    need = property.count_size + property.size * length;
                }
                at += need;
                if (at > content.size())
                    return PlyDefect{
                        fmt::format("the file is truncated: its data end within {} {} of {}", element.name, i + 1, element.count), 0};
            }
    return std::nullopt;
}

}  // namespace

std::optional<PlyDefect> ply_defect(const std::string& content) {
    if (content.compare(0, 3, "ply") != 0) return PlyDefect{"the file does not start with \"ply\"", 1};
    const Header header = read_header(content);
    if (header.defect) return header.defect;
    if (header.end == 0) return PlyDefect{"the header has no end", header.lines};
    if (header.format == Format::none) return PlyDefect{"the header names no known format", 2};
    return header.format == Format::ascii ? ascii_defect(header, content) : binary_defect(header, content);
}

}  // namespace cutterflow::geometry
