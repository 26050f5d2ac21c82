/// Volume, centroid and smoothness of the kernel on cells of simple shapes.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/sphere.hpp"
#include "solver/coupling/kernel/mapping.hpp"
#include "solver/coupling/kernel/testing/normalisation_error.hpp"
#include "solver/physics/drag.hpp"
#include "solver/ports/testing/synthetic_mesh.hpp"
#include "solver/ports/testing/threaded_ranks.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;
using coupling::testing::SyntheticMesh;

constexpr double k_diameter = 0.02;

SyntheticMesh cube(double half, double dx) {
    SyntheticMesh mesh;
    mesh.add_box(Vec3::Constant(-half), Vec3::Constant(half), dx, false);
    return mesh;
}

/// A box with a blade without thickness in the plane x = 0 below z = 0.
SyntheticMesh bladed(double half, double dx) {
    SyntheticMesh mesh = cube(half, dx);
    mesh.add_sheet(Vec3(0.0, -2.0 * half, -2.0 * half), Vec3(0.0, 4.0 * half, 0.0), Vec3(0.0, 0.0, 2.0 * half), 40, 20, false);
    return mesh;
}

/// Rotor and stator with cells that differ in size across the interface at r = 0.2.
SyntheticMesh rotor_and_stator() {
    SyntheticMesh mesh;
    mesh.add_annulus(0.05, 0.2, 15, 90, -0.12, 0.12, 24, true);
    mesh.add_annulus(0.2, 0.35, 12, 100, -0.12, 0.12, 20, false);
    return mesh;
}

/// One rock on a mesh.
class Placed {
public:
    explicit Placed(const SyntheticMesh& mesh)
        : mesh_(mesh), mapping_(mesh_.cells(), mesh_.steel(), coupling::testing::unit_turn(), coupling::KernelSettings{}, serial_) {}

    void put(const Vec3& position, double diameter = k_diameter, double angle = 0.0) {
        position_ = {position};
        diameter_ = {diameter};
        angle_ = angle;
        mapping_.set_time(angle);
        mapping_.build({id_, position_, diameter_}, stencils_);
    }
    double volume_error() { return coupling::testing::normalisation_error(stencils_, mesh_.volumes, serial_); }
    /// Distance of the centroid from the rock, over its diameter.
    double centroid_error() const {
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = 0; i < stencils_.cell.size(); ++i) {
            const auto c = static_cast<std::size_t>(stencils_.cell[i]);
            const Vec3 centre = mesh_.in_rotor[c] != 0 ? rotate_about(RotationAxis{}, angle_, mesh_.centres[c]) : mesh_.centres[c];
            sum += stencils_.deposit[i] * mesh_.volumes[c] * centre;
        }
        return (sum - position_[0]).norm() / diameter_[0];
    }
    /// Share of the rock's volume on cells that `where` picks.
    template <class Where>
    double share(const Where& where) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < stencils_.cell.size(); ++i) {
            const auto c = static_cast<std::size_t>(stencils_.cell[i]);
            if (where(mesh_.centres[c])) sum += stencils_.deposit[i] * mesh_.volumes[c];
        }
        return sum;
    }
    std::vector<double> solid_fraction() const {
        std::vector<double> fraction(mesh_.size(), 0.0);
        const double volume = sphere_volume(diameter_[0]);
        coupling::deposit(stencils_, gsl::span<const double>(&volume, 1), fraction);
        return fraction;
    }
    const SyntheticMesh& mesh() const { return mesh_; }

private:
    SyntheticMesh mesh_;
    coupling::SerialCommunicator serial_;
    coupling::Mapping mapping_;
    coupling::Stencils stencils_;
    std::vector<int> id_{1};
    std::vector<Vec3> position_{Vec3::Zero()};
    std::vector<double> diameter_{k_diameter};
    double angle_ = 0.0;
};

void volumes_and_centroids(Verification& verification) {
    double volume = 0.0, centroid = 0.0;
    for (const double ratio : {0.2, 0.5, 1.0, 2.0, 3.5, 5.0, 8.0}) {
        const double dx = 0.01, d = ratio * dx, reach = 3.0 * std::max(d, 1.5 * dx);
        Placed rock(cube(std::ceil(reach / dx + 1.0) * dx, dx));
        for (const Vec3& shift : {Vec3(0.0, 0.0, 0.0), Vec3(0.3, 0.1, -0.2), Vec3(0.5, 0.5, 0.5), Vec3(-0.37, 0.5, 0.11)}) {
            rock.put(shift * dx, d);
            volume = larger(volume, rock.volume_error());
            centroid = larger(centroid, rock.centroid_error());
        }
    }
    const char* const interior = "d/dx from 0.2 to 8, four places within a cell";
    verification.at_most("volume, interior", "-", volume, 1e-12, {"exact", interior});
    verification.at_most("centroid, interior", "d", centroid, 5e-3, {"exact", interior});

    Placed walled(cube(0.2, 0.01));
    for (const auto& [place, x] : {std::pair("wall", Vec3(0.19, 0.0, 0.0)), std::pair("edge of two walls", Vec3(0.19, -0.19, 0.003)),
                                   std::pair("corner", Vec3(0.19, 0.19, 0.19))}) {
        walled.put(x);
        verification.at_most(fmt::format("volume, {}", place), "-", walled.volume_error(), 1e-12,
                             {"exact", "half a diameter from the walls"});
        verification.report(fmt::format("centroid, {}", place), "d", walled.centroid_error(), std::nullopt,
                            {"exact", "without wall images the centroid moves off the wall by the kernel's missing part"});
    }

    Placed rotor(rotor_and_stator());
    volume = centroid = 0.0;
    for (const double radius : {0.185, 0.195, 0.2, 0.2001, 0.21, 0.225})
        for (int i = 0; i < 24; ++i) {
            rotor.put(Vec3(radius * std::cos(0.1), radius * std::sin(0.1), 0.003), k_diameter, 0.37 * i);
            volume = larger(volume, rotor.volume_error());
            centroid = larger(centroid, rotor.centroid_error());
        }
    verification.at_most("volume, rotor interface", "-", volume, 1e-12, {"exact", "six radii, 24 angles, cells of other size beyond"});
    verification.at_most("centroid, rotor interface", "d", centroid, 0.05, {"exact", "six radii, 24 angles, cells of other size beyond"});
}

void ranks(Verification& verification) {
    const SyntheticMesh whole = cube(0.12, 0.01);
    const std::vector<int> id{1};
    const std::vector<Vec3> position{Vec3(0.001, 0.002, -0.003)};
    const std::vector<double> diameter{k_diameter};
    double error = 0.0;
    coupling::testing::ThreadedRanks(4).run([&](coupling::Communicator& communicator) {
        const auto quarter = [&](std::size_t c) {
            const Vec3& x = whole.centres[c];
            return (x.x() > 0.0 ? 1 : 0) + (x.y() > 0.0 ? 2 : 0) == communicator.rank();
        };
        const SyntheticMesh mine = whole.part(quarter);
        coupling::Mapping mapping(mine.cells(), mine.steel(), coupling::testing::unit_turn(), coupling::KernelSettings{}, communicator);
        coupling::Stencils stencils;
        mapping.build({id, position, diameter}, stencils);
        const double found = coupling::testing::normalisation_error(stencils, mine.volumes, communicator);
        if (communicator.rank() == 0) error = found;
    });
    verification.at_most("volume, where four ranks meet", "-", error, 1e-12, {"exact", "a rock beside the line common to four ranks"});
}

/// Largest volume that moves between cells in a step along a path, over the rock's, and largest change of a cell.
struct StepChange {
    double moved = 0.0, largest = 0.0;
};

StepChange change_along(Placed& rock, const Vec3& from, const Vec3& to, double step) {
    StepChange change;
    std::vector<double> before;
    const int n = static_cast<int>(std::ceil((to - from).norm() / step));
    for (int i = 0; i <= n; ++i) {
        rock.put(from + (to - from) * i / n);
        std::vector<double> now = rock.solid_fraction();
        double moved = 0.0;
        for (std::size_t c = 0; c < before.size(); ++c) {
            moved += 0.5 * std::abs(now[c] - before[c]) * rock.mesh().volumes[c] / sphere_volume(k_diameter);
            change.largest = larger(change.largest, std::abs(now[c] - before[c]));
        }
        change.moved = larger(change.moved, moved);
        before = std::move(now);
    }
    return change;
}

void thin_blade(Verification& verification) {
    Placed beside(bladed(0.2, 0.01));
    double behind = 0.0, volume = 0.0;
    for (const Vec3& x :
         {Vec3(-0.51 * k_diameter, 0.0, -0.15), Vec3(-0.6 * k_diameter, 0.033, -0.1501), Vec3(-1.3 * k_diameter, 0.01, -0.14)}) {
        beside.put(x);
        behind = larger(behind, beside.share([](const Vec3& c) { return c.x() > 0.0; }));
        volume = larger(volume, beside.volume_error());
    }
    verification.at_most("volume, beside a thin blade", "-", volume, 1e-12, {"exact", "0.51 to 1.3 d from it"});
    verification.at_most("share of the rock behind a thin blade", "-", behind, 0.0, {"exact", "0.51 to 1.3 d from it"});

    for (const double ratio : {2.0, 1.0}) {
        if (ratio == 1.0 && !verification.wants(Effort::standard)) continue;
        const double dx = k_diameter / ratio, sigma = std::max(k_diameter, 1.5 * dx), half = std::ceil(4.5 * sigma / dx) * dx;
        Placed past(bladed(half, dx)), open(cube(half, dx));
        double moved = 0.0, largest = 0.0;
        const Vec3 paths[][2] = {{Vec3(-1.2 * sigma, 0.3 * dx, 0.6 * k_diameter), Vec3(1.2 * sigma, 0.3 * dx, 0.6 * k_diameter)},
                                 {Vec3(-0.6 * k_diameter, 0.3 * dx, -1.2 * sigma), Vec3(-0.6 * k_diameter, 0.3 * dx, 1.2 * sigma)}};
        for (const auto& path : paths) {
            const StepChange at_edge = change_along(past, path[0], path[1], 0.25 * dx);
            const StepChange in_open = change_along(open, path[0], path[1], 0.25 * dx);
            moved = larger(moved, at_edge.moved / in_open.moved);
            largest = larger(largest, at_edge.largest / in_open.largest);
        }
        const std::string where = fmt::format("past a blade's edge over open water, d/dx = {:g}", ratio);
        verification.at_most("volume moved in a step " + where, "-", moved, 2.0, {"exact", "over the edge and along the blade"});
        verification.at_most("largest change of a cell in a step " + where, "-", largest, 2.0,
                             {"exact", "over the edge and along the blade"});
    }
}

void run(Verification& verification) {
    volumes_and_centroids(verification);
    ranks(verification);
    thin_blade(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
