#include "geometry/surface/soundness.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "geometry/cgal/self_intersections.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry {
namespace {

constexpr std::size_t k_places = 5;

void add(Defect& defect, const std::vector<std::size_t>& triangles, const Vec3& place) {
    ++defect.count;
    defect.triangles.insert(defect.triangles.end(), triangles.begin(), triangles.end());
    if (defect.places.size() < k_places) defect.places.push_back(place);
}

void sort_out(Defect& defect) {
    std::sort(defect.triangles.begin(), defect.triangles.end());
    defect.triangles.erase(std::unique(defect.triangles.begin(), defect.triangles.end()), defect.triangles.end());
}

void find_triangle_defects(const TriangleSurface& surface, SoundnessReport& report) {
    const double length = report.bounds.extent().maxCoeff();
    std::set<Triangle> known;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const Triangle& triangle = surface.triangles[t];
        if (area_vector(surface, triangle).norm() <= 1e-14 * length * length)
            add(report.degenerate_triangles, {t}, centroid_of(surface, triangle));
        Triangle sorted = triangle;
        std::sort(sorted.begin(), sorted.end());
        if (!known.insert(sorted).second) add(report.duplicate_triangles, {t}, centroid_of(surface, triangle));
    }
}

void find_edge_defects(const TriangleSurface& surface, const std::vector<EdgeUse>& uses, SoundnessReport& report) {
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i;
        std::vector<std::size_t> triangles;
        while (end < uses.size() && uses[end].same_edge(uses[i])) triangles.push_back(uses[end++].triangle);
        const Vec3 middle = 0.5 * (surface.points[uses[i].low] + surface.points[uses[i].high]);
        if (triangles.size() == 1) add(report.border_edges, triangles, middle);
        if (triangles.size() > 2) add(report.non_manifold_edges, triangles, middle);
        if (triangles.size() == 2 && uses[i].ascending == uses[i + 1].ascending) add(report.misoriented_edges, triangles, middle);
        i = end;
    }
}

void find_components(const TriangleSurface& surface, const std::vector<EdgeUse>& uses, SoundnessReport& report) {
    const std::vector<std::size_t> number = component_numbers(surface, uses);
    const Vec3 origin = report.bounds.min;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        if (number[t] == report.components.size()) report.components.emplace_back();
        SurfaceComponent& component = report.components[number[t]];
        const Vec3 area = area_vector(surface, surface.triangles[t]);
        ++component.triangles;
        component.area += area.norm();
        component.volume += area.dot(surface.points[surface.triangles[t][0]] - origin) / 3.0;
    }
    std::stable_sort(report.components.begin(), report.components.end(),
                     [](const SurfaceComponent& a, const SurfaceComponent& b) { return a.area > b.area; });
}

/// Triangles around each point must form one fan: be connected over edges that end in the point.
void find_point_defects(const TriangleSurface& surface, const std::vector<EdgeUse>& uses, SoundnessReport& report) {
    const std::vector<std::size_t> fan_of = fans_of_corners(surface, uses);
    std::vector<std::set<std::size_t>> fans(surface.points.size());
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) fans[surface.triangles[t][k]].insert(fan_of[3 * t + k]);
    for (std::size_t p = 0; p < fans.size(); ++p) {
        if (fans[p].size() < 2) continue;
        std::vector<std::size_t> triangles;
        for (const std::size_t corner : fans[p]) triangles.push_back(corner / 3);
        add(report.non_manifold_points, triangles, surface.points[p]);
    }
}

std::string place_text(const Defect& defect) {
    const Vec3& p = defect.places.front();
    return fmt::format("the first at ({:.5g}, {:.5g}, {:.5g}) m, triangle {}", p.x(), p.y(), p.z(), defect.triangles.front());
}

}  // namespace

bool SoundnessReport::outward() const {
    return !components.empty() &&
           std::all_of(components.begin(), components.end(), [](const SurfaceComponent& component) { return component.volume > 0.0; });
}

bool SoundnessReport::sound() const {
    return defects_of(*this, "").empty();
}

SoundnessReport inspect_surface(const TriangleSurface& surface) {
    SoundnessReport report;
    report.points = surface.points.size();
    report.triangles = surface.triangles.size();
    report.bounds = bounds_of(surface);
    report.area = area_of(surface);
    report.volume = volume_of(surface);
    const std::vector<EdgeUse> uses = sorted_edge_uses(surface);
    find_triangle_defects(surface, report);
    find_edge_defects(surface, uses, report);
    find_components(surface, uses, report);
    find_point_defects(surface, uses, report);
    for (const auto& [i, j] : find_self_intersections(surface))
        add(report.self_intersections, {i, j}, centroid_of(surface, surface.triangles[i]));
    for (Defect* defect : {&report.degenerate_triangles, &report.duplicate_triangles, &report.border_edges, &report.non_manifold_edges,
                           &report.misoriented_edges, &report.non_manifold_points, &report.self_intersections})
        sort_out(*defect);
    return report;
}

std::vector<Mistake> defects_of(const SoundnessReport& report, const std::string& name) {
    std::vector<Mistake> mistakes;
    const auto state = [&](const Defect& defect, const std::string& what, const std::string& rule, const std::string& remedy) {
        if (defect.count > 0) mistakes.push_back({name, fmt::format("{} {}, {}", defect.count, what, place_text(defect)), rule, remedy});
    };
    const std::string export_again = "Export it from CAD as one watertight solid";
    state(report.degenerate_triangles, "triangle(s) without area", "Every triangle must have an area", export_again);
    state(report.duplicate_triangles, "duplicate triangle(s)", "Each triangle may appear once", export_again);
    state(report.border_edges, "open edge(s)", "The surface must be closed", "Close the hole in CAD, or export with joined faces");
    state(report.non_manifold_edges, "edge(s) with more than two triangles", "Every edge must join two triangles",
          "Unite touching bodies into one solid");
    state(report.misoriented_edges, "edge(s) between triangles of opposite orientation", "All triangles must face outwards",
          "Unify the surface's normals in CAD");
    state(report.non_manifold_points, "point(s) where the surface touches itself", "Around each point the triangles must form one fan",
          "Unite or separate the bodies that touch there");
    state(report.self_intersections, "pair(s) of triangles intersect", "The surface must not cross itself",
          "Unite overlapping bodies into one solid");
    if (!report.closed() || !report.consistently_oriented()) return mistakes;
    for (std::size_t i = 0; i < report.components.size(); ++i) {
        const SurfaceComponent& component = report.components[i];
        if (component.volume > 0.0) continue;
        mistakes.push_back({name,
                            fmt::format("component {} of {} ({} triangles) is inside out: its volume is {:.4g} m3", i + 1,
                                        report.components.size(), component.triangles, component.volume),
                            "Triangles must be counter-clockwise seen from outside",
                            "Flip its normals in CAD, or remove it if it is a cavity"});
    }
    return mistakes;
}

void require_sound(const SoundnessReport& report, const std::string& name) {
    std::vector<Mistake> mistakes = defects_of(report, name);
    if (mistakes.empty()) return;
    mistakes.back().remedy += fmt::format(". Or try: cutterflow repair \"{}\" -o repaired.stl", name);
    throw UserError(std::move(mistakes));
}

}  // namespace cutterflow::geometry
