/// Restitution and overlap of impacts in the DEM: dry, wet, on planes, rocks and facets.
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/contact.hpp"
#include "validation/harness/reference_table.hpp"
#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

constexpr double k_radius = 0.01;
constexpr double k_water = 998.2, k_viscosity = 1.0034e-6;
const Elastic k_rock{1.1e8, 0.24, 2650.0};

/// Water, added mass and restitution after Legendre instead of the dry one.
coupling::DemSettings in_fluid(coupling::DemSettings settings, double density, double viscosity) {
    settings.contact.wet_restitution = true;
    settings.fluid = {density, viscosity};
    settings.added_mass = 0.5;
    return settings;
}

/// Of the Rayleigh time, in a row's name; the shipped one has none.
std::string at_fraction(double fraction) {
    return fraction == coupling::ContactSettings{}.time_step_fraction ? "" : fmt::format(", timeStepFraction {}", fraction);
}

coupling::DemSettings with_fraction(coupling::DemSettings settings, double fraction) {
    settings.contact.time_step_fraction = fraction;
    return settings;
}

void check_dry(Verification& verification, double restitution, double fraction) {
    const About about{"SchwagerPoeschel2007",
                      "20 mm, 1 m/s, E = 0.11 GPa, steps of timeStepFraction of the Rayleigh time, 0.1 where the name has none",
                      {}};
    const std::string name_end = fmt::format(", e = {}{}", restitution, at_fraction(fraction));
    const ImpactOutcome wall = collide(with_fraction(dry_room(0.3, true, k_rock, restitution, 0.0, 1.0), fraction),
                                       {above_floor(k_radius, k_rock.density, Vec3(0, 0, -1.0))}, k_own_step);
    verification.relative("dry restitution on a wall" + name_end, "-", wall.velocity[0].z(), restitution, 0.01, about);
    const double x = k_radius * (1.0 + 1e-4);
    const ImpactOutcome pair =
        collide(with_fraction(dry_room(0.3, false, k_rock, restitution, 0.0, 1.0), fraction),
                {{k_radius, k_rock.density, Vec3(-x, 0, 0), Vec3(0.5, 0, 0)}, {k_radius, k_rock.density, Vec3(x, 0, 0), Vec3(-0.5, 0, 0)}},
                k_own_step);
    verification.relative("dry restitution of two rocks" + name_end, "-", pair.velocity[1].x() - pair.velocity[0].x(), restitution, 0.01,
                          about);
}

void check_wet(Verification& verification, double fraction) {
    const ReferenceTable table = read_reference(case_file("restitution/wet.csv"), {{"impact speed", "m/s"}, {"restitution", "-"}});
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double speed = table.at("impact speed")[i];
        const auto settings = with_fraction(in_fluid(dry_room(0.3, true, k_rock, 0.97, 0.0, 1.0), k_water, k_viscosity), fraction);
        const ImpactOutcome impact = collide(settings, {above_floor(k_radius, k_rock.density, Vec3(0, 0, -speed))}, k_own_step);
        verification.relative(fmt::format("restitution in water at {} m/s{}", speed, at_fraction(fraction)), "-",
                              impact.velocity[0].z() / speed, table.at("restitution")[i], 0.02,
                              {table.source, "20 mm rock, Hertz, added mass 0.5", {}});
    }
}

/// From 0.1 on a step takes more than 1 % of the rebound where the dashpot takes most of it: README.md.
void check_steps(Verification& verification) {
    for (const double fraction : {0.05, 0.1, 0.2}) {
        for (const double restitution : {0.3, 0.5, 0.7, 0.9, 0.97}) {
            if (fraction > 0.05 && restitution < 0.7 && !verification.wants(Effort::standard)) continue;
            check_dry(verification, restitution, fraction);
        }
        check_wet(verification, fraction);
    }
}

using Facet = std::array<Vec3, 3>;

std::filesystem::path write_stl(const std::filesystem::path& file, const std::vector<Facet>& facets) {
    std::ofstream stream(file);
    stream << "solid wall\n";
    for (const Facet& facet : facets) {
        stream << "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& corner : facet) stream << fmt::format("vertex {:.17g} {:.17g} {:.17g}\n", corner.x(), corner.y(), corner.z());
        stream << "endloop\nendfacet\n";
    }
    stream << "endsolid wall\n";
    return file;
}

/// A cylinder about z of narrow facets, from one azimuth on.
std::vector<Facet> cylinder(double radius, double length, int facets, double from, double to) {
    std::vector<Facet> surface;
    const auto corner = [&](int k, double z) {
        const double azimuth = from + (to - from) * k / facets;
        return Vec3(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
    };
    for (int k = 0; k < facets; ++k) {
        surface.push_back({corner(k, -length), corner(k + 1, -length), corner(k + 1, length)});
        surface.push_back({corner(k, -length), corner(k + 1, length), corner(k, length)});
    }
    return surface;
}

void check_drum(Verification& verification) {
    const double drum = 0.143;
    const auto file = write_stl(verification.folder("drum.stl"), cylinder(drum, 0.03, 900, 0.0, 2.0 * k_pi));
    const ReferenceTable table = read_reference(case_file("restitution/wet.csv"), {{"impact speed", "m/s"}, {"restitution", "-"}});
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double speed = table.at("impact speed")[i];
        for (const double surface_speed : {0.0, speed, 5.0 * speed}) {
            if (surface_speed > speed && speed < 1.0) continue;  // a facet's edge gives a blow of its own, see README.md
            coupling::DemSettings settings = in_fluid(dry_room(0.4, false, k_rock, 0.97, 0.0, 1.0), k_water, k_viscosity);
            settings.walls = {{"drum", file, true}};
            BenchBall ball{k_radius, k_rock.density, Vec3(drum + k_radius * 1.0001, 0.0, 0.0), Vec3(-speed, 0.0, 0.0)};
            const ImpactOutcome impact = collide(settings, {ball}, k_own_step, surface_speed / drum);
            verification.relative(
                fmt::format("restitution in water at {} m/s on a drum of 1 mm facets that pass at {:g} m/s", speed, surface_speed), "-",
                impact.velocity[0].x() / speed, table.at("restitution")[i], 0.02,
                {table.source, "without friction; one contact across several facets", {}});
        }
    }
}

void check_trough(Verification& verification) {
    const double trough = 0.3, arm = trough - k_radius, gravity = 9.81;
    coupling::DemSettings settings = dry_room(0.5, false, k_rock, 0.97, 0.0, 2.0);
    const int facets = static_cast<int>(std::lround(trough * k_pi / 0.003));
    settings.walls = {{"trough", write_stl(verification.folder("trough.stl"), cylinder(trough, 0.05, facets, -k_pi, 0.0)), false}};
    settings.gravity = Vec3(0.0, -gravity, 0.0);
    const double start = k_pi / 4.0;  // from the lowest point
    const double away = arm * (1.0 - 1e-4);
    const Slide result = slide(settings, {k_radius, k_rock.density, Vec3(-away * std::sin(start), -away * std::cos(start), 0.0)}, 1e-4);
    verification.relative("speed at the bottom of a trough of 3 mm facets", "m/s", result.speed,
                          std::sqrt(2.0 * gravity * arm * (1.0 - std::cos(start))), 0.02,
                          {"exact", "a frictionless rock slides down an eighth of a circle of 0.3 m", {}});
    verification.at_most("height of the rock over the trough while it slides, over its radius", "-", result.height / k_radius, 0.02,
                         {"exact", "", {}});
}

void check_gondret(Verification& verification) {
    const ReferenceTable table = read_reference(
        case_file("restitution/gondret.csv"),
        {{"Stokes number", "-"}, {"diameter", "mm"}, {"impact speed", "m/s"}, {"oil density", "kg/m3"}, {"oil viscosity", "Pa s"}});
    const Elastic steel{1e9, 0.27, 7800.0};
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double diameter = 1e-3 * table.at("diameter")[i], speed = table.at("impact speed")[i], density = table.at("oil density")[i];
        const double viscosity = table.at("oil viscosity")[i] / density;
        const double stokes = (steel.density / density + 0.5) * speed * diameter / (9.0 * viscosity);
        const auto settings = in_fluid(dry_room(0.1, true, steel, 0.97, 0.0, speed), density, viscosity);
        const ImpactOutcome impact = collide(settings, {above_floor(0.5 * diameter, steel.density, Vec3(0, 0, -speed))}, 1e-6);
        verification.relative(fmt::format("restitution of Gondret's ball at St = {}", table.at("Stokes number")[i]), "-",
                              impact.velocity[0].z() / speed, 0.97 * std::exp(-35.0 / stokes), 0.01,
                              {"Legendre2006", "steel ball in silicone oil; the reference is Legendre's curve", {}});
    }
}

void check_overlap(Verification& verification) {
    const double speed = 90.0 / 60.0 * 2.0 * k_pi * 0.4;  // the model cutter's tip at 90 rpm
    const double inertia = k_rock.density + 0.5 * k_water;
    const double chosen =
        physics::youngs_modulus_for_overlap(inertia, speed, physics::k_largest_overlap_ratio, 2.0 - 0.24 * 0.24 - 0.27 * 0.27);
    for (const double modulus : {chosen, 1e7}) {
        const Elastic material{modulus, 0.24, k_rock.density};
        auto settings = in_fluid(dry_room(0.3, true, material, 0.97, 0.15, speed), k_water, k_viscosity);
        settings.contact.poisson_steel = 0.27;
        const ImpactOutcome impact = collide(settings, {above_floor(k_radius, k_rock.density, Vec3(0, 0, -speed))}, k_own_step);
        const std::string name = fmt::format("overlap over radius at the tip speed of 90 rpm, E = {:.3g} GPa", modulus * 1e-9);
        if (modulus == chosen)
            verification.at_most(name, "-", impact.overlap / k_radius, 0.05,
                                 {"AntypovElliott2011", "20 mm rock on steel, 3.77 m/s; the stiffness that a study chooses", {}});
        else
            verification.report(name, "-", impact.overlap / k_radius, {}, {"NieuwboerVanRheeKeetels2023", "the paper's stiffness", {}});
    }
}

void run(Verification& verification) {
    const SingleProcess mpi;
    check_steps(verification);
    check_drum(verification);
    check_trough(verification);
    check_gondret(verification);
    check_overlap(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
