#include "solver/coupling/kernel/mapping.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/physics/kernels.hpp"
#include "solver/ports/mapping_width.hpp"

namespace cutterflow::coupling {
namespace {

// Spacing of the visibility's lattice over the kernel width. The visible fraction is interpolated between nodes and changes by 1/h per
// metre at most, its Gaussian by exp(-1/2)/sigma: from h = 0.82 sigma on a cell that comes in view fills at most twice as fast as one in
// open water.
constexpr double k_lattice_spacing = 0.85;

// Vicinities per rock above which those that the last builds did not use are dropped.
constexpr std::size_t k_kept_vicinities = 2;
constexpr std::uint64_t k_kept_builds = 4;

// What is found of a rock's cells reaches this many kernel widths farther than the kernel, for the rock to travel.
constexpr double k_skin = 0.3;

// Rock that is farther than this many cell sizes from the nearest cell's centre is outside the mesh. Of maps that lay rock in cells.
constexpr double k_farthest_cell = 3.0;

CheckFailure no_cell_near(const RockShapes& rocks, std::size_t rock, double distance) {
    const Vec3& x = rocks.position[rock];
    return CheckFailure({"",
                         fmt::format("rock {} at ({:.6g} {:.6g} {:.6g}) m has no cell of the mesh within {:.3g} m", rocks.id[rock], x[0],
                                     x[1], x[2], distance),
                         "Rock must stay inside the mesh", "Let rock.domain end inside the mesh"});
}

// A rock that sees less than this many times the room that it needs also lies in cells behind steel and in soil.
constexpr double k_ample = 2.0;

/// Sums over a rock's cells, rock by rock in one array. Room is the cells' volume, which fades to 0 at the kernel's reach so that none
/// appears with a jump.
enum RockSum { deposit_sum, sample_sum, overlap_sum, seen_room, hidden_room, k_sums };

/// Whether a rock has cells, by the sums of w V and psi V over all ranks.
bool is_mapped(const std::vector<double>& sums, std::size_t rock) {
    return sums[k_sums * rock + deposit_sum] > 0.0 && sums[k_sums * rock + sample_sum] > 0.0;
}

}  // namespace

void Stencils::clear() {
    shared = {};
    width.clear();
    zone.clear();
    first.assign(1, 0);
    cell.clear();
    deposit.clear();
    sample.clear();
    overlap.clear();
    without_cells.clear();
    hidden = cramped = 0;
}

void Stencils::resize_entries(std::size_t count) {
    cell.resize(count);
    deposit.resize(count);
    sample.resize(count);
}

Mapping::Mapping(const Cells& cells, const Steel& steel, gsl::span<const ZoneMotion> moving, const KernelSettings& kernel,
                 Communicator& communicator, NodeView view)
    : moving_(moving.begin(), moving.end()),
      frames_(moving, 0.0),
      trees_(cells, frames_.zones()),
      boxes_(trees_, communicator),
      sizes_(cells, frames_.zones(), communicator),
      visibility_(steel, trees_, frames_, view),
      open_(steel.soil, trees_, moving, sizes_, frames_, communicator),
      kernel_(kernel),
      communicator_(communicator),
      angles_(moving_.size(), 0.0) {
    if (kernel.map != k_gaussian_map) groups_.emplace(trees_, kernel, communicator);
}

void Mapping::set_time(double time) {
    std::vector<double> angles;
    for (const ZoneMotion& motion : moving_) angles.push_back(motion.angle(time));
    if (angles == angles_) return;
    angles_ = std::move(angles);
    frames_ = ZoneFrames(moving_, time);
    visibility_.set_frames(frames_);
    open_.set_frames(frames_);
    has_turned_ = true;
    last_ = {};
}

bool Mapping::Kept::are_of(const RockShapes& rocks) const {
    const auto equal = [](const auto& kept, const auto& given) { return std::equal(kept.begin(), kept.end(), given.begin(), given.end()); };
    return equal(id, rocks.id) && equal(position, rocks.position) && equal(diameter, rocks.diameter);
}

void Mapping::build(const RockShapes& rocks, Stencils& stencils) {
    if (has_turned_) return build_anew(rocks, stencils);
    if (last_.is_present && last_.are_of(rocks)) {
        std::swap(stencils, last_.stencils);
        last_.is_present = false;
        return;
    }
    build_anew(rocks, stencils);
    last_.is_present = true;
    last_.id.assign(rocks.id.begin(), rocks.id.end());
    last_.position.assign(rocks.position.begin(), rocks.position.end());
    last_.diameter.assign(rocks.diameter.begin(), rocks.diameter.end());
    last_.stencils = stencils;
}

void Mapping::build_anew(const RockShapes& rocks, Stencils& stencils) {
    stencils.clear();
    stencils.shared = SharedRocks(communicator_.rank());
    ++builds_;
    visibility_.begin_set();
    std::vector<double> sums(k_sums * rocks.size(), 0.0);
    if (groups_)
        lay_in_groups(rocks, stencils, sums);
    else
        lay_kernels(rocks, stencils, sums);
    forget_vicinities(stencils.shared.near().size());
    stencils.shared.sum(sums, k_sums, communicator_);
    std::vector<std::size_t> hidden;
    Outlook outlook = outlook_of(rocks, stencils, sums);
    const std::size_t in_view = outlook.mapped;
    if (in_view < stencils.size()) {
        hidden = replace_hidden(rocks, stencils, sums);
        outlook = outlook_of(rocks, stencils, sums);
    }
    const std::size_t out_of_view = outlook.mapped - in_view;
    if (outlook.mapped < stencils.size()) {
        leave_out_unmapped(stencils, sums);
        outlook = outlook_of(rocks, stencils, sums);
    }
    if (outlook.cramped > 0) make_room_for_cramped(rocks, stencils, sums, hidden);
    stencils.hidden = out_of_view;
    stencils.cramped = outlook.cramped;
    had_hidden_rock_ = had_hidden_rock_ || stencils.hidden > 0;
    had_cramped_rock_ = had_cramped_rock_ || stencils.cramped > 0;

    stencils.overlap.assign(rocks.size(), 0.0);
    for (const std::size_t p : stencils.shared.near()) {
        if (!is_mapped(sums, p)) continue;
        const double deposit_scale = 1.0 / sums[k_sums * p + deposit_sum], sample_scale = 1.0 / sums[k_sums * p + sample_sum];
        stencils.overlap[p] = sums[k_sums * p + overlap_sum] * deposit_scale * sample_scale;
        for (std::size_t i = stencils.first[p]; i < stencils.first[p + 1]; ++i) {
            stencils.deposit[i] *= deposit_scale;
            stencils.sample[i] *= sample_scale;
        }
    }
}

/// Kernels of the rocks near this rank's cells, unnormalised, and this rank's part of their sums.
void Mapping::lay_kernels(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums) {
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        if (!locate(rocks, p, stencils)) {
            stencils.width.push_back(0.0);
            stencils.zone.push_back(k_still_zone);
            stencils.first.push_back(stencils.cell.size());
            continue;
        }
        look_from(rocks, p, stencils.width[p]);
        add_entries(rocks, p, {0.0, 0.0}, stencils, sums);
    }
}

void Mapping::look_from(const RockShapes& rocks, std::size_t rock, double width) {
    const double narrowest = mapping_width(kernel_, rocks.diameter[rock], sizes_.smallest());
    visibility_.look_from(rocks.position[rock], physics::k_kernel_reach * width, k_lattice_spacing * narrowest);
}

/// The same with one group of cells per rock.
void Mapping::lay_in_groups(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums) {
    std::vector<int> others;  // a group may lie on any rank
    for (int rank = 0; rank < boxes_.size(); ++rank)
        if (rank != communicator_.rank()) others.push_back(rank);
    std::vector<CellGroups::Point> points;
    std::vector<double> cell_size;
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        KnownVicinity& vicinity = vicinities_[rocks.id[p]];
        vicinity.last_build = builds_;
        const SizeField::Surroundings mesh = sizes_.around(frames_, rocks.position[p], vicinity.sizes);
        points.push_back({mesh.nearest_zone, frames_.from_absolute(mesh.nearest_zone, rocks.position[p])});
        cell_size.push_back(mesh.size);
        stencils.width.push_back(mapping_width(kernel_, rocks.diameter[p], mesh.size));
        stencils.zone.push_back(mesh.nearest_zone);
        stencils.shared.add(p, others);
    }
    const std::vector<CellGroups::Nearest> nearest = groups_->at(points);
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        const double farthest = k_farthest_cell * cell_size[p];
        if (nearest[p].distance > farthest) throw no_cell_near(rocks, p, farthest);
        for (const CellGroups::Member& member : groups_->members(nearest[p].group)) {
            stencils.cell.push_back(member.cell);
            sums[k_sums * p + deposit_sum] += cells().volumes[static_cast<std::size_t>(member.cell)];
        }
        sums[k_sums * p + sample_sum] = sums[k_sums * p + overlap_sum] = sums[k_sums * p + deposit_sum];
        stencils.first.push_back(stencils.cell.size());
    }
    stencils.deposit.assign(stencils.cell.size(), 1.0);
    stencils.sample.assign(stencils.cell.size(), 1.0);
}

/// Adds the kernel's width and the zone of a rock that is near this rank's cells. \return whether it is near
bool Mapping::locate(const RockShapes& rocks, std::size_t rock, Stencils& stencils) {
    const Vec3& place = rocks.position[rock];
    const auto is_near = [&](int rank, double width) { return boxes_.may_reach(rank, frames_, place, physics::k_kernel_reach * width); };
    const int me = communicator_.rank();
    if (!is_near(me, mapping_width(kernel_, rocks.diameter[rock], sizes_.largest()))) return false;
    KnownVicinity& vicinity = vicinities_[rocks.id[rock]];
    vicinity.last_build = builds_;
    const SizeField::Surroundings mesh = sizes_.around(frames_, place, vicinity.sizes);
    const double width = mapping_width(kernel_, rocks.diameter[rock], mesh.size);
    if (!is_near(me, width)) return false;
    std::vector<int> others;
    for (int rank = 0; rank < boxes_.size(); ++rank)
        if (rank != me && is_near(rank, width)) others.push_back(rank);
    stencils.width.push_back(width);
    stencils.zone.push_back(mesh.nearest_zone);
    stencils.shared.add(rock, others);
    return true;
}

/// Of the rocks of all ranks. Collective
Mapping::Outlook Mapping::outlook_of(const RockShapes& rocks, const Stencils& stencils, const std::vector<double>& sums) const {
    const std::vector<std::size_t>& led = stencils.shared.led();
    const auto count = [&](const auto& holds) { return static_cast<double>(std::count_if(led.begin(), led.end(), holds)); };
    std::array<double, 2> counts{count([&](std::size_t p) { return is_mapped(sums, p); }),
                                 count([&](std::size_t p) { return is_cramped(rocks, sums, p); })};
    communicator_.sum(counts);
    return {static_cast<std::size_t>(counts[0]), static_cast<std::size_t>(counts[1])};
}

/// Takes from rock that has no cells to lie in, or none to see the flow of, what entries it has. Collective
void Mapping::leave_out_unmapped(Stencils& stencils, std::vector<double>& sums) {
    std::vector<double> mapped(stencils.size(), 0.0);
    for (const std::size_t p : stencils.shared.led()) mapped[p] = is_mapped(sums, p) ? 1.0 : 0.0;
    communicator_.sum(mapped);
    std::vector<std::size_t> near;
    for (const std::size_t p : stencils.shared.near())
        if (mapped[p] == 0.0) near.push_back(p);
    lay_again(
        near, [](std::size_t, Stencils& replaced, std::vector<double>&) { replaced.first.push_back(replaced.cell.size()); }, stencils,
        sums);
    for (std::size_t p = 0; p < mapped.size(); ++p)
        if (mapped[p] == 0.0) stencils.without_cells.push_back(p);
}

void Mapping::require_cells(const RockShapes& rocks, const Stencils& stencils) const {
    if (stencils.without_cells.empty()) return;
    const std::size_t p = stencils.without_cells.front();
    SizeField::Vicinity vicinity;
    const double width = mapping_width(kernel_, rocks.diameter[p], sizes_.around(frames_, rocks.position[p], vicinity).size);
    throw no_cell_near(rocks, p, physics::k_kernel_reach * width);
}

/// Drops what is known about rock that has left.
void Mapping::forget_vicinities(std::size_t rocks) {
    if (vicinities_.size() <= k_kept_vicinities * (rocks + 1)) return;
    for (auto i = vicinities_.begin(); i != vicinities_.end();)
        i = i->second.last_build + k_kept_builds < builds_ ? vicinities_.erase(i) : std::next(i);
}

/// Cells of a zone within the kernel's reach of a point [m, zone's frame], and some more.
const NearbyPoints& Mapping::nearby_cells(KnownVicinity& vicinity, Zone zone, const Vec3& point, double width) const {
    vicinity.kernel.resize(frames_.zones());
    NearbyPoints& nearby = vicinity.kernel[zone];
    if (nearby.known_about(point) < physics::k_kernel_reach * width)
        nearby = trees_.of(zone).about(point, (physics::k_kernel_reach + k_skin) * width);
    return nearby;
}

/// Unnormalised weights of this rank's cells around a rock, with the visibility as it was last looked at, and their part of the rock's
/// sums.
void Mapping::add_entries(const RockShapes& rocks, std::size_t rock, const Through& through, Stencils& stencils,
                          std::vector<double>& sums) {
    const double width = stencils.width[rock], inverse_width2 = 1.0 / (width * width);
    const double share = physics::resolved_share(kernel_.gamma * rocks.diameter[rock] / width);
    const bool shell = kernel_.sampling == k_quadratic_sampling;
    const bool sees_all = visibility_.sees_all();
    double deposits = 0.0, samples = 0.0, overlaps = 0.0, seen = 0.0, behind = 0.0;
    const double reach2 = physics::k_kernel_reach2 * width * width;
    std::size_t entries = stencils.cell.size();
    for (Zone zone = 0; zone < frames_.zones(); ++zone) {
        const Vec3 here = frames_.from_absolute(zone, rocks.position[rock]);
        const NearbyPoints& nearby = nearby_cells(vicinities_[rocks.id[rock]], zone, here, width);
        stencils.resize_entries(entries + nearby.indices.size());
        for (const std::int32_t place : nearby.indices) {
            const double squared_distance = (trees_.centre(place) - here).squaredNorm();
            if (squared_distance >= reach2) continue;
            const double visible = sees_all ? 1.0 : visibility_.visible_fraction(place), open = open_.at(place);
            const double in_view = visible * open;
            const double volume = trees_.volume(place), room = (1.0 - squared_distance / reach2) * volume;
            seen += in_view * room;
            behind += (1.0 - in_view) * room;
            const double counts = (visible + (1.0 - visible) * through.steel) * (open + (1.0 - open) * through.soil);
            if (counts == 0.0) continue;
            const double q = squared_distance * inverse_width2;
            const double gaussian = physics::gaussian_weight(q);
            const double resolved =
                shell ? physics::quadratic_weight(q) / physics::k_quadratic_integral : physics::near_weight(q) / physics::k_near_integral;
            const double deposit = counts * gaussian, sample = counts * physics::sampling_weight(resolved, gaussian, share);
            stencils.cell[entries] = trees_.number(place);
            stencils.deposit[entries] = deposit;
            stencils.sample[entries] = sample;
            ++entries;
            deposits += deposit * volume;
            samples += sample * volume;
            overlaps += deposit * sample * volume;
        }
    }
    stencils.resize_entries(entries);
    stencils.first.push_back(stencils.cell.size());
    sums[k_sums * rock + deposit_sum] = deposits;
    sums[k_sums * rock + sample_sum] = samples;
    sums[k_sums * rock + overlap_sum] = overlaps;
    sums[k_sums * rock + seen_room] = seen;
    sums[k_sums * rock + hidden_room] = behind;
}

void Mapping::look_from_nearest_cell(const RockShapes& rocks, std::size_t rock, double width) {
    visibility_.look_from_point(sizes_.nearest_centre(frames_, rocks.position[rock]), physics::k_kernel_reach * 2.0 * width);
}

/// Lays some of the rocks near this rank again. Collective. \param lay  adds the entries of one of them
template <typename Lay>
void Mapping::lay_again(const std::vector<std::size_t>& again, const Lay& lay, Stencils& stencils, std::vector<double>& sums) {
    Stencils replaced;
    replaced.shared = stencils.shared;
    replaced.without_cells = stencils.without_cells;
    replaced.first.push_back(0);
    replaced.width = stencils.width;
    replaced.zone = stencils.zone;
    std::vector<double> new_sums(sums.size(), 0.0);
    auto next = again.begin();
    for (std::size_t p = 0; p < stencils.size(); ++p) {
        if (next != again.end() && *next == p) {
            lay(p, replaced, new_sums);
            ++next;
            continue;
        }
        for (std::size_t i = stencils.first[p]; i < stencils.first[p + 1]; ++i) {
            replaced.cell.push_back(stencils.cell[i]);
            replaced.deposit.push_back(stencils.deposit[i]);
            replaced.sample.push_back(stencils.sample[i]);
        }
        replaced.first.push_back(replaced.cell.size());
    }
    replaced.shared.sum(new_sums, k_sums, communicator_);
    for (const std::size_t p : again) std::copy_n(&new_sums[k_sums * p], k_sums, &sums[k_sums * p]);
    stencils = std::move(replaced);
}

/// Rocks without a visible cell of water (the mesh's steel and the DEM's walls differ slightly, and the centre of a small rock can lie
/// inside the mesh's steel) are mapped from the centre of the nearest cell, soil or not. \return those near this rank
std::vector<std::size_t> Mapping::replace_hidden(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums) {
    std::vector<std::size_t> hidden;
    for (const std::size_t p : stencils.shared.near())
        if (!is_mapped(sums, p)) hidden.push_back(p);
    const auto lay = [&](std::size_t p, Stencils& replaced, std::vector<double>& new_sums) {
        look_from_nearest_cell(rocks, p, replaced.width[p]);
        add_entries(rocks, p, {0.0, 1.0}, replaced, new_sums);
    };
    lay_again(hidden, lay, stencils, sums);
    return hidden;
}

/// What a cell out of view, or of soil, counts for a rock: 0 when it sees k_ample times the room that holds it at kernel.maxSolidFraction,
/// 1 when it sees nothing, between them in proportion.
double Mapping::share_beyond(double diameter, double seen) const {
    const double ample = k_ample * sphere_volume(diameter) / kernel_.max_solid_fraction;
    return std::max(0.0, 1.0 - seen / ample);
}

bool Mapping::is_cramped(const RockShapes& rocks, const std::vector<double>& sums, std::size_t rock) const {
    return sums[k_sums * rock + hidden_room] > 0.0 && share_beyond(rocks.diameter[rock], sums[k_sums * rock + seen_room]) > 0.0;
}

/// A rock in a nook of the mesh, where it sees too few cells to lie in, is laid over cells behind the steel, or in soil, as well. Otherwise
/// no cell in its reach had room for it.
void Mapping::make_room_for_cramped(const RockShapes& rocks, Stencils& stencils, std::vector<double>& sums,
                                    const std::vector<std::size_t>& hidden) {
    std::vector<std::size_t> cramped;
    for (const std::size_t p : stencils.shared.near())
        if (is_cramped(rocks, sums, p)) cramped.push_back(p);
    const auto lay = [&](std::size_t p, Stencils& replaced, std::vector<double>& new_sums) {
        if (std::binary_search(hidden.begin(), hidden.end(), p))
            look_from_nearest_cell(rocks, p, replaced.width[p]);
        else
            look_from(rocks, p, replaced.width[p]);
        const double beyond = share_beyond(rocks.diameter[p], sums[k_sums * p + seen_room]);
        add_entries(rocks, p, {beyond, beyond}, replaced, new_sums);
    };
    lay_again(cramped, lay, stencils, sums);
}

namespace {

template <typename Value>
void deposit_values(const Stencils& stencils, gsl::span<const Value> amount, gsl::span<Value> cell_values) {
    for (std::size_t p = 0; p < stencils.size(); ++p) {
        const Value of_rock = amount[p];
        for (std::size_t i = stencils.first[p]; i < stencils.first[p + 1]; ++i)
            cell_values[static_cast<std::size_t>(stencils.cell[i])] += stencils.deposit[i] * of_rock;
    }
}

}  // namespace

void deposit(const Stencils& stencils, gsl::span<const double> amount, gsl::span<double> cell_values) {
    deposit_values(stencils, amount, cell_values);
}

void deposit(const Stencils& stencils, gsl::span<const Vec3> amount, gsl::span<Vec3> cell_values) {
    deposit_values(stencils, amount, cell_values);
}

}  // namespace cutterflow::coupling
