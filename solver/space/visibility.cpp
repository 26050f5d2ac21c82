#include "solver/space/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace cutterflow::coupling {
namespace {

/// Below this sum of the nodes' weights the rock's centre becomes a node, so that a rock in a tight corner keeps a view.
constexpr double k_least_node_weight = 0.1;
/// Stored hidden cells (4 bytes each) above which unused nodes are dropped, and as how many a triangle in a shadow map counts.
constexpr std::size_t k_most_kept_cells = 32u << 20;
constexpr std::size_t k_cells_per_shade = 2;
/// Nodes used for so many of the last sets of rock stay: a step asks for a few, old and new places among them.
constexpr std::uint64_t k_newest = 8;
/// After so many tries boxes of cells are asked whether all of them are in view only while this share of them was.
constexpr int k_tries = 8;
constexpr double k_least_left_out = 0.25;
/// A stored list reaches this much further than requested, because a rock's kernel widens gradually into coarser cells and those of the
/// other zone pass.
constexpr double k_list_margin = 1.1;

/// The vertices of an icosahedron on the unit sphere and its centre: view points around a rock.
const std::array<Vec3, 13>& view_points() {
    static const std::array<Vec3, 13> points = [] {
        std::array<Vec3, 13> p;
        const double golden = 0.5 * (1.0 + std::sqrt(5.0));
        std::size_t n = 0;
        p[n++] = Vec3::Zero();
        for (const double a : {-1.0, 1.0})
            for (const double b : {-golden, golden})
                for (int shift = 0; shift < 3; ++shift) {
                    Vec3 v;
                    v[shift] = 0.0;
                    v[(shift + 1) % 3] = a;
                    v[(shift + 2) % 3] = b;
                    p[n++] = v.normalized();
                }
        return p;
    }();
    return points;
}

/// Largest coordinate of a view point, of the golden ratio's rectangle, rounded up: where the rock touches a plane wall, the box of its
/// view points does not.
constexpr double k_view_extent = 0.850651;

/// Offset of the lattice from multiples of its spacing. Steel often has round coordinates: for a node in the plane of a face
/// rounding would decide the visibility.
const Vec3 k_lattice_offset(0.381966, 0.236068, 0.618034);

/// Whether the line from `start`, in the ball about a, to b lies in the balls about a and b, which hold no steel.
bool lies_in_balls(const Vec3& start, const Vec3& a, double radius_a, const Vec3& b, double radius_b) {
    const Vec3 from_b = start - b;
    const double length = from_b.norm();
    return length <= radius_b || (b + radius_b / length * from_b - a).norm() <= radius_a;
}

std::uint64_t key_of(int level, const std::array<std::int64_t, 3>& index) {
    std::uint64_t key = static_cast<std::uint64_t>(level + 128);
    for (const std::int64_t i : index) key = key << 18 | (static_cast<std::uint64_t>(i) & 0x3ffff);
    return key;
}

}  // namespace

CellTrees::CellTrees(const Cells& cells, std::size_t zones) : cells_(cells) {
    std::vector<std::vector<Vec3>> centres(zones);
    std::vector<std::vector<std::int32_t>> indices(zones);
    for (std::size_t c = 0; c < cells.centres.size(); ++c) {
        centres[cells.zone[c]].push_back(cells.centres[c]);
        indices[cells.zone[c]].push_back(static_cast<std::int32_t>(c));
    }
    for (Zone zone = 0; zone < zones; ++zone) {
        PointTree& tree = trees_.emplace_back(std::move(centres[zone]), std::move(indices[zone]));
        const std::vector<std::int32_t> numbers = tree.number_by_memory(static_cast<std::int32_t>(numbers_.size()));
        numbers_.insert(numbers_.end(), numbers.begin(), numbers.end());
    }
    for (const std::int32_t c : numbers_) {
        volumes_.push_back(cells.volumes[static_cast<std::size_t>(c)]);
        centres_.push_back(cells.centres[static_cast<std::size_t>(c)]);
    }
}

Visibility::Visibility(const Steel& steel, const CellTrees& trees, const ZoneFrames& frames, NodeView view)
    : trees_(trees),
      frames_(frames),
      view_(view),
      nodes_(trees.zones()),
      visible_(trees.cells().centres.size(), 1.0),
      hidden_(trees.cells().centres.size(), 0.0) {
    for (const gsl::span<const SteelTriangle> of_zone : steel.of_zone) steel_.emplace_back(of_zone);
}

void Visibility::set_frames(const ZoneFrames& frames) {
    frames_ = frames;
    ++stamp_;
}

void Visibility::begin_set() {
    ++set_;
    if (kept_cells_ > k_most_kept_cells) drop_old_nodes();
}

void Visibility::forget() {
    for (const std::int32_t c : dimmed_) visible_[static_cast<std::size_t>(c)] = 1.0;
    dimmed_.clear();
}

/// Takes the share that the steel of one zone hides off the visible fractions.
void Visibility::dim_touched() {
    for (const std::int32_t cell : touched_) {
        const auto c = static_cast<std::size_t>(cell);
        if (visible_[c] == 1.0) dimmed_.push_back(cell);
        visible_[c] *= 1.0 - hidden_[c];
        if (visible_[c] <= k_rounding) visible_[c] = 0.0;
        hidden_[c] = 0.0;
    }
    touched_.clear();
}

void Visibility::look_from(const Vec3& position, double reach, double spacing) {
    forget();
    for (Zone zone = 0; zone < steel_.size(); ++zone) {
        if (steel_[zone].empty()) continue;
        const Vec3 here = frames_.from_absolute(zone, position);
        const double clearance = steel_[zone].distance(here, reach);
        if (clearance < reach) look_past(zone, here, clearance, reach, spacing);
    }
}

void Visibility::look_from_point(const Vec3& position, double reach) {
    forget();
    for (Zone zone = 0; zone < steel_.size(); ++zone) {
        SamplePoint point;
        point.position = frames_.from_absolute(zone, position);
        add_hidden(zone, point, 1.0, reach);
        dim_touched();
        release(point);
    }
}

void Visibility::look_past(Zone steel, const Vec3& position, double clearance, double reach, double spacing) {
    const int level = static_cast<int>(std::lround(4.0 * std::log2(spacing)));
    const bool is_blended = view_ == NodeView::all_nodes;
    const Sources sources =
        is_blended ? all_nodes(steel, position, clearance, reach, level) : one_node(steel, position, clearance, reach, level);
    SamplePoint centre;
    centre.position = position;
    const double least = is_blended ? k_least_node_weight : k_least_node_weight / static_cast<double>(sources.nodes.size());
    const double missing = std::max(0.0, least - sources.sum), sum = sources.sum + missing;
    for (std::size_t i = 0; i < sources.count; ++i) {
        const Source& source = sources.nodes[i];
        add_hidden(steel, *source.point, source.weight / sum, reach + (source.point->position - position).norm());
    }
    if (missing > 0.0) add_hidden(steel, centre, missing / sum, reach);
    dim_touched();
    release(centre);
}

/// Spacing of a lattice [m].
double Visibility::spacing_of(int level) {
    return std::exp2(0.25 * level);
}

/// The nodes about a point with their trilinear weights.
std::array<Visibility::Corner, 8> Visibility::corners_around(const Vec3& position, double spacing) {
    std::array<std::int64_t, 3> base;
    Vec3 fraction;
    for (int i = 0; i < 3; ++i) {
        const double x = position[i] / spacing - k_lattice_offset[i];
        base[static_cast<std::size_t>(i)] = static_cast<std::int64_t>(std::floor(x));
        fraction[i] = x - std::floor(x);
    }
    std::array<Corner, 8> corners;
    for (std::size_t corner = 0; corner < corners.size(); ++corner) {
        corners[corner] = {base, 1.0};
        for (int i = 0; i < 3; ++i) {
            const bool upper = (corner >> i & 1) != 0;
            corners[corner].weight *= upper ? fraction[i] : 1.0 - fraction[i];
            if (upper) ++corners[corner].index[static_cast<std::size_t>(i)];
        }
    }
    return corners;
}

Visibility::Sources Visibility::all_nodes(Zone steel, const Vec3& position, double clearance, double reach, int level) {
    Sources sources;
    for (const Corner& corner : corners_around(position, spacing_of(level))) {
        if (corner.weight == 0.0) continue;
        const Source source = source_at(steel, corner, position, clearance, reach, level);
        if (source.weight == 0.0) continue;
        sources.nodes[sources.count++] = source;
        sources.sum += source.weight;
    }
    return sources;
}

Visibility::Sources Visibility::one_node(Zone steel, const Vec3& position, double clearance, double reach, int level) {
    std::array<Corner, 8> corners = corners_around(position, spacing_of(level));
    std::stable_sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.weight > b.weight; });
    Source best{nullptr, 0.0};
    for (const Corner& corner : corners) {
        if (corner.weight <= best.weight) break;  // what it sees can only lower its weight
        const Source source = source_at(steel, corner, position, clearance, reach, level);
        if (source.weight > best.weight) best = source;
    }
    Sources sources;
    if (best.point == nullptr) return sources;
    sources.nodes[0] = best;
    sources.count = 1;
    sources.sum = best.weight;
    return sources;
}

/// A node, its weight lowered by the share of the rock's surroundings that is hidden from it.
Visibility::Source Visibility::source_at(Zone steel, const Corner& corner, const Vec3& position, double clearance, double reach,
                                         int level) {
    SamplePoint& point = node(steel, level, corner.index);
    measure_clearance(steel, point, reach + (point.position - position).norm());
    return {&point, corner.weight * seen_share(steel, position, clearance, spacing_of(level), point)};
}

Visibility::SamplePoint& Visibility::node(Zone steel, int level, const std::array<std::int64_t, 3>& index) {
    SamplePoint& point = nodes_[steel][key_of(level, index)];
    if (point.last_used == 0)
        point.position =
            spacing_of(level) *
            (Vec3(static_cast<double>(index[0]), static_cast<double>(index[1]), static_cast<double>(index[2])) + k_lattice_offset);
    point.last_used = set_;
    return point;
}

/// Share of the points around the rock (in the steel-free ball about its centre) with a line of sight to a node.
double Visibility::seen_share(Zone steel, const Vec3& position, double clearance, double spacing, const SamplePoint& node) const {
    if ((node.position - position).norm() <= clearance) return 1.0;
    const double radius = std::min(clearance, spacing);
    const Vec3 extent = Vec3::Constant(k_view_extent * radius);
    if (!steel_[steel].may_meet({node.position.cwiseMin(position - extent), node.position.cwiseMax(position + extent)})) return 1.0;
    int seen = 0;
    std::int32_t last = -1;
    for (const Vec3& direction : view_points()) {
        const Vec3 start = position + radius * direction;
        const bool is_clear = lies_in_balls(start, position, clearance, node.position, node.clearance) ||
                              (node.shadows && node.shadows->is_clear(start - node.position)) ||
                              !steel_[steel].blocks(start, node.position, last);
        if (is_clear) ++seen;
    }
    return static_cast<double>(seen) / static_cast<double>(view_points().size());
}

/// Sets the node's distance to the steel, up to `reach` at least.
void Visibility::measure_clearance(Zone steel, SamplePoint& point, double reach) {
    if (point.clearance_limit >= reach) return;
    point.clearance_limit = k_list_margin * reach;
    point.clearance = steel_[steel].distance(point.position, point.clearance_limit);
    drop_shadows(point);
}

void Visibility::drop_shadows(SamplePoint& point) {
    if (!point.shadows) return;
    kept_cells_ -= k_cells_per_shade * point.shadows->size();
    point.shadows.reset();
}

void Visibility::add_hidden(Zone steel, SamplePoint& point, double weight, double reach) {
    measure_clearance(steel, point, reach);
    if (point.clearance >= reach) return;
    for (Zone cells = 0; cells < trees_.zones(); ++cells) {
        for (const std::int32_t c : hidden_cells(steel, point, cells, reach)) {
            double& share = hidden_[static_cast<std::size_t>(c)];
            if (share == 0.0) touched_.push_back(c);
            share += weight;
        }
    }
}

const std::vector<std::int32_t>& Visibility::hidden_cells(Zone steel, SamplePoint& point, Zone cells, double reach) {
    point.hidden.resize(trees_.zones());
    HiddenCells& list = point.hidden[cells];
    const bool moves = cells != steel;
    kept_cells_ -= list.size();
    if (moves && list.stamp != stamp_) {
        list.cells.clear();
        list.reach = -1.0;
        list.stamp = stamp_;
    }
    if (list.reach < reach) {
        const double outer = moves ? reach : point.clearance_limit;
        find_hidden(steel, point, cells, std::max(list.reach, point.clearance), outer, list);
        list.reach = outer;
    }
    kept_cells_ += list.size();
    return list.cells;
}

/// Appends the cells that a point does not see, of those at a distance of `inner` or more and less than `outer` [m].
void Visibility::find_hidden(Zone steel, SamplePoint& point, Zone cells, double inner, double outer, HiddenCells& list) {
    if (trees_.of(cells).size() == 0) return;
    const ZoneFrames::Change change = frames_.between(cells, steel);
    const Eigen::Matrix3d extent_of_turned = change.turn.cwiseAbs();
    const Vec3 centre = change.turn.transpose() * (point.position - change.shift);
    // No steel meets the box that holds the point and a box of cells: all lines between them are clear.
    const auto sees_all_of = [&](const Box& box) {
        const Vec3 lower = box.lower.cwiseMax(centre - Vec3::Constant(outer)), upper = box.upper.cwiseMin(centre + Vec3::Constant(outer));
        const Vec3 middle = change(0.5 * (lower + upper)), half = extent_of_turned * (0.5 * (upper - lower));
        return !steel_[steel].may_meet({point.position.cwiseMin(middle - half), point.position.cwiseMax(middle + half)});
    };
    if (sees_all_of(trees_.of(cells).bounds())) return;
    if (!point.shadows) {
        point.shadows.emplace(steel_[steel], point.position, point.clearance_limit);
        kept_cells_ += k_cells_per_shade * point.shadows->size();
    }
    // Where steel is all around, as over a bank, asking costs more than it leaves out.
    int asked = 0, left_out = 0;
    const auto is_worth_leaving_out = [&](const Box& box) {
        if (asked >= k_tries && left_out < k_least_left_out * asked) return false;
        ++asked;
        const bool sees_all = sees_all_of(box);
        left_out += sees_all ? 1 : 0;
        return sees_all;
    };
    found_.clear();
    if (cells == steel)
        trees_.of(cells).between(centre, inner, outer, is_worth_leaving_out, found_);
    else
        find_passing(cells, centre, inner, outer, list.passing);
    for (const Neighbour& n : found_) {
        const Vec3 offset = change(trees_.centre(n.index)) - point.position;
        if (point.shadows->is_clear(offset)) continue;
        ++tests_;
        if (point.shadows->blocks(offset)) list.cells.push_back(n.index);
    }
    if (trees_.zones() == 1) drop_shadows(point);  // no cell will come again
}

/// Appends the cells of a zone that turns past a point, of those at a distance of `inner` or more and less than `outer` [m], to what was
/// found. They pass by little from one position of the mesh to the next. \param centre  the point in the cells' frame
void Visibility::find_passing(Zone cells, const Vec3& centre, double inner, double outer, NearbyPoints& passing) {
    if (passing.known_about(centre) < outer) passing = trees_.of(cells).about(centre, k_list_margin * outer);
    for (const std::int32_t place : passing.indices) {
        const double squared = (trees_.centre(place) - centre).squaredNorm();
        if (squared >= inner * inner && squared < outer * outer) found_.push_back({place, squared});
    }
}

void Visibility::release(SamplePoint& point) {
    for (const HiddenCells& list : point.hidden) kept_cells_ -= list.size();
    drop_shadows(point);
}

/// Halves what is kept, or as near as it comes with all nodes of the last sets of rock: those unused for longest go first.
void Visibility::drop_old_nodes() {
    for (std::uint64_t age = set_ / 2; kept_cells_ > k_most_kept_cells / 2 && age > k_newest; age /= 2) drop_nodes_unused_for(age);
}

/// \param age  in sets of rock
void Visibility::drop_nodes_unused_for(std::uint64_t age) {
    for (Lattice& lattice : nodes_)
        for (auto i = lattice.begin(); i != lattice.end();) {
            if (i->second.last_used + age >= set_) {
                ++i;
                continue;
            }
            release(i->second);
            i = lattice.erase(i);
        }
}

}  // namespace cutterflow::coupling
