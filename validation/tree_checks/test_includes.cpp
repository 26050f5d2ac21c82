/// The layers' one direction (docs/design/001-contracts.md, README "Folders"): every #include of every source file is held against one table.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

/// A folder and the project folders that its files may include. The longest matching prefix counts.
struct Layer {
    std::string folder;
    std::vector<std::string> may_include;
};

const std::vector<Layer> k_layers = {
    {"geometry/base/", {"geometry/base/"}},
    {"geometry/", {"geometry/"}},
    {"meshing/", {"geometry/", "meshing/"}},
    {"solver/physics/", {"geometry/base/", "solver/physics/"}},
    {"solver/coupling/", {"geometry/base/", "solver/physics/", "solver/coupling/"}},
    {"solver/foam/", {"geometry/base/", "solver/physics/", "solver/coupling/", "solver/foam/"}},
    {"solver/liggghts/", {"geometry/base/", "solver/physics/", "solver/coupling/", "solver/liggghts/"}},
    {"solver/app/", {"geometry/base/", "solver/"}},
    {"postproc/", {"geometry/base/", "postproc/"}},
    {"cases/", {"geometry/", "meshing/", "solver/physics/", "solver/coupling/", "postproc/", "cases/"}},
    {"validation/", {"geometry/", "meshing/", "cases/", "postproc/", "validation/"}},
    {"validation/support/", {"geometry/", "meshing/", "cases/", "postproc/", "solver/coupling/", "solver/liggghts/", "validation/"}},
    {"validation/cases/", {"geometry/", "meshing/", "cases/", "postproc/", "solver/physics/", "solver/coupling/", "validation/"}},
};

/// Third-party headers that only some folders may see.
struct Quarantine {
    std::string what;
    std::regex header;
    std::vector<std::string> only_in;
};

const std::vector<Quarantine> k_quarantines = {
    {"CGAL", std::regex("^CGAL/"), {"geometry/cgal/"}},
    {"assimp", std::regex("^assimp/"), {"geometry/io/"}},
    {"OpenFOAM", std::regex(".*\\.H$"), {"solver/foam/", "meshing/foam/"}},
    {"LIGGGHTS", std::regex("^liggghts/|^lammps\\.h$|^library\\.h$|^library_cfd_coupling\\.h$"), {"solver/liggghts/"}},
    {"MPI", std::regex("^mpi\\.h$"), {"solver/foam/", "solver/liggghts/", "solver/app/", "validation/support/"}},
};

bool starts_with(const std::string& text, const std::string& prefix) { return text.rfind(prefix, 0) == 0; }

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
    return std::any_of(prefixes.begin(), prefixes.end(), [&](const std::string& prefix) { return starts_with(text, prefix); });
}

const Layer* layer_of(const std::string& file) {
    const Layer* best = nullptr;
    for (const Layer& layer : k_layers)
        if (starts_with(file, layer.folder) && (best == nullptr || layer.folder.size() > best->folder.size())) best = &layer;
    return best;
}

/// What is wrong with `header` in `file` (both relative to the root); empty when nothing is.
std::string complaint(const std::string& file, const std::string& header) {
    for (const Quarantine& quarantine : k_quarantines)
        if (std::regex_search(header, quarantine.header) && !starts_with_any(file, quarantine.only_in))
            return fmt::format("{} is seen only in {}", quarantine.what, fmt::join(quarantine.only_in, ", "));
    const bool of_the_project = std::any_of(k_layers.begin(), k_layers.end(), [&](const Layer& layer) {
        return starts_with(header, layer.folder.substr(0, layer.folder.find('/') + 1));
    });
    if (!of_the_project) return {};
    const Layer* layer = layer_of(file);
    if (layer == nullptr) return "the file lies in no known layer";
    if (!starts_with_any(header, layer->may_include)) return fmt::format("{} may include only {}", layer->folder, fmt::join(layer->may_include, ", "));
    return {};
}

std::vector<fs::path> source_files() {
    std::vector<fs::path> files;
    for (const char* folder : {"geometry", "meshing", "solver", "postproc", "cases", "validation"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(CUTTERFLOW_SOURCE_DIR) / folder)) {
            const std::string extension = entry.path().extension().string();
            if (entry.is_regular_file() && (extension == ".hpp" || extension == ".cpp")) files.push_back(entry.path());
        }
    return files;
}

TEST(Includes, point_only_downwards) {
    const std::regex include_line("^\\s*#\\s*include\\s*[<\"]([^>\"]+)[>\"]");
    std::size_t checked = 0;
    for (const fs::path& path : source_files()) {
        const std::string file = fs::relative(path, CUTTERFLOW_SOURCE_DIR).generic_string();
        std::ifstream stream(path);
        std::string line;
        for (int number = 1; std::getline(stream, line); ++number) {
            std::smatch match;
            if (!std::regex_search(line, match, include_line)) continue;
            ++checked;
            const std::string wrong = complaint(file, match[1]);
            EXPECT_TRUE(wrong.empty()) << file << ":" << number << ": includes " << match[1] << "; " << wrong;
        }
    }
    EXPECT_GT(checked, 50u) << "the scan found almost no includes: it looks in the wrong place";
}

TEST(Includes, a_wrong_direction_is_caught) {
    EXPECT_FALSE(complaint("geometry/base/error.cpp", "geometry/surface.hpp").empty());
    EXPECT_FALSE(complaint("postproc/report.cpp", "cases/study.hpp").empty());
    EXPECT_FALSE(complaint("cases/study.cpp", "solver/foam/cutter_fluid.hpp").empty());
    EXPECT_FALSE(complaint("geometry/surface.cpp", "CGAL/Surface_mesh.h").empty());
    EXPECT_FALSE(complaint("solver/coupling/stencil.cpp", "fvCFD.H").empty());
    EXPECT_FALSE(complaint("solver/coupling/stencil.cpp", "mpi.h").empty());
    EXPECT_TRUE(complaint("solver/foam/session.cpp", "fvCFD.H").empty());
    EXPECT_TRUE(complaint("meshing/mesh_plan.cpp", "geometry/base/contour.hpp").empty());
    EXPECT_TRUE(complaint("solver/physics/drag.cpp", "vector").empty());
}

}  // namespace
