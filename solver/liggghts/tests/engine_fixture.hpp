#pragma once
/// \file What the engine's tests share: settings, rocks, walls written as STL, force laws.
#include <filesystem>
#include <fstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <mpi.h>

#include "solver/liggghts/liggghts_engine.hpp"
#include "solver/liggghts/wall_surface.hpp"

namespace cutterflow::liggghts::tests {

inline constexpr double k_water_density = 998.2;
inline constexpr double k_water_viscosity = 1.0034e-6;
inline constexpr double k_rock_density = 2650.0;

inline int rank() {
    int me = 0;
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    return me;
}

inline int ranks() {
    int count = 1;
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    return count;
}

/// An empty folder of this test, the same on all ranks.
inline std::filesystem::path scratch_folder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    std::string name = fmt::format("{}.{}.{}", test->test_suite_name(), test->name(), ranks());
    for (char& c : name)
        if (c == '/') c = '_';
    const std::filesystem::path folder = std::filesystem::path(CUTTERFLOW_BUILD_DIR) / "tests" / "liggghts" / name;
    if (rank() == 0) {
        std::filesystem::remove_all(folder);
        std::filesystem::create_directories(folder);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    return folder;
}

inline std::filesystem::path write_stl(const std::filesystem::path& file, const std::vector<Triangle>& surface) {
    if (rank() == 0) {
        std::ofstream stream(file);
        stream << "solid wall\n";
        for (const Triangle& triangle : surface) {
            stream << "facet normal 0 0 0\nouter loop\n";
            for (const Vec3& corner : triangle)
                stream << fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", corner.x(), corner.y(), corner.z());
            stream << "endloop\nendfacet\n";
        }
        stream << "endsolid wall\n";
    }
    MPI_Barrier(MPI_COMM_WORLD);
    return file;
}

/// Rectangle origin + s a + t b, 0 <= s, t <= 1, of n x m cells of two triangles.
inline std::vector<Triangle> sheet(const Vec3& origin, const Vec3& a, const Vec3& b, int n, int m) {
    std::vector<Triangle> surface;
    const auto corner = [&](int i, int j) { return Vec3(origin + a * i / n + b * j / m); };
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            surface.push_back({corner(i, j), corner(i + 1, j), corner(i + 1, j + 1)});
            surface.push_back({corner(i, j), corner(i + 1, j + 1), corner(i, j + 1)});
        }
    }
    return surface;
}

/// Closed box.
inline std::vector<Triangle> block(const Vec3& low, const Vec3& high, int cells) {
    const Vec3 d = high - low;
    const Vec3 x(d.x(), 0, 0), y(0, d.y(), 0), z(0, 0, d.z());
    std::vector<Triangle> surface;
    const auto add = [&](const Vec3& origin, const Vec3& a, const Vec3& b) {
        for (const Triangle& t : sheet(origin, a, b, cells, cells)) surface.push_back(t);
    };
    add(low, y, x);
    add(low + z, x, y);
    add(low, x, z);
    add(low + y, z, x);
    add(low, z, y);
    add(low + x, y, z);
    return surface;
}

/// Smooth rocks in water, no walls, gravity downwards, in a cylinder of radius and half height 0.5 m.
inline coupling::DemSettings still_water() {
    coupling::DemSettings settings;
    settings.contact.youngs_modulus = 1.1e8;
    settings.contact.max_speed = 4.0;
    coupling::use_preset(settings.contact, coupling::k_paper_pairs);
    settings.domain = coupling::cylinder_domain(0.5, -0.5, 0.5);
    settings.fluid = {k_water_density, k_water_viscosity};
    settings.added_mass = 0.5;
    settings.gravity = Vec3(0, 0, -9.81);
    return settings;
}

inline void add_rock(coupling::Rocks& rocks, int id, const Vec3& position, const Vec3& velocity = Vec3::Zero(), double diameter = 0.02,
                     double density = k_rock_density) {
    rocks.append({id, position, velocity, Vec3::Zero(), diameter, density});
}

inline coupling::Rocks one_rock(const Vec3& position, const Vec3& velocity = Vec3::Zero(), double diameter = 0.02) {
    coupling::Rocks rocks;
    add_rock(rocks, 1, position, velocity, diameter);
    return rocks;
}

inline double volume(double diameter) {
    return k_pi / 6.0 * diameter * diameter * diameter;
}

inline Vec3 no_force(std::size_t, const Vec3&) {
    return Vec3::Zero();
}

inline std::vector<coupling::ZoneMotion> no_zones() {
    return {};
}

}  // namespace cutterflow::liggghts::tests
