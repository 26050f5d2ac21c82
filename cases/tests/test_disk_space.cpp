// Room on the disk: refused before a run, named when it runs out. Needs a disk of its own, which only root can make.
#include "cases/runner/disk_space.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>

namespace cutterflow::cases {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

/// A disk of 1 MB in memory.
class SmallDisk : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_disk_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
        mounted_ = ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=1m") == 0;
        if (!mounted_) GTEST_SKIP() << "needs root, who can mount a small disk";
    }
    void TearDown() override {
        if (mounted_) ::umount(folder_.c_str());
        fs::remove_all(folder_);
    }
    fs::path folder_;
    bool mounted_ = false;
};

}  // namespace

TEST_F(SmallDisk, is_refused_before_a_run_that_does_not_fit) {
    EXPECT_NEAR(free_bytes(folder_ / "not/there/yet"), 1048576.0, 20000.0);
    EXPECT_NO_THROW(require_free_bytes(folder_, 5e5));
    EXPECT_FALSE(missing_space(folder_, 5e5));
    EXPECT_THAT(missing_space(folder_, 5e6)->text(), HasSubstr("about 5 MB"));
    try {
        require_free_bytes(folder_ / "run", 2.5e9);
        FAIL() << "accepted";
    } catch (const UserError& error) {
        EXPECT_THAT(error.what(), HasSubstr("has 1.05 MB free. The run is predicted to write about 2.5 GB. Free space"));
    }
}

TEST_F(SmallDisk, that_is_full_is_named_with_what_is_written_and_missing) {
    EXPECT_FALSE(is_disk_full(folder_));
    std::ofstream file(folder_ / "field");
    file << std::string(2000000, 'x');
    file.close();
    EXPECT_FALSE(file);  // the disk is full
    EXPECT_TRUE(is_disk_full(folder_));
    const std::string text = full_disk(folder_, 3e6).text();
    EXPECT_THAT(text, HasSubstr("is full: 1.05 MB are written, 0 MB free"));
    EXPECT_THAT(text, HasSubstr("about 3 MB in all, 1.95 MB more"));
    EXPECT_THAT(text, HasSubstr("--resume"));
}

}  // namespace cutterflow::cases
