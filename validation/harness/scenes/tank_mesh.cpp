#include "validation/harness/scenes/tank_mesh.hpp"

#include <array>
#include <cmath>
#include <tuple>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "geometry/base/axis_frame.hpp"

namespace cutterflow::validation {
namespace {

constexpr int k_corners = 4;

/// Circles of four vertices each, at both ends of the cylinder. Vertex k is at 45 + 90 k degrees.
class Circles {
public:
    explicit Circles(double height) : height_(height) {}

    /// \param curved  whether its edges are arcs (the core's are straight) \return its number
    int add(double radius, bool curved) {
        radius_.push_back(radius);
        curved_.push_back(curved);
        return static_cast<int>(radius_.size()) - 1;
    }

    int vertex(int circle, int k, int end) const { return (end * static_cast<int>(radius_.size()) + circle) * k_corners + k % k_corners; }

    std::string vertices() const {
        std::string text;
        for (const double z : {-0.5 * height_, 0.5 * height_})
            for (const double radius : radius_)
                for (int k = 0; k < k_corners; ++k) text += point(radius, 0.5 + k, z);
        return text;
    }

    std::string arcs() const {
        std::string text;
        for (int end = 0; end < 2; ++end)
            for (int circle = 0; circle < static_cast<int>(radius_.size()); ++circle)
                for (int k = 0; curved_[circle] && k < k_corners; ++k)
                    text += fmt::format("arc {} {} {}", vertex(circle, k, end), vertex(circle, k + 1, end),
                                        point(radius_[circle], 1.0 + k, (end - 0.5) * height_));
        return text;
    }

    std::string side(int circle) const {
        std::string text;
        for (int k = 0; k < k_corners; ++k)
            text += fmt::format("({} {} {} {}) ", vertex(circle, k, 0), vertex(circle, k + 1, 0), vertex(circle, k + 1, 1),
                                vertex(circle, k, 1));
        return text;
    }

    /// Both ends between two circles.
    std::string ends(int inner, int outer) const {
        std::string text;
        for (int end = 0; end < 2; ++end)
            for (int k = 0; k < k_corners; ++k)
                text += fmt::format("({} {} {} {}) ", vertex(inner, k, end), vertex(outer, k, end), vertex(outer, k + 1, end),
                                    vertex(inner, k + 1, end));
        return text;
    }

    std::string core_ends(int circle) const {
        std::string text;
        for (int end = 0; end < 2; ++end)
            text += fmt::format("({} {} {} {}) ", vertex(circle, 0, end), vertex(circle, 1, end), vertex(circle, 2, end),
                                vertex(circle, 3, end));
        return text;
    }

    std::string core_block(int circle, int across, int high) const {
        std::array<int, 8> v{};
        for (int i = 0; i < 8; ++i) v[static_cast<std::size_t>(i)] = vertex(circle, i % 4, i / 4);
        return block(v, "rotor", across, across, high);
    }

    std::string ring_blocks(int inner, int outer, const std::string& zone, int radial, int around, int high) const {
        std::string text;
        for (int k = 0; k < k_corners; ++k)
            text += block({vertex(inner, k, 0), vertex(outer, k, 0), vertex(outer, k + 1, 0), vertex(inner, k + 1, 0), vertex(inner, k, 1),
                           vertex(outer, k, 1), vertex(outer, k + 1, 1), vertex(inner, k + 1, 1)},
                          zone, radial, around, high);
        return text;
    }

private:
    static std::string point(double radius, double quarters, double z) {
        const double angle = 0.5 * k_pi * quarters;
        return fmt::format("({:.17g} {:.17g} {:.17g})\n", radius * std::cos(angle), radius * std::sin(angle), z);
    }
    static std::string block(const std::array<int, 8>& vertices, const std::string& zone, int n1, int n2, int n3) {
        return fmt::format("hex ({}) {} ({} {} {}) simpleGrading (1 1 1)\n", fmt::join(vertices, " "), zone, n1, n2, n3);
    }

    double height_;
    std::vector<double> radius_;
    std::vector<bool> curved_;
};

}  // namespace

std::string block_mesh(const TankMesh& tank) {
    Circles circles(tank.height);
    const int core = circles.add(0.5 * tank.radius_interface, false);
    const int rotor = circles.add(tank.radius_interface, true);
    const int stator = tank.interface ? circles.add(tank.radius_interface, true) : rotor;
    const int rim = circles.add(tank.radius, true);
    const int around = tank.cells_around_quarter;
    const int stator_around = tank.interface ? tank.stator_cells_around_quarter : around;
    std::string patches = fmt::format("rim {{ type patch; faces ( {} ); }}\nends {{ type wall; faces ( {} ); }}\n", circles.side(rim),
                                      circles.core_ends(core) + circles.ends(core, rotor) + circles.ends(stator, rim));
    if (tank.interface)
        for (const auto& [name, neighbour, circle] :
             {std::tuple("rotor_interface", "stator_interface", rotor), std::tuple("stator_interface", "rotor_interface", stator)})
            patches += fmt::format("{} {{ type cyclicAMI; neighbourPatch {}; transform noOrdering; faces ( {} ); }}\n", name, neighbour,
                                   circles.side(circle));
    return fmt::format("scale 1;\nvertices\n({});\nedges\n({});\nblocks\n({});\nboundary\n({});\nmergePatchPairs ();\n", circles.vertices(),
                       circles.arcs(),
                       circles.core_block(core, around, tank.cells_high) +
                           circles.ring_blocks(core, rotor, "rotor", tank.cells_in_rotor_ring, around, tank.cells_high) +
                           circles.ring_blocks(stator, rim, "stator", tank.cells_in_stator, stator_around, tank.cells_high),
                       patches);
}

std::string turning(double speed) {
    return fmt::format(
        "dynamicFvMesh dynamicMotionSolverFvMesh; motionSolverLibs (fvMotionSolvers); motionSolver solidBody;\n"
        "solidBodyCoeffs {{ cellZone rotor; solidBodyMotionFunction rotatingMotion;\n"
        "rotatingMotionCoeffs {{ origin (0 0 0); axis (0 0 1); omega {:.17g}; }} }}\n",
        speed);
}

}  // namespace cutterflow::validation
