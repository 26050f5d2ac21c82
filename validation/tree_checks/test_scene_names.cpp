/// A scene of grains is a study put together from parts: no C++ knows one by its name.
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
const std::regex k_scenes("draw_?down|repose|raceway|furnace|jenike", std::regex::icase);
const std::regex k_also_parts("suction_pipe|hopper|[^a-z]plate[^a-z]", std::regex::icase);

/// Code that rooms go through.
const std::vector<std::string> k_room_code = {"cases/scenes/room/", "meshing/room/",     "postproc/pages/room/",
                                              "cases/runner/room_", "cases/sweep/room_", "cases/cli/kinds/"};
/// The table of generators has words for solids.
const std::string k_generators = "cases/scenes/room/solid_generators.";

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
    if (std::regex_search(code, found, k_scenes)) return found.str();
    const bool of_rooms =
        std::any_of(k_room_code.begin(), k_room_code.end(), [&](const std::string& folder) { return starts_with(file, folder); });
    if (of_rooms && !starts_with(file, k_generators) && std::regex_search(code, found, k_also_parts)) return found.str();
    return {};
}

TEST(SceneNames, stand_in_studies_and_verification_cases_alone) {
    std::size_t checked = 0;
    for (const char* folder : {"geometry", "meshing", "solver", "postproc", "cases", "validation"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(CUTTERFLOW_SOURCE_DIR) / folder)) {
            const std::string extension = entry.path().extension().string();
            const std::string file = fs::relative(entry.path(), CUTTERFLOW_SOURCE_DIR).generic_string();
            const bool source = extension == ".hpp" || extension == ".cpp";
            if (!source || file.find("/tests/") != std::string::npos || starts_with(file, "validation/")) continue;
            std::ifstream stream(entry.path());
            std::string line;
            for (int number = 1; std::getline(stream, line); ++number) EXPECT_EQ(scene_in(file, line), "") << file << ":" << number;
            ++checked;
        }
    EXPECT_GT(checked, 300u);
}

TEST(SceneNames, are_found_where_they_stand) {
    EXPECT_EQ(scene_in("solver/app/cutter_foam.cpp", "void run_raceway();"), "raceway");
    EXPECT_EQ(scene_in("cases/cli/kinds/room_kind.cpp", "if (scene == \"draw_down\") fill();"), "draw_down");
    EXPECT_EQ(scene_in("cases/scenes/room/room_reader.cpp", "SuctionPipe suction_pipe;"), "suction_pipe");
    EXPECT_EQ(scene_in("cases/scenes/room/room_case.cpp", "case Scene::hopper:"), "hopper");
    EXPECT_EQ(scene_in("cases/scenes/room/solid_generators.cpp", "{\"hopper\", hopper}"), "");
    EXPECT_EQ(scene_in("cases/scenes/cutter/case_builder.cpp", "{\"suction_pipe\", false}"), "");
    EXPECT_EQ(scene_in("cases/scenes/room/room_case.cpp", "x = 1;  // as for a hopper"), "");
}

}  // namespace
