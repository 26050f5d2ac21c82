#include "geometry/base/installation.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"
#include "geometry/base/file_content.hpp"
#include "geometry/base/versions.hpp"

namespace cutterflow {
namespace {

namespace fs = std::filesystem;

class InstallationPlaces : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_prefix_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

TEST_F(InstallationPlaces, are_found_from_any_program_below_the_prefix) {
    const fs::path prefix = folder_ / "opt/a prefix";
    write_file(prefix / "share/cutterflow/docs/references.bib", "");
    for (const char* program : {"bin/cutterflow", "libexec/cutterflow/verification/settling"}) {
        const Installation found = installation_of(prefix / program);
        EXPECT_EQ(found.prefix, prefix);
        EXPECT_EQ(found.programs, prefix / "bin");
        EXPECT_EQ(found.verification, prefix / "libexec/cutterflow/verification");
        EXPECT_EQ(found.data, prefix / "share/cutterflow");
    }
}

TEST_F(InstallationPlaces, are_those_of_the_nearest_prefix) {
    write_file(folder_ / "share/cutterflow/docs/references.bib", "");
    write_file(folder_ / "local/share/cutterflow/docs/references.bib", "");
    EXPECT_EQ(installation_of(folder_ / "local/bin/cutterflow").prefix, folder_ / "local");
    EXPECT_EQ(installation_of(folder_ / "bin/cutterflow").prefix, folder_);
}

TEST_F(InstallationPlaces, of_a_program_copied_alone_are_refused) {
    EXPECT_THROW(installation_of(folder_ / "bin/cutterflow"), UserError);
}

TEST(Versions, name_every_program_that_the_build_uses) {
    const auto versions = build_versions();
    std::vector<std::string> names;
    for (const auto& [name, version] : versions) {
        names.push_back(name);
        EXPECT_NE(version, "") << name;
        EXPECT_NE(version, "unknown") << name;
    }
    EXPECT_EQ(names, (std::vector<std::string>{"cutterflow", "OpenFOAM", "LIGGGHTS", "CGAL", "assimp", "Open MPI", "compiler"}));
}

}  // namespace
}  // namespace cutterflow
