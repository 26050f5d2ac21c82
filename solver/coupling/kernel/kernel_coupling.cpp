#include "solver/coupling/kernel/kernel_coupling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "geometry/base/error.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/coupling/kernel/redistribution.hpp"
#include "solver/physics/kernels.hpp"
#include "solver/physics/own_trace.hpp"

namespace cutterflow::coupling {
namespace {

/// Share of the carry that the fluid receives per step. The whole carry oscillates where drag is stiff (K dt above the void fraction alpha,
/// as in a gas): with A = alpha + K dt, velocities follow roots of magnitude sqrt(K dt / A), for half of it below sqrt(1/2).
constexpr double k_carry_share = 0.5;

/// Rock and interface travel at most this share of the kernel width per step: where the fluid feels rock, so that its fields are smooth in
/// time, and where it does not, so that the flow a rock feels hardly changes in a step.
constexpr double k_travel_share = 0.25;
constexpr double k_travel_share_one_way = 0.5;

/// Walls take the rock that they sweep from a cell itself up to this share of the cell's volume, so that the cell keeps fluid.
constexpr double k_swept_share = 0.25;

std::vector<double> volumes_of(const Rocks& rocks) {
    std::vector<double> volumes;
    for (const double d : rocks.diameter) volumes.push_back(sphere_volume(d));
    return volumes;
}

std::vector<double> void_fraction_of(const std::vector<double>& solid_fraction) {
    std::vector<double> void_fraction(solid_fraction.size());
    std::transform(solid_fraction.begin(), solid_fraction.end(), void_fraction.begin(), [](double f) { return 1.0 - f; });
    return void_fraction;
}

/// Above this solid fraction the fluid's equations are meaningless.
constexpr double k_solvable_solid_fraction = 0.95;

double largest_of(const std::vector<double>& solid_fraction, Communicator& communicator) {
    double largest = 0.0;
    for (const double f : solid_fraction) largest = std::max(largest, f);
    communicator.max(gsl::span<double>(&largest, 1));
    return largest;
}

int count_above(double limit, const std::vector<double>& solid_fraction, Communicator& communicator) {
    auto count = static_cast<double>(std::count_if(solid_fraction.begin(), solid_fraction.end(), [&](double f) { return f > limit; }));
    communicator.sum(gsl::span<double>(&count, 1));
    return static_cast<int>(count);
}

/// Solid fraction above which volume moves to other cells in reach. Rock that is laid evenly over groups of cells has none to go to.
double redistribution_limit(const KernelSettings& kernel) {
    return kernel.map == k_gaussian_map ? kernel.max_solid_fraction : std::numeric_limits<double>::infinity();
}

/// \throws CheckFailure  when redistribution found no room
void require_room(double largest_solid_fraction, const KernelSettings& kernel) {
    if (largest_solid_fraction <= k_solvable_solid_fraction) return;
    const std::string what = fmt::format("a cell holds a solid fraction of {:.3f}", largest_solid_fraction);
    if (kernel.map != k_gaussian_map)
        throw CheckFailure({"", what, fmt::format("kernel.map = {} moves no rock to other cells", kernel.map),
                            "Place less rock there, lay it over more cells, or set: map gaussian;"});
    throw CheckFailure({"", what,
                        fmt::format("Rock is spread until no cell holds more than kernel.maxSolidFraction = {}; here all cells in reach "
                                    "are full",
                                    kernel.max_solid_fraction),
                        "Place less rock there, or widen kernel.gamma"});
}

/// Sum of a field's values over the cells of a rock's kernel, by their share of what the rock samples.
template <typename Value>
Value sum_over_kernel(const Stencils& stencils, std::size_t rock, gsl::span<const double> volumes, gsl::span<const Value> field,
                      Value sum) {
    for (std::size_t i = stencils.first[rock]; i < stencils.first[rock + 1]; ++i) {
        const auto c = static_cast<std::size_t>(stencils.cell[i]);
        sum += stencils.sample[i] * volumes[c] * field[c];
    }
    return sum;
}

}  // namespace

KernelCoupling::KernelCoupling(const CouplingSettings& settings, const FluidProperties& properties, FluidEngine& fluid, DemEngine& dem,
                               Communicator& communicator)
    : settings_(settings),
      properties_(properties),
      fluid_(fluid),
      dem_(dem),
      communicator_(communicator),
      drag_(physics::find_drag_law(settings.closures.drag)),
      hindrance_(physics::find_hindrance_law(settings.closures.hindrance)),
      lift_(physics::find_lift_law(settings.closures.lift)),
      mapping_(fluid.cells(), fluid.steel(), fluid.moving_zones(), settings.kernel, communicator,
               fluid.feels_rock() ? NodeView::all_nodes : NodeView::one_node),
      interface_speed_(mapping_.sizes().interface_speed(fluid.moving_zones())),
      carry_(fluid.cells().centres.size(), Vec3::Zero()) {
    map_present_rock();
}

RockShapes KernelCoupling::shapes(const std::vector<Vec3>& position) const {
    return {dem_.rocks().id, position, dem_.rocks().diameter};
}

void KernelCoupling::map_present_rock() {
    mapping_.set_time(fluid_.time());
    mapping_.build(shapes(dem_.rocks().position), present_);
}

void KernelCoupling::restore(std::vector<Vec3> carry, const BookedExchange& booked) {
    carry_ = std::move(carry);
    booked_ = booked;
    map_present_rock();
}

std::vector<int> KernelCoupling::insert(const std::vector<FeedRock>& due) {
    Rocks candidates = rocks_of(due);
    mapping_.set_time(fluid_.time());
    const RockShapes shapes{candidates.id, candidates.position, candidates.diameter};
    mapping_.build(shapes, present_);
    mapping_.require_cells(shapes, present_);
    std::vector<FlowAtRock> flow;
    sample_with(present_, flow);
    for (const FeedRock& rock : due) {
        const auto p =
            static_cast<std::size_t>(std::lower_bound(candidates.id.begin(), candidates.id.end(), rock.id) - candidates.id.begin());
        if (!rock.velocity) candidates.velocity[p] = flow[p].velocity;
    }
    const std::vector<int> inserted = dem_.insert(candidates);
    std::vector<int> rejected;
    for (std::size_t p = 0; p < candidates.size(); ++p) {
        if (!std::binary_search(inserted.begin(), inserted.end(), candidates.id[p])) {
            rejected.push_back(candidates.id[p]);
            continue;
        }
        const double volume = sphere_volume(candidates.diameter[p]);
        booked_.volume += volume;
        booked_.momentum += properties_.density * volume * flow[p].velocity;
    }

    follow_set_of_rock();
    return rejected;
}

std::vector<bool> KernelCoupling::room_for(const std::vector<FeedRock>& rocks) const {
    return dem_.room_for(as_listed(rocks));
}

void KernelCoupling::adopt_present_rock() {
    map_present_rock();
    mapping_.require_cells(shapes(dem_.rocks().position), present_);
    std::vector<FlowAtRock> flow;
    sample_with(present_, flow);
    for (std::size_t p = 0; p < dem_.rocks().size(); ++p) {
        const double volume = sphere_volume(dem_.rocks().diameter[p]);
        booked_.volume += volume;
        booked_.momentum += properties_.density * volume * flow[p].velocity;
    }
    follow_set_of_rock();
}

void KernelCoupling::remove(gsl::span<const int> ids) {
    const Rocks& rocks = dem_.rocks();
    Rocks leaving;
    for (const int id : ids)
        leaving.append(rocks, static_cast<std::size_t>(std::lower_bound(rocks.id.begin(), rocks.id.end(), id) - rocks.id.begin()));
    mapping_.set_time(fluid_.time());
    mapping_.build({leaving.id, leaving.position, leaving.diameter}, present_);
    std::vector<FlowAtRock> flow;
    sample_with(present_, flow);
    for (std::size_t p = 0; p < leaving.size(); ++p) {
        if (!flow[p].has_cells) continue;
        const double volume = sphere_volume(leaving.diameter[p]);
        booked_.volume -= volume;
        booked_.momentum -= properties_.density * volume * flow[p].velocity;
    }
    dem_.remove(ids);
    follow_set_of_rock();
}

/// After rock came or went. A flow that does not feel rock gets its void fraction with the next sample.
void KernelCoupling::follow_set_of_rock() {
    if (fluid_.feels_rock()) replace_void_fraction();
}

void KernelCoupling::replace_void_fraction() {
    const std::vector<double> solid_fraction = spread_present_rock();
    note_fullness(solid_fraction, largest_of(solid_fraction, communicator_));
    void_fraction_new_ = void_fraction_of(solid_fraction);
    fluid_.reset_void_fraction(void_fraction_new_);
}

/// \return solid fraction per cell of the rocks where they are
std::vector<double> KernelCoupling::spread_present_rock() {
    map_present_rock();
    Stencils* const stencils[] = {&present_};
    return redistribute(stencils, volumes_of(dem_.rocks()), mapping_.cells().volumes, redistribution_limit(settings_.kernel),
                        communicator_)[0];
}

void KernelCoupling::sample_with(const Stencils& stencils, std::vector<FlowAtRock>& flow) const {
    const FluidFields fields = fluid_.fields();
    const gsl::span<const double> volumes = mapping_.cells().volumes;
    std::vector<std::pair<gsl::span<const Vec3>, Vec3 FlowAtRock::*>> vectors{{fields.velocity, &FlowAtRock::velocity},
                                                                              {fields.material_acceleration, &FlowAtRock::acceleration}};
    if (lift_ != nullptr) vectors.emplace_back(fluid_.vorticity(), &FlowAtRock::vorticity);
    if (!settings_.closures.viscous_force) vectors.emplace_back(fluid_.stress_divergence(), &FlowAtRock::stress_divergence);
    const std::size_t n = 3 * vectors.size() + 1;
    std::vector<double> sums(n * stencils.size(), 0.0);
    for (std::size_t p = 0; p < stencils.size(); ++p) {
        for (std::size_t k = 0; k < vectors.size(); ++k) {
            const Vec3 sum = sum_over_kernel(stencils, p, volumes, vectors[k].first, Vec3(Vec3::Zero()));
            std::copy_n(sum.data(), 3, &sums[n * p + 3 * k]);
        }
        sums[n * p + n - 1] = sum_over_kernel(stencils, p, volumes, fields.void_fraction, 0.0);
    }
    communicator_.sum(sums);
    flow.assign(stencils.size(), {});
    for (std::size_t p = 0; p < stencils.size(); ++p) {
        for (std::size_t k = 0; k < vectors.size(); ++k) flow[p].*vectors[k].second = Eigen::Map<const Vec3>(&sums[n * p + 3 * k]);
        flow[p].void_fraction = sums[n * p + n - 1];
    }
    for (const std::size_t p : stencils.without_cells) {
        flow[p] = {};
        flow[p].has_cells = false;
    }
}

void KernelCoupling::sample() {
    if (!fluid_.feels_rock()) replace_void_fraction();
    sample_with(present_, flow_);
    note_rock_without_cells();
    if (settings_.kernel.sampling == k_gaussian_sampling && settings_.kernel.map == k_gaussian_map) take_out_own_trace();
}

/// Where rock samples near to where it is laid: the flow at each as if it were not there, see own_trace().
void KernelCoupling::take_out_own_trace() {
    const Rocks& rocks = dem_.rocks();
    enum Known { width, overlap, cell_velocity, k_known = cell_velocity + 3 };  // of the rank that leads a rock
    std::vector<double> known(k_known * rocks.size(), 0.0);
    for (const std::size_t p : present_.shared.led()) {
        known[k_known * p + width] = present_.width[p];
        known[k_known * p + overlap] = present_.overlap[p];
        std::copy_n(velocity_of_cells(p).data(), 3, &known[k_known * p + cell_velocity]);
    }
    communicator_.sum(known);
    balance_.limited.wake_rocks = 0;
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        FlowAtRock& flow = flow_[p];
        if (!flow.has_cells) continue;
        const double* const of_rock = &known[k_known * p];
        const double volume = sphere_volume(rocks.diameter[p]), own = volume * of_rock[overlap];
        const double share = physics::own_trace_share(std::max(0.0, 1.0 - flow.void_fraction - own));
        flow.void_fraction = std::min(1.0, flow.void_fraction + share * own);
        if (!fluid_.feels_rock()) continue;
        const Vec3 slip = flow.velocity - rocks.velocity[p];
        const Vec3 through_cells = rocks.velocity[p] - Eigen::Map<const Vec3>(of_rock + cell_velocity);
        const double drag_rate = drag_per_slip(rock_in_fluid(rocks, p, flow), slip.norm()) / properties_.density;
        const physics::Sampler sampler{volume, of_rock[overlap], of_rock[width],
                                       physics::resolved_share(settings_.kernel.gamma * rocks.diameter[p] / of_rock[width])};
        const physics::OwnTrace trace =
            physics::own_trace(slip, through_cells, drag_rate, sampler, properties_.kinematic_viscosity, fluid_.time_step());
        if (trace.is_limited) ++balance_.limited.wake_rocks;
        flow.velocity += share * trace.velocity;
        flow.acceleration += share * trace.acceleration;
    }
}

/// Of the cells where a rock near this rank is [m/s].
Vec3 KernelCoupling::velocity_of_cells(std::size_t rock) const {
    const Zone zone = present_.zone[rock];
    if (zone == k_still_zone) return Vec3::Zero();
    const ZoneMotion& motion = fluid_.moving_zones()[zone - 1];
    return motion.speed * motion.axis.direction.cross(dem_.rocks().position[rock] - motion.axis.origin);
}

double KernelCoupling::travel_limit() const {
    const Rocks& rocks = dem_.rocks();
    const double share = fluid_.feels_rock() ? k_travel_share : k_travel_share_one_way;
    double limit = std::numeric_limits<double>::infinity();
    for (const std::size_t p : present_.shared.near()) {
        double speed = std::max(rocks.velocity[p].norm(), (rocks.velocity[p] - velocity_of_cells(p)).norm());
        if (fluid_.feels_rock()) speed = std::max(speed, interface_speed_);
        if (speed > 0.0) limit = std::min(limit, share * present_.width[p] / speed);
    }
    double least = -limit;
    communicator_.max(gsl::span<double>(&least, 1));
    return -least;
}

/// The part of the force that does not follow the rock's velocity.
Vec3 KernelCoupling::steady_force(const physics::RockInFluid& rock, const FlowAtRock& flow) const {
    const double volume = sphere_volume(rock.diameter);
    Vec3 force = physics::fluid_acceleration_force(volume, properties_.density, settings_.closures.added_mass, flow.acceleration);
    if (!settings_.closures.viscous_force) force -= physics::viscous_force(volume, properties_.density, flow.stress_divergence);
    return force;
}

const DemStep& KernelCoupling::move() {
    before_ = dem_.rocks();
    struct AtRock {  // what each of the DEM's steps reads lies together
        Vec3 flow_velocity, steady;
        physics::RockInFluid rock;
        bool has_cells;
    };
    std::vector<AtRock> at(before_.size());
    for (std::size_t p = 0; p < before_.size(); ++p) {
        const physics::RockInFluid rock = rock_in_fluid(before_, p, flow_[p]);
        at[p] = {flow_[p].velocity, steady_force(rock, flow_[p]), rock, flow_[p].has_cells};
    }
    const HydrodynamicForce force = [&](std::size_t p, const Vec3& velocity) -> Vec3 {
        if (!at[p].has_cells) return Vec3::Zero();
        const Vec3 slip = at[p].flow_velocity - velocity;
        Vec3 total = drag_per_slip(at[p].rock, slip.norm()) * slip + at[p].steady;
        if (lift_ != nullptr) total += physics::lift_force(at[p].rock, slip, flow_[p].vorticity, lift_);
        return total;
    };
    step_ = dem_.advance(fluid_.time_step(), force);

    require_all_rocks();
    index_before_.clear();
    for (const int id : dem_.rocks().id)
        index_before_.push_back(static_cast<std::size_t>(std::lower_bound(before_.id.begin(), before_.id.end(), id) - before_.id.begin()));
    return step_;
}

/// \throws CheckFailure  when rock neither stays nor leaves
void KernelCoupling::require_all_rocks() const {
    std::vector<int> ids = dem_.rocks().id;
    ids.insert(ids.end(), step_.left.id.begin(), step_.left.id.end());
    std::sort(ids.begin(), ids.end());
    if (ids == before_.id) return;
    throw CheckFailure({"", fmt::format("of {} rocks {} are there or left after a step", before_.size(), ids.size()),
                        "Rock stays in the run or leaves it through the domain's boundary", "Report this as a defect"});
}

/// Tells of the first rock without cells, and again when there were twice as many.
void KernelCoupling::note_rock_without_cells() {
    const Rocks& rocks = dem_.rocks();
    for (const std::size_t p : present_.without_cells) without_cells_.insert(rocks.id[p]);
    if (without_cells_.size() < next_without_cells_) return;
    next_without_cells_ = 2 * without_cells_.size();
    const std::size_t last = present_.without_cells.back();
    const Vec3& x = rocks.position[last];
    warnings_.push_back(
        fmt::format("{} rock(s) so far had no cell of the mesh in reach, rock {} at ({:.6g} {:.6g} {:.6g}) m is one: until it "
                    "has cells it moves by contacts and weight less buoyancy alone, and the fluid feels nothing of it{}. "
                    "Let rock.domain end inside the mesh, or make cells finer there",
                    without_cells_.size(), rocks.id[last], x[0], x[1], x[2],
                    fluid_.feels_rock() ? "; solid_volume_error of balance.csv tells its volume" : ""));
}

/// \throws CheckFailure  when a cell has no room left
void KernelCoupling::note_fullness(const std::vector<double>& solid_fraction, double largest) {
    const double limit = settings_.kernel.max_solid_fraction;
    balance_.solid_fraction_max = largest;
    require_room(largest, settings_.kernel);
    balance_.overfull_cells = count_above(limit, solid_fraction, communicator_);
    if (balance_.overfull_cells > 0)
        warn_once("overfull",
                  fmt::format("{} cells hold more than kernel.maxSolidFraction = {}, at most {:.3f}: no cell in reach has room{}",
                              balance_.overfull_cells, limit, largest, fluid_.feels_rock() ? "; balance.csv counts them" : ""));
}

/// Rock that has cells at one end of the step only would be a source of fluid as large as itself: it counts at neither.
std::vector<double> KernelCoupling::volumes_of_rock_in_both(std::vector<double> volumes) const {
    for (const Stencils* stencils : {&old_, &present_})
        for (const std::size_t p : stencils->without_cells) volumes[p] = 0.0;
    return volumes;
}

void KernelCoupling::map() {
    if (!fluid_.feels_rock()) return check_ranges();
    const Rocks& rocks = dem_.rocks();
    const gsl::span<const double> cell_volume = mapping_.cells().volumes;
    const double dt = fluid_.time_step();
    mapping_.set_time(fluid_.time());

    // Both void fractions hold the same set of rock: those that are still here and have cells before and after the step.
    std::vector<Vec3> old_position, velocity_change;
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        old_position.push_back(before_.position[index_before_[p]]);
        velocity_change.push_back(rocks.velocity[p] - before_.velocity[index_before_[p]]);
    }
    mapping_.build(shapes(old_position), old_);
    mapping_.build(shapes(rocks.position), present_);
    const std::vector<double> volumes = volumes_of(rocks), laid = volumes_of_rock_in_both(volumes);
    Stencils* const both[] = {&old_, &present_};
    const auto fractions = redistribute(both, laid, cell_volume, redistribution_limit(settings_.kernel), communicator_);
    void_fraction_old_ = void_fraction_before(laid, fractions[0], fractions[1]);
    void_fraction_new_ = void_fraction_of(fractions[1]);

    source_.resize(carry_.size());
    std::transform(carry_.begin(), carry_.end(), source_.begin(), [dt](const Vec3& carry) -> Vec3 { return k_carry_share * carry / dt; });
    rock_momentum_.setZero();
    gross_impulse_ = 0.0;
    add_impulses(present_, step_.impulse, velocity_change, volumes);
    if (!step_.left.id.empty()) follow_departures();

    std::vector<double> drag(rocks.size(), 0.0);
    for (const std::size_t p : present_.shared.near()) {
        const FlowAtRock& flow = flow_[index_before_[p]];
        drag[p] = drag_per_slip(rock_in_fluid(rocks, p, flow), (flow.velocity - rocks.velocity[p]).norm()) / properties_.density;
    }
    drag_rate_.assign(carry_.size(), 0.0);
    deposit(present_, drag, drag_rate_);
    even_out_within_kernels(drag);
    inertia_.resize(carry_.size());
    const double factor = 1.0 + settings_.closures.added_mass;
    std::transform(fractions[1].begin(), fractions[1].end(), inertia_.begin(), [factor](double f) { return factor * f; });

    check_ranges();
    balance_.limited.hidden_rocks = static_cast<int>(present_.hidden);
    balance_.limited.cramped_rocks = static_cast<int>(present_.cramped);
    balance_.solid_volume_error = std::max(volume_error(fractions[0], volumes), volume_error(fractions[1], volumes));
    note_fullness(fractions[1], std::max(largest_of(fractions[0], communicator_), largest_of(fractions[1], communicator_)));
}

/// The part of the target that only moves drag between the cells of a kernel: sum_p w_p D_p (ubar_p - u_old) / rho_f. Velocities are taken
/// relative to what the rock saw, so that in a uniform stream, where all differences are rounding, so is what is moved.
/// \param drag  D_p / rho_f [m3/s]
void KernelCoupling::even_out_within_kernels(const std::vector<double>& drag) {
    const gsl::span<const Vec3> velocity = fluid_.fields().velocity;
    const gsl::span<const double> volumes = mapping_.cells().volumes;
    std::vector<double> mean(3 * drag.size(), 0.0);
    for (std::size_t p = 0; p < drag.size(); ++p) {
        const Vec3 seen = flow_[index_before_[p]].velocity;
        Vec3 sum = Vec3::Zero();
        for (std::size_t i = present_.first[p]; i < present_.first[p + 1]; ++i) {
            const auto c = static_cast<std::size_t>(present_.cell[i]);
            sum += present_.deposit[i] * volumes[c] * (velocity[c] - seen);
        }
        std::copy_n(sum.data(), 3, &mean[3 * p]);
    }
    present_.shared.sum(mean, 3, communicator_);
    for (std::size_t p = 0; p < drag.size(); ++p) {
        const Vec3 seen = flow_[index_before_[p]].velocity, mean_of_rock(&mean[3 * p]);
        for (std::size_t i = present_.first[p]; i < present_.first[p + 1]; ++i) {
            const auto c = static_cast<std::size_t>(present_.cell[i]);
            source_[c] += present_.deposit[i] * drag[p] * (mean_of_rock - (velocity[c] - seen));
        }
    }
}

/// The old void fraction on the present cells. Walls move by sweeping cells: with the void fraction alpha_c beside the wall the fluid they
/// displace is alpha_c v.S_c, and the rock of the swept space, (1 - alpha_c) v.S_c dt, was there before and is no more. With s_c = dt v.S_c
/// / V_c a cell held before the step what the old kernels laid there and what was swept of the present ones:
///   solid_old_c = sum_p V_p (w_old_pc + w_pc s_c).
/// What exceeds the largest share of a cell, or fills it, is laid over the rock's old kernel. Without the swept part a blade that passes
/// rock would be a source of fluid; laid over the kernel as a whole, it would be one around the blade.
/// \param old_solid, present_solid  sum_p V_p w_old_pc, sum_p V_p w_pc
std::vector<double> KernelCoupling::void_fraction_before(const std::vector<double>& volume, const std::vector<double>& old_solid,
                                                         const std::vector<double>& present_solid) {
    const gsl::span<const double> retreat = fluid_.wall_retreat();
    const gsl::span<const double> cell_volume = mapping_.cells().volumes;
    std::vector<double> solid_fraction = old_solid, excess(carry_.size(), 0.0);
    std::vector<double> beyond(volume.size() + 1, 0.0);  // of each rock; the number of cells with an excess
    for (std::size_t c = 0; c < carry_.size(); ++c) {
        if (retreat[c] == 0.0 || present_solid[c] == 0.0) continue;
        const double swept = fluid_.time_step() * retreat[c] / cell_volume[c];
        const double room = std::max(0.0, k_solvable_solid_fraction - old_solid[c]) / present_solid[c];
        const double here = std::clamp(swept, -k_swept_share, std::min(k_swept_share, room));
        solid_fraction[c] += present_solid[c] * here;
        excess[c] = swept - here;
    }
    const auto is_some = [](double value) { return value != 0.0; };
    beyond.back() = static_cast<double>(std::count_if(excess.begin(), excess.end(), is_some));
    for (std::size_t p = 0; is_some(beyond.back()) && p < present_.size(); ++p)
        for (std::size_t i = present_.first[p]; i < present_.first[p + 1]; ++i) {
            const auto c = static_cast<std::size_t>(present_.cell[i]);
            if (is_some(excess[c])) beyond[p] += volume[p] * present_.deposit[i] * excess[c] * cell_volume[c];
        }
    communicator_.sum(beyond);
    balance_.limited.swept_cells = static_cast<int>(beyond.back());
    if (balance_.limited.swept_cells > 0) deposit(old_, beyond, solid_fraction);
    return void_fraction_of(solid_fraction);
}

physics::RockInFluid KernelCoupling::rock_in_fluid(const Rocks& rocks, std::size_t p, const FlowAtRock& flow) const {
    return {rocks.diameter[p], properties_.density, properties_.kinematic_viscosity, flow.void_fraction, sphericity_of(rocks.shape[p])};
}

double KernelCoupling::sphericity_of(int shape) const {
    const double given = settings_.closures.sphericity;
    return shape == k_sphere_shape ? given : settings_.shapes[static_cast<std::size_t>(shape)].clump.sphericity.value_or(given);
}

double KernelCoupling::drag_per_slip(const physics::RockInFluid& rock, double slip_speed) const {
    return physics::drag_coefficient_per_slip(rock, slip_speed, drag_, hindrance_, settings_.closures.drag_modifier);
}

void KernelCoupling::check_ranges() {
    const Rocks& rocks = dem_.rocks();
    std::vector<const physics::Closure*> in_use{&physics::find_closure(physics::ClosureKind::drag, settings_.closures.drag)};
    if (settings_.closures.hindrance != physics::k_no_closure)
        in_use.push_back(&physics::find_closure(physics::ClosureKind::hindrance, settings_.closures.hindrance));
    if (lift_ != nullptr) in_use.push_back(&physics::find_closure(physics::ClosureKind::lift, settings_.closures.lift));
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        const FlowAtRock& flow = flow_[index_before_[p]];
        if (!flow.has_cells) continue;
        const double d_over_nu = rocks.diameter[p] / properties_.kinematic_viscosity;
        physics::RockNumbers numbers;
        numbers.reynolds = (flow.velocity - rocks.velocity[p]).norm() * d_over_nu;
        numbers.particle_reynolds = flow.void_fraction * numbers.reynolds;
        numbers.shear_reynolds = flow.vorticity.norm() * rocks.diameter[p] * d_over_nu;
        numbers.void_fraction = flow.void_fraction;
        numbers.sphericity = sphericity_of(rocks.shape[p]);
        for (const physics::Closure* closure : in_use) check_range(*closure, numbers, rocks.id[p]);
    }
    if (mapping_.had_hidden_rock())
        warn_once("hidden",
                  "a rock's centre lies inside the mesh's steel; it is mapped from the nearest cell (steel of mesh and walls differ); "
                  "balance.csv counts such rock");
    if (mapping_.had_cramped_rock())
        warn_once("cramped",
                  "a rock in a nook of the mesh sees too few cells to lie in; it also lies in cells behind the steel; balance.csv counts "
                  "such rock");
}

void KernelCoupling::check_range(const physics::Closure& closure, const physics::RockNumbers& numbers, int id) {
    for (const physics::ClosureRange& range : closure.ranges) {
        const double value = numbers.value_of(range.argument);
        const std::string_view symbol = physics::argument_symbol(range.argument);
        if (!range.excludes(value)) continue;
        const std::string subject = std::string(closure.name) + std::string(symbol);
        if (warned_.count(subject) == 0)  // the text of a warning costs more than all else here
            warn_once(subject, fmt::format("{} is used at {} = {:.4g} (rock {}), outside the range {:g} to {:g} of its source {}",
                                           closure.name, symbol, value, id, range.minimum, range.maximum, closure.citation));
    }
}

void KernelCoupling::warn_once(const std::string& subject, const std::string& text) {
    if (warned_.insert(subject).second) warnings_.push_back(text);
}

/// Adds what the fluid is to receive of rocks that got `impulse` [N s] from it and changed their velocity [m/s].
void KernelCoupling::add_impulses(const Stencils& stencils, gsl::span<const Vec3> impulse, gsl::span<const Vec3> velocity_change,
                                  gsl::span<const double> volume) {
    const double dt = fluid_.time_step();
    std::vector<Vec3> amount;
    for (std::size_t p = 0; p < stencils.size(); ++p) {
        const Vec3 received = impulse[p] - settings_.closures.added_mass * properties_.density * volume[p] * velocity_change[p];
        rock_momentum_ += received;
        gross_impulse_ += received.norm();
        amount.push_back(-received / (properties_.density * dt));
    }
    deposit(stencils, amount, source_);
}

/// Rocks that left in the step: their impulse goes back where they were when it began, and fluid takes their place without a source.
void KernelCoupling::follow_departures() {
    std::vector<int> id;
    std::vector<Vec3> position, impulse, velocity_change;
    std::vector<double> diameter, volume;
    for (std::size_t k = 0; k < step_.left.size(); ++k) {
        const auto p =
            static_cast<std::size_t>(std::lower_bound(before_.id.begin(), before_.id.end(), step_.left.id[k]) - before_.id.begin());
        id.push_back(before_.id[p]);
        position.push_back(before_.position[p]);
        diameter.push_back(before_.diameter[p]);
        volume.push_back(sphere_volume(before_.diameter[p]));
        impulse.push_back(step_.left_impulse[k]);
        velocity_change.push_back(step_.left.velocity[k] - before_.velocity[p]);
        if (!flow_[p].has_cells) continue;
        booked_.volume -= volume.back();
        booked_.momentum -= properties_.density * volume.back() * flow_[p].velocity;
    }
    mapping_.build({id, position, diameter}, old_);
    add_impulses(old_, impulse, velocity_change, volume);
}

double KernelCoupling::volume_error(const std::vector<double>& solid_fraction, const std::vector<double>& rock_volume) const {
    double sum = 0.0, rock = 0.0;
    for (std::size_t c = 0; c < solid_fraction.size(); ++c) sum += solid_fraction[c] * mapping_.cells().volumes[c];
    communicator_.sum(gsl::span<double>(&sum, 1));
    for (const double volume : rock_volume) rock += volume;
    return rock > 0.0 ? std::abs(sum - rock) / rock : 0.0;
}

ExchangeBalance KernelCoupling::book() {
    if (!fluid_.feels_rock()) return balance_;
    const gsl::span<const Vec3> received = fluid_.received();
    const gsl::span<const double> void_fraction = fluid_.fields().void_fraction;
    const gsl::span<const double> volumes = mapping_.cells().volumes;
    const double dt = fluid_.time_step();
    Eigen::Vector4d sums = Eigen::Vector4d::Zero();  // deposits of the step and amount of carry, over rho_f
    std::vector<double> solid_fraction(carry_.size());
    for (std::size_t c = 0; c < carry_.size(); ++c) {
        solid_fraction[c] = 1.0 - void_fraction[c];
        sums.head<3>() += (source_[c] * dt - k_carry_share * carry_[c]) * volumes[c];
        sums[3] += carry_[c].norm() * volumes[c];
        carry_[c] += (source_[c] - received[c]) * dt - k_carry_share * carry_[c];
    }
    communicator_.sum(gsl::span<double>(sums.data(), 4));
    sums *= properties_.density;
    const double gross = gross_impulse_ + sums[3];
    balance_.solid_volume_error = std::max(balance_.solid_volume_error, volume_error(solid_fraction, volumes_of(dem_.rocks())));
    balance_.deposit_error = gross > 0.0 ? (rock_momentum_ + sums.head<3>()).norm() / gross : 0.0;
    return balance_;
}

}  // namespace cutterflow::coupling
