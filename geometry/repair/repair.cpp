#include "geometry/repair/repair.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/cgal/self_intersections.hpp"
#include "geometry/repair/holes.hpp"
#include "geometry/repair/orientation.hpp"
#include "geometry/repair/outer_boundary.hpp"
#include "geometry/repair/seams.hpp"
#include "geometry/repair/welding.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry::repair {
namespace {

constexpr std::size_t k_holes_named = 5;
/// Patching costs the cube of it.
constexpr std::size_t k_most_hole_points = 1500;
constexpr int k_tidying_passes = 8;
/// Separated points must not be welded again when the result is repaired a second time.
constexpr double k_parting_per_weld_distance = 3.0;
/// Closed crumbs that exact arithmetic leaves where walls nearly coincide.
constexpr double k_crumb_volume = 1e-6;
/// Heights of triangles below this share of the largest coordinate are the rounding of single precision (2^-24 each way for three points).
constexpr double k_rounding = 3e-7;

double largest_coordinate(const TriangleSurface& surface) {
    double largest = 0.0;
    for (const Vec3& p : surface.points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
    return largest;
}

TracedSurface rounded_to_single(TracedSurface traced) {
    for (Vec3& p : traced.surface.points) p = p.cast<float>().cast<double>();
    return traced;
}

/// For each triangle the number of its sheet: triangles connected over edges of exactly two.
std::vector<std::size_t> sheet_roots(const TriangleSurface& surface, const std::vector<EdgeUse>& uses) {
    DisjointSets sheets(surface.triangles.size());
    for_each_edge(uses, [&](auto first, auto last) {
        if (last - first == 2) sheets.unite(first->triangle, std::next(first)->triangle);
    });
    std::vector<std::size_t> roots(surface.triangles.size());
    for (std::size_t t = 0; t < roots.size(); ++t) roots[t] = sheets.root(t);
    return roots;
}

std::string point_text(const Vec3& p) {
    return fmt::format("({:.5g}, {:.5g}, {:.5g}) m", p.x(), p.y(), p.z());
}

bool is_closed(const TriangleSurface& surface) {
    bool closed = !surface.triangles.empty();
    for_each_edge(sorted_edge_uses(surface), [&](auto first, auto last) { closed = closed && last - first == 2; });
    return closed;
}

/// Ends a repair.
struct Refused {
    std::vector<Mistake> mistakes;
    std::map<std::string, std::vector<std::size_t>> triangles;  ///< by kind of defect, of the surface before the step
};

class Repair {
public:
    Repair(const TriangleSurface& surface, const RepairLimits& limits, std::string name) : name_(std::move(name)) {
        outcome_.limits = limits;
        outcome_.before = inspect_surface(surface);
        outcome_.result.surface = surface;
        for (std::size_t t = 0; t < surface.triangles.size(); ++t) outcome_.result.source.push_back(static_cast<std::int64_t>(t));
        area_ = area_of(surface);
        volume_ = enclosed_volume(surface);
    }

    RepairOutcome run() && {
        try {
            go();
        } catch (const Refused& refused) {
            outcome_.refusals = refused.mistakes;
            note_bad_faces(refused.triangles);
        } catch (const CheckFailure& failure) {
            outcome_.refusals = {{name_, "the repair does not come to its end", failure.what(), "Mend the surface in CAD"}};
            note_bad_faces({{"crossing", crossing_triangles()}});
        }
        return std::move(outcome_);
    }

private:
    const TracedSurface& now() const { return outcome_.result; }
    const RepairLimits& limits() const { return outcome_.limits; }

    void go() {
        take("weld points", "points joined", weld_points(now(), limits().weld_distance),
             fmt::format("nearer than {:.3g} m", limits().weld_distance));
        take("drop flat triangles", "triangles", drop_flat_triangles(now(), limits().weld_distance));
        take("drop duplicates", "triangles", drop_duplicates(now()));
        require_something();
        take("join seams", "edges divided", join_seams(now(), limits().weld_distance),
             fmt::format("borders nearer than {:.3g} m", limits().weld_distance));
        take("drop hanging sheets", "triangles", drop_hanging_sheets(now()));
        require_something();
        take("orient faces", "triangles flipped", orient_consistently(now()));
        require_orientable();
        const Filled filled = close_holes();
        take("orient outwards", "triangles flipped", orient_outwards(now()));
        require_change_within(filled.uncertain_volume, volume_, limits().volume_change,
                              "the patches of all holes leave {} of the volume uncertain", "--volume-change-percent",
                              {{"hole", added_triangles()}});
        resolve_self_intersections();
        unite_shells();
        tidy();
        drop_cavities();
        outcome_.after = inspect_surface(now().surface);
        require_sound_result();
    }

    RepairStep& take(const std::string& step_name, const std::string& counted, const Stepped& stepped, const std::string& remark = {}) {
        const double area = area_of(stepped.traced.surface);
        const double volume = enclosed_volume(stepped.traced.surface);
        outcome_.steps.push_back({step_name, counted, stepped.count, volume - volume_, area - area_, remark});
        outcome_.result = stepped.traced;
        area_ = area;
        volume_ = volume;
        return outcome_.steps.back();
    }

    void require_something() const {
        if (now().surface.triangles.empty())
            throw Refused{{{name_, "nothing is left after flat, duplicate and hanging triangles are dropped",
                            "The surface must bound a solid", "Export the solid's surface"}},
                          {}};
    }

    /// \param what    with {} where the share goes
    /// \param option  of the command that raises the limit; empty when none does
    /// \throws Refused  when `change` is more than the share `limit` of `whole`
    void require_change_within(double change, double whole, double limit, const std::string& what, const std::string& option,
                               std::map<std::string, std::vector<std::size_t>> where) const {
        if (std::abs(change) <= limit * std::abs(whole)) return;
        std::string place = "";
        for (const auto& [kind, triangles] : where)
            if (place.empty() && !triangles.empty())
                place = fmt::format(", the first at {}, face {}",
                                    point_text(centroid_of(now().surface, now().surface.triangles[triangles.front()])),
                                    now().source[triangles.front()]);
        const std::string share = fmt::format("{:.3g} %", 100.0 * std::abs(change) / std::abs(whole));
        throw Refused{{{name_, fmt::format(fmt::runtime(what), share) + place, fmt::format("The limit is {:.3g} %", 100.0 * limit),
                        option.empty() ? "Mend it in CAD" : fmt::format("Mend it in CAD, or raise {}", option)}},
                      std::move(where)};
    }

    void require_orientable() const {
        std::vector<std::size_t> misoriented;
        for_each_edge(sorted_edge_uses(now().surface), [&](auto first, auto last) {
            if (last - first == 2 && first->ascending == std::next(first)->ascending)
                misoriented.insert(misoriented.end(), {first->triangle, std::next(first)->triangle});
        });
        if (misoriented.empty()) return;
        throw Refused{{{name_,
                        fmt::format("the surface has one side only: neighbours of opposite orientation remain at {}, face {}",
                                    point_text(centroid_of(now().surface, now().surface.triangles[misoriented.front()])),
                                    now().source[misoriented.front()]),
                        "The boundary of a solid has an inner and an outer side", "Mend it in CAD"}},
                      {{"misoriented", misoriented}}};
    }

    /// Triangles of the patches.
    std::vector<std::size_t> added_triangles() const {
        std::vector<std::size_t> added;
        for (std::size_t t = 0; t < now().source.size(); ++t)
            if (now().source[t] == k_added) added.push_back(t);
        return added;
    }

    Filled close_holes() {
        const std::vector<Hole> holes = find_holes(now().surface);
        refuse_large_holes(holes);
        const Filled filled = fill_holes(now(), holes);
        refuse_unpatched(filled.left_open);
        std::map<std::string, std::vector<std::size_t>> where{{"hole", {}}};
        double largest = 0.0;
        for (const Hole& hole : holes) {
            where["hole"].insert(where["hole"].end(), hole.triangles.begin(), hole.triangles.end());
            largest = std::max(largest, hole.size);
        }
        require_change_within(filled.area, area_, limits().area_change, "the patches of all holes make up {} of the area",
                              "--area-change-percent", where);
        take("fill holes", "holes", {filled.traced, filled.count},
             filled.count == 0 ? std::string()
                               : fmt::format("largest {:.3g} m (limit {:.3g} m), patches {:.3g} m2, uncertain volume {:.3g} m3", largest,
                                             limits().hole_size, filled.area, filled.uncertain_volume));
        return filled;
    }

    void refuse_large_holes(std::vector<Hole> holes) const {
        holes.erase(
            std::remove_if(holes.begin(), holes.end(),
                           [&](const Hole& hole) { return hole.size <= limits().hole_size && hole.points.size() <= k_most_hole_points; }),
            holes.end());
        if (holes.empty()) return;
        std::sort(holes.begin(), holes.end(), [](const Hole& a, const Hole& b) { return a.size > b.size; });
        Refused refused;
        for (const Hole& hole : holes) {
            std::vector<std::size_t>& bad = refused.triangles["hole"];
            bad.insert(bad.end(), hole.triangles.begin(), hole.triangles.end());
            if (refused.mistakes.size() == k_holes_named) continue;
            refused.mistakes.push_back(
                {name_,
                 fmt::format("a hole of {:.3g} m with {} edges about {}, at face {}{}", hole.size, hole.points.size(),
                             point_text(hole.middle), now().source[hole.triangles.front()],
                             refused.mistakes.empty() ? fmt::format(", the largest of {} that are too large", holes.size()) : ""),
                 fmt::format("Holes up to {:.3g} m and {} edges are filled", limits().hole_size, k_most_hole_points),
                 "Close it in CAD, or raise --hole-size-m"});
        }
        throw refused;
    }

    void refuse_unpatched(const std::vector<Hole>& holes) const {
        if (holes.empty()) return;
        throw Refused{{{name_,
                        fmt::format("no patch fits the hole about {}, at face {}", point_text(holes.front().middle),
                                    now().source[holes.front().triangles.front()]),
                        "A hole must be spanned by triangles between its own points", "Close it in CAD"}},
                      {{"hole", holes.front().triangles}}};
    }

    std::vector<std::size_t> crossing_triangles() const {
        std::vector<std::size_t> triangles;
        for (const auto& [i, j] : find_self_intersections(now().surface)) triangles.insert(triangles.end(), {i, j});
        std::sort(triangles.begin(), triangles.end());
        triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
        return triangles;
    }

    /// Each closed shell that crosses itself becomes its own outer boundary.
    void resolve_self_intersections() {
        const std::vector<EdgeUse> uses = sorted_edge_uses(now().surface);
        const std::vector<std::size_t> sheet = sheet_roots(now().surface, uses);
        std::vector<bool> crosses_itself(sheet.size(), false);
        std::map<std::string, std::vector<std::size_t>> where{{"crossing", {}}};
        std::size_t pairs = 0;
        for (const auto& [i, j] : find_self_intersections(now().surface)) {
            if (sheet[i] != sheet[j]) continue;
            crosses_itself[sheet[i]] = true;
            where["crossing"].insert(where["crossing"].end(), {i, j});
        }
        std::vector<bool> as_it_is(sheet.size());
        for (std::size_t t = 0; t < sheet.size(); ++t) as_it_is[t] = !crosses_itself[sheet[t]];
        TracedSurface resolved = selected(now(), as_it_is);
        for (std::size_t root = 0; root < sheet.size(); ++root) {
            if (!crosses_itself[root]) continue;
            std::vector<bool> in_sheet(sheet.size());
            for (std::size_t t = 0; t < sheet.size(); ++t) in_sheet[t] = sheet[t] == root;
            TracedSurface shell = selected(now(), in_sheet);
            if (is_closed(shell.surface) && volume_of(shell.surface) > 0.0) {
                const Stepped boundary = outer_boundary(shell);
                shell = boundary.traced;
                pairs += boundary.count;
            }
            append(resolved, shell);
        }
        if (pairs == 0) {
            take("resolve self-intersections", "pairs of triangles", {now(), 0});
            return;
        }
        require_change_within(volume_of(resolved.surface) - volume_, volume_, limits().volume_change,
                              "resolving the self-intersections changes the volume by {}", "--volume-change-percent", where);
        require_change_within(area_of(resolved.surface) - area_, area_, limits().area_change,
                              "resolving the self-intersections changes the area by {}", "--area-change-percent", where);
        take("resolve self-intersections", "pairs of triangles", {rewelded(resolved), pairs});
    }

    static void append(TracedSurface& to, const TracedSurface& from) {
        to.surface = joined({to.surface, from.surface});
        to.source.insert(to.source.end(), from.source.begin(), from.source.end());
    }

    /// Points of equal coordinates made one again.
    static TracedSurface rewelded(const TracedSurface& traced) { return {welded(traced.surface), traced.source}; }

    void unite_shells() {
        const std::vector<EdgeUse> uses = sorted_edge_uses(now().surface);
        const std::vector<std::size_t> sheet = sheet_roots(now().surface, uses);
        std::size_t shells = 0;
        for (std::size_t t = 0; t < sheet.size(); ++t) shells += sheet[t] == t ? 1 : 0;
        const std::vector<std::size_t> crossing = crossing_triangles();
        if (shells == 1 && crossing.empty()) {
            take("unite shells", "shells", {now(), 1});
            return;
        }
        const Stepped united = outer_boundary(now());
        if (united.traced.surface.triangles.empty())
            throw Refused{{{name_, "the surface encloses no volume", "It must bound a solid", "Export the solid's surface"}},
                          {{"crossing", crossing}}};
        const double volume = volume_of(united.traced.surface);
        require_change_within(volume - volume_, volume_, limits().overlap, "uniting the shells changes the sum of their volumes by {}", "",
                              {{"crossing", crossing}});
        take("unite shells", "shells", {united.traced, shells}, fmt::format("{} pairs of triangles crossed", united.count));
    }

    /// Rounds to the single precision of an STL and repairs the defects of rounding, until nothing crosses.
    void tidy() {
        const double before = volume_;
        Stepped tidied{rounded_to_single(now()), 0};
        double height = k_rounding * largest_coordinate(now().surface);
        for (int pass = 0; pass < k_tidying_passes; ++pass) {
            const Stepped joined_points = weld_points(tidied.traced, height);
            const Stepped high = drop_flat_triangles(joined_points.traced, height);
            const Stepped single = drop_duplicates(high.traced);
            const Stepped seamed = join_seams(single.traced, 2.0 * height);
            const Stepped parted = part_touching_points(seamed.traced, k_parting_per_weld_distance * limits().weld_distance);
            tidied = {rounded_to_single(parted.traced),
                      tidied.count + joined_points.count + high.count + single.count + seamed.count + parted.count};
            if (is_closed(tidied.traced.surface) && find_self_intersections(tidied.traced.surface).empty()) break;
            tidied.traced = rounded_to_single(outer_boundary(tidied.traced).traced);
            // A remaining crossing is a sliver slightly higher than the last limit.
            height = std::min(2.0 * height, std::max(height, 0.5 * limits().weld_distance));
        }
        require_change_within(volume_of(tidied.traced.surface) - before, before, limits().volume_change,
                              "rounding changes the volume by {}", "--volume-change-percent", {});
        take("round to single precision", "points and triangles touched", tidied, "the precision of a binary STL");
    }

    /// Drops closed components inside the solid, and crumbs.
    void drop_cavities() {
        const std::vector<EdgeUse> uses = sorted_edge_uses(now().surface);
        const std::vector<std::size_t> number = component_numbers(now().surface, uses);
        std::vector<double> volume;
        const Vec3 origin = bounds_of(now().surface).min;
        for (std::size_t t = 0; t < number.size(); ++t) {
            if (number[t] == volume.size()) volume.push_back(0.0);
            volume[number[t]] +=
                area_vector(now().surface, now().surface.triangles[t]).dot(now().surface.points[now().surface.triangles[t][0]] - origin) /
                3.0;
        }
        std::vector<bool> keep(number.size());
        std::map<std::string, std::vector<std::size_t>> where{{"cavity", {}}};
        for (std::size_t t = 0; t < number.size(); ++t) {
            keep[t] = volume[number[t]] > k_crumb_volume * volume_;
            if (volume[number[t]] < -k_crumb_volume * volume_) where["cavity"].push_back(t);
        }
        double dropped = 0.0;
        std::size_t count = 0;
        for (const double v : volume) {
            if (v > k_crumb_volume * volume_) continue;
            dropped += std::abs(v);
            ++count;
        }
        require_change_within(dropped, volume_, limits().volume_change, "closed cavities have {} of the volume", "--volume-change-percent",
                              where);
        take("fill cavities", "cavities and crumbs", {selected(now(), keep), count});
        require_something();
    }

    void require_sound_result() const {
        if (outcome_.after.sound()) return;
        const SoundnessReport& r = outcome_.after;
        const std::vector<Mistake> defects = defects_of(in_numbers_of_the_file(r), name_ + ", after all steps");
        throw Refused{defects,
                      {{"hole", r.border_edges.triangles},
                       {"edge_of_many", r.non_manifold_edges.triangles},
                       {"misoriented", r.misoriented_edges.triangles},
                       {"touching_point", r.non_manifold_points.triangles},
                       {"crossing", r.self_intersections.triangles},
                       {"flat", r.degenerate_triangles.triangles},
                       {"duplicate", r.duplicate_triangles.triangles}}};
    }

    /// The report with triangles as the file numbers them.
    SoundnessReport in_numbers_of_the_file(SoundnessReport report) const {
        for (Defect* defect : {&report.degenerate_triangles, &report.duplicate_triangles, &report.border_edges, &report.non_manifold_edges,
                               &report.misoriented_edges, &report.non_manifold_points, &report.self_intersections})
            for (std::size_t& triangle : defect->triangles)
                triangle = static_cast<std::size_t>(std::max<std::int64_t>(0, now().source[triangle]));
        return report;
    }

    void note_bad_faces(const std::map<std::string, std::vector<std::size_t>>& by_kind) {
        std::vector<bool> is_bad(now().surface.triangles.size(), false);
        for (const auto& [kind, triangles] : by_kind)
            for (const std::size_t t : triangles) is_bad[t] = true;
        outcome_.bad_faces.faces = selected(now(), is_bad);
        for (const auto& [kind, triangles] : by_kind) {
            if (triangles.empty()) continue;
            std::vector<bool> has(is_bad.size(), false);
            for (const std::size_t t : triangles) has[t] = true;
            std::vector<std::int64_t>& flags = outcome_.bad_faces.defects[kind];
            for (std::size_t t = 0; t < is_bad.size(); ++t)
                if (is_bad[t]) flags.push_back(has[t] ? 1 : 0);
        }
    }

    std::string name_;
    RepairOutcome outcome_;
    double volume_ = 0.0;
    double area_ = 0.0;
};

}  // namespace

RepairLimits default_limits(const TriangleSurface& surface) {
    const double extent = bounds_of(surface).extent().maxCoeff();
    RepairLimits limits;
    limits.weld_distance = std::max(k_weld_distance_per_extent * extent, k_rounding * largest_coordinate(surface));
    limits.hole_size = k_hole_size_per_extent * extent;
    return limits;
}

RepairOutcome repair_surface(const TriangleSurface& surface, const RepairLimits& limits, const std::string& name) {
    return Repair(surface, limits, name).run();
}

}  // namespace cutterflow::geometry::repair
