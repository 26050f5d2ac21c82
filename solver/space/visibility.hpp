#pragma once
/// \file Visible fraction of a rock from a cell past the steel, so that nothing is mapped through a thin blade.
#include <array>
#include <cstdint>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <vector>

#include "solver/ports/fluid_engine.hpp"
#include "solver/space/point_tree.hpp"
#include "solver/space/shadow_map.hpp"
#include "solver/space/steel_tree.hpp"
#include "solver/space/zone_frames.hpp"

namespace cutterflow::coupling {

/// This rank's cells for searches: one tree per zone, in the zone's own frame, built once. What a search finds are places: numbers of the
/// cells in the order of the trees, in which neighbours in space are neighbours in memory.
class CellTrees {
public:
    CellTrees(const Cells& cells, std::size_t zones);
    std::size_t zones() const { return trees_.size(); }
    const PointTree& of(Zone zone) const { return trees_[zone]; }
    const Cells& cells() const { return cells_; }
    /// Of the cell at a place: its number among `cells`, its volume [m3], its centre [m] in its zone's frame.
    std::int32_t number(std::int32_t place) const { return numbers_[static_cast<std::size_t>(place)]; }
    double volume(std::int32_t place) const { return volumes_[static_cast<std::size_t>(place)]; }
    const Vec3& centre(std::int32_t place) const { return centres_[static_cast<std::size_t>(place)]; }

private:
    Cells cells_;
    std::vector<PointTree> trees_;
    std::vector<std::int32_t> numbers_;
    std::vector<double> volumes_;
    std::vector<Vec3> centres_;
};

/// What of a lattice's nodes around a rock looks for it.
enum class NodeView : std::uint8_t {
    all_nodes,  ///< all eight with trilinear weights: changes smoothly as the rock moves, as the fluid's equations ask for
    one_node    ///< the one of the largest weight: changes with a jump, at an eighth of the lines of sight
};

/// Visible fraction of a rock from each cell around it.
///
/// The rock is sampled at the nodes of a lattice that is fixed in the frame of the steel: at the eight nodes around its centre with
/// trilinear weights, or at one of them. A cell is hidden from a node when a triangle intersects the line
/// between them. Nodes, steel and cells of one zone do not move relative to each other, so a node's hidden cells are computed once and
/// stored; those of other zones are computed for every mesh position, from the cells that pass near by. A node that is hidden from part of
/// the rock's surroundings (beyond a blade, inside steel) loses weight in proportion to that part; the other nodes take it over. The
/// visible fraction is the product over the steel of all zones. Without steel within reach all cells are visible.
class Visibility {
public:
    Visibility(const Steel& steel, const CellTrees& trees, const ZoneFrames& frames, NodeView view = NodeView::all_nodes);

    /// Sets the position of the mesh.
    void set_frames(const ZoneFrames& frames);

    /// A set of rock follows. Nodes that none of the last sets used go when too much is kept.
    void begin_set();

    /// Computes the visibility of all cells within `reach` [m] of a rock at `position` [m, absolute]. \param spacing  of the lattice [m];
    /// it is rounded to quarter octaves, so that rocks of one size share their nodes. Replaces the previous result.
    void look_from(const Vec3& position, double reach, double spacing);

    /// As look_from, from the position alone (no lattice).
    void look_from_point(const Vec3& position, double reach);

    /// Whether every cell within reach sees the whole rock.
    bool sees_all() const { return dimmed_.empty(); }

    /// Visible fraction [-] of the rock from the cell at a place of CellTrees, within reach.
    double visible_fraction(std::int32_t place) const { return visible_[static_cast<std::size_t>(place)]; }

    /// Numbers of stored nodes and of line-of-sight tests so far, for measurements.
    std::size_t kept_nodes() const {
        return std::accumulate(nodes_.begin(), nodes_.end(), std::size_t{0},
                               [](std::size_t n, const Lattice& nodes) { return n + nodes.size(); });
    }
    std::size_t tests() const { return tests_; }

private:
    static constexpr double k_rounding = 1e-12;  // of the sum of a hidden cell's shares

    struct HiddenCells {
        double reach = -1.0;              // that the list is complete for
        std::uint64_t stamp = 0;          // of the mesh position that it holds for (cells of the other zone)
        std::vector<std::int32_t> cells;  // their places
        NearbyPoints passing;             // cells of the other zone about the point, of which these are hidden
        std::size_t size() const { return cells.size() + passing.indices.size(); }
    };
    struct SamplePoint {
        Vec3 position;
        double clearance = 0.0;  // distance to the steel, or the requested reach
        double clearance_limit = -1.0;
        std::vector<HiddenCells> hidden{};   // by the cells' zone
        std::optional<ShadowMap> shadows{};  // of the steel that can hide listed cells
        std::uint64_t last_used = 0;
    };
    struct Corner {
        std::array<std::int64_t, 3> index;
        double weight;
    };
    struct Source {
        SamplePoint* point;
        double weight;
    };
    struct Sources {
        std::array<Source, 8> nodes;
        std::size_t count = 0;
        double sum = 0.0;  // of the weights
    };
    using Lattice = std::unordered_map<std::uint64_t, SamplePoint>;

    void forget();
    void dim_touched();
    void look_past(Zone steel, const Vec3& position, double clearance, double reach, double spacing);
    static double spacing_of(int level);
    static std::array<Corner, 8> corners_around(const Vec3& position, double spacing);
    Sources all_nodes(Zone steel, const Vec3& position, double clearance, double reach, int level);
    Sources one_node(Zone steel, const Vec3& position, double clearance, double reach, int level);
    Source source_at(Zone steel, const Corner& corner, const Vec3& position, double clearance, double reach, int level);
    SamplePoint& node(Zone steel, int level, const std::array<std::int64_t, 3>& index);
    void measure_clearance(Zone steel, SamplePoint& point, double reach);
    void drop_shadows(SamplePoint& point);
    double seen_share(Zone steel, const Vec3& position, double clearance, double spacing, const SamplePoint& node) const;
    void add_hidden(Zone steel, SamplePoint& point, double weight, double reach);
    const std::vector<std::int32_t>& hidden_cells(Zone steel, SamplePoint& point, Zone cells, double reach);
    void find_hidden(Zone steel, SamplePoint& point, Zone cells, double inner, double outer, HiddenCells& list);
    void find_passing(Zone cells, const Vec3& centre, double inner, double outer, NearbyPoints& passing);
    void release(SamplePoint& point);
    void drop_old_nodes();
    void drop_nodes_unused_for(std::uint64_t age);

    const CellTrees& trees_;
    std::vector<SteelTree> steel_;
    ZoneFrames frames_;
    NodeView view_;
    std::uint64_t stamp_ = 1;     // of the position of the mesh
    std::uint64_t set_ = 1;       // of rock
    std::vector<Lattice> nodes_;  // by the steel's zone
    std::size_t kept_cells_ = 0;
    std::size_t tests_ = 0;
    std::vector<double> visible_;        // by place
    std::vector<std::int32_t> dimmed_;   // places whose visible fraction is below 1
    std::vector<double> hidden_;         // by place, share behind the steel of the zone in hand
    std::vector<std::int32_t> touched_;  // places whose share is not 0
    std::vector<Neighbour> found_;
};

}  // namespace cutterflow::coupling
