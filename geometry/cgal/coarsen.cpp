#include "geometry/cgal/coarsen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/distance.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include "geometry/cgal/convert.hpp"

namespace cutterflow::geometry {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_face_graph_triangle_primitive<Mesh>>>;
using Vertex = Mesh::Vertex_index;
using Edge = Mesh::Edge_index;
using Face = Mesh::Face_index;
using Halfedge = Mesh::Halfedge_index;
using Corners = std::array<Vec3, 3>;

constexpr double k_samples_per_edge = 4.0;  // of the longest length
constexpr double k_longest_edge = 4.0 / 3.0;
constexpr int k_rounds = 12;
constexpr double k_worthwhile_share = 5e-3;        // of all edges that a pass over them must collapse for another one
constexpr double k_least_normal_product = 0.7071;  // an operation may turn a triangle by 45 degrees at most
constexpr double k_least_sliver_product = 0.2;     // a sliver has no reliable normal: compared with the mean of its star
constexpr double k_sliver_angle = 1e-3;
constexpr double k_flat_angle = 1.75;  // 100 degrees
constexpr double k_least_gain = 1e-3;  // [rad] in the smallest angle
constexpr double k_right_angle = 1.5707963267948966;

Vec3 normal_of(const Corners& t) {
    return (t[1] - t[0]).cross(t[2] - t[0]);
}

double angle_at(const Vec3& apex, const Vec3& a, const Vec3& b) {
    const Vec3 to_a = a - apex, to_b = b - apex;
    return std::atan2(to_a.cross(to_b).norm(), to_a.dot(to_b));
}

double smallest_angle(const Corners& t) {
    return std::min({angle_at(t[0], t[1], t[2]), angle_at(t[1], t[2], t[0]), angle_at(t[2], t[0], t[1])});
}

double squared_distance_to_segment(const Vec3& a, const Vec3& b, const Vec3& point) {
    const Vec3 along = b - a;
    const double length2 = along.squaredNorm();
    const double s = length2 > 0.0 ? std::clamp((point - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    return (point - a - s * along).squaredNorm();
}

double squared_distance(const Corners& t, const Vec3& point) {
    const Vec3 normal = normal_of(t);
    bool above = normal.squaredNorm() > 0.0;
    for (int k = 0; above && k < 3; ++k) above = normal.dot((t[(k + 1) % 3] - t[k]).cross(point - t[k])) >= 0.0;
    if (above) {
        const double height = normal.dot(point - t[0]);
        return height * height / normal.squaredNorm();
    }
    return std::min({squared_distance_to_segment(t[0], t[1], point), squared_distance_to_segment(t[1], t[2], point),
                     squared_distance_to_segment(t[2], t[0], point)});
}

class Coarsening {
public:
    Coarsening(const TriangleSurface& surface, const CoarseningBounds& bounds)
        : given_(detail::to_mesh<Mesh::Point>(surface)),
          mesh_(given_),
          bounds_(bounds),
          tree_(faces(given_).begin(), faces(given_).end(), given_) {
        take_samples();
    }

    TriangleSurface run() {
        while (split_all(0.0)) {
        }
        while (static_cast<double>(collapse_all(false)) > k_worthwhile_share * mesh_.number_of_edges()) flip_all();
        gain_ = k_least_gain;
        for (int round = 0; round < k_rounds && has_thin_faces(); ++round) {
            split_all(bounds_.smallest_angle);
            flip_all();
            move_all();
            collapse_all(true);
            flip_all();
        }
        mesh_.collect_garbage();
        return detail::to_surface(mesh_);
    }

private:
    using Samples = std::vector<std::uint32_t>;

    Vec3 at(Vertex v) const {
        const auto& p = mesh_.point(v);
        return {p.x(), p.y(), p.z()};
    }
    Vec3 source(Halfedge h) const { return at(mesh_.source(h)); }
    Vec3 target(Halfedge h) const { return at(mesh_.target(h)); }
    double length(Edge e) const { return (source(mesh_.halfedge(e)) - target(mesh_.halfedge(e))).norm(); }
    double longest() const { return k_longest_edge * bounds_.edge_length; }

    Corners corners(Face f) const {
        const Halfedge h = mesh_.halfedge(f);
        return {source(h), target(h), target(mesh_.next(h))};
    }

    /// Points of the surface, and points along its edges.
    void take_samples() {
        samples_of_.resize(mesh_.num_faces());
        const double spacing = bounds_.edge_length / k_samples_per_edge;
        const auto keep = [&](const Vec3& point, Halfedge beside) {
            const Face face = mesh_.face(mesh_.is_border(beside) ? mesh_.opposite(beside) : beside);
            samples_of_[face].push_back(static_cast<std::uint32_t>(samples_.size()));
            samples_.push_back(point);
        };
        for (const Vertex v : mesh_.vertices())
            if (!mesh_.is_isolated(v)) keep(at(v), mesh_.halfedge(v));
        for (const Edge e : mesh_.edges()) {
            const Halfedge h = mesh_.halfedge(e);
            const int parts = 1 + static_cast<int>(std::ceil(length(e) / spacing));
            for (int k = 1; k < parts; ++k) keep(source(h) + (target(h) - source(h)) * k / parts, h);
        }
    }

    bool is_near(const std::vector<Corners>& triangles, const Vec3& point) const {
        const double reach = bounds_.deviation * bounds_.deviation;
        return std::any_of(triangles.begin(), triangles.end(), [&](const Corners& t) { return squared_distance(t, point) <= reach; });
    }

    bool keep_near(const Samples& samples, const std::vector<Corners>& triangles) const {
        return std::all_of(samples.begin(), samples.end(), [&](std::uint32_t s) { return is_near(triangles, samples_[s]); });
    }

    /// Removes the samples from the faces.
    Samples lift(const std::vector<Face>& faces) {
        Samples lifted;
        for (const Face f : faces) {
            lifted.insert(lifted.end(), samples_of_[f].begin(), samples_of_[f].end());
            samples_of_[f].clear();
        }
        return lifted;
    }

    /// Assigns each sample to the nearest of the faces.
    void lay(const Samples& samples, const std::vector<Face>& faces) {
        samples_of_.resize(mesh_.num_faces());
        std::vector<Corners> triangles;
        for (const Face f : faces) triangles.push_back(corners(f));
        for (const std::uint32_t s : samples) {
            std::size_t best = 0;
            double nearest = std::numeric_limits<double>::max();
            for (std::size_t k = 0; k < triangles.size(); ++k) {
                const double distance = squared_distance(triangles[k], samples_[s]);
                if (distance < nearest) best = k;
                nearest = std::min(nearest, distance);
            }
            samples_of_[faces[best]].push_back(s);
        }
    }

    std::vector<Face> faces_around(Vertex v) const {
        std::vector<Face> faces;
        for (const Halfedge h : CGAL::halfedges_around_target(v, mesh_))
            if (!mesh_.is_border(h)) faces.push_back(mesh_.face(h));
        return faces;
    }

    bool is_thin(Face f) const { return smallest_angle(corners(f)) < bounds_.smallest_angle; }

    bool is_beside_thin(Edge e) const {
        const Halfedge h = mesh_.halfedge(e), o = mesh_.opposite(h);
        return (!mesh_.is_border(h) && is_thin(mesh_.face(h))) || (!mesh_.is_border(o) && is_thin(mesh_.face(o)));
    }

    /// The shortest first; all, or those of thin triangles alone. \return how many
    std::size_t collapse_all(bool thin_only) {
        std::vector<std::pair<double, Edge>> edges;
        for (const Edge e : mesh_.edges())
            if (length(e) < longest() && (!thin_only || is_beside_thin(e))) edges.emplace_back(length(e), e);
        std::sort(edges.begin(), edges.end());
        std::size_t collapsed = 0;
        for (const auto& [at_start, edge] : edges)
            if (!mesh_.is_removed(edge) && collapse(edge)) ++collapsed;
        return collapsed;
    }

    /// Towards the end that leaves the better triangles.
    bool collapse(Edge edge) {
        if (!CGAL::Euler::does_satisfy_link_condition(edge, mesh_)) return false;
        const Halfedge h = mesh_.halfedge(edge);
        const double forward = angle_after_collapse(h);
        const double backward = angle_after_collapse(mesh_.opposite(h));
        if (std::max(forward, backward) < 0.0) return false;
        const Vertex goes = forward >= backward ? mesh_.source(h) : mesh_.target(h);
        const Vec3 stays = forward >= backward ? target(h) : source(h);
        const Samples samples = lift(faces_around(goes));
        const Vertex merged = CGAL::Euler::collapse_edge(edge, mesh_);
        mesh_.point(merged) = {stays.x(), stays.y(), stays.z()};
        lay(samples, faces_around(merged));
        return true;
    }

    /// Effect of moving a vertex on the triangles around it.
    struct Star {
        std::vector<Corners> before, after;
        Vec3 mean = Vec3::Zero();  // sum of the normals before
        Samples samples;
        double angle_before = k_right_angle, angle_after = k_right_angle;  // smallest
        double longest = 0.0;                                              // edge of the vertex
    };

    /// \param merged  the vertex it is merged with, if any: their common triangles vanish
    Star star_of(Vertex goes, const Vec3& to, Vertex merged = Mesh::null_vertex()) const {
        Star star;
        for (const Halfedge around : CGAL::halfedges_around_target(goes, mesh_)) {
            const Face face = mesh_.face(around);
            const Corners old{source(around), target(around), target(mesh_.next(around))};
            star.samples.insert(star.samples.end(), samples_of_[face].begin(), samples_of_[face].end());
            star.angle_before = std::min(star.angle_before, smallest_angle(old));
            star.mean += normal_of(old);
            if (mesh_.source(around) == merged || mesh_.target(mesh_.next(around)) == merged) continue;
            star.before.push_back(old);
            star.after.push_back({old[0], to, old[2]});
            star.longest = std::max(star.longest, (old[0] - to).norm());
            star.angle_after = std::min(star.angle_after, smallest_angle(star.after.back()));
        }
        return star;
    }

    bool keeps_shape(const Star& star) const {
        for (std::size_t k = 0; k < star.after.size(); ++k)
            if (!keeps_direction(star.before[k], star.after[k], star.mean)) return false;
        return keep_near(star.samples, star.after);
    }

    /// Smallest angle of the triangles around the source of h after moving it to the target; -1 if the move is not allowed.
    double angle_after_collapse(Halfedge h) const {
        if (mesh_.is_border(mesh_.source(h))) return -1.0;
        const Star star = star_of(mesh_.source(h), target(h), mesh_.target(h));
        if (star.longest > longest() || star.angle_after < std::min(bounds_.smallest_angle, star.angle_before + gain_)) return -1.0;
        return keeps_shape(star) ? star.angle_after : -1.0;
    }

    /// Moves the corners of triangles with too small an angle to where the smallest angle around them is larger.
    void move_all() {
        for (const Face f : mesh_.faces()) {
            if (!is_thin(f)) continue;
            for (const Vertex v : CGAL::vertices_around_face(mesh_.halfedge(f), mesh_)) move(v);
        }
    }

    void move(Vertex v) {
        if (mesh_.is_border(v)) return;
        std::vector<Vec3> places;
        Vec3 sum = Vec3::Zero();
        for (const Halfedge h : CGAL::halfedges_around_target(v, mesh_)) {
            for (const double share : {0.25, 0.5}) places.push_back(at(v) + share * (source(h) - at(v)));
            sum += source(h);
        }
        places.push_back(sum / (0.5 * static_cast<double>(places.size())));
        Vec3 best = at(v);
        double angle = star_of(v, best).angle_after + k_least_gain;
        for (const Vec3& place : places) {
            const Vec3 on_surface = projected(place);
            const Star star = star_of(v, on_surface);
            if (star.angle_after < angle || star.longest > longest() || !keeps_shape(star)) continue;
            best = on_surface;
            angle = star.angle_after;
        }
        put(v, best);
    }

    /// Nearest point of the given surface.
    Vec3 projected(const Vec3& point) const {
        const auto nearest = tree_.closest_point({point.x(), point.y(), point.z()});
        return {nearest.x(), nearest.y(), nearest.z()};
    }

    void put(Vertex v, const Vec3& place) {
        const std::vector<Face> around = faces_around(v);
        const Samples samples = lift(around);
        mesh_.point(v) = {place.x(), place.y(), place.z()};
        lay(samples, around);
    }

    bool has_thin_faces() const {
        return std::any_of(mesh_.faces().begin(), mesh_.faces().end(), [&](Face f) { return is_thin(f); });
    }

    static bool keeps_direction(const Corners& before, const Corners& after, const Vec3& mean) {
        const bool sliver = smallest_angle(before) < k_sliver_angle;
        const Vec3 reference = sliver ? mean : normal_of(before);
        const double least = sliver ? k_least_sliver_product : k_least_normal_product;
        return normal_of(after).dot(reference) >= least * normal_of(after).norm() * reference.norm();
    }

    bool flip_all() {
        bool changed = false;
        for (const Edge e : mesh_.edges()) changed |= flip(e);
        return changed;
    }

    /// Where the other diagonal has the larger smallest angle.
    bool flip(Edge edge) {
        if (mesh_.is_border(edge)) return false;
        const Halfedge h = mesh_.halfedge(edge);
        const Vertex left = mesh_.target(mesh_.next(h)), right = mesh_.target(mesh_.next(mesh_.opposite(h)));
        if (mesh_.halfedge(left, right) != Mesh::null_halfedge()) return false;
        const Vec3 a = source(h), b = target(h), c = at(left), d = at(right);
        if ((c - d).norm() > longest()) return false;
        const std::vector<Corners> before{{a, b, c}, {b, a, d}}, after{{a, d, c}, {b, c, d}};
        const double gain =
            std::min(smallest_angle(after[0]), smallest_angle(after[1])) - std::min(smallest_angle(before[0]), smallest_angle(before[1]));
        if (gain < k_least_gain) return false;
        const Vec3 mean = normal_of(before[0]) + normal_of(before[1]);
        for (const Corners& t : after)
            if (normal_of(t).dot(mean) < k_least_normal_product * normal_of(t).norm() * mean.norm()) return false;
        const std::vector<Face> faces{mesh_.face(h), mesh_.face(mesh_.opposite(h))};
        if (!is_near(after, 0.5 * (a + b)) || !is_near(before, 0.5 * (c + d)) || !keep_near(samples_of_[faces[0]], after) ||
            !keep_near(samples_of_[faces[1]], after))
            return false;
        const Samples samples = lift(faces);
        CGAL::Euler::flip_edge(h, mesh_);
        lay(samples, {mesh_.face(h), mesh_.face(mesh_.opposite(h))});
        return true;
    }

    /// Divides edges that are too long, and the longest edge of each triangle with an angle below `least_angle`.
    bool split_all(double least_angle) {
        std::vector<Face> bad;
        for (const Face f : mesh_.faces())
            if (smallest_angle(corners(f)) < least_angle || longest_edge(f).second > longest()) bad.push_back(f);
        bool changed = false;
        for (const Face f : bad) {
            const auto [h, size] = longest_edge(f);
            // Dividing a neighbour may have divided this triangle.
            if (smallest_angle(corners(f)) >= least_angle && size <= longest()) continue;
            changed |= split(h);
        }
        return changed;
    }

    std::pair<Halfedge, double> longest_edge(Face f) const {
        std::pair<Halfedge, double> best{mesh_.halfedge(f), 0.0};
        for (const Halfedge h : CGAL::halfedges_around_face(mesh_.halfedge(f), mesh_))
            if (const double size = (target(h) - source(h)).norm(); size > best.second) best = {h, size};
        return best;
    }

    /// In the middle, or at the foot of the apex of a flat triangle.
    bool split(Halfedge h) {
        if (mesh_.is_border(mesh_.edge(h))) return false;
        const Vec3 from = source(h), along = target(h) - source(h);
        if (along.norm() < 2.0 * bounds_.deviation) return false;
        const Vec3 apex = target(mesh_.next(h));
        const bool flat = angle_at(apex, from, from + along) > k_flat_angle;
        const double share = flat ? along.dot(apex - from) / along.squaredNorm() : 0.5;
        const Vec3 middle = from + share * along;
        const Samples samples = lift({mesh_.face(h), mesh_.face(mesh_.opposite(h))});
        const Halfedge half = CGAL::Euler::split_edge(h, mesh_);
        const Vertex added = mesh_.target(half);
        mesh_.point(added) = {middle.x(), middle.y(), middle.z()};
        CGAL::Euler::split_face(half, mesh_.next(h), mesh_);
        CGAL::Euler::split_face(mesh_.opposite(h), mesh_.next(mesh_.opposite(half)), mesh_);
        lay(samples, faces_around(added));
        const Vec3 on_surface = projected(middle);
        if (const Star star = star_of(added, on_surface); star.angle_after > 0.5 * star.angle_before && keeps_shape(star))
            put(added, on_surface);
        return true;
    }

    Mesh given_, mesh_;
    CoarseningBounds bounds_;
    Tree tree_;          // of the given surface
    double gain_ = 0.0;  // what a collapse must add to an angle below the wanted one [rad]
    std::vector<Vec3> samples_;
    std::vector<Samples> samples_of_;  // by face
};

}  // namespace

TriangleSurface coarsened(const TriangleSurface& surface, const CoarseningBounds& bounds) {
    return Coarsening(surface, bounds).run();
}

double surface_distance(const TriangleSurface& a, const TriangleSurface& b, double spacing) {
    namespace pmp = CGAL::Polygon_mesh_processing;
    const auto sampling = pmp::parameters::use_random_uniform_sampling(false).use_grid_sampling(true).grid_spacing(spacing);
    return pmp::approximate_symmetric_Hausdorff_distance<CGAL::Sequential_tag>(detail::to_mesh<Mesh::Point>(a),
                                                                               detail::to_mesh<Mesh::Point>(b), sampling, sampling);
}

}  // namespace cutterflow::geometry
