/// One type per name: a reader who meets a name finds one definition.
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

/// The type that a line of a header defines in a namespace; empty for none. Members of types are indented.
std::string type_in(const std::string& line) {
    static const std::regex definition("^(?:struct|class|enum class|enum) ([A-Za-z0-9_]+)(?: final)?(?: :[^;]*| \\{.*)?$");
    std::smatch found;
    return std::regex_match(line, found, definition) ? found[1].str() : std::string();
}

TEST(TypeNames, are_those_of_one_type_outside_of_tests) {
    std::map<std::string, std::string> known;
    for (const char* folder : {"geometry", "meshing", "solver", "postproc", "cases", "validation"})
        for (const auto& entry : fs::recursive_directory_iterator(fs::path(CUTTERFLOW_SOURCE_DIR) / folder)) {
            const std::string file = fs::relative(entry.path(), CUTTERFLOW_SOURCE_DIR).generic_string();
            if (entry.path().extension() != ".hpp" || file.find("/tests/") != std::string::npos) continue;
            std::ifstream stream(entry.path());
            std::string line;
            while (std::getline(stream, line)) {
                const std::string type = type_in(line);
                if (type.empty()) continue;
                const auto [place, is_new] = known.emplace(type, file);
                EXPECT_TRUE(is_new) << type << " is defined in " << place->second << " and in " << file
                                    << ". Use one type where both are the same thing, else name one of them more precisely";
            }
        }
    EXPECT_GT(known.size(), 400u);
}

TEST(TypeNames, are_found_where_a_type_is_defined) {
    EXPECT_EQ(type_in("struct Box {"), "Box");
    EXPECT_EQ(type_in("struct EverywhereRegion {};"), "EverywhereRegion");
    EXPECT_EQ(type_in("class FakeFluid : public FluidEngine {"), "FakeFluid");
    EXPECT_EQ(type_in("class UserError final : public Error {"), "UserError");
    EXPECT_EQ(type_in("enum class DomainShape { box, cylinder };"), "DomainShape");
    EXPECT_EQ(type_in("class FluidEngine;"), "");
    EXPECT_EQ(type_in("struct Hash<Box> {"), "");
    EXPECT_EQ(type_in("    struct Sphere {"), "");
}

}  // namespace
