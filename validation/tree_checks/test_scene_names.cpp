/// A scene of grains is a study put together from parts: no C++ knows one by its name. What every scene goes through knows no cutter.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

/// Names of scenes alone, and names that parts of other kinds have too.
const std::regex k_scenes("draw_?down|repose|raceway|furnace|jenike|channel_?bed|column_?collapse", std::regex::icase);
const std::regex k_also_parts("suction_pipe|hopper|[^a-z]plate[^a-z]", std::regex::icase);

/// Verification cases are scenes.
const std::string k_cases = "validation/cases/";
/// Tests that read shipped examples, and this one.
const std::vector<std::string> k_may_name_examples = {"cases/tests/test_room_study.cpp", "cases/tests/test_calibrate.cpp",
                                                      "cases/tests/test_cli.cpp", "validation/tree_checks/test_scene_names.cpp"};

/// Code that rooms go through.
const std::vector<std::string> k_room_code = {"cases/scenes/room/", "meshing/room/",     "postproc/pages/room/",
                                              "cases/runner/room_", "cases/sweep/room_", "cases/cli/kinds/"};
/// The table of generators has words for solids.
const std::string k_generators = "cases/scenes/room/solid_generators.";

const std::regex k_cutter_words("cutter(?!flow)|\\bheads?\\b(?!<)|blade|suction|\\bswing\\b|mouth|ladder|spill|\\bbank\\b",
                                std::regex::icase);
/// What every scene goes through.
const std::vector<std::string> k_core = {"solver/ports/", "solver/space/", "solver/coupling/kernel/"};
/// Settings of a head stand beside the others, and the DEM gives the torque on what turns.
const std::vector<std::string> k_settings_of_heads = {"solver/ports/settings.", "solver/ports/setting_table.cpp",
                                                      "solver/ports/dem_engine.hpp"};

bool starts_with(const std::string& text, const std::string& beginning) {
    return text.rfind(beginning, 0) == 0;
}

std::string without_comment(const std::string& line) {
    return line.substr(0, line.find("//"));
}

/// The scene that a line of code of a file names; empty for none.
std::string scene_in(const std::string& file, const std::string& line) {
    const std::string code = without_comment(line);
    std::smatch found;
    if (starts_with(file, k_cases) || std::find(k_may_name_examples.begin(), k_may_name_examples.end(), file) != k_may_name_examples.end())
        return {};
    if (std::regex_search(code, found, k_scenes)) return found.str();
    const bool of_rooms =
        std::any_of(k_room_code.begin(), k_room_code.end(), [&](const std::string& folder) { return starts_with(file, folder); });
    if (of_rooms && !starts_with(file, k_generators) && std::regex_search(code, found, k_also_parts)) return found.str();
    return {};
}

/// The word of a cutter that a line of code of the solver's core has; empty for none.
std::string cutter_word_in(const std::string& file, const std::string& line) {
    const auto is_below = [&](const std::string& folder) { return starts_with(file, folder); };
    if (std::none_of(k_core.begin(), k_core.end(), is_below) ||
        std::any_of(k_settings_of_heads.begin(), k_settings_of_heads.end(), is_below))
        return {};
    for (const char* folder : {"/testing/", "/tests/", "/bench/"})
        if (file.find(folder) != std::string::npos) return {};
    const std::string code = without_comment(line);
    std::smatch found;
    return std::regex_search(code, found, k_cutter_words) ? found.str() : std::string();
}

TEST(SceneNames, stand_in_studies_and_verification_cases_alone) {
    std::size_t checked = 0;
    for (const char* folder : {"geometry", "meshing", "solver", "postproc", "cases", "validation"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(CUTTERFLOW_SOURCE_DIR) / folder)) {
            const std::string extension = entry.path().extension().string();
            const std::string file = fs::relative(entry.path(), CUTTERFLOW_SOURCE_DIR).generic_string();
            if ((extension != ".hpp" && extension != ".cpp") || starts_with(file, k_cases)) continue;
            EXPECT_EQ(scene_in(file, file), "") << file;
            std::ifstream stream(entry.path());
            std::string line;
            for (int number = 1; std::getline(stream, line); ++number) {
                EXPECT_EQ(scene_in(file, line), "") << file << ":" << number;
                EXPECT_EQ(cutter_word_in(file, line), "") << file << ":" << number;
            }
            ++checked;
        }
    EXPECT_GT(checked, 300u);
}

TEST(SceneNames, are_found_where_they_stand) {
    EXPECT_EQ(scene_in("solver/app/cutter_foam.cpp", "void run_raceway();"), "raceway");
    EXPECT_EQ(scene_in("cases/cli/kinds/room_kind.cpp", "if (scene == \"draw_down\") fill();"), "draw_down");
    EXPECT_EQ(scene_in("validation/harness/scenes/box_case.cpp", "struct ColumnCollapse {"), "ColumnCollapse");
    EXPECT_EQ(scene_in("postproc/tests/measures/test_heap.cpp", "write(\"channel_bed\");"), "channel_bed");
    EXPECT_EQ(scene_in("validation/harness/scenes/furnace.hpp", "validation/harness/scenes/furnace.hpp"), "furnace");
    EXPECT_EQ(scene_in("validation/cases/draw_down/draw_down.cpp", "void draw_down();"), "");
    EXPECT_EQ(scene_in("cases/tests/test_cli.cpp", "copy(\"cases/examples/calibrate_repose\");"), "");
    EXPECT_EQ(scene_in("cases/scenes/room/reader/read_solids.cpp", "SuctionPipe suction_pipe;"), "suction_pipe");
    EXPECT_EQ(scene_in("cases/scenes/room/room_case.cpp", "case Scene::hopper:"), "hopper");
    EXPECT_EQ(scene_in("cases/scenes/room/solid_generators.cpp", "{\"hopper\", hopper}"), "");
    EXPECT_EQ(scene_in("cases/scenes/cutter/case_builder.cpp", "{\"suction_pipe\", false}"), "");
    EXPECT_EQ(scene_in("cases/scenes/room/room_case.cpp", "x = 1;  // as for a hopper"), "");
    EXPECT_EQ(cutter_word_in("solver/coupling/kernel/mapping.cpp", "const Blade blade = blades[0];"), "Blade");
    EXPECT_EQ(cutter_word_in("solver/space/point_tree.hpp", "double head_radius = head.radius;"), "head");
    EXPECT_EQ(cutter_word_in("solver/ports/fluid_engine.hpp", "namespace cutterflow::coupling {"), "");
    EXPECT_EQ(cutter_word_in("solver/coupling/kernel/kernel_coupling.cpp", "sums.head<3>() += x;  // of the head"), "");
    EXPECT_EQ(cutter_word_in("solver/observe/head/fate_tracker.hpp", "MouthSettings mouth;"), "");
}

}  // namespace
