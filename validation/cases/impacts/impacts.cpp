/// Chung and Ooi's tests 1 to 8 and Kharaz' oblique impacts, in the DEM itself.
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "geometry/base/axis_frame.hpp"
#include "solver/physics/contact.hpp"
#include "validation/harness/largest.hpp"
#include "validation/harness/reference_table.hpp"
#include "validation/harness/scenes/contact_bench.hpp"
#include "validation/harness/verification.hpp"

namespace {

using namespace cutterflow;
using namespace cutterflow::validation;

const Elastic k_glass{48e9, 0.20, 2800.0}, k_limestone{20e9, 0.25, 2500.0}, k_alloy{70e9, 0.30, 2699.0}, k_magnesium{40e9, 0.35, 1800.0},
    k_oxide{380e9, 0.23, 4000.0}, k_iron{100e9, 0.25, 7000.0}, k_steel{208e9, 0.30, 7850.0}, k_alloy6{70e9, 0.33, 2700.0};

constexpr double k_closed_form = 0.002;  // what tests 1, 2 and 4 may differ by from their closed forms

double ball_mass(double radius, double density) {
    return 4.0 / 3.0 * k_pi * std::pow(radius, 3) * density;
}

double plane_modulus(const Elastic& m) {
    return m.youngs_modulus / (1.0 - m.poisson * m.poisson);
}

/// Hertz' force at an overlap: 4/3 E* sqrt(R*) overlap^(3/2).
double hertz_force(const physics::Impact& impact) {
    return 4.0 / 3.0 * impact.modulus * std::sqrt(impact.radius) * std::pow(physics::hertz_largest_overlap(impact), 1.5);
}

void compare_with_hertz(Verification& verification, const std::string& name, const ImpactOutcome& found, const physics::Impact& hertz) {
    const About about{"ChungOoi2011", "the reference is Hertz' closed form; a DEM step of a thousandth of Hertz' time", {}};
    verification.relative(name + ": largest force", "N", found.force, hertz_force(hertz), k_closed_form, about);
    verification.relative(name + ": largest overlap", "m", found.overlap, physics::hertz_largest_overlap(hertz), k_closed_form, about);
    verification.relative(name + ": time of contact", "s", found.duration, physics::hertz_time(hertz), k_closed_form, about);
}

void check_elastic(Verification& verification) {
    const std::pair<const char*, Elastic> pairs[] = {{"glass", k_glass}, {"limestone", k_limestone}};
    for (const auto& [name, material] : pairs) {
        const double radius = 0.01, speed = 10.0, x = radius * (1.0 + 1e-4);
        const physics::Impact hertz{0.5 * ball_mass(radius, material.density), 0.5 * radius, 0.5 * plane_modulus(material), 2.0 * speed};
        const ImpactOutcome found = collide(
            dry_room(0.2, false, material, 1.0, 0.35, 2.0 * speed),
            {{radius, material.density, Vec3(-x, 0, 0), Vec3(speed, 0, 0)}, {radius, material.density, Vec3(x, 0, 0), Vec3(-speed, 0, 0)}},
            physics::hertz_time(hertz) / 1000.0);
        compare_with_hertz(verification, fmt::format("test 1, two spheres of {}", name), found, hertz);
    }
    const std::pair<const char*, Elastic> balls[] = {{"aluminium alloy", k_alloy}, {"magnesium alloy", k_magnesium}};
    for (const auto& [name, material] : balls) {
        const double radius = 0.1, speed = 0.2;
        const physics::Impact hertz{ball_mass(radius, material.density), radius, plane_modulus(material), speed};
        const ImpactOutcome found =
            collide(dry_room(2.0, true, against_rigid(material), 1.0, 0.0, speed),
                    {above_floor(radius, material.density, Vec3(0, 0, -speed))}, physics::hertz_time(hertz) / 1000.0);
        compare_with_hertz(verification, fmt::format("test 2, {} on a rigid wall", name), found, hertz);
    }
}

void check_restitution(Verification& verification) {
    const std::pair<const char*, Elastic> materials[] = {{"aluminium oxide", k_oxide}, {"cast iron", k_iron}};
    for (const auto& [name, material] : materials)
        for (const double restitution : {0.2, 0.4, 0.6, 0.8, 1.0}) {
            const double radius = 0.0025, speed = 3.9;
            const physics::Impact hertz{ball_mass(radius, material.density), radius, plane_modulus(material), speed};
            const auto check = [&](const std::string& step, double sample, const std::string& note) {
                const ImpactOutcome found = collide(dry_room(0.05, true, against_rigid(material), restitution, 0.0, speed),
                                                    {above_floor(radius, material.density, Vec3(0, 0, -speed))}, sample);
                verification.relative(fmt::format("test 3, {}, e = {}{}", name, restitution, step), "-", found.velocity[0].z() / speed,
                                      restitution, 0.01, {"ChungOoi2011", note, {}});
            };
            check("", physics::hertz_time(hertz) / 100.0, "3.9 m/s on a rigid wall, a DEM step of a hundredth of Hertz' time");
            check(", a study's step", k_own_step, "3.9 m/s on a rigid wall, the shipped step: 0.1 of the Rayleigh time");
        }
}

/// A sphere on a rigid wall with a normal and a tangential speed of its centre (along x) and a spin about y.
struct Oblique {
    double tangential = 0.0, normal = 0.0, spin = 0.0;  ///< after it [m/s], [rad/s]
};

Oblique hit_wall(const Elastic& material, double radius, double restitution, double friction, double normal, double tangential,
                 double spin) {
    const physics::Impact hertz{ball_mass(radius, material.density), radius, plane_modulus(material), normal};
    const ImpactOutcome found = collide(dry_room(20.0 * radius, true, against_rigid(material), restitution, friction, normal),
                                        {above_floor(radius, material.density, Vec3(tangential, 0, -normal), Vec3(0, spin, 0))},
                                        physics::hertz_time(hertz) / 200.0);
    return {found.velocity[0].x(), found.velocity[0].z(), found.spin[0].y()};
}

/// Test 4: a sphere of aluminium oxide at 3.9 m/s, which slides throughout above atan(7/2 mu (1 + e)).
namespace oblique {
constexpr double k_radius = 0.0025, k_speed = 3.9, k_friction = 0.092, k_restitution = 0.98, k_sliding_deg = 32.5;

Oblique hit(double angle_deg) {
    const double angle = angle_deg * k_pi / 180.0;
    return hit_wall(k_oxide, k_radius, k_restitution, k_friction, k_speed * std::cos(angle), k_speed * std::sin(angle), 0.0);
}

double tangential_restitution(double angle_deg) {
    return hit(angle_deg).tangential / (k_speed * std::sin(angle_deg * k_pi / 180.0));
}

/// The paper's rebound angle is that of the contact patch [deg].
double patch_angle(double angle_deg) {
    const Oblique after = hit(angle_deg);
    return std::atan2(after.tangential - k_radius * after.spin, after.normal) * 180.0 / k_pi;
}

void check_sliding(Verification& verification) {
    for (const double angle_deg : {35.0, 40.0, 50.0, 60.0, 70.0, 80.0, 85.0}) {
        const double angle = angle_deg * k_pi / 180.0, impulse = k_friction * (1.0 + k_restitution);
        const About about{"ChungOoi2011", "slides throughout: the reference is the closed form; a DEM step of 1/200 of Hertz' time", {}};
        verification.relative(fmt::format("test 4, {} degrees: tangential restitution", angle_deg), "-", tangential_restitution(angle_deg),
                              1.0 - impulse / std::tan(angle), k_closed_form, about);
        verification.relative(fmt::format("test 4, {} degrees: spin", angle_deg), "rad/s", hit(angle_deg).spin,
                              2.5 * impulse * k_speed * std::cos(angle) / k_radius, k_closed_form, about);
    }
}

/// The paper counts the spin against the velocity's direction.
void check_curve(Verification& verification) {
    struct Curve {
        const char *name, *angle, *value, *unit;
        double scale;
        double (*found)(double angle_deg);
    };
    const Curve curves[] = {
        {"tangential restitution", "angle for restitution", "tangential restitution", "-", 1.0, tangential_restitution},
        {"spin over 617 rad/s", "angle for spin", "spin", "rad/s", 617.0, [](double angle_deg) { return -hit(angle_deg).spin; }},
        {"rebound angle over 90 degrees", "angle for rebound", "rebound angle", "deg", 90.0, patch_angle}};
    for (const Curve& curve : curves) {
        const ReferenceTable table = read_reference(case_file("impacts/test4.csv"), {{curve.angle, "deg"}, {curve.value, curve.unit}});
        double slides = 0.0, sticks = 0.0;
        for (std::size_t i = 0; i < table.rows(); ++i) {
            const double angle_deg = table.at(curve.angle)[i];
            double& worst = angle_deg > k_sliding_deg ? slides : sticks;
            worst = larger(worst, std::abs(curve.found(angle_deg) - table.at(curve.value)[i]) / curve.scale);
        }
        verification.at_most(fmt::format("test 4: largest distance of the {}, sliding", curve.name), "-", slides, 0.02,
                             {table.source, "35 to 85 degrees against the digitised curve, of its full scale", {}});
        verification.report(
            fmt::format("test 4: largest distance of the {}, sticking", curve.name), "-", sticks, 0.0,
            {table.source,
             "5 to 30 degrees. The curve is another DEM code's, without micro-slip, and the measurement contradicts it: 0.948 at 5.2 "
             "degrees where 0.746 was measured at 4.2. The measurement is asked for.",
             {}});
    }
}

/// Class fast leaves out the angles at which the sphere sticks in part.
void check_measured(Verification& verification) {
    const ReferenceTable table = read_reference(case_file("impacts/kharaz.csv"), {{"angle", "deg"}, {"tangential restitution", "-"}});
    const About about{
        table.source,
        "against the measured points, alumina on glass. Below 32.5 degrees it sticks in part; there many springs and the glass's own "
        "constants would change the value by less than 0.01",
        {}};
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double angle_deg = table.at("angle")[i];
        if (angle_deg < k_sliding_deg && !verification.wants(Effort::standard)) continue;
        verification.relative(fmt::format("Kharaz' sphere at {} degrees: tangential restitution", angle_deg), "-",
                              tangential_restitution(angle_deg), table.at("tangential restitution")[i], 0.02, about);
    }
}
}  // namespace oblique

/// Steel at 5 m/s, elastic. A sphere that slides throughout (x = V_st/(mu V_n) above 7) has y1 = V_st'/(mu V_n) = x - 7 and the spin 5 mu
/// V_n/R.
void check_constant_normal_speed(Verification& verification) {
    constexpr double radius = 0.01, normal = 5.0, friction = 0.3;
    const auto patch = [&](double x, Oblique& after) {
        after = hit_wall(k_steel, radius, 1.0, friction, normal, x * friction * normal, 0.0);
        return (after.tangential - radius * after.spin) / (friction * after.normal);
    };
    const About sliding{"ChungOoi2011", "steel, elastic, slides throughout: the reference is the closed form", {}};
    Oblique after;
    for (const double x : {8.0, 10.0, 13.0}) {
        verification.relative(fmt::format("test 5, V_st = {} mu V_n: velocity of the contact patch over mu V_n", x), "-", patch(x, after),
                              x - 7.0, 0.02, sliding);
        verification.relative(fmt::format("test 5, V_st = {} mu V_n: spin over mu V_n / R", x), "-",
                              radius * after.spin / (friction * normal), 5.0, 0.02, sliding);
    }
    if (!verification.wants(Effort::standard)) return;
    const ReferenceTable table = read_reference(case_file("impacts/test5.csv"), {{"x", "-"}, {"y1", "-"}});
    double error = 0.0;
    for (std::size_t i = 0; i < table.rows(); ++i) error = larger(error, std::abs(patch(table.at("x")[i], after) - table.at("y1")[i]));
    verification.at_most(
        "test 5: largest distance of the patch's velocity from the finite-element curve, over 5 mu V_n", "-", error / 5.0, 0.02,
        {table.source,
         "9 points, the worst at V_st = 1.19 mu V_n, the others within 0.01. Sixteen times as many springs change it by 0.004: it is what "
         "Cattaneo's and Mindlin's theory and the finite elements differ by.",
         {}});
}

/// Test 6: beta = -V_st'/V_st of a spinning sphere on a wall; test 8: on a sphere of five times its size and a thousand times its density.
struct Spin {
    double wall = 0.0, spheres = 0.0;
};

Spin spin_test(double x) {
    constexpr double radius = 0.1, normal = 0.2, friction = 0.4, restitution = 0.5;
    const double slip = 3.5 * friction * (1.0 + restitution) * normal / x;
    const Oblique after = hit_wall(k_alloy6, radius, restitution, friction, normal, 0.0, -slip / radius);
    const physics::Impact hertz{ball_mass(radius, k_alloy6.density), radius / 1.2, 0.5 * plane_modulus(k_alloy6), normal};
    const ImpactOutcome pair =
        collide(dry_room(4.0, false, k_alloy6, restitution, friction, normal),
                {{radius, k_alloy6.density, Vec3(0, 0, radius * (1.0 + 1e-4)), Vec3(0, 0, -normal), Vec3(0, -slip / radius, 0)},
                 {5.0 * radius, 1000.0 * k_alloy6.density, Vec3(0, 0, -5.0 * radius), Vec3::Zero(), Vec3::Zero()}},
                physics::hertz_time(hertz) / 200.0);
    return {-(after.tangential - radius * after.spin) / slip, -(pair.velocity[0].x() - radius * pair.spin[0].y()) / slip};
}

void check_spin(Verification& verification) {
    const About sliding{
        "ChungOoi2011",
        "aluminium alloy, e = 0.5, slides throughout: the reference is the closed form x - 1; tolerance 3 % of the full scale 1",
        {}};
    for (const double x : {0.1, 0.2, 0.4}) {
        const Spin found = spin_test(x);
        verification.absolute(fmt::format("test 6, x = {}: beta", x), "-", found.wall, x - 1.0, 0.03, sliding);
        verification.absolute(fmt::format("test 8, x = {}: beta", x), "-", found.spheres, x - 1.0, 0.03, sliding);
    }
    if (!verification.wants(Effort::standard)) return;
    const ReferenceTable table = read_reference(case_file("impacts/test6.csv"), {{"x", "-"}, {"beta wall", "-"}, {"beta spheres", "-"}});
    Spin slides, sticks;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const double x = table.at("x")[i];
        const Spin found = spin_test(x);
        Spin& worst = x < 1.0 ? slides : sticks;
        worst.wall = larger(worst.wall, std::abs(found.wall - table.at("beta wall")[i]));
        worst.spheres = larger(worst.spheres, std::abs(found.spheres - table.at("beta spheres")[i]));
    }
    const About slide_note{table.source, "x below 1", {}};
    const About stick_note{table.source,
                           "x above 1. Another DEM code's curve, whose law is not told with the copy; no law that we tried meets it "
                           "(docs/design/006). e = 0.5 here, rock has 0.97.",
                           {}};
    verification.at_most("test 6: largest distance of beta from the curve, sliding", "-", slides.wall, 0.03, slide_note);
    verification.at_most("test 8: largest distance of beta from the curve, sliding", "-", slides.spheres, 0.03, slide_note);
    verification.at_most("test 6: largest distance of beta from the curve, sticking", "-", sticks.wall, 0.03, stick_note);
    verification.at_most("test 8: largest distance of beta from the curve, sticking", "-", sticks.spheres, 0.03, stick_note);
}

void check_gears(Verification& verification) {
    constexpr double radius = 0.1, normal = 0.2, friction = 0.4, x = radius * (1.0 + 1e-4);
    const physics::Impact hertz{0.5 * ball_mass(radius, k_alloy6.density), 0.5 * radius, 0.5 * plane_modulus(k_alloy6), 2.0 * normal};
    double velocity = 0.0, spin = 0.0;
    for (const double ratio : {0.175, 1.0, 5.0, 22.86}) {
        const double given = ratio * friction * normal / radius;
        const ImpactOutcome found = collide(dry_room(2.0, false, k_alloy6, 0.5, friction, 2.0 * normal),
                                            {{radius, k_alloy6.density, Vec3(-x, 0, 0), Vec3(normal, 0, 0), Vec3(0, 0, given)},
                                             {radius, k_alloy6.density, Vec3(x, 0, 0), Vec3(-normal, 0, 0), Vec3(0, 0, -given)}},
                                            physics::hertz_time(hertz) / 200.0);
        for (const Vec3& v : found.velocity) velocity = larger(velocity, std::abs(v.y()) / normal);
        for (const Vec3& w : found.spin) spin = larger(spin, std::abs(std::abs(w.z()) / given - 1.0));
    }
    const About about{"ChungOoi2011", "equal and opposite spins: the surfaces do not slide on each other", {}};
    verification.at_most("test 7: tangential velocity after it over the normal one", "-", velocity, 1e-10, about);
    verification.at_most("test 7: change of spin", "-", spin, 1e-10, about);
}

void run(Verification& verification) {
    const SingleProcess mpi;
    check_elastic(verification);
    check_restitution(verification);
    oblique::check_sliding(verification);
    oblique::check_curve(verification);
    oblique::check_measured(verification);
    check_constant_normal_speed(verification);
    check_spin(verification);
    check_gears(verification);
}

}  // namespace

int main(int argc, char** argv) {
    return verify(argc, argv, run);
}
