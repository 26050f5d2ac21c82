#include "geometry/head/geometry_report.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "geometry/base/statistics/sample.hpp"

namespace cutterflow::geometry {
namespace {

using nlohmann::json;

constexpr double k_degrees = 180.0 / k_pi;
constexpr std::size_t k_volumes_told = 5;

json vector_json(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

const char* name_of_sense(CarryingSense sense) {
    switch (sense) {
        case CarryingSense::positive:
            return "positive";
        case CarryingSense::negative:
            return "negative";
        case CarryingSense::none:
            return "none";
    }
    return "";
}

json defect_json(const Defect& defect) {
    json places = json::array();
    for (const Vec3& place : defect.places) places.push_back(vector_json(place));
    return {{"count", defect.count}, {"triangles", defect.triangles}, {"places_m", places}};
}

json surface_json(const SoundnessReport& report) {
    json components = json::array();
    for (const SurfaceComponent& component : report.components)
        components.push_back({{"triangles", component.triangles}, {"area_m2", component.area}, {"volume_m3", component.volume}});
    return {{"points", report.points},
            {"triangles", report.triangles},
            {"volume_m3", report.volume},
            {"area_m2", report.area},
            {"bounds_m", {{"min", vector_json(report.bounds.min)}, {"max", vector_json(report.bounds.max)}}},
            {"closed", report.closed()},
            {"consistently_oriented", report.consistently_oriented()},
            {"outward", report.outward()},
            {"components", components}};
}

json defects_json(const SoundnessReport& report) {
    return {{"degenerate_triangles", defect_json(report.degenerate_triangles)},
            {"duplicate_triangles", defect_json(report.duplicate_triangles)},
            {"border_edges", defect_json(report.border_edges)},
            {"non_manifold_edges", defect_json(report.non_manifold_edges)},
            {"misoriented_edges", defect_json(report.misoriented_edges)},
            {"non_manifold_points", defect_json(report.non_manifold_points)},
            {"self_intersections", defect_json(report.self_intersections)}};
}

json blades_json(const std::vector<BladeSlice>& blades) {
    json slices = json::array();
    for (const BladeSlice& slice : blades)
        slices.push_back(
            {{"z_m", slice.z}, {"angle_deg", slice.angle * k_degrees}, {"coverage", slice.coverage}, {"depth_m", slice.depth}});
    return slices;
}

json head_json(const Head& head) {
    return {{"axis", {{"origin_m", vector_json(head.axis.origin)}, {"direction", vector_json(head.axis.direction)}}},
            {"blades", head.symmetry.blade_count},
            {"symmetry", {{"residual_m", head.symmetry.residual}, {"contrast", head.symmetry.contrast}}},
            {"ring_radius_m", head.ring_radius},
            {"lowest_z_m", head.lowest_z},
            {"steel_above_ring_m", head.steel_above_ring},
            {"passage_m", head.passage ? json(*head.passage) : json()},
            {"thickness_m", head.thickness},
            {"carrying", {{"sense", name_of_sense(head.carrying.sense)}, {"measure", head.carrying.measure}}},
            {"blade_slices", blades_json(head.blades)},
            {"contour", {{"nodes", head.contour.z.size()}, {"error_m", head.contour.error}}}};
}

/// Volumes of the largest of several components, so that one that floats beside the head is seen.
std::string volumes_text(const std::vector<SurfaceComponent>& components) {
    if (components.size() < 2) return "";
    std::vector<double> volumes;
    volumes.reserve(components.size());
    for (const SurfaceComponent& component : components) volumes.push_back(component.volume);
    const bool all = volumes.size() <= k_volumes_told;
    if (!all) volumes.resize(k_volumes_told);
    return fmt::format(" of {:.3g}{} m3", fmt::join(volumes, ", "), all ? "" : " ...");
}

/// The ladder from which on rock slides off most of the blades [rad]: the angle that half of the slices with blades exceed.
double middle_angle(const std::vector<BladeSlice>& blades) {
    std::vector<double> angles;
    for (const BladeSlice& slice : blades)
        if (slice.coverage < 1.0) angles.push_back(slice.angle);
    return angles.empty() ? 0.0 : median(std::move(angles));
}

std::string blades_text(const std::vector<BladeSlice>& blades) {
    if (blades.empty()) return "";
    std::string text =
        "blades by depth below the ring: angle with the axis, share of the circumference that they close, their depth along the radius\n";
    for (auto slice = blades.rbegin(); slice != blades.rend(); ++slice)
        text += fmt::format("  {:>8.4g} m  {:>5.1f} deg  {:>5.1f} %  {:>8.4g} m\n", -slice->z, slice->angle * k_degrees,
                            100.0 * slice->coverage, slice->depth);
    const double middle = middle_angle(blades) * k_degrees;
    return text + fmt::format("rock slides towards the ring on most of the rising blades where the ladder is flatter than {:.0f} degrees\n",
                              std::max(0.0, middle));
}

std::string head_text(const Head& head) {
    const Vec3& o = head.axis.origin;
    const Vec3& d = head.axis.direction;
    std::string text = fmt::format("axis         origin ({:.5g}, {:.5g}, {:.5g}) m, direction ({:.6f}, {:.6f}, {:.6f}), hub to ring\n",
                                   o.x(), o.y(), o.z(), d.x(), d.y(), d.z());
    text += fmt::format("blades       {} (RMS distance from symmetry {:.3g} m)\n", head.symmetry.blade_count, head.symmetry.residual);
    text += fmt::format("ring radius  {:.5g} m\nhead height  {:.5g} m\n", head.ring_radius, -head.lowest_z);
    if (head.passage) text += fmt::format("passage      {:.4g} m: the largest rock that gets between two blades\n", *head.passage);
    text += fmt::format("thickness    {:.4g} m where the steel is thinnest\n", head.thickness);
    text += fmt::format("contour      {} nodes, error {:.3g} m\n", head.contour.z.size(), head.contour.error);
    text += fmt::format("carries rock to the suction side for rotation: {} (measure {:.3g})\n", name_of_sense(head.carrying.sense),
                        head.carrying.measure);
    text += blades_text(head.blades);
    if (head.steel_above_ring > 0.0) text += fmt::format("steel stands out {:.4g} m above the ring plane\n", head.steel_above_ring);
    return text;
}

}  // namespace

GeometryInspection inspect_cutter(const ImportedSurface& imported, const std::string& file) {
    GeometryInspection inspection{file, imported.unit, inspect_surface(imported.surface), std::nullopt};
    if (!inspection.soundness.sound()) return inspection;
    try {
        inspection.head = understand_head(imported.surface);
    } catch (const UserError& error) {
        inspection.no_head = error.mistakes();
    }
    return inspection;
}

void require_head(const GeometryInspection& inspection) {
    require_sound(inspection.soundness, inspection.file);
    if (inspection.head) return;
    std::vector<Mistake> mistakes = inspection.no_head;
    for (Mistake& mistake : mistakes) mistake.where = inspection.file;
    throw UserError(std::move(mistakes));
}

json to_json(const GeometryInspection& inspection) {
    json result{
        {"file", inspection.file},
        {"unit", {{"name", name_of(inspection.unit.unit)}, {"detected", inspection.unit.detected}, {"reason", inspection.unit.reason}}},
        {"surface", surface_json(inspection.soundness)},
        {"defects", defects_json(inspection.soundness)},
        {"sound", inspection.soundness.sound()}};
    if (inspection.head) result["head"] = head_json(*inspection.head);
    for (const Mistake& mistake : inspection.no_head) result["no_head"].push_back(mistake.text());
    return result;
}

std::string to_text(const GeometryInspection& inspection) {
    const SoundnessReport& report = inspection.soundness;
    const auto yes = [](bool value) { return value ? "yes" : "no"; };
    const Bounds& b = report.bounds;
    std::string text = fmt::format("file         {}\nunit         {}\n", inspection.file, inspection.unit.reason);
    text += fmt::format("surface      {} triangles, {} points, {} component(s){}\n", report.triangles, report.points,
                        report.components.size(), volumes_text(report.components));
    text += fmt::format("closed {}, outward {}, self-intersections {}\n", yes(report.closed()),
                        yes(report.consistently_oriented() && report.outward()), report.self_intersections.count);
    text += fmt::format("volume       {:.5g} m3\narea         {:.5g} m2\n", report.volume, report.area);
    text += fmt::format("bounds       ({:.5g}, {:.5g}, {:.5g}) to ({:.5g}, {:.5g}, {:.5g}) m\n", b.min.x(), b.min.y(), b.min.z(), b.max.x(),
                        b.max.y(), b.max.z());
    if (inspection.head) text += head_text(*inspection.head);
    return text;
}

}  // namespace cutterflow::geometry
