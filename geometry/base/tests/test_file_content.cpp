#include "geometry/base/file_content.hpp"

#include <cstdlib>

#include <gtest/gtest.h>

#include "geometry/base/error.hpp"

using namespace cutterflow;
namespace fs = std::filesystem;

namespace {

class FileContent : public ::testing::Test {
protected:
    void SetUp() override {
        std::string name = (fs::temp_directory_path() / "cutterflow_file_XXXXXX").string();
        ASSERT_NE(::mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

}  // namespace

TEST_F(FileContent, sha256_agrees_with_the_standards_test_vectors) {  // FIPS 180-4
    EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    write_file(folder_ / "million", std::string(1000000, 'a'));
    EXPECT_EQ(sha256_of_file(folder_ / "million"), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST_F(FileContent, a_sha256_is_told_by_its_form) {
    EXPECT_TRUE(is_sha256(sha256("abc")));
    EXPECT_FALSE(is_sha256(sha256("abc").substr(1)));
    EXPECT_FALSE(is_sha256(std::string(64, 'g')));
}

TEST_F(FileContent, writes_whole_files_and_leaves_nothing_beside_them) {
    const fs::path file = folder_ / "deep" / "file.txt";
    write_file(file, "old");
    write_file(file, std::string("new\0\n", 5));
    EXPECT_EQ(read_file(file), std::string("new\0\n", 5));
    EXPECT_EQ(std::distance(fs::directory_iterator(file.parent_path()), fs::directory_iterator()), 1);
}

TEST_F(FileContent, explains_what_cannot_be_read_or_written) {
    EXPECT_THROW(read_file(folder_ / "missing"), UserError);
    EXPECT_THROW(read_file(folder_), UserError);
    EXPECT_THROW(sha256_of_file(folder_ / "missing"), UserError);
    write_file(folder_ / "file", "x");
    EXPECT_THROW(write_file(folder_ / "file" / "below", "y"), UserError);
    EXPECT_THROW(write_file(folder_, "y"), UserError);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1) << "a failed write leaves nothing behind";
}
