#include <algorithm>
#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/boost/graph/Euler_operations.h>

#include "geometry/cgal/convert.hpp"
#include "geometry/cgal/remesh.hpp"

namespace cutterflow::geometry {
namespace {

namespace pmp = CGAL::Polygon_mesh_processing;
using Mesh = CGAL::Surface_mesh<CGAL::Exact_predicates_inexact_constructions_kernel::Point_3>;
using Vertex = Mesh::Vertex_index;
using Edge = Mesh::Edge_index;
using Halfedge = Mesh::Halfedge_index;
using Flags = Mesh::Property_map<Edge, bool>;

constexpr unsigned k_remeshing_iterations = 6;
/// Edges shorter than this share of the wanted length are traces of rounding, not shape.
constexpr double k_spurious_edge = 0.02;
constexpr double k_flattest_angle = 3.0543;  // 175 degrees
constexpr double k_thinnest = 50.0;          // longest by shortest side
constexpr int k_thinning_passes = 12;
/// A collapse may turn a triangle by 45 degrees at most.
constexpr double k_least_normal_product = 0.7071;

Vec3 position(const Mesh& mesh, Vertex vertex) {
    const auto& p = mesh.point(vertex);
    return {p.x(), p.y(), p.z()};
}

/// Boolean operations leave points a rounding error apart and points within an edge of rounding size of a line: triangles without
/// direction, which would be taken for features.
void remove_slivers(Mesh& mesh, double length) {
    const double flattest = std::cos(k_flattest_angle);
    pmp::experimental::remove_almost_degenerate_faces(mesh, flattest, k_thinnest, length);
    mesh.collect_garbage();
}

/// The vertices that carry the bounding box: remeshing must not shrink the surface.
std::vector<bool> extreme_vertices(const Mesh& mesh) {
    std::vector<bool> extreme(mesh.num_vertices(), false);
    for (int axis = 0; axis < 3; ++axis) {
        const auto below = [&](Vertex a, Vertex b) { return mesh.point(a)[axis] < mesh.point(b)[axis]; };
        const auto [lowest, highest] = std::minmax_element(mesh.vertices_begin(), mesh.vertices_end(), below);
        extreme[*lowest] = true;
        extreme[*highest] = true;
    }
    return extreme;
}

/// Collapses short edges along feature lines, towards corners where there are any.
class FeatureThinning {
public:
    FeatureThinning(Mesh& mesh, double shortest, double feature_angle_deg)
        : mesh_(mesh), shortest_(shortest), angle_(feature_angle_deg), extreme_(extreme_vertices(mesh)) {}

    void run() {
        for (int pass = 0; pass < k_thinning_passes; ++pass)
            if (!collapse_once()) break;
    }

private:
    /// One pass over the short feature edges, no two of which may share a neighbourhood.
    bool collapse_once() {
        Flags feature = mesh_.add_property_map<Edge, bool>("e:thinning", false).first;
        pmp::detect_sharp_edges(mesh_, angle_, feature);
        std::vector<std::pair<double, Edge>> short_edges;
        for (const Edge edge : mesh_.edges())
            if (feature[edge] && pmp::edge_length(edge, mesh_) < shortest_) short_edges.emplace_back(pmp::edge_length(edge, mesh_), edge);
        std::sort(short_edges.begin(), short_edges.end());
        std::vector<bool> touched(mesh_.num_vertices(), false);
        bool changed = false;
        for (const auto& [length, edge] : short_edges) changed |= collapse(edge, feature, touched);
        mesh_.remove_property_map(feature);
        return changed;
    }

    bool collapse(Edge edge, const Flags& feature, std::vector<bool>& touched) {
        for (const Halfedge h : {mesh_.halfedge(edge), mesh_.opposite(mesh_.halfedge(edge))}) {
            if (touched[mesh_.source(h)] || touched[mesh_.target(h)]) return false;
            if (!is_inner_line_vertex(mesh_.source(h), feature) || !keeps_normals(h)) continue;
            if (!CGAL::Euler::does_satisfy_link_condition(edge, mesh_)) continue;
            for (const Vertex v : CGAL::vertices_around_target(mesh_.opposite(h), mesh_)) touched[v] = true;
            const auto kept = mesh_.point(mesh_.target(h));
            touched[mesh_.target(h)] = true;
            const Vertex merged = CGAL::Euler::collapse_edge(edge, mesh_);
            mesh_.point(merged) = kept;
            // The vertex that remains represents both.
            touched[merged] = true;
            return true;
        }
        return false;
    }

    /// Between two feature edges and removable.
    bool is_inner_line_vertex(Vertex vertex, const Flags& feature) const {
        if (extreme_[vertex]) return false;
        int features = 0;
        for (const Halfedge h : CGAL::halfedges_around_target(vertex, mesh_)) features += feature[mesh_.edge(h)] ? 1 : 0;
        return features == 2;
    }

    /// Whether moving the source of h to its target nearly keeps every triangle's normal.
    bool keeps_normals(Halfedge h) const {
        const Vertex source = mesh_.source(h);
        const Vec3 from = position(mesh_, source);
        const Vec3 to = position(mesh_, mesh_.target(h));
        for (const Halfedge around : CGAL::halfedges_around_target(source, mesh_)) {
            const Vertex a = mesh_.target(mesh_.next(around));
            const Vertex b = mesh_.source(around);
            if (a == mesh_.target(h) || b == mesh_.target(h)) continue;
            const Vec3 pa = position(mesh_, a);
            const Vec3 pb = position(mesh_, b);
            const Vec3 before = (pa - from).cross(pb - from);
            const Vec3 after = (pa - to).cross(pb - to);
            if (before.dot(after) < k_least_normal_product * before.norm() * after.norm()) return false;
        }
        return true;
    }

    Mesh& mesh_;
    double shortest_;
    double angle_;
    std::vector<bool> extreme_;
};

}  // namespace

TriangleSurface with_thinned_features(const TriangleSurface& surface, double shortest_edge, double feature_angle_deg) {
    Mesh mesh = detail::to_mesh<Mesh::Point>(surface);
    remove_slivers(mesh, k_spurious_edge * shortest_edge);
    FeatureThinning(mesh, shortest_edge, feature_angle_deg).run();
    mesh.collect_garbage();
    return detail::to_surface(mesh);
}

TriangleSurface remeshed(const TriangleSurface& surface, double edge_length, double feature_angle_deg) try {
    Mesh mesh = detail::to_mesh<Mesh::Point>(surface);
    Flags feature = mesh.add_property_map<Edge, bool>("e:feature", false).first;
    pmp::detect_sharp_edges(mesh, feature_angle_deg, feature);
    // Remeshing divides no protected edge and requires that none is longer than 4/3 of the target length.
    pmp::split_long_edges(mesh.edges(), 1.3 * edge_length, mesh, pmp::parameters::edge_is_constrained_map(feature));
    auto extreme = mesh.add_property_map<Vertex, bool>("v:extreme", false).first;
    const std::vector<bool> extremes = extreme_vertices(mesh);
    for (const Vertex v : mesh.vertices()) extreme[v] = extremes[v];
    pmp::isotropic_remeshing(
        mesh.faces(), edge_length, mesh,
        pmp::parameters::edge_is_constrained_map(feature).protect_constraints(true).vertex_is_constrained_map(extreme).number_of_iterations(
            k_remeshing_iterations));
    mesh.collect_garbage();
    remove_slivers(mesh, k_spurious_edge * edge_length);
    return detail::to_surface(mesh);
} catch (const CGAL::Failure_exception&) {
    // An assertion inside the remeshing: not all feature edges could be kept.
    throw CheckFailure({"", "the surface cannot be remeshed", "Feature lines must not nearly coincide", "Change the sizes a little"});
}

}  // namespace cutterflow::geometry
