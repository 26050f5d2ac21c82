/// Flow through a bed of rock that cannot move has Ergun's pressure drop.
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_diameter = 0.002, k_spacing = 0.00215;

/// A square duct with rock on a lattice in the middle of its length.
BoxCase duct(double inflow) {
    const int across = 16, high = 24, ahead = 7;  // in rocks
    BoxCase box;
    box.lower = Vec3(-0.5 * across * k_spacing, -0.5 * across * k_spacing, 0.0);
    box.upper = Vec3(0.5 * across * k_spacing, 0.5 * across * k_spacing, (high + 2 * ahead) * k_spacing);
    box.cells = {17, 17, 41};
    box.sides = BoxSides::duct;
    box.inflow = inflow;
    box.gravity = Vec3::Zero();
    box.closures = "drag gidaspow; hindrance none; addedMass 0.5;";
    for (int k = 0; k < high; ++k)
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < across; ++i)
                box.rocks.push_back({static_cast<int>(box.rocks.size()) + 1, 0.0,
                                     box.lower + k_spacing * Vec3(i + 0.5, j + 0.5, ahead + k + 0.5), k_diameter, 1e9, Vec3::Zero()});
    box.time_step = 2e-3;
    box.end_time = 0.2;  // ten times what the flow needs to settle: density over Ergun's slope, 0.02 s
    return box;
}

struct Core {
    double void_fraction = 0.0, superficial = 0.0, gradient = 0.0;
};

/// Means over the middle of the bed, out of reach of its walls (two kernels); the pressure gradient by least squares over its layers.
Core core_of(const BoxCase& box, const std::filesystem::path& fields) {
    const auto alpha = read_scalar_field(fields / "voidFraction", box.cell_count()), p = read_scalar_field(fields / "p", box.cell_count());
    const auto u = read_vector_field(fields / "U", box.cell_count());
    const double dz = (box.upper.z() - box.lower.z()) / box.cells[2];
    Core core;
    int count = 0;
    double n = 0.0, sz = 0.0, sp = 0.0, szz = 0.0, szp = 0.0;
    std::size_t cell = 0;
    for (int k = 0; k < box.cells[2]; ++k)
        for (int j = 0; j < box.cells[1]; ++j)
            for (int i = 0; i < box.cells[0]; ++i, ++cell) {
                const bool inside = i >= 7 && i < 10 && j >= 7 && j < 10 && k >= 18 && k < 23;
                if (!inside) continue;
                const double z = (k + 0.5) * dz;
                core.void_fraction += alpha[cell];
                core.superficial += alpha[cell] * u[cell].z();
                n += 1.0, sz += z, sp += p[cell], szz += z * z, szp += z * p[cell];
                ++count;
            }
    core.void_fraction /= count;
    core.superficial /= count;
    core.gradient = (n * szp - sz * sp) / (n * szz - sz * sz);
    return core;
}

void flow_through(Verification& verification, double inflow) {
    const BoxCase box = duct(inflow);
    const auto folder = verification.folder(fmt::format("inflow_{:g}", inflow));
    write_box_case(folder, box);
    run_cutter_foam(folder);
    const Core core = core_of(box, folder / fmt::format("{:g}", box.end_time));
    const double a = core.void_fraction, s = 1.0 - a, u = core.superficial, d = k_diameter;
    const double ergun = box.density * (150.0 * box.viscosity * s * s / (a * a * a * d * d) * u + 1.75 * s / (a * a * a * d) * u * u);
    verification.relative(fmt::format("pressure gradient at {:g} m/s", inflow), "Pa/m", -core.gradient * box.density, ergun, 0.01,
                          {"Ergun1952", fmt::format("in the bed's core: void fraction {:.4f}, superficial velocity {:.5f} m/s", a, u)});
    verification.report(fmt::format("superficial velocity in the core over the mean, {:g} m/s", inflow), "-", u / inflow, 1.0,
                        {"exact", "below 1: the bed is thinner along walls, where the kernel is cut"});
}

void run(Verification& verification) {
    flow_through(verification, 0.01);
    flow_through(verification, 0.1);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
