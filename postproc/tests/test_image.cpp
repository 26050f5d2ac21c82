#include <cmath>
#include <cstring>

#include <gtest/gtest.h>
#include <zlib.h>

#include "geometry/base/axis_frame.hpp"
#include "geometry/base/error.hpp"
#include "postproc/draw/image.hpp"
#include "postproc/draw/rendering.hpp"
#include "postproc/draw/triangle_surface.hpp"
#include "postproc/tests/synthetic_run.hpp"

namespace cutterflow::postproc {
namespace {

TEST(Base64, matches_rfc_4648) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = (value << 8) | static_cast<std::uint8_t>(bytes[at + i]);
    return value;
}

TEST(Png, holds_the_pixels) {
    const Image image{2, 1, {10, 20, 30, 5, 25, 255}};
    const std::string png = png_bytes(image);
    ASSERT_EQ(png.substr(0, 8), std::string("\x89PNG\r\n\x1a\n", 8));
    EXPECT_EQ(big_endian(png, 16), 2u);
    EXPECT_EQ(big_endian(png, 20), 1u);
    const std::uint32_t packed = big_endian(png, 33);
    ASSERT_EQ(png.substr(37, 4), "IDAT");
    EXPECT_EQ(big_endian(png, 41 + packed), crc32(0, reinterpret_cast<const Bytef*>(png.data() + 37), packed + 4));
    std::string row(7, '\0');
    uLongf size = row.size();
    ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(row.data()), &size, reinterpret_cast<const Bytef*>(png.data() + 41), packed), Z_OK);
    ASSERT_EQ(size, 7u);
    EXPECT_EQ(row[0], 1);
    for (std::size_t i = 1; i < 7; ++i) {
        const int left = i > 3 ? image.rgb[i - 4] : 0;
        EXPECT_EQ((static_cast<std::uint8_t>(row[i]) + left) % 256, image.rgb[i - 1]);
    }
}

/// Pixel of an image.
std::array<int, 3> pixel(const Image& image, int x, int y) {
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * image.width + x);
    return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

View front_view() {
    return {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), 2.0, 100, 100};
}

TEST(Rendering, nearer_rock_hides_the_farther_one) {
    HeadScene scene;
    scene.rocks = {{Vec3(0, 0, 0.5), 0.2, colour_of("#ff0000")}, {Vec3(0, 0, -0.5), 0.4, colour_of("#0000ff")}};
    const Image image = render(scene, front_view());
    EXPECT_GT(pixel(image, 50, 50)[0], 2 * pixel(image, 50, 50)[2]);
    EXPECT_GT(pixel(image, 50 + 15, 50)[2], 2 * pixel(image, 50 + 15, 50)[0]);
    EXPECT_EQ(pixel(image, 5, 5), (std::array<int, 3>{255, 255, 255}));
}

TEST(Rendering, sphere_covers_its_area) {
    HeadScene scene;
    scene.rocks = {{Vec3(0.1, -0.2, 0.0), 0.3, colour_of("#000000")}};
    const Image image = render(scene, front_view());
    int covered = 0;
    for (int y = 0; y < 100; ++y) {
        for (int x = 0; x < 100; ++x) covered += pixel(image, x, y)[0] < 250 ? 1 : 0;
    }
    EXPECT_NEAR(covered, k_pi * 15.0 * 15.0, 60);
    EXPECT_LT(pixel(image, 55, 60)[0], 128);  // picture y goes down
}

TEST(Rendering, steel_in_front_hides_rock_and_ghosts_do_not) {
    const TriangleSurface wall{{Vec3(-1, -1, 1), Vec3(1, -1, 1), Vec3(0, 1, 1)}};
    HeadScene scene;
    scene.rocks = {{Vec3(0, -0.3, 0), 0.2, colour_of("#ff0000")}};
    const auto redness = [&] {
        const auto at = pixel(render(scene, front_view()), 50, 65);
        return at[0] - at[2];
    };
    EXPECT_GT(redness(), 100);
    scene.ghosts = wall;
    EXPECT_GT(redness(), 80);
    scene.ghosts.clear();
    const auto bare = pixel(render(scene, front_view()), 80, 85);
    scene.soil = wall;
    EXPECT_GT(redness(), 60) << "rock behind soil can be told";
    const auto soil = pixel(render(scene, front_view()), 80, 85);
    EXPECT_EQ(bare, (std::array<int, 3>{255, 255, 255}));
    EXPECT_LT(soil[2], soil[0] - 20) << "soil is brown";
    scene.steel = wall;
    EXPECT_LT(redness(), 10);
}

TEST(TriangleSurface, refuses_a_file_cut_short) {
    const auto file = testing::fresh_directory("stl") / "cut.stl";
    std::string bytes(84 + 50, '\0');
    bytes[80] = 2;
    testing::write_text(file, bytes);
    EXPECT_THROW(read_binary_stl(file), UserError);
    bytes[80] = 1;
    const float x = 1.5F;
    std::memcpy(bytes.data() + 84 + 12, &x, sizeof x);
    testing::write_text(file, bytes);
    const TriangleSurface surface = read_binary_stl(file);
    ASSERT_EQ(surface.size(), 1u);
    EXPECT_EQ(surface[0][0].x(), 1.5);
}

}  // namespace
}  // namespace cutterflow::postproc
