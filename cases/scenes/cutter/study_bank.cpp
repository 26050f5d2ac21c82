#include "cases/scenes/cutter/study_bank.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "cases/scenes/cutter/case_builder.hpp"
#include "cases/scenes/cutter/study_case.hpp"
#include "geometry/base/at_work/usual_ranges.hpp"
#include "geometry/base/axis_frame.hpp"
#include "geometry/base/mistakes.hpp"
#include "geometry/cgal/solid_search.hpp"
#include "geometry/head/blade_faces.hpp"
#include "geometry/head/stationary_steel.hpp"
#include "geometry/io/read_surface.hpp"
#include "geometry/surface/contact_surface.hpp"
#include "geometry/surface/soundness.hpp"

namespace cutterflow::cases {
namespace {

// Rock that far from the axis has left the head for good.
constexpr double k_reach_per_ring_radius = 3.0;
constexpr double k_seconds_per_hour = 3600.0;
// Of the surface that rock touches: a fifth of a millimetre on a ring radius of 0.4 m. Its measured error may be twice as large.
constexpr double k_tolerance_per_ring_radius = 5e-4, k_tolerance_per_distance = 0.25;
constexpr double k_edge_per_ring_radius = 0.25;
constexpr double k_measured_per_ring_radius = 0.0125;
constexpr int k_pick_heights = 32;
constexpr double k_patch_per_ring_radius = 0.05;
// Farther off soil holds no rock in the head.
constexpr double k_farthest_soil = 0.5;
constexpr double k_most_solids = 0.3;  // of a mixture that is pumped, by volume

/// Volume of the grains that are cut over that of the mixture that is sucked up.
double solids_share(const Study& study, const CutFigures& figures) {
    return (1.0 - study.bank->porosity) * figures.in_situ / study.suction.discharge;
}

Mistake broken(const ParameterValues& resolved, const char* key, const std::string& rule, const std::string& remedy) {
    return {resolved.where(key), fmt::format("{} = {:.6g}", key, resolved.number(key)), rule, remedy};
}

double reach_of_soil(const HeadSize& size) {
    return k_reach_per_ring_radius * std::max(size.ring_radius, size.tip_radius);
}

/// Height along the vertical of the highest point of the water's cylinder.
double height_of_water(const Study& study, const HeadSize& size) {
    const AxialCylinder water = study.water(size);
    return water.z_max * std::sin(study.inclination) + water.radius * std::cos(study.inclination);
}

void check_shape(const ParameterValues& resolved, const Study& study, const HeadSize& size, const geometry::Bank& bank,
                 Mistakes& mistakes) {
    if (!(study.bank->cut_height < bank.head_height()))
        mistakes.add(broken(resolved, "bank.cut_height_m",
                            fmt::format("The head with picks and clearance is {:.4g} m high, and no swing cuts higher", bank.head_height()),
                            "Lower the bank; higher ones are cut in layers"));
    if (!(bank.top() < height_of_water(study, size)))
        mistakes.add(broken(resolved, "bank.cut_height_m",
                            fmt::format("The bank's top would stand {:.4g} m above the water", bank.top() - height_of_water(study, size)),
                            "Lower the bank, or make the tank larger"));
    if (!(study.bank->step < bank.head_length()))
        mistakes.add(
            broken(resolved, "bank.step_m",
                   fmt::format("The head with picks and clearance is {:.4g} m long in the direction of advance; soil would be left "
                               "between two swings",
                               bank.head_length()),
                   "Make shorter steps"));
    if (!(study.bank->spill_layer < study.bank->cut_height))
        mistakes.add(broken(resolved, "bed.spill_layer_m",
                            fmt::format("What the swing before left would be as high as the bank, {:.4g} m", study.bank->cut_height),
                            "Make the layer thinner; its unit is m"));
    if (!mistakes.empty()) return;
    if (!(bank.width_at_top() >= study.bank->step))
        mistakes.add(broken(resolved, "bank.step_m",
                            fmt::format("At the bank's top, {:.4g} m above its lowest point, the head is {:.4g} m long in the direction of "
                                        "advance: with longer steps soil would overhang",
                                        study.bank->cut_height, bank.width_at_top()),
                            "Make shorter steps or lower bank.cut_height_m"));
}

/// Soil that comes nearer than the clearance to the steel that does not turn.
void check_stationary_steel(const ParameterValues& resolved, const Study& study, const HeadSize& size,
                            const geometry::TriangleSurface& surface, Mistakes& mistakes) {
    const geometry::SolidSearch soil(surface);
    const geometry::StationarySteel steel = geometry::generate_stationary_steel(stationary_steel_of(study, size));
    for (const auto& [name, part] : {std::pair("backplate", &steel.backplate), std::pair("suction pipe", &steel.suction_pipe)}) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& point : part->points) nearest = std::min(nearest, soil.contains(point) ? 0.0 : soil.nearest(point).distance);
        if (nearest > 0.0 && nearest >= study.bank->clearance) continue;
        mistakes.add(broken(resolved, "bank.clearance_m",
                            nearest > 0.0 ? fmt::format("The bank comes within {:.4g} m of the {}", nearest, name)
                                          : fmt::format("The {} would stand in the bank", name),
                            study.bank->file ? "Cut the soil of bank.file back, or shorten the steel behind the head"
                                             : "Lower bank.cut_height_m, make shorter steps, or shorten the steel behind the head"));
    }
}

/// Distance of soil from the head's body of revolution, 0 where they meet: from points of the body to the soil's surface, and whether
/// corners of the soil lie in the body.
double distance_from_head(const geometry::TriangleSurface& surface, const HeadSize& size, const geometry::RevolutionContour& profile) {
    const auto radius_at = [&](double z) {
        const auto above = std::upper_bound(profile.z.begin(), profile.z.end(), z);
        if (above == profile.z.begin() || above == profile.z.end()) return -1.0;
        const auto i = static_cast<std::size_t>(above - profile.z.begin());
        const double share = (z - profile.z[i - 1]) / (profile.z[i] - profile.z[i - 1]);
        return profile.radius[i - 1] + share * (profile.radius[i] - profile.radius[i - 1]);
    };
    for (const Vec3& corner : surface.points)
        if (corner.head<2>().norm() <= radius_at(corner.z())) return 0.0;
    const geometry::SolidSearch soil(surface);
    const double spacing = k_measured_per_ring_radius * size.ring_radius;
    const auto around = static_cast<int>(std::ceil(2.0 * k_pi * size.tip_radius / spacing));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < profile.z.size(); ++i) {
        const double length = std::hypot(profile.z[i + 1] - profile.z[i], profile.radius[i + 1] - profile.radius[i]);
        const int parts = std::max(1, static_cast<int>(std::ceil(length / spacing)));
        for (int part = 0; part < parts; ++part) {
            const double share = (part + 0.5) / parts;
            const double z = profile.z[i] + share * (profile.z[i + 1] - profile.z[i]);
            const double radius = profile.radius[i] + share * (profile.radius[i + 1] - profile.radius[i]);
            for (int k = 0; k < around; ++k) {
                const double azimuth = 2.0 * k_pi * k / around;
                const Vec3 point(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
                if (soil.contains(point)) return 0.0;
                nearest = std::min(nearest, soil.nearest(point).distance);
            }
        }
    }
    return nearest;
}

/// Soil of the user's own beside the head and below the water.
void check_soil_of_file(const ParameterValues& resolved, const Study& study, const HeadSize& size,
                        const geometry::RevolutionContour& profile, const geometry::TriangleSurface& soil, Mistakes& mistakes) {
    const auto refuse = [&](const std::string& rule, const std::string& remedy) {
        mistakes.add({resolved.where("bank.file"), fmt::format("bank.file = \"{}\"", resolved.text("bank.file")), rule, remedy});
    };
    const double distance = distance_from_head(soil, size, profile);
    if (distance == 0.0)
        refuse("The soil cuts the head",
               "Take the head with its clearance out of the soil; the run's frame has the axis along z and the ring plane at z = 0");
    else if (!(distance > profile.error))
        refuse(fmt::format("The soil comes within {:.3g} m of the head, whose contour is known to {:.3g} m", distance, profile.error),
               "Cut the soil back");
    else if (!(distance > study.bank->pick_length))
        refuse(fmt::format("The soil comes within {:.3g} m of the head, whose picks stand out by {:g} m (bank.pick_length_m)", distance,
                           study.bank->pick_length),
               "Cut the soil back, or give the picks their length");
    const Vec3 up(-std::cos(study.inclination), 0.0, std::sin(study.inclination));
    double top = -std::numeric_limits<double>::infinity();
    for (const Vec3& corner : soil.points) top = std::max(top, corner.dot(up));
    if (!(top < height_of_water(study, size)))
        refuse(fmt::format("Its top would stand {:.4g} m above the water", top - height_of_water(study, size)),
               "Lower it, or make the tank larger");
}

/// \throws UserError  when the file holds no surface, or its surface does not close
geometry::TriangleSurface soil_of_file(const std::filesystem::path& file) {
    geometry::TriangleSurface soil = geometry::welded(geometry::read_surface(file));
    geometry::require_sound(geometry::inspect_surface(soil), file.string());
    return soil;
}

}  // namespace

geometry::Bank bank_of(const Study& study, const geometry::Contour& contour) {
    geometry::BankParameters parameters;
    parameters.inclination = study.inclination;
    parameters.swing_sign = study.bank_side();
    parameters.cut_height = study.bank->cut_height;
    parameters.step = study.bank->step;
    parameters.pick_length = study.bank->pick_length;
    parameters.clearance = study.bank->clearance;
    return {contour, parameters};
}

geometry::TriangleSurface bank_surface(const Study& study, const HeadSize& size, const geometry::Contour& contour) {
    return study.bank->file ? soil_of_file(*study.bank->file) : bank_of(study, contour).soil(reach_of_soil(size));
}

namespace {

/// Soil of a file is coarsened as steel is.
MadeWall wall_of_file(const coupling::WallSettings& settings, const geometry::TriangleSurface& soil,
                      const geometry::ContactSurfaceBounds& bounds) {
    const geometry::ContactSurface contact = geometry::contact_surface(soil, bounds);
    return {settings.file,
            contact.surface,
            {settings.name, soil.triangles.size(), contact.surface.triangles.size(), geometry::smallest_angle_of(soil),
             contact.smallest_angle, contact.deviation, bounds.deviation, contact.kept_because}};
}

}  // namespace

MadeWall bank_contact_wall(const Study& study, const HeadSize& size, const geometry::Contour& contour,
                           const geometry::TriangleSurface& soil) {
    const geometry::Bank bank = bank_of(study, contour);
    const double reach = reach_of_soil(size), distance = study.bank->pick_length + study.bank->clearance;
    const double tolerance = std::min(k_tolerance_per_ring_radius * size.ring_radius, k_tolerance_per_distance * distance);
    const coupling::WallSettings settings = bank_wall();
    if (study.bank->file) return wall_of_file(settings, soil, {tolerance, k_edge_per_ring_radius * size.ring_radius});
    MadeWall made{settings.file, bank.wall({reach, tolerance, k_edge_per_ring_radius * size.ring_radius}), {}};
    WallSurfaceReport& report = made.report;
    report.wall = settings.name;
    report.triangles_given = soil.triangles.size();
    report.triangles = made.surface.triangles.size();
    report.smallest_angle_given = geometry::smallest_angle_of(soil);
    report.smallest_angle = geometry::smallest_angle_of(made.surface);
    report.deviation = bank.wall_error(made.surface, soil, reach, k_measured_per_ring_radius * size.ring_radius);
    report.allowed_deviation = 2.0 * tolerance;
    if (report.deviation <= report.allowed_deviation) return made;
    throw CheckFailure({"", fmt::format("the bank that rock touches lies {:.3g} m off its soil", report.deviation),
                        fmt::format("It may lie {:.3g} m off", report.allowed_deviation),
                        "Send the study and the cutter's file to the maintainers"});
}

MadeWall pick_contact_wall(const Study& study, const geometry::Contour& contour, const geometry::TriangleSurface& cutter) {
    const double sense = study.rotation_speed > 0.0 ? 1.0 : -1.0;
    const coupling::WallSettings settings = pick_wall();
    MadeWall made{
        settings.file, geometry::pick_rows(geometry::SolidSearch(cutter), contour, study.bank->pick_length, sense, k_pick_heights), {}};
    if (made.surface.triangles.empty())
        throw UserError("bank.pick_length_m", "Picks stand on the edges of blades, and the cutter has none",
                        "Write bank.pick_length_m = 0");
    WallSurfaceReport& report = made.report;
    report.wall = settings.name;
    report.triangles_given = report.triangles = made.surface.triangles.size();
    report.smallest_angle_given = report.smallest_angle = geometry::smallest_angle_of(made.surface);
    return made;
}

std::vector<Mistake> bank_mistakes(const ParameterValues& resolved, const Study& study, const HeadSize& size,
                                   const geometry::RevolutionContour& profile) {
    if (!study.bank) return {};
    const geometry::Contour contour{profile.z, profile.radius, size.ring_radius, study.suction.gap};
    Mistakes mistakes;
    const double standing_out = study.bank->pick_length + study.bank->clearance;
    if (!(standing_out > profile.error))
        mistakes.add(broken(resolved, "bank.clearance_m",
                            fmt::format("The bank would touch the head: with bank.pick_length_m = {:g} it must be more than {:.3g} m, the "
                                        "error of the contour",
                                        study.bank->pick_length, profile.error - study.bank->pick_length),
                            "Raise it"));
    if (!(standing_out < k_farthest_soil * size.ring_radius)) {
        mistakes.add(
            {resolved.where("bank.clearance_m"), fmt::format("bank.pick_length_m + bank.clearance_m = {:g} m", standing_out),
             fmt::format("Soil begins nearer to the head than {:g} times its ring radius of {:g} m", k_farthest_soil, size.ring_radius),
             "Shorten the picks or the clearance; lengths are in m"});
        return mistakes.take();
    }
    check_shape(resolved, study, size, bank_of(study, contour), mistakes);
    if (!mistakes.empty() && !study.bank->file) return mistakes.take();  // soil of a file does not follow from these keys
    mistakes.gather([&] {
        const geometry::TriangleSurface soil = bank_surface(study, size, contour);
        if (study.bank->file) check_soil_of_file(resolved, study, size, profile, soil, mistakes);
        check_stationary_steel(resolved, study, size, soil, mistakes);
    });
    return mistakes.take();
}

CutFigures cut_figures(const Study& study, const geometry::Contour& contour) {
    const geometry::Bank bank = bank_of(study, contour);
    CutFigures figures;
    figures.section = bank.cut_section();
    for (const geometry::CutFacePatch& patch : bank.cut_face(k_patch_per_ring_radius * contour.ring_radius()).patches)
        figures.depth += patch.depth_m * patch.flux_area_m2 / figures.section;
    figures.swing_speed = study.bank->swing_speed;
    figures.in_situ = figures.swing_speed * figures.section;
    figures.dry = study.bank->grain_density * (1.0 - study.bank->porosity) * figures.in_situ;
    return figures;
}

CutFigures scaled(const CutFigures& figures, double length_ratio) {
    const double flow = std::pow(length_ratio, 2.5);
    return {figures.section * length_ratio * length_ratio, figures.depth * length_ratio, figures.in_situ * flow, figures.dry * flow,
            figures.swing_speed * std::sqrt(length_ratio)};
}

std::vector<Mistake> swing_warnings(const ParameterValues& resolved, const Study& study, const HeadSize& size,
                                    const geometry::Contour& contour) {
    if (!study.bank) return {};
    const CutFigures figures = cut_figures(study, contour);
    const std::string what = fmt::format("swing.speed_m_min = {:.6g}", 60.0 * figures.swing_speed),
                      where = resolved.where("swing.speed_m_min");
    std::vector<Mistake> warnings;
    const double tip = std::abs(study.rotation_speed) * size.tip_radius;
    if (figures.swing_speed > tip)
        warnings.push_back(
            {where, what, fmt::format("The head swings faster than its blades' tips, {:.3g} m/s: they do not cut", tip), "Check it"});
    const double share = solids_share(study, figures);
    if (share > k_most_solids)
        warnings.push_back(
            {where, what,
             fmt::format("Grains of the soil that is cut are {:.3g} % of suction.discharge_m3_s by volume; dredge pumps take "
                         "{:g} % at most",
                         100.0 * share, 100.0 * k_most_solids),
             "Swing more slowly, or cut less: what is not taken in is spilled"});
    return warnings;
}

std::vector<Mistake> practice_warnings(const Study& study, const HeadSize& size) {
    if (!study.bank) return {};
    const double omega = std::abs(study.rotation_speed), mouth = study.suction.mouth_radius, diameter = 2.0 * size.ring_radius;
    const std::vector<std::string> outside =
        outside_usual_ranges({{at_work::k_ring_diameter, diameter},
                              {at_work::k_rotor_speed, 30.0 * omega / k_pi},
                              {at_work::k_tip_speed, omega * size.tip_radius},
                              {at_work::k_swing_speed, 60.0 * study.bank->swing_speed},
                              {at_work::k_step, study.bank->step},
                              {at_work::k_cut_height, study.bank->cut_height / diameter},
                              {at_work::k_ladder, study.inclination * 180.0 / k_pi},
                              {at_work::k_mouth_speed, study.suction.discharge / (k_pi * mouth * mouth)}},
                             study.length_ratio);
    if (outside.empty()) return {};
    return {{"", fmt::format("outside of usual practice: {}", fmt::join(outside, ", ")),
             fmt::format("Values of the prototype, {:g} times as long (scale.length_ratio), by Froude's law; usual ranges in brackets",
                         study.length_ratio),
             "Check scale.length_ratio, and that the point is meant"}};
}

std::string bank_text(const Study& study, const geometry::Contour& contour) {
    if (!study.bank) return "";
    const auto line = [](const char* of, const CutFigures& figures) {
        return fmt::format(
            "{}cut section {:.4g} m2, {:.2g} m below the ring in the mean, swing {:.4g} m/min: {:.4g} m3/h of soil in situ, "
            "{:.4g} t/h of dry grains\n",
            of, figures.section, figures.depth, 60.0 * figures.swing_speed, k_seconds_per_hour * figures.in_situ,
            1e-3 * k_seconds_per_hour * figures.dry);
    };
    const CutFigures figures = cut_figures(study, contour);
    std::string text =
        fmt::format("bank         {:.4g} m high, steps of {:.4g} m, {}\n", study.bank->cut_height, study.bank->step, study.swing_direction);
    if (study.bank->file) text += fmt::format("soil         {}\n", study.bank->file->string());
    text += line("cut          ", figures);
    text += fmt::format("mixture      {:.2g} m of soil in a revolution; {:.3g} % of the discharge by volume if all of it were delivered\n",
                        figures.swing_speed * study.period(), 100.0 * solids_share(study, figures));
    if (study.length_ratio != 1.0) text += line("prototype    ", scaled(figures, study.length_ratio));
    return text;
}

nlohmann::json bank_json(const Study& study, const geometry::Contour& contour) {
    if (!study.bank) return nullptr;
    const auto figures_json = [](const CutFigures& figures) {
        return nlohmann::json{{"cut_section_m2", figures.section},
                              {"mean_depth_m", figures.depth},
                              {"swing_speed_m_s", figures.swing_speed},
                              {"in_situ_m3_s", figures.in_situ},
                              {"dry_kg_s", figures.dry}};
    };
    const CutFigures figures = cut_figures(study, contour);
    return {{"model", figures_json(figures)}, {"prototype", figures_json(scaled(figures, study.length_ratio))}};
}

}  // namespace cutterflow::cases
