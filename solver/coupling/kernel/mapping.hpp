#pragma once
/// \file Mapping between rocks and the cells of this rank: one stencil per rock serves every field in both directions.
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "solver/coupling/kernel/cell_groups.hpp"
#include "solver/coupling/kernel/shared_rocks.hpp"
#include "solver/ports/communicator.hpp"
#include "solver/ports/settings.hpp"
#include "solver/space/open_share.hpp"
#include "solver/space/size_field.hpp"
#include "solver/space/visibility.hpp"

namespace cutterflow::coupling {

/// Positions and diameters of the rocks to be mapped, the same on every rank.
struct RockShapes {
    gsl::span<const int> id;
    gsl::span<const Vec3> position;    ///< [m], absolute
    gsl::span<const double> diameter;  ///< [m]
    std::size_t size() const { return id.size(); }
};

/// Weights of this rank's cells for every rock. Entries of rock p are [first[p], first[p + 1]); a rock that is not near has none.
/// Over all ranks, sum of weight * cell volume = 1 for every rock and both weights, but for rock without cells.
struct Stencils {
    SharedRocks shared;              ///< the rocks near this rank's cells
    std::vector<double> width;       ///< sigma of each rock that is near, or the side of its group of cells [m]; 0 of others
    std::vector<Zone> zone;          ///< of the cell nearest to each rock that is near
    std::vector<std::size_t> first;  ///< one more than rocks
    std::vector<std::int32_t> cell;  ///< of each entry
    std::vector<double> deposit;     ///< w: from rock to fluid [1/m3]
    std::vector<double> sample;      ///< psi: from fluid to rock [1/m3]
    std::vector<double> overlap;     ///< of each rock that is near: sum of w psi V over the cells of all ranks [1/m3], as laid at first
    std::vector<std::size_t> without_cells;  ///< rocks that have no entry on any rank, ascending; the same on every rank
    std::size_t hidden = 0;   ///< rocks of all ranks that saw no cell of water and were mapped from the nearest cell's centre instead
    std::size_t cramped = 0;  ///< rocks of all ranks that saw so few cells that they were laid over cells behind steel and in soil as well
    std::size_t size() const { return width.size(); }
    /// Empties the stencils but keeps their capacity.
    void clear();
    /// Room for this many entries in all; those that are there stay.
    void resize_entries(std::size_t count);
};

/// Builds stencils: kernels on geometric distance over all zones and all ranks, times the visible fraction of the rock and the share of the
/// cell that soil leaves; or, with another map than gaussian, one group of cells per rock. Each rank builds those of the rocks near its
/// cells, and sums over a rock's kernel are messages between the ranks near to it.
class Mapping {
public:
    /// Keeps references to the engine's arrays. The mesh is at its position at time 0. \param view  one node is enough where no fluid feels
    /// the rock
    Mapping(const Cells& cells, const Steel& steel, gsl::span<const ZoneMotion> moving, const KernelSettings& kernel,
            Communicator& communicator, NodeView view = NodeView::all_nodes);

    /// Sets the mesh to its position at a time [s].
    void set_time(double time);

    /// Stencils of the rocks at their positions on the present mesh. On a mesh that never turned the last ones are stored and reused: the
    /// new positions of one step are the old ones of the next. Collective.
    /// \param stencils  overwritten; buffers are reused because allocating them would dominate the cost
    /// \throws CheckFailure  with another map than gaussian, when a rock is outside the mesh
    void build(const RockShapes& rocks, Stencils& stencils);

    /// \param stencils  of these rocks on the present mesh
    /// \throws CheckFailure  that names the first rock without cells
    void require_cells(const RockShapes& rocks, const Stencils& stencils) const;

    const SizeField& sizes() const { return sizes_; }
    const Cells& cells() const { return trees_.cells(); }
    /// Whether a rock (of all builds so far, on any rank) saw no cell of water and was mapped from the nearest cell's centre instead.
    bool had_hidden_rock() const { return had_hidden_rock_; }
    /// Whether a rock saw so few cells that it was laid over cells behind steel and in soil as well.
    bool had_cramped_rock() const { return had_cramped_rock_; }
    const Visibility& visibility() const { return visibility_; }

private:
    /// Stencils and the rocks that they belong to.
    struct Kept {
        bool is_present = false;
        std::vector<int> id;
        std::vector<Vec3> position;
        std::vector<double> diameter;
        Stencils stencils;
        bool are_of(const RockShapes& rocks) const;
    };

    void build_anew(const RockShapes& rocks, Stencils& stencils);
    bool locate(const RockShapes& rocks, std::size_t rock, Stencils& stencils);
    struct Outlook {
        std::size_t mapped;
        std::size_t cramped;
    };
    Outlook outlook_of(const RockShapes& rocks, const Stencils& stencils, const std::vector<double>& sums) const;
    void leave_out_unmapped(Stencils& stencils, std::vector<double>& sums);
    void forget_vicinities(std::size_t rocks);
    void lay_kernels(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums);
    void lay_in_groups(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums);
    void look_from(const RockShapes& rocks, std::size_t rock, double width);
    void look_from_nearest_cell(const RockShapes& rocks, std::size_t rock, double width);
    /// What a cell counts of one in open water.
    struct Through {
        double steel;  ///< behind steel
        double soil;   ///< in soil
    };
    void add_entries(const RockShapes& rocks, std::size_t rock, const Through& through, Stencils& stencils, std::vector<double>& sums);
    template <typename Lay>
    void lay_again(const std::vector<std::size_t>& again, const Lay& lay, Stencils& stencils, std::vector<double>& sums);
    std::vector<std::size_t> replace_hidden(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums);
    double share_beyond(double diameter, double seen) const;
    bool is_cramped(const RockShapes& rocks, const std::vector<double>& sums, std::size_t rock) const;
    void make_room_for_cramped(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums,
                               const std::vector<std::size_t>& hidden);

    std::vector<ZoneMotion> moving_;
    ZoneFrames frames_;
    CellTrees trees_;
    RankBoxes boxes_;
    SizeField sizes_;
    Visibility visibility_;
    OpenShare open_;
    KernelSettings kernel_;
    Communicator& communicator_;
    std::optional<CellGroups> groups_;  // none: map gaussian
    std::vector<double> angles_;        // of the moving zones [rad]
    Kept last_;                         // unused once the mesh has turned
    bool has_turned_ = false;
    bool had_hidden_rock_ = false;
    bool had_cramped_rock_ = false;

    /// Cells about a rock, found when it was near by.
    struct KnownVicinity {
        SizeField::Vicinity sizes;
        std::vector<NearbyPoints> kernel;  // by zone
        std::uint64_t last_build = 0;
    };
    const NearbyPoints& nearby_cells(KnownVicinity& vicinity, Zone zone, const Vec3& point, double width) const;
    std::unordered_map<int, KnownVicinity> vicinities_;  // by the rock's id
    std::uint64_t builds_ = 0;
};

/// Adds amount[p] * w to each cell: solid_fraction from volumes [m3] and so on.
void deposit(const Stencils& stencils, gsl::span<const double> amount, gsl::span<double> cell_values);
void deposit(const Stencils& stencils, gsl::span<const Vec3> amount, gsl::span<Vec3> cell_values);

}  // namespace cutterflow::coupling
