/// What a rock below a suction mouth sees of the water's speed: sampled over true speed in the potential flow towards a disc.
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/coupling/kernel/mapping.hpp"
#include "solver/physics/kernels.hpp"
#include "solver/ports/testing/synthetic_mesh.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_mouth = 0.047;  // radius [m], of the suction pipe's example

/// Velocity of water that a mouth in the plane z = 0 draws from below, evenly over its disc and per discharge [1/m2]: potential flow, the
/// sum of sinks on rings of equal area.
class MouthFlow {
public:
    MouthFlow() {
        constexpr int rings = 24, on_ring = 48;
        for (int i = 0; i < rings; ++i)
            for (int j = 0; j < on_ring; ++j) {
                const double radius = k_mouth * std::sqrt((i + 0.5) / rings), azimuth = 2.0 * k_pi * (j + 0.5) / on_ring;
                sinks_.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), 0.0);
            }
    }
    Vec3 at(const Vec3& place) const {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& sink : sinks_) {
            const Vec3 way = sink - place;
            const double squared = way.squaredNorm() + k_softening * k_softening;
            sum += way / (squared * std::sqrt(squared));
        }
        return sum / (2.0 * k_pi * static_cast<double>(sinks_.size()));
    }

private:
    static constexpr double k_softening = 1e-3;  // [m]: the sinks are 3 mm apart
    std::vector<Vec3> sinks_;
};

/// A kernel and how it weighs what a rock samples.
struct Sampling {
    const char* weight;
    double gamma;
};

coupling::KernelSettings settings_of(const Sampling& sampling) {
    coupling::KernelSettings kernel;
    kernel.gamma = sampling.gamma;
    kernel.sampling = sampling.weight;
    return kernel;
}

/// Speed that a rock samples, through the mapping, on cubes of `cell` [m] that fill the room below the mouth's plane.
double sampled_speed(const MouthFlow& flow, const Vec3& place, double diameter, double cell, const Sampling& sampling) {
    coupling::testing::SyntheticMesh mesh;
    const double reach = 1.1 * physics::k_kernel_reach * std::max(sampling.gamma * diameter, 1.5 * cell);
    const double half = cell * std::ceil((place.head<2>().norm() + reach) / cell), depth = cell * std::ceil((reach - place.z()) / cell);
    mesh.add_box(Vec3(-half, -half, -depth), Vec3(half, half, 0.0), cell, false);
    coupling::SerialCommunicator serial;
    coupling::Mapping mapping(mesh.cells(), mesh.steel(), {}, settings_of(sampling), serial);
    coupling::Stencils stencils;
    const std::vector<int> id{1};
    const std::vector<Vec3> position{place};
    const std::vector<double> diameters{diameter};
    mapping.build({id, position, diameters}, stencils);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < stencils.cell.size(); ++i) {
        const auto c = static_cast<std::size_t>(stencils.cell[i]);
        sum += stencils.sample[i] * mesh.volumes[c] * flow.at(mesh.centres[c]);
    }
    return sum.norm();
}

/// The same by the integral over the kernel's part below the mouth's plane, on a grid of its own. \param width  sigma [m]
double integrated_speed(const MouthFlow& flow, const Vec3& place, double width, const Sampling& sampling) {
    constexpr int half = 30;  // points a side of the kernel
    const double spacing = physics::k_kernel_reach / half;
    const bool shell = sampling.weight == std::string(coupling::k_quadratic_sampling);
    Vec3 sum = Vec3::Zero();
    double weights = 0.0;
    for (int i = -half; i < half; ++i)
        for (int j = -half; j < half; ++j)
            for (int k = -half; k < half; ++k) {
                const Vec3 offset = spacing * Vec3(i + 0.5, j + 0.5, k + 0.5), point = place + width * offset;
                const double q = offset.squaredNorm(), weight = shell ? physics::quadratic_weight(q) : physics::near_weight(q);
                if (weight == 0.0 || point.z() >= 0.0) continue;
                weights += weight;
                sum += weight * flow.at(point);
            }
    return sum.norm() / weights;
}

struct Place {
    const char* name;
    Vec3 centre;
};

constexpr Sampling k_samplings[] = {{coupling::k_quadratic_sampling, 1.0},
                                    {coupling::k_quadratic_sampling, 0.5},
                                    {coupling::k_gaussian_sampling, 1.0},
                                    {coupling::k_gaussian_sampling, 0.5}};

std::string text_of(const Sampling& sampling) {
    return fmt::format("kernel.sampling {}, kernel.gamma {:g}", sampling.weight, sampling.gamma);
}

/// Stones of 26 mm in cells of 9.5 mm, as in the suction pipe's example: one in the top layer of a bed 10 mm below the mouth, and one
/// deeper.
void stones_below_the_pipe(Verification& verification, const MouthFlow& flow) {
    constexpr double diameter = 0.026, cell = 0.0095;
    const Place places[] = {{"on the axis, 23 mm below the mouth", Vec3(0, 0, -0.0226)},
                            {"below the lip, 23 mm below the mouth", Vec3(k_mouth, 0, -0.0226)},
                            {"on the axis, 40 mm below the mouth", Vec3(0, 0, -0.04)},
                            {"below the lip, 40 mm below the mouth", Vec3(k_mouth, 0, -0.04)}};
    for (const Sampling& sampling : k_samplings)
        for (const Place& place : places) {
            const double true_speed = flow.at(place.centre).norm();
            const double sampled = sampled_speed(flow, place.centre, diameter, cell, sampling);
            const double width = std::max(sampling.gamma * diameter, 1.5 * cell);
            const std::string name = fmt::format("{}, {}", text_of(sampling), place.name);
            verification.absolute("sampled over true speed, " + name, "-", sampled / true_speed, 1.0, 0.1,
                                  {"exact", "potential flow towards a disc of 94 mm; a stone of 26 mm in cells of 9.5 mm", {}});
            verification.relative("mesh against integral, " + name, "-", sampled / true_speed,
                                  integrated_speed(flow, place.centre, width, sampling) / true_speed, 0.02,
                                  {"exact", "the same weight on a grid of its own", {}});
        }
}

/// The opening from which on rock sees the speed to a tenth: of 7 kernel widths with the shell, as `check` says, of one with the Gaussian.
void opening_of_some_widths(Verification& verification, const MouthFlow& flow, double widths, const std::vector<Sampling>& samplings) {
    const double diameter = k_mouth / widths;
    for (const Sampling& sampling : samplings)
        for (const Place& place :
             {Place{"on the axis", Vec3(0, 0, -0.01 - 0.5 * diameter)}, Place{"below the lip", Vec3(k_mouth, 0, -0.01 - 0.5 * diameter)}})
            verification.absolute(
                fmt::format("sampled over true speed, mouth of {:g} kernel widths, {}, {}", widths, text_of(sampling), place.name), "-",
                sampled_speed(flow, place.centre, diameter, 0.4 * diameter, sampling) / flow.at(place.centre).norm(), 1.0, 0.1,
                {"exact", fmt::format("a stone of {:.3g} mm that lies 10 mm below the mouth", 1e3 * diameter), {}});
}

void run(Verification& verification) {
    const MouthFlow flow;
    stones_below_the_pipe(verification, flow);
    opening_of_some_widths(verification, flow, 1.0, {k_samplings[2]});
    for (const double widths : {4.0, 7.0}) opening_of_some_widths(verification, flow, widths, {k_samplings[0], k_samplings[2]});
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
