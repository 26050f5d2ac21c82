#include "meshing/room/room_mesh_plan.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "geometry/cgal/solid_search.hpp"

namespace cutterflow::meshing {
namespace {

constexpr double k_most_cells = 5e6;
constexpr double k_level_tolerance = 0.05;  // a cell that is hardly too large is not halved once more
constexpr double k_thin_share = 0.95;       // of a cell, below which a solid is thinner than it
constexpr int k_samples = 4;                // per edge of a background cell, for the prediction
constexpr int k_places = 11;                // along the room's edges, at which the medium is looked for
constexpr double k_off_grid = 0.4137;       // of the distance between such places
// Core seconds of the mesh stage: start of its programs, and per cell, with snappyHexMesh and without (docs/design/017-rooms.md).
constexpr double k_stage_s = 2.0, k_cut_s_per_cell = 1.5e-4, k_plain_s_per_cell = 2e-5;

struct Contains {
    const Vec3& place;
    bool operator()(const MeshBox& box) const {
        return (place.array() >= box.lower.array()).all() && (place.array() <= box.upper.array()).all();
    }
    bool operator()(const MeshCylinder& cylinder) const {
        const Vec3 axis = cylinder.to - cylinder.from;
        const double along = (place - cylinder.from).dot(axis) / axis.squaredNorm();
        return along >= 0.0 && along <= 1.0 && (place - cylinder.from - along * axis).norm() <= cylinder.radius;
    }
};

int level_of(double background, double wanted) {
    return std::max(0, static_cast<int>(std::ceil(std::log2(background / wanted) - k_level_tolerance)));
}

int level_at(const RoomMeshPlan& plan, const Vec3& place) {
    int level = 0;
    for (std::size_t i = 0; i < plan.levels.size(); ++i)
        if (contains(plan.input.refinements[i].part, place)) level = std::max(level, plan.levels[i]);
    return level;
}

/// Cells of the box, from samples of the level; each halving makes eight of one.
double count_cells(const RoomMeshPlan& plan) {
    const double all = static_cast<double>(plan.cells[0]) * plan.cells[1] * plan.cells[2];
    if (plan.levels.empty()) return all;
    double sum = 0.0;
    const Vec3 step = plan.cell_size / k_samples;
    for (int k = 0; k < k_samples * plan.cells[2]; ++k)
        for (int j = 0; j < k_samples * plan.cells[1]; ++j)
            for (int i = 0; i < k_samples * plan.cells[0]; ++i)
                sum += std::pow(8.0, level_at(plan, plan.input.lower + step.cwiseProduct(Vec3(i + 0.5, j + 0.5, k + 0.5))));
    return sum / (k_samples * k_samples * k_samples);
}

/// Smallest distance to solids and sides; negative in a solid.
double clearance(const std::vector<geometry::SolidSearch>& solids, const RoomMeshInput& input, const Vec3& place) {
    double least = std::min((place - input.lower).minCoeff(), (input.upper - place).minCoeff());
    for (const geometry::SolidSearch& solid : solids)
        least = std::min(least, (solid.contains(place) ? -1.0 : 1.0) * solid.nearest(place).distance);
    return least;
}

Vec3 place_in_medium(const RoomMeshInput& input) {
    std::vector<geometry::SolidSearch> solids;
    for (const RoomMeshSolid& solid : input.solids) solids.emplace_back(solid.surface);
    const Vec3 step = (input.upper - input.lower) / k_places;
    Vec3 best = input.lower;
    double widest = 0.0;
    for (int k = 0; k < k_places; ++k)
        for (int j = 0; j < k_places; ++j)
            for (int i = 0; i < k_places; ++i) {
                const Vec3 place = input.lower + step.cwiseProduct(Vec3(i + k_off_grid, j + k_off_grid, k + k_off_grid));
                const double free = clearance(solids, input, place);
                if (free <= widest) continue;
                widest = free;
                best = place;
            }
    if (widest == 0.0)
        throw UserError("the room's solids leave no place for its medium", "The mesh is what they leave of the room",
                        "Make the room larger, or set fluid = false for solids that grains alone feel");
    return best;
}

/// Corners of the box around a part.
std::pair<Vec3, Vec3> bounds_of(const MeshPart& part) {
    if (const auto* box = std::get_if<MeshBox>(&part)) return {box->lower, box->upper};
    const auto& cylinder = std::get<MeshCylinder>(part);
    const Vec3 margin = Vec3::Constant(cylinder.radius);
    return {cylinder.from.cwiseMin(cylinder.to) - margin, cylinder.from.cwiseMax(cylinder.to) + margin};
}

/// Whether the centre of a face of one side lies in the patch's part. Where solids cut the cells this is an estimate.
bool has_face(const RoomMeshPlan& plan, const RoomMeshPatch& patch, std::size_t side) {
    const auto axis = static_cast<Eigen::Index>(side / 2), a = (axis + 1) % 3, b = (axis + 2) % 3;
    const auto [from, to] = bounds_of(*patch.part);
    Vec3 place = 0.5 * (from + to);
    place[axis] = (side % 2 == 0 ? plan.input.lower : plan.input.upper)[axis];
    const Vec3 face = plan.cell_size * std::ldexp(1.0, -level_at(plan, place));
    const auto first = [&](Eigen::Index along) { return std::floor((from[along] - plan.input.lower[along]) / face[along]) + 0.5; };
    for (double i = first(a); plan.input.lower[a] + i * face[a] <= to[a]; ++i)
        for (double j = first(b); plan.input.lower[b] + j * face[b] <= to[b]; ++j) {
            place[a] = plan.input.lower[a] + i * face[a];
            place[b] = plan.input.lower[b] + j * face[b];
            if (contains(*patch.part, place)) return true;
        }
    return false;
}

/// \throws UserError  with every patch that is too small for the cells
void require_faces(const RoomMeshPlan& plan) {
    std::vector<Mistake> mistakes;
    for (const RoomMeshPatch& patch : plan.input.patches) {
        const auto found = [&](std::size_t side) { return has_face(plan, patch, side); };
        if (!patch.part || std::any_of(patch.sides.begin(), patch.sides.end(), found)) continue;
        mistakes.push_back({"", fmt::format("{} is too small for the cells", patch.name), "A boundary has the centre of a face in it",
                            "Take smaller cells there ([[room.refine]]), or make it larger"});
    }
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
}

}  // namespace

bool contains(const MeshPart& part, const Vec3& place) {
    return std::visit(Contains{place}, part);
}

double RoomMeshPlan::cell_at(const Vec3& at) const {
    return std::ldexp(background_cell(), -level_at(*this, at));
}

double RoomMeshPlan::smallest_cell() const {
    const int finest = levels.empty() ? 0 : *std::max_element(levels.begin(), levels.end());
    return std::ldexp(background_cell(), -finest);
}

RoomMeshPlan plan_room_mesh(const RoomMeshInput& input) {
    RoomMeshPlan plan;
    plan.input = input;
    const Vec3 size = input.upper - input.lower;
    double background = 1.0;
    for (int axis = 0; axis < 3; ++axis) background *= std::max(1.0, std::round(size[axis] / input.cell));
    const auto refuse_above = [](double cells) {
        if (cells > k_most_cells)
            throw UserError(fmt::format("the mesh has {:.3g} cells", cells), fmt::format("A room has at most {:g}", k_most_cells),
                            "Make room.cell_m or the cells of [[room.refine]] larger");
    };
    refuse_above(background);
    for (int axis = 0; axis < 3; ++axis) {
        plan.cells[axis] = std::max(1, static_cast<int>(std::lround(size[axis] / input.cell)));
        plan.cell_size[axis] = size[axis] / plan.cells[axis];
    }
    if (plan.cells[0] * plan.cells[1] * plan.cells[2] == 1)
        throw UserError(fmt::format("the mesh is one cell of {:g} m", input.cell), "A room has several", "Make room.cell_m smaller");
    for (const RoomMeshRefinement& one : input.refinements) plan.levels.push_back(level_of(plan.background_cell(), one.cell));
    for (const RoomMeshSolid& solid : input.solids) plan.solid_volume += geometry::volume_of(solid.surface);
    plan.medium_volume = size.prod() - plan.solid_volume;
    plan.predicted_cells = count_cells(plan) * plan.medium_volume / size.prod();
    refuse_above(plan.predicted_cells);
    plan.predicted_core_s = k_stage_s + plan.predicted_cells * (plan.is_cut() ? k_cut_s_per_cell : k_plain_s_per_cell);
    if (plan.is_cut()) plan.place = place_in_medium(input);
    require_faces(plan);
    return plan;
}

std::vector<Mistake> room_mesh_warnings(const RoomMeshPlan& plan) {
    std::vector<Mistake> warnings;
    for (const RoomMeshSolid& solid : plan.input.solids) {
        double coarsest = 0.0;
        for (const Vec3& point : solid.surface.points) coarsest = std::max(coarsest, plan.cell_at(point));
        if (solid.thinnest > 0.0 && solid.thinnest < k_thin_share * coarsest)
            warnings.push_back({"", fmt::format("{} is {:g} m thin in cells of {:g} m", solid.name, solid.thinnest, coarsest),
                                "It stays, with the thickness and edges that the cells allow", "Add [[room.refine]] around it"});
    }
    return warnings;
}

}  // namespace cutterflow::meshing
