/// The layers' one direction (docs/developer/structure.md): every #include of every source file is held
/// against one table.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
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

const std::string k_base = "geometry/base/";
const std::string k_head_shape = "geometry/head/contour.hpp";
const std::string k_axial_bins = "geometry/head/axial_bins.hpp";
const std::string k_head_names = "geometry/head/head_names.hpp";

/// docs/developer/structure.md shows this table as a picture. It is changed when the structure is, never to let a file pass.
const std::vector<Layer> k_layers = {
    {"geometry/base/", {k_base}},
    {"geometry/base/process/", {"geometry/base/error.hpp", "geometry/base/file_content.hpp", "geometry/base/process/"}},
    {"geometry/surface/", {k_base, "geometry/surface/", "geometry/cgal/"}},
    {"geometry/cgal/", {k_base, "geometry/cgal/", "geometry/surface/surface.hpp", "geometry/surface/topology.hpp"}},
    {"geometry/io/", {k_base, "geometry/surface/", "geometry/io/"}},
    {"geometry/repair/", {k_base, "geometry/surface/", "geometry/cgal/", "geometry/io/", "geometry/repair/"}},
    {"geometry/head/", {k_base, "geometry/surface/", "geometry/cgal/", "geometry/io/", "geometry/head/"}},
    {"geometry/packing/", {k_base, "geometry/cgal/", k_head_shape, "geometry/packing/"}},
    {"geometry/clump/", {k_base, "geometry/surface/surface.hpp", "geometry/clump/"}},
    {"geometry/clump_fit/", {k_base, "geometry/surface/", "geometry/cgal/", "geometry/clump/", "geometry/clump_fit/"}},
    {"geometry/soil/", {k_base, "geometry/surface/", "geometry/cgal/", k_head_shape, "geometry/soil/"}},
    {"geometry/tests/", {"geometry/"}},

    {"meshing/dictionary/", {k_base, "meshing/dictionary/"}},
    {"meshing/quality/", {k_base, "meshing/quality/"}},
    {"meshing/cutter/", {k_base, "geometry/surface/", "geometry/head/", "meshing/dictionary/", "meshing/quality/", "meshing/cutter/"}},
    {"meshing/room/",
     {k_base, "geometry/surface/", "geometry/cgal/solid_search.hpp", "meshing/dictionary/", "meshing/quality/", "meshing/room/"}},
    {"meshing/foam/", {k_base, k_head_names}},
    {"meshing/tests/", {"geometry/", "meshing/"}},

    {"solver/physics/", {k_base, "solver/physics/"}},
    {"solver/ports/", {k_base, k_head_shape, "geometry/clump/unit_clump.hpp", "solver/physics/", "solver/ports/"}},
    {"solver/space/", {k_base, "solver/ports/", "solver/space/"}},
    {"solver/observe/", {k_base, k_axial_bins, "solver/ports/", "solver/observe/"}},
    {"solver/observe/head/",
     {k_base, k_head_shape, k_axial_bins, "solver/physics/", "solver/ports/", "solver/observe/run_recorder.hpp", "solver/observe/head/"}},
    {"solver/observe/velocity/", {k_base, "solver/ports/", "solver/space/", "solver/observe/velocity/"}},
    {"solver/replay/", {k_base, "solver/ports/", "solver/replay/"}},
    {"solver/coupling/", {k_base, "solver/physics/", "solver/ports/", "solver/observe/", "solver/replay/", "solver/coupling/"}},
    {"solver/coupling/feed/", {k_base, "solver/ports/", "solver/coupling/feed/"}},
    {"solver/coupling/kernel/",
     {k_base, "solver/physics/", "solver/ports/", "solver/space/", "solver/coupling/feed/", "solver/coupling/rock_coupling.hpp",
      "solver/coupling/kernel/"}},
    {"solver/foam/session/", {k_base, "solver/ports/", "solver/foam/session/"}},
    {"solver/foam/dictionary/", {k_base, "geometry/clump/", "solver/ports/", "solver/foam/session/", "solver/foam/dictionary/"}},
    {"solver/foam/multigrid/", {k_base, "solver/foam/session/", "solver/foam/multigrid/"}},
    {"solver/foam/mesh_motion/", {k_base, "solver/ports/", "solver/foam/session/", "solver/foam/multigrid/", "solver/foam/mesh_motion/"}},
    {"solver/foam/single_phase/",
     {k_base, "solver/ports/", "solver/foam/session/", "solver/foam/multigrid/", "solver/foam/mesh_motion/", "solver/foam/single_phase/",
      "solver/foam/soil/"}},
    {"solver/foam/soil/",
     {k_base, "solver/ports/", "solver/space/", "solver/foam/session/", "solver/foam/mesh_motion/", "solver/foam/soil/"}},
    {"solver/foam/", {k_base, "solver/ports/", "solver/foam/"}},
    {"solver/liggghts/", {k_base, "solver/physics/", "solver/ports/", "solver/space/steel_tree.hpp", "solver/liggghts/"}},
    {"solver/liggghts/contacts/", {k_base, "solver/physics/", "solver/ports/", "solver/liggghts/contacts/"}},
    {"solver/free_surface/cut_cells/",
     {k_base, "geometry/cgal/solid_search.hpp", "geometry/surface/", "solver/ports/", "solver/free_surface/grid.hpp",
      "solver/free_surface/cell_lists.hpp", "solver/free_surface/kernel.hpp", "solver/free_surface/mirror.hpp",
      "solver/free_surface/cut_cells/"}},
    {"solver/free_surface/", {k_base, "geometry/io/", "geometry/surface/", "solver/physics/", "solver/ports/", "solver/free_surface/"}},
    {"solver/app/", {k_base, "solver/"}},

    {"postproc/run/", {k_base, k_head_shape, k_axial_bins, k_head_names, "postproc/run/"}},
    {"postproc/draw/", {k_base, k_head_names, "postproc/run/", "postproc/draw/"}},
    {"postproc/draw/head/", {k_base, k_head_names, "postproc/run/", "postproc/draw/"}},
    {"postproc/analysis/", {k_base, k_axial_bins, k_head_names, "postproc/run/", "postproc/draw/", "postproc/analysis/"}},
    {"postproc/analysis/calibration/", {k_base, "postproc/analysis/calibration/"}},
    {"postproc/analysis/measures/", {k_base, "postproc/run/", "postproc/analysis/time_average.hpp", "postproc/analysis/measures/"}},
    {"postproc/analysis/steel/", {k_base, k_axial_bins, k_head_names, "postproc/run/", "postproc/draw/", "postproc/analysis/"}},
    {"postproc/pages/", {k_base, k_head_names, "postproc/"}},
    {"postproc/pages/free_surface/", {k_base, "postproc/run/", "postproc/draw/", "postproc/analysis/", "postproc/pages/"}},
    {"postproc/pages/measures/", {k_base, "postproc/analysis/measures/", "postproc/draw/", "postproc/pages/measures/"}},
    {"postproc/tests/", {k_base, k_axial_bins, k_head_names, "postproc/"}},

    {"cases/study/",
     {k_base, "geometry/clump/", "geometry/head/", "meshing/cutter/mesh_plan.hpp", "solver/physics/", "solver/ports/",
      "postproc/run/adv_points.hpp", "cases/study/"}},
    {"cases/scenes/", {k_base, "cases/scenes/"}},
    {"cases/scenes/flow/", {k_base, "meshing/dictionary/", "cases/scenes/flow/"}},
    {"cases/scenes/rock/", {k_base, "meshing/dictionary/", "cases/study/shape_file.hpp", "cases/scenes/rock/"}},
    {"cases/scenes/cutter/",
     {"geometry/", "meshing/", "solver/physics/", "solver/ports/", "cases/study/", "cases/scenes/flow/", "cases/scenes/rock/",
      "cases/scenes/cutter/"}},
    {"cases/scenes/free_surface/", {k_base, "solver/free_surface/", "cases/scenes/free_surface/"}},
    {"cases/scenes/room/",
     {"geometry/", "meshing/", "solver/physics/", "solver/ports/", "postproc/analysis/measures/", "cases/study/study_section.hpp",
      "cases/study/closure_rules.hpp", "cases/study/contact_rules.hpp", "cases/study/shape_file.hpp", "cases/scenes/flow/",
      "cases/scenes/rock/", "cases/scenes/room/"}},
    {"cases/runner/",
     {"geometry/", "meshing/", "solver/ports/", "postproc/analysis/measures/", "postproc/pages/", "postproc/run/", "cases/study/",
      "cases/scenes/", "cases/runner/"}},
    {"cases/replay/",
     {k_base, "geometry/io/", "geometry/head/", "meshing/dictionary/", "postproc/analysis/", "postproc/run/", "cases/study/",
      "cases/scenes/cutter/", "cases/runner/", "solver/ports/recording_summary.hpp", "cases/replay/"}},
    {"cases/sweep/", {k_base, "cases/study/", "cases/scenes/", "cases/runner/", "cases/sweep/"}},
    {"cases/calibration/",
     {k_base, "postproc/analysis/calibration/", "cases/study/", "cases/scenes/", "cases/runner/", "cases/sweep/", "cases/calibration/"}},
    {"cases/testing/", {k_base, k_head_names, "meshing/dictionary/", "cases/scenes/cutter/", "cases/testing/"}},
    {"cases/cli/", {"geometry/", "meshing/", "postproc/", "cases/", "validation/harness/suite/"}},
    {"cases/tests/", {"geometry/", "meshing/", "solver/physics/", "solver/ports/", "postproc/", "cases/"}},

    {"validation/harness/", {k_base, "validation/harness/"}},
    {"validation/harness/tests/", {k_base, "postproc/draw/", "validation/harness/"}},
    {"validation/harness/suite/", {k_base, "postproc/draw/", "cases/runner/", "validation/harness/suite/"}},
    {"validation/harness/scenes/",
     {k_base, k_head_names, "geometry/io/", "geometry/soil/", "meshing/dictionary/", "solver/ports/", "solver/liggghts/",
      "cases/scenes/cutter/", "cases/runner/", "cases/testing/", "validation/harness/"}},
    {"validation/cases/",
     {k_base, "geometry/soil/", "geometry/cgal/", "geometry/clump/", "geometry/io/", "geometry/surface/", "meshing/dictionary/",
      "solver/physics/", "solver/ports/", "solver/coupling/", "solver/free_surface/", "postproc/analysis/", "cases/study/", "cases/runner/",
      "cases/testing/", "validation/harness/"}},
    {"validation/examples/", {k_base, "validation/harness/"}},
    {"validation/corpus/", {"geometry/", "validation/corpus/"}},
    {"validation/fuzz/",
     {"geometry/", "solver/ports/", "solver/coupling/", "postproc/", "cases/calibration/", "cases/study/", "cases/scenes/", "cases/runner/",
      "cases/sweep/", "validation/fuzz/"}},
    {"validation/rotor/",
     {k_base, k_head_names, "geometry/cgal/", "geometry/clump/", "geometry/io/write_stl.hpp", "geometry/soil/", "meshing/dictionary/",
      "postproc/draw/", "cases/scenes/cutter/", "cases/runner/", "cases/testing/", "validation/harness/"}},
    {"validation/studies/", {"geometry/", "meshing/", "validation/harness/", "validation/studies/"}},
    {"validation/tree_checks/", {k_base}},
};

/// Third-party headers that only some folders may include.
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
    {"NLopt", std::regex("^nlopt"), {"postproc/analysis/calibration/"}},
    {"MPI", std::regex("^mpi\\.h$"), {"solver/foam/", "solver/liggghts/", "solver/app/", "validation/harness/"}},
};

bool starts_with(const std::string& text, const std::string& prefix) {
    return text.rfind(prefix, 0) == 0;
}

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
    if (!starts_with_any(header, layer->may_include))
        return fmt::format("{} may include only {}", layer->folder, fmt::join(layer->may_include, ", "));
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

TEST(Folders, hold_at_most_25_sources) {
    std::map<std::string, int> sources;
    for (const fs::path& path : source_files()) ++sources[fs::relative(path.parent_path(), CUTTERFLOW_SOURCE_DIR).generic_string()];
    for (const auto& [folder, count] : sources)
        EXPECT_LE(count, 25) << folder << " holds " << count << " sources: split it by what they are for";
}

TEST(Includes, a_wrong_direction_is_caught) {
    EXPECT_FALSE(complaint("geometry/base/error.cpp", "geometry/surface/surface.hpp").empty());
    EXPECT_FALSE(complaint("postproc/pages/report.cpp", "cases/study/study.hpp").empty());
    EXPECT_FALSE(complaint("postproc/draw/plot.cpp", "postproc/pages/report.hpp").empty());
    EXPECT_FALSE(complaint("cases/study/study.cpp", "solver/foam/single_phase/cutter_fluid.hpp").empty());
    EXPECT_FALSE(complaint("cases/study/study.cpp", "cases/scenes/cutter/case_inputs.hpp").empty());
    EXPECT_FALSE(complaint("solver/coupling/kernel/mapping.cpp", "solver/observe/head/fate_tracker.hpp").empty());
    EXPECT_FALSE(complaint("solver/ports/settings.cpp", "solver/coupling/coupled_run.hpp").empty());
    EXPECT_FALSE(complaint("geometry/surface/surface.cpp", "CGAL/Surface_mesh.h").empty());
    EXPECT_FALSE(complaint("solver/coupling/kernel/stencil.cpp", "fvCFD.H").empty());
    EXPECT_FALSE(complaint("solver/coupling/kernel/stencil.cpp", "mpi.h").empty());
    EXPECT_TRUE(complaint("solver/foam/session/session.cpp", "fvCFD.H").empty());
    EXPECT_TRUE(complaint("meshing/cutter/mesh_plan.cpp", "geometry/head/contour.hpp").empty());
    EXPECT_TRUE(complaint("solver/physics/drag.cpp", "vector").empty());
}

}  // namespace
