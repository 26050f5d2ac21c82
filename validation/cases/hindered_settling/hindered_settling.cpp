/// A uniform suspension settles with the slip of its own force balance.
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "validation/harness/scenes/box_case.hpp"
#include "validation/harness/scenes/falling_rock.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_diameter = 0.010;

/// A box that holds a whole number of lattice spacings, filled with rock at one velocity.
BoxCase suspension(double solid_fraction, double speed) {
    const double spacing = k_diameter * std::cbrt(k_pi / 6.0 / solid_fraction);
    const int across = static_cast<int>(std::ceil(0.14 / spacing)), high = static_cast<int>(std::ceil(0.40 / spacing));
    BoxCase box;
    box.lower = Vec3(-0.5 * across * spacing, -0.5 * across * spacing, 0.0);
    box.upper = Vec3(0.5 * across * spacing, 0.5 * across * spacing, high * spacing);
    const int cells = static_cast<int>(std::lround(across * spacing / 0.01));
    box.cells = {cells, cells, static_cast<int>(std::lround(high * spacing / 0.01))};
    for (int k = 0; k < high; ++k)
        for (int j = 0; j < across; ++j)
            for (int i = 0; i < across; ++i)
                box.rocks.push_back({static_cast<int>(box.rocks.size()) + 1, 0.0, box.lower + spacing * Vec3(i + 0.5, j + 0.5, k + 0.5),
                                     k_diameter, 2650.0, Vec3(0.0, 0.0, -speed)});
    // A floor would stop the lowest layer, that the next one, and so on: at 0.2 and 0.3 the pile reaches the middle before the end.
    box.rock_leaves_at_bottom = true;
    box.time_step = 2e-3;
    box.end_time = 0.16;  // the last 3 % of the speed fade with 0.07 s; the upper edge comes down 0.11 m, not yet into the middle
    return box;
}

bool in_the_middle(const BoxCase& box, const Vec3& x) {
    const Eigen::Array3d relative = (x - box.lower).cwiseQuotient(box.upper - box.lower).array();
    return (relative > 0.3).all() && (relative < 0.7).all();
}

double mean_rock_speed(const BoxCase& box, const RockSnapshot& picture) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t p = 0; p < picture.position.size(); ++p)
        if (in_the_middle(box, picture.position[p])) {
            sum -= picture.velocity[p].z();
            ++count;
        }
    return sum / count;
}

double mean_fluid_speed(const BoxCase& box, const std::vector<Vec3>& velocity) {
    const Vec3 size = (box.upper - box.lower).cwiseQuotient(Vec3(box.cells[0], box.cells[1], box.cells[2]));
    double sum = 0.0;
    int count = 0;
    std::size_t cell = 0;
    for (int k = 0; k < box.cells[2]; ++k)
        for (int j = 0; j < box.cells[1]; ++j)
            for (int i = 0; i < box.cells[0]; ++i, ++cell)
                if (in_the_middle(box, box.lower + size.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5)))) {
                    sum += velocity[cell].z();
                    ++count;
                }
    return sum / count;
}

void settle(Verification& verification, double solid_fraction) {
    FallingRock rock;
    rock.diameter = k_diameter;
    const double alone = terminal_slip(rock);
    rock.void_fraction = 1.0 - solid_fraction;
    const double slip = terminal_slip(rock), settling = rock.void_fraction * slip;
    const BoxCase box = suspension(solid_fraction, 0.97 * settling);
    const auto folder = verification.folder(fmt::format("solid_{}", solid_fraction));
    write_box_case(folder, box);
    run_cutter_foam(folder);
    const double fall = mean_rock_speed(box, last_rocks(folder));
    const double rise = mean_fluid_speed(box, read_vector_field(folder / fmt::format("{:g}", box.end_time) / "U", box.cell_count()));
    const std::string at = fmt::format("solid fraction {}", solid_fraction);
    verification.relative("slip, " + at, "m/s", fall + rise, slip, 0.03,
                          {"DiFelice1994", "rock less fluid in the middle of the box, from 97 % of the settling speed on", 0.01});
    const double re = alone * k_diameter / rock.viscosity, x = 0.1 * std::pow(re, 0.9);
    const double garside = (5.1 + 2.7 * x) / (1.0 + x);
    const double in_still_frame = rock.void_fraction * (fall + rise);
    verification.report("settling speed and Richardson-Zaki, " + at, "m/s", in_still_frame, alone * std::pow(rock.void_fraction, 2.39),
                        {"RichardsonZaki1954", "void fraction times slip; reference u_t (1 - alpha_p)^2.39"});
    verification.report("settling speed and Garside-Al-Dibouni, " + at, "m/s", in_still_frame,
                        alone * std::pow(rock.void_fraction, garside),
                        {"GarsideAlDibouni1977", fmt::format("void fraction times slip; reference u_t (1 - alpha_p)^{:.3f}", garside)});
}

void run(Verification& verification) {
    for (const double solid_fraction : {0.02, 0.05, 0.1, 0.2, 0.3}) settle(verification, solid_fraction);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
