/// \file Every tenth file of the corpus; all of them: build/validation/repair_corpus FOLDER.
#include <gtest/gtest.h>

#include "validation/corpus/judge.hpp"

namespace cutterflow::validation {
namespace {

namespace fs = std::filesystem;

TEST(DamagedSurfaces, every_tenth_file_is_repaired_or_refused_with_the_reason) {
    const fs::path folder = fs::path(CUTTERFLOW_BUILD_DIR) / "tests/damaged_surfaces";
    fs::remove_all(folder);
    fs::create_directories(folder);
    const std::vector<DamagedFile> files = damaged_files();
    ASSERT_GE(files.size(), 60u);
    for (std::size_t i = 0; i < files.size(); i += 10) {
        const Verdict verdict = judge(files[i], fs::path(CUTTERFLOW_BUILD_DIR) / "bin/cutterflow", folder);
        EXPECT_TRUE(verdict.passed) << verdict.name << ": " << verdict.note;
    }
}

}  // namespace
}  // namespace cutterflow::validation
