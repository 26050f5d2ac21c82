#include "cases/study/study_shapes.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/file_content.hpp"
#include "geometry/base/mistakes.hpp"

namespace cutterflow::cases {
namespace {

constexpr const char* k_key = "feed.class.shape";

/// Classes of rock that name a shape.
std::vector<const ParameterValues*> shaped_rock(const ParameterValues& study) {
    std::vector<const ParameterValues*> shaped;
    for (const ParameterValues& feed : study.tables("feed"))
        for (const ParameterValues& rock : feed.tables("feed.class"))
            if (rock.has(k_key)) shaped.push_back(&rock);
    return shaped;
}

/// A word of a dictionary, made of a file's name.
std::string word_of(const std::filesystem::path& file) {
    std::string word = file.stem().string();
    std::replace_if(
        word.begin(), word.end(), [](unsigned char letter) { return letter > 127 || !(std::isalnum(letter) || letter == '_'); }, '_');
    const bool is_number = word.empty() || std::isdigit(static_cast<unsigned char>(word.front()));
    return is_number ? "shape_" + word : word;
}

}  // namespace

std::map<std::string, std::string> shape_names(const ParameterValues& study) {
    std::map<std::string, std::string> names;
    std::set<std::string> taken;
    for (const ParameterValues* rock : shaped_rock(study)) {
        const std::string& path = rock->text(k_key);
        if (names.count(path) > 0) continue;
        const std::string word = word_of(path);
        std::string name = word;
        for (int number = 2; !taken.insert(name).second; ++number) name = fmt::format("{}_{}", word, number);
        names[path] = name;
    }
    return names;
}

std::map<std::string, ShapeFile> read_shapes(const ParameterValues& study, const std::filesystem::path& folder) {
    const std::map<std::string, std::string> names = shape_names(study);
    std::map<std::string, ShapeFile> shapes;
    std::set<std::string> tried;
    Mistakes mistakes;
    for (const ParameterValues* rock : shaped_rock(study)) {
        const std::string& path = rock->text(k_key);
        if (tried.insert(path).second)
            mistakes.gather([&] { shapes.emplace(path, read_shape_file(*rock, k_key, names.at(path), folder)); });
    }
    mistakes.refuse();
    return shapes;
}

std::map<std::string, std::string> shape_hashes(const ParameterValues& study, const std::filesystem::path& folder) {
    std::map<std::string, std::string> hashes;
    int feed_number = 0;
    for (const ParameterValues& feed : study.tables("feed")) {
        ++feed_number;
        int number = 0;
        for (const ParameterValues& rock : feed.tables("feed.class"))
            if (++number; rock.has(k_key))
                hashes[fmt::format("feed[{}].class[{}].shape", feed_number, number)] = sha256_of_file(folder / rock.text(k_key));
    }
    return hashes;
}

void move_shapes(ParameterValues& study, const std::function<std::string(const std::string&)>& path_of) {
    if (shaped_rock(study).empty()) return;
    for (ParameterValues& feed : study.tables_for_writing("feed")) {
        if (feed.tables("feed.class").empty()) continue;
        for (ParameterValues& rock : feed.tables_for_writing("feed.class"))
            if (rock.has(k_key)) rock.set(k_key, path_of(rock.text(k_key)));
    }
}

}  // namespace cutterflow::cases
