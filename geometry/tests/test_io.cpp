#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/io/write_stl.hpp"
#include "geometry/surface/soundness.hpp"
#include "geometry/tests/solids.hpp"

namespace cutterflow::geometry {
namespace {

namespace fs = std::filesystem;
using testing::box;
using testing::unit_cube;

/// A fresh folder for each test.
class Files : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::path(CUTTERFLOW_BUILD_DIR) / "tests" / "surface_files" / info->name();
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }

    fs::path write(const std::string& name, const std::string& content) const {
        std::ofstream(folder_ / name, std::ios::binary) << content;
        return folder_ / name;
    }

    static std::string content_of(const fs::path& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    }

    std::string binary_cube() const {
        write_stl(unit_cube(), folder_ / "cube.stl");
        return content_of(folder_ / "cube.stl");
    }

    static std::string refusal(const fs::path& file) {
        try {
            read_surface(file);
        } catch (const UserError& error) {
            return error.what();
        }
        return "not refused";
    }

    void expect_refusal(const fs::path& file, const std::string& words) const {
        const std::string message = refusal(file);
        EXPECT_NE(message.find(words), std::string::npos) << message;
        EXPECT_NE(message.find(file.filename().string()), std::string::npos) << message;
    }

    fs::path folder_;
};

std::string ascii_stl(const TriangleSurface& surface) {
    std::string text = "solid head\n";
    for (const Triangle& t : surface.triangles) {
        text += "facet normal 0 0 0\n outer loop\n";
        for (const std::uint32_t corner : t) {
            const Vec3& p = surface.points[corner];
            text += fmt::format("  vertex {} {} {}\n", p.x(), p.y(), p.z());
        }
        text += " endloop\nendfacet\n";
    }
    return text + "endsolid head\n";
}

const char* const k_obj_cube =
    "# quads\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

const char* const k_ply_tetrahedron =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

std::string binary_ply_tetrahedron() {
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
        "property list uchar int vertex_indices\nend_header\n";
    const TriangleSurface surface = testing::tetrahedron();
    for (const Vec3& point : surface.points) {
        const Eigen::Vector3f single = point.cast<float>();
        bytes.append(reinterpret_cast<const char*>(single.data()), 12);
    }
    for (const Triangle& t : surface.triangles) {
        bytes += '\3';
        bytes.append(reinterpret_cast<const char*>(t.data()), 12);
    }
    return bytes;
}

TEST_F(Files, a_written_stl_reads_back_and_is_the_same_bytes_each_time) {
    const std::string first = binary_cube();
    EXPECT_EQ(first.size(), 84u + 12u * 50u);
    EXPECT_EQ(first, binary_cube());
    const TriangleSurface back = read_surface(folder_ / "cube.stl");
    EXPECT_EQ(back.points.size(), 8u);
    EXPECT_TRUE(inspect_surface(back).sound());
    EXPECT_NEAR(volume_of(back), 1.0, 1e-6);
}

TEST_F(Files, names_with_spaces_parentheses_and_upper_case_work) {
    const fs::path file = write("Cutter Head (rev B).STL", binary_cube());
    EXPECT_EQ(read_surface(file).triangles.size(), 12u);
}

TEST_F(Files, ascii_stl_obj_and_ply_give_joined_closed_surfaces) {
    const SoundnessReport stl = inspect_surface(read_surface(write("a.stl", ascii_stl(unit_cube()))));
    const SoundnessReport obj = inspect_surface(read_surface(write("b.OBJ", k_obj_cube)));
    const SoundnessReport ply = inspect_surface(read_surface(write("c.ply", k_ply_tetrahedron)));
    for (const SoundnessReport* report : {&stl, &obj, &ply}) EXPECT_TRUE(report->sound());
    EXPECT_NEAR(stl.volume, 1.0, 1e-6);
    EXPECT_NEAR(obj.volume, 1.0, 1e-6);
    EXPECT_NEAR(ply.volume, 1.0 / 6.0, 1e-6);
    EXPECT_EQ(obj.triangles, 12u);
}

TEST_F(Files, a_binary_stl_whose_title_starts_with_solid_is_still_binary) {
    std::string bytes = binary_cube();
    bytes.replace(0, 11, "solid model");
    EXPECT_EQ(read_surface(write("solid.stl", bytes)).triangles.size(), 12u);
}

TEST_F(Files, bytes_after_a_binary_stl_do_no_harm) {
    EXPECT_EQ(read_surface(write("long.stl", binary_cube() + "attributes of some CAD")).triangles.size(), 12u);
}

TEST_F(Files, what_is_no_surface_is_refused_by_name_and_reason) {
    expect_refusal(folder_ / "missing.stl", "does not exist");
    expect_refusal(write("empty.stl", ""), "is empty");
    expect_refusal(write("head.step", "ISO-10303-21;"), "ends in \".step\"");
    expect_refusal(write("picture.stl", std::string("\x89PNG\r\n\x1a\n", 8) + std::string(4000, '\x7f')), "no STL or a truncated one");
    expect_refusal(write("short.stl", "hello"), "this is no STL: 5 bytes");
    expect_refusal(write("text.obj", "Dear colleague,\nplease find the head attached.\n"), "");
    EXPECT_NE(refusal(folder_ / "text.obj"), "not refused");
    expect_refusal(write("nothing.ply", "ply\nnot at all"), "nothing.ply:2: the header has a line that begins with \"not\"");
    expect_refusal(write("endless.ply", "ply\nformat ascii 1.0\n"), "the header has no end");
    expect_refusal(write("picture.ply", "\x89PNG"), "does not start with \"ply\"");
}

TEST_F(Files, truncated_files_are_refused) {
    const std::filesystem::path huge = write("huge.stl", "solid");
    std::filesystem::resize_file(huge, 20'000'000'000);  // no block of it is stored
    expect_refusal(huge, "the file has 20 GB. At most 0.5 GB are read");
    const std::string binary = binary_cube();
    expect_refusal(write("half.stl", binary.substr(0, binary.size() / 2)), "announces 12 triangles, which need 684 bytes");
    const std::string ascii = ascii_stl(unit_cube());
    expect_refusal(write("half_ascii.stl", ascii.substr(0, ascii.size() / 2)), "has no \"endsolid\"");
    const std::string ply = k_ply_tetrahedron;
    for (const std::size_t cut : {9u, 12u, 30u}) expect_refusal(write("cut.ply", ply.substr(0, ply.size() - cut)), "the file is truncated");
    const std::string binary_ply = binary_ply_tetrahedron();
    EXPECT_EQ(read_surface(write("whole.ply", binary_ply)).triangles.size(), 4u);
    for (const std::size_t cut : {1u, 14u, 60u})
        expect_refusal(write("cut.ply", binary_ply.substr(0, binary_ply.size() - cut)), "the file is truncated");
}

/// assimp aborts on the first three, reads outside its arrays on the fourth and fifth, and does not end on the sixth.
TEST_F(Files, a_ply_that_assimp_does_not_survive_is_refused_with_its_line) {
    const auto changed = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    const std::string ascii = k_ply_tetrahedron;
    const std::string binary = binary_ply_tetrahedron();
    expect_refusal(write("no_points.ply", changed(ascii, "3 0 1 3", "0 0 1 3")), "no_points.ply:15: face 2 of 4 has no points");
    expect_refusal(write("empty_face.ply", changed(ascii, "3 1 2 3", "0")), "empty_face.ply:17: face 4 of 4 has no points");
    std::string empty = binary;
    empty[binary.size() - 13] = 0;  // the length of the last face
    expect_refusal(write("empty_binary.ply", empty), "face 4 of 4 has no points");
    expect_refusal(write("word.ply", changed(binary, "property float y", "vertex element y")),
                   "word.ply:5: the header has a line that begins with \"vertex\"");
    expect_refusal(write("prop.ply", changed(binary, "property float y", "propusemtlerty float y")), "prop.ply:5");
    expect_refusal(write("long.ply", changed(ascii, "3 1 2 3", "2147483648 1 2 3")),
                   "long.ply:17: the file is truncated or damaged: face 4 of 4");
    expect_refusal(write("count.ply", changed(ascii, "face 4", "face -4")), "the number of elements \"face\" is \"-4\"");
}

/// assimp reads outside its arrays.
TEST_F(Files, an_obj_whose_faces_name_points_before_the_first_is_refused) {
    for (const int first : {-9, -1000000, -2147483647})
        EXPECT_NE(refusal(write("before.obj", fmt::format("v 0 0 0\nv 1 0 0\nv 0 1 0\nf {} -2 -1 -2 -3\n", first))), "not refused");
}

TEST_F(Files, coordinates_that_are_no_numbers_are_refused) {
    std::string bytes = binary_cube();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    bytes.replace(84 + 12 + 4, 4, reinterpret_cast<const char*>(&nan), 4);
    expect_refusal(write("nan.stl", bytes), "Coordinates must be finite numbers");
    std::string ascii = ascii_stl(unit_cube());
    ascii.replace(ascii.find("vertex 0"), 8, "vertex nan");
    expect_refusal(write("nan_ascii.stl", ascii), "finite");
}

/// Single precision has steps of 1/16 at 1e6.
TEST_F(Files, a_surface_far_from_the_origin_is_refused_with_that_cause_alone) {
    const auto cube_at = [this](double x) {
        write_stl(box(Vec3(x, 0.0, 0.0), Vec3(x + 0.02, 0.02, 0.02)), folder_ / "far.stl");
        return folder_ / "far.stl";
    };
    for (const double x : {1e6, -1e6, 100.0}) {
        const std::string message = refusal(cube_at(x));
        EXPECT_NE(message.find("Move the origin near the body"), std::string::npos) << message;
        EXPECT_EQ(message.find("without area"), std::string::npos) << message;
    }
    expect_refusal(cube_at(1e6), "coordinates of 1e+06, in the file's unit. Single precision resolves 0.062 there");
    EXPECT_EQ(read_surface(cube_at(10.0)).triangles.size(), 12u);
}

TEST_F(Files, points_alone_are_no_surface) {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
    EXPECT_NE(refusal(write("points.ply", ply)), "not refused");
    expect_refusal(write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2\n"), "holds no triangles");
}

TEST_F(Files, the_unit_is_told_from_the_size_and_reported) {
    const auto imported = [this](double half_extent, std::optional<LengthUnit> unit) {
        write_stl(box(Vec3::Constant(-half_extent), Vec3::Constant(half_extent)), folder_ / "head.stl");
        return import_cutter(folder_ / "head.stl", unit);
    };
    const ImportedSurface metres = imported(0.4, std::nullopt);
    EXPECT_EQ(metres.unit.unit, LengthUnit::metre);
    EXPECT_TRUE(metres.unit.detected);
    EXPECT_EQ(metres.unit.reason, "unit m told from the size: half the largest extent is 0.4 m (0.1219 m with --unit ft)");
    const ImportedSurface millimetres = imported(1600.0, std::nullopt);
    EXPECT_EQ(millimetres.unit.unit, LengthUnit::millimetre);
    EXPECT_NEAR(bounds_of(millimetres.surface).max.x(), 1.6, 1e-6);
    const ImportedSurface told_inches = imported(15.75, std::nullopt);
    EXPECT_EQ(told_inches.unit.unit, LengthUnit::inch);
    EXPECT_TRUE(told_inches.unit.detected);
    EXPECT_EQ(told_inches.unit.reason, "unit inch told from the size: half the largest extent is 0.4 m (0.1575 m with --unit cm)");
    const ImportedSurface inches = imported(15.75, LengthUnit::inch);
    EXPECT_FALSE(inches.unit.detected);
    EXPECT_NEAR(bounds_of(inches.surface).max.x(), 0.40005, 1e-6);
    const ImportedSurface feet = imported(1.3, LengthUnit::foot);
    EXPECT_NEAR(bounds_of(feet.surface).max.x(), 0.39624, 1e-6);
}

TEST_F(Files, an_implausible_size_is_refused_with_the_unit_that_would_fit) {
    write_stl(box(Vec3::Constant(-400.0), Vec3::Constant(400.0)), folder_ / "Head.stl");
    try {
        import_cutter(folder_ / "Head.stl", LengthUnit::metre);
        FAIL();
    } catch (const UserError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("Head.stl: half the surface's largest extent is 400 m"), std::string::npos) << message;
        EXPECT_NE(message.find("--unit mm"), std::string::npos) << message;
        EXPECT_EQ(error.code(), ExitCode::user_input);
    }
    EXPECT_THROW(decide_unit(0.01, std::nullopt), UserError);
    EXPECT_THROW(decide_unit(1e9, std::nullopt), UserError);
    EXPECT_THROW(length_unit_of("furlong"), UserError);
}

}  // namespace
}  // namespace cutterflow::geometry
