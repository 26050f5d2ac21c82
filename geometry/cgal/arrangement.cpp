// Cascading intersections of constraints are rare here.
#define CGAL_NO_CDT_2_WARNING

#include "geometry/cgal/arrangement.hpp"

#include <algorithm>
#include <map>
#include <set>

#include <boost/variant/get.hpp>

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/intersections.h>

#include "geometry/base/error.hpp"
#include "geometry/surface/topology.hpp"

namespace cutterflow::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Point = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<Kernel, CGAL::Default, CGAL::Exact_intersections_tag>;

/// Cuts of a group of triangles in one plane.
struct Cuts {
    std::vector<Point> points;
    std::vector<Segment> segments;
    void add_polygon(const std::vector<Point>& corners) {
        for (std::size_t k = 0; k < corners.size(); ++k) segments.emplace_back(corners[k], corners[(k + 1) % corners.size()]);
    }
    void add(const Cuts& other) {
        points.insert(points.end(), other.points.begin(), other.points.end());
        segments.insert(segments.end(), other.segments.begin(), other.segments.end());
    }
};

/// A plane projected along one coordinate axis, exactly.
class PlaneView {
public:
    explicit PlaneView(const Kernel::Triangle_3& triangle) : plane_(triangle.supporting_plane()) {
        const double a = std::abs(CGAL::to_double(plane_.a()));
        const double b = std::abs(CGAL::to_double(plane_.b()));
        const double c = std::abs(CGAL::to_double(plane_.c()));
        along_ = a >= b && a >= c ? 0 : (b >= c ? 1 : 2);
    }
    Kernel::Point_2 seen(const Point& p) const { return {p[(along_ + 1) % 3], p[(along_ + 2) % 3]}; }
    Point lifted(const Kernel::Point_2& p) const {
        const Kernel::FT normal[3] = {plane_.a(), plane_.b(), plane_.c()};
        const int u = (along_ + 1) % 3;
        const int v = (along_ + 2) % 3;
        Kernel::FT coordinates[3];
        coordinates[u] = p.x();
        coordinates[v] = p.y();
        coordinates[along_] = -(normal[u] * p.x() + normal[v] * p.y() + plane_.d()) / normal[along_];
        return {coordinates[0], coordinates[1], coordinates[2]};
    }

private:
    Kernel::Plane_3 plane_;
    int along_ = 0;
};

class Arranger {
public:
    explicit Arranger(const TriangleSurface& surface)
        : surface_(surface), cuts_(surface.triangles.size()), groups_(surface.triangles.size()) {}

    Arrangement run(const std::vector<std::pair<std::size_t, std::size_t>>& crossing) {
        std::vector<bool> is_cut(surface_.triangles.size(), false);
        for (const auto& [i, j] : crossing) {
            is_cut[i] = is_cut[j] = true;
            intersect(i, j);
        }
        result_.points = surface_.points;
        std::map<std::size_t, std::vector<std::size_t>> members;
        for (std::size_t t = 0; t < surface_.triangles.size(); ++t) {
            if (is_cut[t]) {
                members[groups_.root(t)].push_back(t);
            } else {
                result_.facets.push_back({surface_.triangles[t], t, 1});
            }
        }
        for (const auto& [root, group] : members)
            for (const std::size_t t : group)
                for (const std::uint32_t corner : surface_.triangles[t]) index_at_.try_emplace(point(corner), corner);
        for (const auto& [root, group] : members) divide(group);
        return std::move(result_);
    }

private:
    Point point(std::uint32_t index) const {
        const Vec3& p = surface_.points[index];
        return {p.x(), p.y(), p.z()};
    }
    Kernel::Triangle_3 triangle(std::size_t t) const {
        const Triangle& corners = surface_.triangles[t];
        return {point(corners[0]), point(corners[1]), point(corners[2])};
    }

    /// Records the common part of two triangles as cuts of both.
    void intersect(std::size_t i, std::size_t j) {
        const auto common = CGAL::intersection(triangle(i), triangle(j));
        if (!common) return;
        Cuts cuts;
        if (const Point* p = boost::get<Point>(&*common)) cuts.points.push_back(*p);
        if (const Segment* s = boost::get<Segment>(&*common)) cuts.segments.push_back(*s);
        if (const Kernel::Triangle_3* t = boost::get<Kernel::Triangle_3>(&*common)) {
            cuts.add_polygon({t->vertex(0), t->vertex(1), t->vertex(2)});
            groups_.unite(i, j);
        }
        if (const std::vector<Point>* polygon = boost::get<std::vector<Point>>(&*common)) {
            cuts.add_polygon(*polygon);
            groups_.unite(i, j);
        }
        cuts_[i].add(cuts);
        cuts_[j].add(cuts);
    }

    std::uint32_t index_of(const Point& p) {
        const auto [found, is_new] = index_at_.try_emplace(p, static_cast<std::uint32_t>(result_.points.size()));
        if (is_new) {
            CGAL::exact(p);
            result_.points.emplace_back(CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z()));
        }
        return found->second;
    }

    /// Divides triangles that overlap in one plane by one triangulation.
    void divide(const std::vector<std::size_t>& group) {
        const PlaneView view(triangle(group.front()));
        Triangulation triangulation;
        std::vector<Kernel::Triangle_2> outlines;
        for (const std::size_t t : group) {
            const Triangle& corners = surface_.triangles[t];
            outlines.emplace_back(view.seen(point(corners[0])), view.seen(point(corners[1])), view.seen(point(corners[2])));
            for (int k = 0; k < 3; ++k) triangulation.insert_constraint(outlines.back()[k], outlines.back()[k + 1]);
            for (const Segment& s : cuts_[t].segments)
                if (!s.is_degenerate()) triangulation.insert_constraint(view.seen(s.source()), view.seen(s.target()));
            for (const Point& p : cuts_[t].points) triangulation.insert(view.seen(p));
        }
        std::map<Triangulation::Vertex_handle, std::uint32_t> index;
        for (const auto vertex : triangulation.finite_vertex_handles()) index[vertex] = index_of(view.lifted(vertex->point()));
        for (const auto face : triangulation.finite_face_handles()) {
            const Kernel::Point_2 inside = CGAL::centroid(face->vertex(0)->point(), face->vertex(1)->point(), face->vertex(2)->point());
            Facet facet{{index[face->vertex(0)], index[face->vertex(1)], index[face->vertex(2)]}, 0, 0};
            // Faces of the triangulation are counter-clockwise in the projection; a counter-clockwise triangle has the same sense.
            for (std::size_t m = 0; m < group.size(); ++m) {
                if (outlines[m].bounded_side(inside) != CGAL::ON_BOUNDED_SIDE) continue;
                facet.multiplicity += outlines[m].orientation() == CGAL::COUNTERCLOCKWISE ? 1 : -1;
                facet.parent = group[m];
            }
            if (facet.multiplicity != 0) result_.facets.push_back(facet);
        }
    }

    const TriangleSurface& surface_;
    std::vector<Cuts> cuts_;
    DisjointSets groups_;
    Arrangement result_;
    std::map<Point, std::uint32_t> index_at_;
};

}  // namespace

Arrangement arrange(const TriangleSurface& surface, const std::vector<std::pair<std::size_t, std::size_t>>& crossing) try {
    return Arranger(surface).run(crossing);
} catch (const CGAL::Failure_exception& failure) {
    throw CheckFailure({"", "the triangles cannot be divided along their intersections", failure.message(), "Repair the surface in CAD"});
}

}  // namespace cutterflow::geometry
