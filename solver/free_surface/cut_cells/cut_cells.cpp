#include "solver/free_surface/cut_cells/cut_cells.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/base/axis_frame.hpp"
#include "solver/free_surface/kernel.hpp"
#include "solver/free_surface/mirror.hpp"

namespace cutterflow::free_surface {

namespace {

constexpr double k_wholly_covered = 1.0 - 1e-12;  // share of a cell
constexpr KernelWeights k_across_plane{-1, {0.0, 1.0, 0.0}};
constexpr int k_lines = 16;  // through a cell for its open volume, and through a face in space: what stands still is covered once

/// Covered share of a segment of a line.
double covered_share(const std::vector<StillSolid>& solids, const Line& line, const Interval& segment) {
    std::vector<Interval> parts;
    for (const StillSolid& solid : solids) {
        for (const Interval& part : covered_parts(solid, line)) {
            const Interval within = common(part, segment);
            if (within.length() > 0.0) parts.push_back(within);
        }
    }
    return parts.empty() ? 0.0 : union_length(std::move(parts)) / segment.length();
}

/// Mean covered share of parallel lines in a rectangle or box.
double covered_share(const std::vector<StillSolid>& solids, int along, const Vec3& from, const Vec3& to, const std::array<int, 3>& lines) {
    double sum = 0.0;
    int count = 0;
    Line line{along, from};
    const int a = (along + 1) % 3, b = (along + 2) % 3;
    for (int m = 0; m < lines[a]; ++m) {
        line.through[a] = from[a] + (m + 0.5) / lines[a] * (to[a] - from[a]);
        for (int n = 0; n < lines[b]; ++n) {
            line.through[b] = from[b] + (n + 0.5) / lines[b] * (to[b] - from[b]);
            sum += covered_share(solids, line, {from[along], to[along]});
            ++count;
        }
    }
    return sum / count;
}

struct Corners {
    Vec3 from, to;
};

Corners corners(const StaggeredGrid& grid, int i, int j, int k) {
    const Vec3 from(i * grid.width(0), j * grid.width(1), k * grid.width(2));
    return {from, from + Vec3(grid.width(0), grid.width(1), grid.width(2))};
}

/// Cells that a body may touch, clipped to the tank.
struct CellRange {
    std::array<int, 3> from{}, to{};  ///< to: one beyond
};

CellRange range_of(const StaggeredGrid& grid, const SolidBox& box) {
    CellRange range;
    for (int d = 0; d < 3; ++d) {
        const double low = std::clamp(box.from[d], 0.0, grid.extent(d)), high = std::clamp(box.to[d], 0.0, grid.extent(d));
        range.from[d] = std::clamp(static_cast<int>(std::floor(low / grid.width(d))), 0, grid.cells(d));
        range.to[d] = std::clamp(static_cast<int>(std::ceil(high / grid.width(d))), 0, grid.cells(d));
    }
    return range;
}

CellRange range_of(const StaggeredGrid& grid, const Body& body) {
    SolidBox around{body.position.array() - body.radius, body.position.array() + body.radius};
    if (!body.sphere) {
        around.from.y() = 0.0;
        around.to.y() = grid.extent(1);
    }
    return range_of(grid, around);
}

/// Faces of a direction within the tank at the cells of a range.
CellRange faces_of(const StaggeredGrid& grid, CellRange range, int d) {
    range.to[d] = std::min(range.to[d] + 1, grid.cells(d));
    range.from[d] = std::max(range.from[d], 1);  // the tank's walls stay walls
    return range;
}

/// Share of a box, or of a face of one, that a solid box covers; touching it covers a face.
double covered_share(const SolidBox& solid, const Vec3& from, const Vec3& to) {
    constexpr double touching = 1e-9;  // [m]
    double share = 1.0;
    for (int d = 0; d < 3; ++d) {
        if (to[d] <= from[d]) {
            if (from[d] < solid.from[d] - touching || from[d] > solid.to[d] + touching) return 0.0;
        } else {
            share *= common({solid.from[d], solid.to[d]}, {from[d], to[d]}).length() / (to[d] - from[d]);
        }
    }
    return share < touching ? 0.0 : share;
}

/// The gate with the first sliver of its opening, in the cell where its lower edge is, given to it.
SolidBox without_sliver(const StaggeredGrid& grid, SolidBox gate) {
    const double h = grid.spacing(), edge = gate.from.z() / h, floor = std::floor(edge + 1e-9);
    if (edge - floor < k_smallest_gate_opening) gate.from.z() = floor * h;
    return gate;
}

template <typename Visit>
void for_each_in(const CellRange& range, const Visit& visit) {
    for (int k = range.from[2]; k < range.to[2]; ++k) {
        for (int j = range.from[1]; j < range.to[1]; ++j) {
            for (int i = range.from[0]; i < range.to[0]; ++i) visit(i, j, k);
        }
    }
}

/// Covered shares of the parts of a cell: k_parts in each direction of the grid.
using PartShares = std::array<double, k_parts * k_parts * k_parts>;

struct Parts {
    int across = 1;  ///< in y
    int count() const { return k_parts * k_parts * across; }
};

Parts parts_of(const StaggeredGrid& grid) {
    return {grid.is_plane() ? 1 : k_parts};
}

/// Calls visit(number, centre, size) for the parts of the cell from a corner on.
template <typename Visit>
void for_each_part(const StaggeredGrid& grid, const Vec3& from, const Visit& visit) {
    const Parts parts = parts_of(grid);
    const Vec3 size(grid.width(0) / k_parts, grid.width(1) / parts.across, grid.width(2) / k_parts);
    int number = 0;
    for (int k = 0; k < k_parts; ++k) {
        for (int j = 0; j < parts.across; ++j) {
            for (int i = 0; i < k_parts; ++i) visit(number++, Vec3(from + Vec3(i + 0.5, j + 0.5, k + 0.5).cwiseProduct(size)), size);
        }
    }
}

/// Takes a share of a part of a cell, or of the cell, from the room of the kernels around it, ghosts too.
void take_room(const StaggeredGrid& grid, int cell, double share, const std::array<const KernelWeights*, 3>& weights, CellField& room) {
    for (int c = 0; c < 3; ++c) {
        for (int b = 0; b < 3; ++b) {
            const double weight = share * weights[2]->weight[c] * weights[1]->weight[b];
            if (weight <= 0.0) continue;
            double* row = room.data() + cell + (b - 1) * grid.stride(1) + (c - 1) * grid.stride(2);
            for (int a = 0; a < 3; ++a) row[a - 1] -= weight * weights[0]->weight[a];
        }
    }
}

/// Takes the covered parts of a cell.
void take_room(const StaggeredGrid& grid, int cell, const PartShares& shares, CellField& room) {
    static const std::array<KernelWeights, k_parts> weights{part_weights(0), part_weights(1), part_weights(2), part_weights(3)};
    const Parts parts = parts_of(grid);
    int number = 0;
    for (int k = 0; k < k_parts; ++k) {
        for (int j = 0; j < parts.across; ++j) {
            for (int i = 0; i < k_parts; ++i) {
                const double share = shares[number++] / parts.count();
                if (share > 0.0)
                    take_room(grid, cell, share, {&weights[i], grid.is_plane() ? &k_across_plane : &weights[j], &weights[k]}, room);
            }
        }
    }
}

/// Takes a covered share of a cell, the same in all of its parts.
void take_room(const StaggeredGrid& grid, int cell, double share, CellField& room) {
    static const KernelWeights whole{-1, {1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0}};
    take_room(grid, cell, share, {&whole, grid.is_plane() ? &k_across_plane : &whole, &whole}, room);
}

/// Ghosts repeat the cell next to them.
void repeat_in_ghosts(const StaggeredGrid& grid, CellField& field) {
    const auto nearest = [&](int n, int d) { return std::clamp(n, 0, grid.cells(d) - 1); };
    const int j_from = grid.is_plane() ? 0 : -1, j_to = grid.is_plane() ? 1 : grid.cells(1) + 1;
    for (int k = -1; k <= grid.cells(2); ++k) {
        for (int j = j_from; j < j_to; ++j) {
            const bool edge_row = k < 0 || k == grid.cells(2) || j < 0 || j == grid.cells(1);
            for (int i = -1; i <= grid.cells(0); i += (edge_row ? 1 : grid.cells(0) + 1)) {
                field[grid.at(i, j, k)] = field[grid.at(nearest(i, 0), nearest(j, 1), nearest(k, 2))];
            }
        }
    }
}

}  // namespace

double covered_volume(const Body& body, const Vec3& from, const Vec3& to) {
    Vec3 low = from - body.position, high = to - body.position;
    if (!body.sphere) low.y() = high.y() = 0.0;
    const Vec3 farthest = low.cwiseAbs().cwiseMax(high.cwiseAbs()), nearest = low.cwiseMax(0.0) + high.cwiseMin(0.0);
    const double volume = (to - from).prod(), square = body.radius * body.radius;
    if (farthest.squaredNorm() <= square) return volume;
    if (nearest.squaredNorm() >= square) return 0.0;
    const Interval x{low.x(), high.x()}, y{low.y(), high.y()}, z{low.z(), high.z()};
    return body.sphere ? sphere_in_box(body.radius, x, y, z) : disc_in_rectangle(body.radius, x, z) * (to - from).y();
}

CellCutter::CellCutter(const StaggeredGrid& grid, const std::vector<StillSolid>& solids) : grid_(grid), entry_(grid.size(), -1) {
    fixed_.open = grid_.face_field();
    fixed_.open_volume = grid_.cell_field();
    fixed_.room = grid_.cell_field();
    grid_.for_each_cell([&](int cell, int, int, int) { fixed_.room[cell] = 1.0; });
    fixed_.closed.assign(grid_.size(), 1);
    for (auto& owner : fixed_.owner) owner.assign(grid_.size(), k_no_body);
    cover_still_faces(solids);
    cover_still_volumes(solids);
    set_gates({});
}

void CellCutter::set_gates(gsl::span<const SolidBox> gates) {
    still_ = fixed_;
    still_.gates.resize(gates.size());
    for (std::size_t n = 0; n < gates.size(); ++n) cover_by_gate(static_cast<int>(n), without_sliver(grid_, gates[n]));
    close_around_closed_cells();
    for (std::size_t n = 0; n < gates.size(); ++n) find_flux_of_gate(static_cast<int>(n), gates[n]);
    find_slip_walls();
    repeat_in_ghosts(grid_, still_.open_volume);
}

void CellCutter::cover_by_gate(int index, const SolidBox& box) {
    const CellRange range = range_of(grid_, box);
    for (const int d : grid_.directions()) {
        for_each_in(faces_of(grid_, range, d), [&](int i, int j, int k) {
            const int face = grid_.at(i, j, k);
            auto [from, to] = corners(grid_, i, j, k);
            to[d] = from[d];
            const double covered = covered_share(box, from, to);
            if (covered <= 0.0) return;
            const double open = still_.open[d][face] - covered;
            still_.open[d][face] = open < k_smallest_open_share ? 0.0 : open;
            still_.owner[d][face] = static_cast<std::int16_t>(k_first_gate - index);
        });
    }
    for_each_in(range, [&](int i, int j, int k) {
        const int cell = grid_.at(i, j, k);
        const auto [from, to] = corners(grid_, i, j, k);
        const double covered = covered_share(box, from, to);
        if (covered <= 0.0) return;
        const double open = still_.open_volume[cell] - covered;
        still_.open_volume[cell] = open < k_smallest_open_share ? 0.0 : open;
        PartShares shares{};
        for_each_part(grid_, from, [&](int number, const Vec3& centre, const Vec3& size) {
            shares[number] = covered_share(box, centre - 0.5 * size, centre + 0.5 * size);
        });
        take_room(grid_, cell, shares, still_.room);
    });
}

/// What the gate covers of upright faces pushes no water: it moves along them.
void CellCutter::find_flux_of_gate(int index, const SolidBox& box) {
    std::vector<BodyCell>& list = still_.gates[index];
    for_each_in(faces_of(grid_, range_of(grid_, box), 2), [&](int i, int j, int k) {
        const int face = grid_.at(i, j, k);
        if (still_.owner[2][face] != k_first_gate - index) return;
        const double share = fixed_.open[2][face] - still_.open[2][face];
        add_to_cell(list, face - grid_.stride(2), 2, share);
        add_to_cell(list, face, 2, -share);
    });
    for (const BodyCell& entry : list) entry_[entry.cell] = -1;
}

void CellCutter::cover_still_faces(const std::vector<StillSolid>& solids) {
    for (const int d : grid_.directions()) {
        grid_.for_each_face(d, [&](int face, int i, int j, int k) {
            const std::array<int, 3> place{i, j, k};
            if (place[d] == 0 || place[d] == grid_.cells(d)) return;
            auto [from, to] = corners(grid_, i, j, k);
            to[d] = from[d];
            std::array<int, 3> lines{1, 1, 1};
            const int along = d == 2 ? 0 : 2, other = 3 - d - along;
            if (!grid_.is_plane()) lines[other] = k_lines;
            const double open = 1.0 - covered_share(solids, along, from, to, lines);
            fixed_.open[d][face] = open < k_smallest_open_share ? 0.0 : open;
        });
    }
}

void CellCutter::cover_still_volumes(const std::vector<StillSolid>& solids) {
    grid_.for_each_cell([&](int cell, int i, int j, int k) {
        const auto [from, to] = corners(grid_, i, j, k);
        const std::array<int, 3> lines{k_lines, grid_.is_plane() ? 1 : k_lines, 1};
        const double open = solids.empty() ? 1.0 : 1.0 - covered_share(solids, 2, from, to, lines);
        fixed_.open_volume[cell] = open < k_smallest_open_share ? 0.0 : open;
        if (open < 1.0) cover_still_room(solids, cell, from);
    });
}

void CellCutter::cover_still_room(const std::vector<StillSolid>& solids, int cell, const Vec3& from) {
    PartShares shares;
    shares.fill(1.0);
    const std::array<int, 3> lines{k_lines / k_parts, grid_.is_plane() ? 1 : k_lines / k_parts, 1};
    if (fixed_.open_volume[cell] > 0.0)
        for_each_part(grid_, from, [&](int number, const Vec3& centre, const Vec3& size) {
            shares[number] = covered_share(solids, 2, centre - 0.5 * size, centre + 0.5 * size, lines);
        });
    take_room(grid_, cell, shares, fixed_.room);
}

/// A part is covered in proportion to its depth under the surface; together the parts cover what the cell is covered.
void CellCutter::cover_room(const Body& body, int cell, const Vec3& from, double covered, CutCells& cells) const {
    if (covered >= k_wholly_covered) return take_room(grid_, cell, covered, cells.room);
    PartShares shares{};
    double sum = 0.0;
    for_each_part(grid_, from, [&](int number, const Vec3& centre, const Vec3& size) {
        Vec3 arm = centre - body.position;
        if (!body.sphere) arm.y() = 0.0;
        shares[number] = std::clamp(0.5 + (body.radius - arm.norm()) / size.x(), 0.0, 1.0);
        sum += shares[number];
    });
    if (sum <= 0.0) return take_room(grid_, cell, covered, cells.room);  // a corner too small to reach the middle of a part
    for (double& share : shares) share *= covered * parts_of(grid_).count() / sum;
    take_room(grid_, cell, shares, cells.room);
}

/// Water must not end in a cell that has no room, whatever the sixteen lines and the edges of solids make of its faces.
void CellCutter::close_around_closed_cells() {
    still_.cut.clear();
    grid_.for_each_cell([&](int cell, int, int, int) {
        const double open = still_.open_volume[cell];
        still_.closed[cell] = open <= 0.0;
        if (open < 1.0) still_.cut.push_back(cell);
        if (open > 0.0) return;
        for (const int d : grid_.directions()) {
            still_.open[d][cell] = 0.0;
            still_.open[d][cell + grid_.stride(d)] = 0.0;
        }
    });
}

void CellCutter::find_slip_walls() {
    slip_walls_ = {};
    if (still_.cut.empty()) return;
    slip_walls_.near.assign(grid_.size(), 0);
    for (auto& closed : slip_walls_.closed) closed.assign(grid_.size(), 0);
    for (const int d : grid_.directions()) {
        grid_.for_each_face(d, [&](int face, int i, int j, int k) {
            const std::array<int, 3> place{i, j, k};
            if (place[d] == 0 || place[d] == grid_.cells(d) || still_.open[d][face] > 0.0) return;
            slip_walls_.closed[d][face] = 1;
            std::array<int, 3> from = place, to = place;
            for (const int e : grid_.directions()) {
                from[e] = std::max(0, place[e] - (e == d ? 2 : 1));
                to[e] = std::min(grid_.cells(e) - 1, place[e] + 1);
            }
            for (int c = from[2]; c <= to[2]; ++c) {
                for (int b = from[1]; b <= to[1]; ++b) {
                    for (int a = from[0]; a <= to[0]; ++a) slip_walls_.near[grid_.at(a, b, c)] = 1;
                }
            }
        });
        for (const int e : grid_.directions()) {
            if (e != d)
                for_each_mirror(grid_, e, false,
                                [&](int inside, int ghost) { slip_walls_.closed[d][ghost] = slip_walls_.closed[d][inside]; });
        }
    }
}

void CellCutter::add_to_cell(std::vector<BodyCell>& list, int cell, int direction, double flux) {
    if (entry_[cell] < 0) {
        entry_[cell] = static_cast<int>(list.size());
        list.push_back({cell, Vec3::Zero()});
    }
    list[entry_[cell]].k[direction] += flux;
}

void CellCutter::cover_faces(int index, const Body& body, int d, CutCells& cells) {
    for_each_in(faces_of(grid_, range_of(grid_, body), d), [&](int i, int j, int k) {
        const int face = grid_.at(i, j, k);
        double& open = cells.open[d][face];
        if (open <= 0.0) return;
        const std::array<int, 3> place{i, j, k};
        auto [low, high] = corners(grid_, i, j, k);
        const double middle = low[d];
        low[d] = place[d] == 1 ? 0.0 : middle - 0.5 * grid_.width(d);
        high[d] = place[d] == grid_.cells(d) - 1 ? grid_.extent(d) : middle + 0.5 * grid_.width(d);
        double share = std::min(open, covered_volume(body, low, high) / grid_.cell_volume());
        if (share <= 0.0) return;
        if (open - share < k_smallest_open_share) share = open;
        open -= share;
        if (share > 0.5 || cells.owner[d][face] == k_no_body) cells.owner[d][face] = static_cast<std::int16_t>(index);
        add_to_cell(cells.bodies[index], face - grid_.stride(d), d, share);
        add_to_cell(cells.bodies[index], face, d, -share);
    });
}

void CellCutter::cover_volumes(int index, const Body& body, CutCells& cells) const {
    for_each_in(range_of(grid_, body), [&](int i, int j, int k) {
        const int cell = grid_.at(i, j, k);
        const auto [low_corner, high] = corners(grid_, i, j, k);
        const double covered = covered_volume(body, low_corner, high) / grid_.cell_volume();
        if (covered <= 0.0) return;
        cells.covering.add(cell, index);
        double& open = cells.open_volume[cell];
        if (open <= 0.0) return;
        if (open >= 1.0) cells.cut.push_back(cell);
        cover_room(body, cell, low_corner, std::min(open, covered), cells);
        open = std::max(0.0, open - covered);
    });
}

void CellCutter::add_body(int index, const Body& body, CutCells& cells) {
    for (const int d : grid_.directions()) cover_faces(index, body, d, cells);
    for (const BodyCell& entry : cells.bodies[index]) entry_[entry.cell] = -1;
    cover_volumes(index, body, cells);
}

bool CellCutter::has_open_face(const CutCells& cells, int cell) const {
    const auto open = [&](int d) { return cells.open[d][cell] > 0.0 || cells.open[d][cell + grid_.stride(d)] > 0.0; };
    return open(0) || open(2) || (!grid_.is_plane() && open(1));
}

/// Slivers without an open face are no water. What a body drives out of them, their neighbours get: the sum of k stays 0.
void CellCutter::hand_on_flux_of_closed_cells(const CutCells& cells, std::vector<BodyCell>& list) const {
    for (BodyCell& from : list) {
        if (!cells.closed[from.cell] || from.k.isZero(0.0)) continue;
        for (BodyCell& to : list) {
            if (cells.closed[to.cell]) continue;
            const int way = std::abs(to.cell - from.cell);
            if (way != grid_.stride(0) && way != grid_.stride(2) && (grid_.is_plane() || way != grid_.stride(1))) continue;
            to.k += from.k;
            from.k.setZero();
            break;
        }
    }
}

void CellCutter::cut(gsl::span<const Body> bodies, CutCells& cells) {
    std::vector<std::vector<BodyCell>> lists = std::move(cells.bodies);
    cells = still_;
    lists.resize(bodies.size());
    for (auto& list : lists) list.clear();
    cells.bodies = std::move(lists);
    cells.covering.clear(grid_.size());
    for (std::size_t b = 0; b < bodies.size(); ++b) add_body(static_cast<int>(b), bodies[b], cells);
    fold(grid_, k_centres, 1.0, cells.room);
    if (bodies.empty()) return;
    repeat_in_ghosts(grid_, cells.open_volume);
    for (const int cell : cells.cut) cells.closed[cell] = !has_open_face(cells, cell);
    for (auto* lists_of : {&cells.bodies, &cells.gates}) {
        for (auto& list : *lists_of) hand_on_flux_of_closed_cells(cells, list);
    }
}

}  // namespace cutterflow::free_surface
