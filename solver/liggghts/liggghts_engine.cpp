#include "solver/liggghts/liggghts_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <optional>
#include <stdexcept>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <gsl/assert>
#include <nlohmann/json.hpp>

#include "atom.h"
#include "atom_vec.h"
#include "domain.h"
#include "fix_contact_history.h"
#include "fix_property_atom.h"
#include "geometry/base/file_content.hpp"
#include "input.h"
#include "lammps.h"
#include "modify.h"
#include "update.h"

#include "geometry/base/error.hpp"
#include "geometry/base/json_document.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/liggghts/clump_state.hpp"
#include "solver/liggghts/contacts/contact_registration.hpp"
#include "solver/liggghts/contacts/wall_contacts.hpp"
#include "solver/liggghts/liggghts_commands.hpp"
#include "solver/liggghts/rigid_bodies.hpp"
#include "solver/liggghts/rock_grid.hpp"
#include "solver/liggghts/rock_motion.hpp"
#include "solver/liggghts/steel_wall.hpp"
#include "solver/liggghts/wall_work_state.hpp"
#include "solver/physics/contact.hpp"

namespace cutterflow::liggghts {

namespace {

using coupling::Rocks;

constexpr double k_skin_in_radii = 0.4;       // of the largest rock: neighbour lists hold until something moved half of it
constexpr double k_skin_without_rock = 4e-4;  // of the domain's half width
constexpr double k_margin_in_radii = 0.25;    // of the domain's half width: room that a rock may use between leaving it and being removed
constexpr double k_most_bins = 1e5;           // of little rock: LIGGGHTS clears all bins at each rebuild
constexpr double k_bins_per_rock = 10.0;      // of much rock, however little of the domain it fills
constexpr const char* k_restart_file = "dem.restart";
constexpr const char* k_restart_hash = "restart_sha256";
constexpr const char* k_rolling_history = "rolling_history";
constexpr const char* k_walls = "walls";
constexpr const char* k_remedy = "Remove this checkpoint folder; the run then resumes from the one before";
constexpr const char* k_clumps = "clumps";
constexpr const char* k_motion = "rock_motion";
constexpr const char* k_contact_memory = "contact_memory";
// 1, without the key: speeds of impacts in place of their radii; 2: the springs of a contact one after the other.
constexpr int k_this_contact_memory = 3;
constexpr const char* k_pressed = "pressed_m";  // of a wall in a checkpoint
constexpr const char* k_wall_contacts = "wall_contacts";
constexpr const char* k_wall_rolling = "wall_rolling";
constexpr const char* k_contact_forces = "contact_forces";

/// k_margin_in_radii with clumps, half of it for their spheres beyond the centre.
constexpr double k_clump_margin = 2.0 * coupling::k_largest_reach;

std::array<double, 3> as_list(const Vec3& v) {
    return {v.x(), v.y(), v.z()};
}

/// Smallest upright box around a domain.
commands::SimulationBox bounds(const coupling::DomainSettings& domain) {
    commands::SimulationBox box{domain.lower, domain.upper};
    if (domain.shape == coupling::DomainShape::box) return box;
    box.low.head<2>() = domain.axis_point.head<2>().array() - domain.radius;
    box.high.head<2>() = domain.axis_point.head<2>().array() + domain.radius;
    return box;
}

/// A length of a domain's size: half its larger horizontal width [m].
double half_width(const coupling::DomainSettings& domain) {
    const commands::SimulationBox box = bounds(domain);
    return 0.5 * (box.high - box.low).head<2>().maxCoeff();
}

/// Redirects standard output and error during its lifetime: some output of LIGGGHTS has no switch.
class QuietOutput {
public:
    QuietOutput() : saved_{dup(STDOUT_FILENO), dup(STDERR_FILENO)} {
        std::fflush(nullptr);
        const int nowhere = open("/dev/null", O_WRONLY);
        dup2(nowhere, STDOUT_FILENO);
        dup2(nowhere, STDERR_FILENO);
        close(nowhere);
    }
    ~QuietOutput() {
        std::fflush(nullptr);
        dup2(saved_[0], STDOUT_FILENO);
        dup2(saved_[1], STDERR_FILENO);
        for (const int descriptor : saved_) close(descriptor);
    }
    QuietOutput(const QuietOutput&) = delete;
    QuietOutput& operator=(const QuietOutput&) = delete;

private:
    int saved_[2];
};

/// LIGGGHTS reads a damaged file without a check, or for ever. \param state  dem.json; of before it had the hash any file is taken that is
/// not empty
void require_whole_restart_file(const std::filesystem::path& file, const nlohmann::json& state) {
    const char* const rule = "A checkpoint holds the state of the rock as it was written";
    if (!std::filesystem::is_regular_file(file)) throw UserError({{file.string(), "there is no such file", rule, k_remedy}});
    if (std::filesystem::file_size(file) == 0) throw UserError({{file.string(), "the file is empty", rule, k_remedy}});
    if (state.contains(k_restart_hash) && state.at(k_restart_hash) != sha256_of_file(file))
        throw UserError({{file.string(), fmt::format("the file is not the one that {} belongs to", names::dem_state), rule, k_remedy}});
}

/// LIGGGHTS drops what leaves its box within one step of contacts.
CheckFailure vanished(const std::string& what) {
    return CheckFailure({"", what, "The DEM drops rock that leaves its box within a step of contacts, thrown out by a deep overlap",
                         "Look at the last picture; give the rock a larger modulus, solids less speed, or the contacts a smaller step"});
}

}  // namespace

class LiggghtsEngine::Implementation {
public:
    Implementation(const coupling::DemSettings& settings, std::vector<coupling::ZoneMotion> moving, MPI_Comm communicator);
    ~Implementation();

    const Rocks& rocks() const { return rocks_; }
    double largest_time_step() const;
    std::vector<bool> room_for(const Rocks& candidates) const;
    std::vector<int> insert(const Rocks& candidates);
    void remove(gsl::span<const int> ids);
    const std::vector<int>& frozen() const { return frozen_; }
    void set_frozen(gsl::span<const int> ids, bool frozen);
    double walls_change_until() const;
    coupling::DemStep advance(double duration, const coupling::HydrodynamicForce& force);
    std::vector<coupling::WallWork> wall_work() const;
    std::vector<double> zone_angles() const {
        if (!has_rotor_) return {};
        return {rotor_.angle(time_)};
    }
    void write_checkpoint(const std::filesystem::path& folder);
    void read_checkpoint(const std::filesystem::path& folder);
    void start_from(const std::filesystem::path& folder);

private:
    void start_liggghts();
    void declare(const std::optional<std::filesystem::path>& restart, const std::vector<std::string>& walls_of_restart = {});
    void declare_walls();
    void declare_motion();
    void command(const std::string& text) { lammps_->input->one(text.c_str()); }
    void commands(const std::vector<std::string>& texts) {
        for (const std::string& text : texts) command(text);
    }
    commands::SimulationBox box() const;
    void set_neighbours();
    void set_up();
    void gather();
    void require_all_rocks(const std::vector<int>& before) const;
    bool overlaps_wall(const Vec3& centre, double radius) const;
    bool fits_margin(const coupling::Rock& rock) const;
    Eigen::AlignedBox3d bounds_of(const Rocks& rocks) const;
    void create_rock(const coupling::Rock& rock);
    void create_particle(const coupling::Rock& rock, int tag, const geometry::Ball& ball);
    void delete_rocks(const std::vector<int>& sorted_ids);
    void after_change_of_rocks();
    std::vector<std::string> body_names() const;
    Vec3 pressed(std::size_t body) const;
    nlohmann::json read_state_file(const std::filesystem::path& folder) const;
    void read_rocks(const std::filesystem::path& folder, const nlohmann::json& state);
    void adopt_work(const std::filesystem::path& folder);
    void adopt_wall_contacts(const std::vector<std::string>& names_before);
    std::vector<Vec3> sum(std::vector<Vec3> values) const;
    void store_contact_forces();
    void restore_contact_forces();
    double sum(double value) const;
    bool is_first_rank() const;

    coupling::DemSettings settings_;
    bool has_rotor_;
    coupling::ZoneMotion rotor_;  // the only moving zone; at rest when there is none
    MPI_Comm communicator_ = MPI_COMM_NULL;
    ContactContext context_;
    std::optional<WallContacts> wall_contacts_;
    std::vector<SteelWall> walls_;
    RigidBodies bodies_;
    std::unique_ptr<LAMMPS_NS::LAMMPS> lammps_;
    RockMotion* motion_ = nullptr;  // LIGGGHTS owns it
    LAMMPS_NS::FixPropertyAtom* contact_forces_ = nullptr;
    LAMMPS_NS::FixPropertyAtom* records_ = nullptr;  // of contacts with walls
    Rocks rocks_;
    std::vector<Vec3> impulse_, contact_impulse_;  // of the last call of advance, rock by rock [N s]
    double time_ = 0.0;
    std::vector<int> frozen_;             // ids
    double contact_torque_ = 0.0;         // on rotating steel, of the contact forces that are stored; this rank's share [N m]
    std::vector<Vec3> forces_on_bodies_;  // likewise [N]
    std::vector<double> work_since_;      // of each wall [s]
    double largest_radius_ = 0.0;
    bool set_up_needed_ = true;
};

namespace {

const coupling::DemSettings& checked(const coupling::DemSettings& settings) {
    std::vector<Mistake> mistakes = coupling::check_settings(settings, "constant/couplingProperties");
    if (!mistakes.empty()) throw UserError(std::move(mistakes));
    return settings;
}

}  // namespace

LiggghtsEngine::Implementation::Implementation(const coupling::DemSettings& settings, std::vector<coupling::ZoneMotion> moving,
                                               MPI_Comm communicator)
    : settings_(checked(settings)),
      has_rotor_(!moving.empty()),
      rotor_(has_rotor_ ? moving.front() : coupling::ZoneMotion{}),
      context_(settings, rotor_),
      bodies_(settings_.shapes, context_) {
    Expects(moving.size() <= 1);
    forces_on_bodies_ = context_.tally.force_on_body;
    for (const coupling::WallSettings& wall : settings_.walls) walls_.emplace_back(wall, static_cast<int>(walls_.size()), rotor_);
    work_since_.resize(walls_.size());
    for (std::size_t body = 0; body < walls_.size(); ++body)
        if (!walls_[body].is_soil()) context_.work[body].resize(walls_[body].surface().triangles().size());
    MPI_Comm_dup(communicator, &communicator_);
    register_contact_models();
    start_liggghts();
    declare(std::nullopt);
}

LiggghtsEngine::Implementation::~Implementation() {
    ContactContext::clear(lammps_.get());
    lammps_.reset();
    MPI_Comm_free(&communicator_);
}

/// Encloses the domain with room for rock that is leaving.
commands::SimulationBox LiggghtsEngine::Implementation::box() const {
    const double margin = (context_.has_clumps ? k_clump_margin : k_margin_in_radii) * half_width(settings_.domain);
    commands::SimulationBox box = bounds(settings_.domain);
    box.low.array() -= margin;
    box.high.array() += margin;
    return box;
}

void LiggghtsEngine::Implementation::start_liggghts() {
    // All goes to the "screen", because some errors do not reach LIGGGHTS' log, and parts of it write there without asking whether it
    // exists.
    const std::string log = settings_.log.empty() ? "/dev/null" : settings_.log.string();
    std::vector<std::string> arguments{"liggghts", "-screen", log, "-log", "none", "-nocite"};
    std::vector<char*> pointers;
    for (std::string& argument : arguments) pointers.push_back(argument.data());
    const QuietOutput quiet;  // a second instance in the process warns of every contact model that it finds registered
    lammps_ = std::make_unique<LAMMPS_NS::LAMMPS>(static_cast<int>(pointers.size()), pointers.data(), communicator_);
    if (lammps_->screen) std::setvbuf(lammps_->screen, nullptr, _IOLBF, BUFSIZ);  // the last words before an abort count
    ContactContext::set(lammps_.get(), &context_);
}

/// \param walls_of_restart  names by which its contacts number the walls; empty when it does not tell them, and they are this run's
void LiggghtsEngine::Implementation::declare(const std::optional<std::filesystem::path>& restart,
                                             const std::vector<std::string>& walls_of_restart) {
    commands(commands::basics());
    if (restart) {
        const QuietOutput quiet;
        command(commands::read_restart(*restart));
    } else {
        commands(commands::create_box(box()));
    }
    set_neighbours();
    command(commands::no_contacts_within(k_frozen));
    commands(commands::contact_model());
    declare_walls();
    if (!walls_of_restart.empty()) adopt_wall_contacts(walls_of_restart);
    declare_motion();
    set_up();
}

void LiggghtsEngine::Implementation::declare_walls() {
    context_.planes.clear();
    std::vector<std::string> planes;
    for (std::size_t side = 0; side < coupling::k_domain_sides.size(); ++side) {
        if (!settings_.domain.side_is_wall[side]) continue;
        const std::string id = fmt::format("plane_{}", coupling::k_domain_sides[side]);
        context_.planes[id] = static_cast<int>(walls_.size() + planes.size());
        planes.push_back(commands::plane_wall(id, static_cast<int>(side / 2), settings_.domain.position_of(side)));
    }

    const auto property = [&](const char* name, int columns) {
        command(commands::rock_property(name, columns));
        return static_cast<LAMMPS_NS::FixPropertyAtom*>(lammps_->modify->find_fix_id(name));
    };
    records_ = property(k_wall_contacts, WallContacts::columns);
    auto* rolling = context_.some_body_resists_rolling() ? property(k_wall_rolling, WallContacts::rolling_columns) : nullptr;
    wall_contacts_.emplace(lammps_.get(), context_, records_, rolling);
    context_.wall_contacts = &*wall_contacts_;
    contact_forces_ = property(k_contact_forces, 6);
    commands(planes);
}

/// LIGGGHTS makes fixes from names it was built with; ours takes the place of one without effect.
void LiggghtsEngine::Implementation::declare_motion() {
    command(commands::placeholder(k_motion));
    LAMMPS_NS::Modify& modify = *lammps_->modify;
    const int place = modify.find_fix(k_motion);
    delete modify.fix[place];
    modify.fix[place] = nullptr;
    std::string id = k_motion, group = "all", style = "cutterflow/motion";
    char* arguments[] = {id.data(), group.data(), style.data()};
    motion_ = new RockMotion(lammps_.get(), 3, arguments, context_, walls_, bodies_, settings_.gravity);
    modify.fix[place] = motion_;
    modify.fmask[place] = motion_->setmask();
}

void LiggghtsEngine::Implementation::set_neighbours() {
    const double skin = largest_radius_ > 0.0 ? k_skin_in_radii * largest_radius_ : k_skin_without_rock * half_width(settings_.domain);
    const commands::SimulationBox extent = box();
    const double bins = std::max(k_most_bins, k_bins_per_rock * static_cast<double>(lammps_->atom->natoms));
    const double coarsest = std::cbrt((extent.high - extent.low).prod() / bins);
    commands(commands::neighbours(skin, std::max(largest_radius_ + 0.5 * skin, coarsest)));
}

/// Updates LIGGGHTS' lists after rocks were added or removed; the forces of existing contacts are kept.
void LiggghtsEngine::Implementation::set_up() {
    store_contact_forces();
    context_.time = time_;
    command(commands::run(0, true));
    restore_contact_forces();
    set_up_needed_ = false;
}

void LiggghtsEngine::Implementation::store_contact_forces() {
    const LAMMPS_NS::Atom& atom = *lammps_->atom;
    if (set_up_needed_) return;
    contact_torque_ = context_.tally.torque;
    forces_on_bodies_ = context_.tally.force_on_body;
    for (int i = 0; i < atom.nlocal; ++i) {
        std::copy_n(atom.f[i], 3, contact_forces_->array_atom[i]);
        std::copy_n(atom.torque[i], 3, contact_forces_->array_atom[i] + 3);
    }
}

void LiggghtsEngine::Implementation::restore_contact_forces() {
    const LAMMPS_NS::Atom& atom = *lammps_->atom;
    for (int i = 0; i < atom.nlocal; ++i) {
        std::copy_n(contact_forces_->array_atom[i], 3, atom.f[i]);
        std::copy_n(contact_forces_->array_atom[i] + 3, 3, atom.torque[i]);
    }
    context_.tally.torque = contact_torque_;
    context_.tally.force_on_body = forces_on_bodies_;
}

double LiggghtsEngine::Implementation::sum(double value) const {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_SUM, communicator_);
    return value;
}

std::vector<Vec3> LiggghtsEngine::Implementation::sum(std::vector<Vec3> values) const {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(3 * values.size()), MPI_DOUBLE, MPI_SUM, communicator_);
    return values;
}

bool LiggghtsEngine::Implementation::is_first_rank() const {
    int rank = 0;
    MPI_Comm_rank(communicator_, &rank);
    return rank == 0;
}

void LiggghtsEngine::Implementation::gather() {
    constexpr int columns = 19;
    const LAMMPS_NS::Atom& atom = *lammps_->atom;
    std::vector<double> mine;
    int spheres_of_bodies = 0;
    for (int i = 0; i < atom.nlocal; ++i) {
        if (bodies_.hold(atom.tag[i])) {
            ++spheres_of_bodies;
            continue;
        }
        mine.push_back(context_.rock_of(atom.tag[i]));
        mine.insert(mine.end(), atom.x[i], atom.x[i] + 3);
        mine.insert(mine.end(), atom.v[i], atom.v[i] + 3);
        mine.insert(mine.end(), atom.omega[i], atom.omega[i] + 3);
        mine.push_back(2.0 * context_.radius_of(atom.radius[i]));
        mine.push_back(atom.density[i]);
        mine.push_back(atom.type[i] == k_frozen ? 1.0 : 0.0);
        mine.insert(mine.end(), motion_->impulse(i).data(), motion_->impulse(i).data() + 3);
        mine.insert(mine.end(), motion_->contact_impulse(i).data(), motion_->contact_impulse(i).data() + 3);
    }
    int ranks = 1;
    MPI_Comm_size(communicator_, &ranks);
    std::vector<int> counts(ranks), starts(ranks);
    const int count = static_cast<int>(mine.size());
    MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator_);
    std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
    std::vector<double> all(starts.back() + counts.back());
    MPI_Allgatherv(mine.data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, communicator_);

    if (!bodies_.empty() && static_cast<std::size_t>(std::lround(sum(spheres_of_bodies))) != bodies_.spheres())
        throw vanished(fmt::format("{:.0f} of {} spheres of clumps vanished from the DEM by {:.6g} s",
                                   static_cast<double>(bodies_.spheres()) - sum(spheres_of_bodies), bodies_.spheres(), time_));

    struct Found {
        coupling::Rock rock;
        Vec3 impulse, contact_impulse;
    };
    std::vector<Found> found;
    frozen_.clear();
    for (std::size_t k = 0; k < all.size(); k += columns) {
        const double* row = all.data() + k;
        const coupling::Rock rock{static_cast<int>(row[0]), Vec3(row + 1), Vec3(row + 4), Vec3(row + 7), row[10], row[11]};
        found.push_back({rock, Vec3(row + 13), Vec3(row + 16)});
        if (row[12] != 0.0) frozen_.push_back(rock.id);
    }
    for (const RigidBody& body : bodies_.all()) {
        found.push_back({body.state, body.impulse, body.contact_impulse});
        if (body.frozen) frozen_.push_back(body.state.id);
    }
    std::sort(frozen_.begin(), frozen_.end());
    std::sort(found.begin(), found.end(), [](const Found& a, const Found& b) { return a.rock.id < b.rock.id; });
    rocks_ = Rocks{};
    impulse_.clear();
    contact_impulse_.clear();
    for (const Found& one : found) {
        rocks_.append(one.rock);
        impulse_.push_back(one.impulse);
        contact_impulse_.push_back(one.contact_impulse);
    }
}

double LiggghtsEngine::Implementation::largest_time_step() const {
    const coupling::ContactSettings& contact = settings_.contact;
    if (context_.linear) {
        const coupling::LinearContactSettings& law = settings_.linear;
        return physics::linear_contact_step(law.theta, law.reference_length, law.gravity, law.steps_per_period);
    }
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < rocks_.size(); ++k) {
        if (rocks_.shape[k] != coupling::k_sphere_shape) continue;
        const double radius = 0.5 * rocks_.diameter[k], density = rocks_.density[k];
        shortest = std::min(shortest, context_.shortest_contact_time(radius, context_.mass_of(radius, density), density));
    }
    for (const RigidBody& body : bodies_.all()) shortest = std::min(shortest, body.shortest);
    return contact.time_step_fraction * shortest;
}

bool LiggghtsEngine::Implementation::overlaps_wall(const Vec3& centre, double radius) const {
    const coupling::DomainSettings& domain = settings_.domain;
    for (std::size_t side = 0; side < coupling::k_domain_sides.size(); ++side) {
        if (!domain.side_is_wall[side]) continue;
        const double outward = side % 2 == 0 ? -1.0 : 1.0;
        if (outward * (centre[static_cast<Eigen::Index>(side / 2)] - domain.position_of(side)) + radius > 0.0) return true;
    }
    std::vector<double> of_rotor, of_stator, of_soil;
    for (const SteelWall& wall : walls_) {
        if (wall.is_removed(time_)) continue;
        const Vec3 point = wall.pose(time_).into_frame(centre);
        if (wall.surface().is_within(point, radius)) return true;
        (wall.is_soil() ? of_soil : wall.rotating() ? of_rotor : of_stator).push_back(wall.surface().winding_number(point));
    }
    return is_inside(of_rotor) || is_inside(of_stator) || is_inside(of_soil);
}

/// Box around rocks with all their spheres.
Eigen::AlignedBox3d LiggghtsEngine::Implementation::bounds_of(const Rocks& rocks) const {
    Eigen::AlignedBox3d box;
    for (std::size_t k = 0; k < rocks.size(); ++k) {
        const Vec3 reach = Vec3::Constant(bodies_.reach_of(rocks.at(k)));
        box.extend(Vec3(rocks.position[k] - reach)).extend(Vec3(rocks.position[k] + reach));
    }
    return box;
}

std::vector<bool> LiggghtsEngine::Implementation::room_for(const Rocks& candidates) const {
    double largest = 0.0;
    for (const std::vector<double>* diameters : {&rocks_.diameter, &candidates.diameter})
        for (const double diameter : *diameters) largest = std::max(largest, diameter);
    RockGrid grid(largest);
    const auto add = [&](const coupling::Rock& rock) {
        for (const geometry::Ball& ball : bodies_.balls_of(rock)) grid.add(ball.centre, 2.0 * ball.radius);
    };
    const Eigen::AlignedBox3d around = bounds_of(candidates);
    for (std::size_t k = 0; k < rocks_.size(); ++k) {
        const double reach = 1.01 * bodies_.reach_of(rocks_.at(k));  // more by more than rounding
        if (around.squaredExteriorDistance(rocks_.position[k]) <= reach * reach) add(rocks_.at(k));
    }
    std::vector<bool> room(candidates.size(), false);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const coupling::Rock rock = candidates.at(k);
        const std::vector<geometry::Ball> balls = bodies_.balls_of(rock);
        const auto is_blocked = [&](const geometry::Ball& ball) {
            return grid.overlaps(ball.centre, 2.0 * ball.radius) || overlaps_wall(ball.centre, ball.radius);
        };
        if (!contains(settings_.domain, rock.position) || !fits_margin(rock) || std::any_of(balls.begin(), balls.end(), is_blocked))
            continue;
        room[k] = true;
        add(rock);
    }
    return room;
}

/// LIGGGHTS loses particles outside its box, in which spheres of a clump may lie beyond the domain that the centre of mass is in.
bool LiggghtsEngine::Implementation::fits_margin(const coupling::Rock& rock) const {
    return rock.shape == coupling::k_sphere_shape || bodies_.reach_of(rock) <= coupling::k_largest_reach * half_width(settings_.domain);
}

std::vector<int> LiggghtsEngine::Implementation::insert(const Rocks& candidates) {
    for (auto id = candidates.id.begin(); id != candidates.id.end(); ++id)
        if (std::binary_search(rocks_.id.begin(), rocks_.id.end(), *id) || std::binary_search(candidates.id.begin(), id, *id))
            throw std::invalid_argument(fmt::format("rock id {} is in the run already", *id));
    const std::vector<bool> room = room_for(candidates);
    Rocks accepted;
    for (std::size_t k = 0; k < candidates.size(); ++k)
        if (room[k]) accepted.append(candidates, k);
    if (accepted.size() == 0) return {};
    store_contact_forces();
    std::vector<coupling::Rock> clumps;
    for (std::size_t k = 0; k < accepted.size(); ++k) {
        create_rock(accepted.at(k));
        if (accepted.shape[k] != coupling::k_sphere_shape) clumps.push_back(accepted.at(k));
    }
    bodies_.add(clumps);
    after_change_of_rocks();
    return accepted.id;
}

void LiggghtsEngine::Implementation::create_rock(const coupling::Rock& rock) {
    if (rock.id > std::numeric_limits<int>::max() / context_.spheres_per_rock)
        throw std::invalid_argument(fmt::format("rock id {} times {} spheres of a clump is too large", rock.id, context_.spheres_per_rock));
    const std::vector<geometry::Ball> balls = bodies_.balls_of(rock);
    for (std::size_t k = 0; k < balls.size(); ++k) create_particle(rock, context_.tag_of(rock.id, static_cast<int>(k)), balls[k]);
}

/// On the rank whose part of the box holds the centre.
void LiggghtsEngine::Implementation::create_particle(const coupling::Rock& rock, int tag, const geometry::Ball& ball) {
    largest_radius_ = std::max(largest_radius_, ball.radius + context_.half_gap);
    LAMMPS_NS::Atom& atom = *lammps_->atom;
    const LAMMPS_NS::Domain& domain = *lammps_->domain;
    Vec3 position = ball.centre;
    for (int axis = 0; axis < 3; ++axis)
        if (position[axis] < domain.sublo[axis] || position[axis] >= domain.subhi[axis]) return;
    atom.avec->create_atom(1, position.data());
    const int i = atom.nlocal - 1;
    const Vec3 velocity = rock.velocity + rock.angular_velocity.cross(position - rock.position);
    atom.tag[i] = tag;
    std::copy_n(velocity.data(), 3, atom.v[i]);
    std::copy_n(rock.angular_velocity.data(), 3, atom.omega[i]);
    atom.radius[i] = ball.radius + context_.half_gap;
    atom.density[i] = rock.density;
    atom.rmass[i] = context_.mass_of(0.5 * rock.diameter, rock.density);
    for (int f = 0; f < lammps_->modify->nfix; ++f)
        if (lammps_->modify->fix[f]->create_attribute) lammps_->modify->fix[f]->set_arrays(i);
}

void LiggghtsEngine::Implementation::remove(gsl::span<const int> ids) {
    std::vector<int> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    delete_rocks(sorted);
}

void LiggghtsEngine::Implementation::delete_rocks(const std::vector<int>& sorted_ids) {
    if (sorted_ids.empty()) return;
    LAMMPS_NS::Atom& atom = *lammps_->atom;
    store_contact_forces();
    // Contacts are kept in the neighbour list, by local numbers that are about to change; this does nothing when that was done already.
    lammps_->modify->find_fix_style_strict("contacthistory", 0)->setup_pre_exchange();
    for (int i = 0; i < atom.nlocal;) {
        if (std::binary_search(sorted_ids.begin(), sorted_ids.end(), context_.rock_of(atom.tag[i]))) {
            atom.avec->copy(atom.nlocal - 1, i, 1);
            --atom.nlocal;
        } else {
            ++i;
        }
    }
    bodies_.remove(sorted_ids);
    after_change_of_rocks();
}

/// Contacts between two frozen rocks end, those of rock that moves go on. All forces are evaluated anew, because contacts came or went.
void LiggghtsEngine::Implementation::set_frozen(gsl::span<const int> ids, bool frozen) {
    std::vector<int> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    if (sorted.empty()) return;
    const LAMMPS_NS::Atom& atom = *lammps_->atom;
    for (int i = 0; i < atom.nlocal; ++i) {
        if (!std::binary_search(sorted.begin(), sorted.end(), context_.rock_of(atom.tag[i]))) continue;
        atom.type[i] = frozen ? k_frozen : k_moving;
        if (!frozen) continue;
        std::fill_n(atom.v[i], 3, 0.0);
        std::fill_n(atom.omega[i], 3, 0.0);
    }
    bodies_.set_frozen(sorted, frozen);
    gather();
    context_.time = time_;
    command(commands::run(0, true));
    set_up_needed_ = false;
}

double LiggghtsEngine::Implementation::walls_change_until() const {
    double last = 0.0;
    for (const coupling::WallSettings& wall : settings_.walls) {
        if (!wall.travels.empty()) last = std::max(last, wall.travels.back().end);
        if (wall.turn.speed != 0.0) last = std::max(last, wall.turn.end);
        if (std::isfinite(wall.removed_at)) last = std::max(last, wall.removed_at);
    }
    if (!std::all_of(walls_.begin(), walls_.end(), [](const SteelWall& wall) { return wall.is_borne(); }))
        return std::numeric_limits<double>::infinity();
    return last;
}

void LiggghtsEngine::Implementation::after_change_of_rocks() {
    LAMMPS_NS::Atom& atom = *lammps_->atom;
    atom.natoms = static_cast<LAMMPS_NS::bigint>(sum(atom.nlocal));
    atom.nghost = 0;
    atom.map_init();
    atom.map_set();
    set_neighbours();
    set_up_needed_ = true;
    gather();
}

coupling::DemStep LiggghtsEngine::Implementation::advance(double duration, const coupling::HydrodynamicForce& force) {
    const int steps = std::max(1, static_cast<int>(std::ceil(duration / largest_time_step() * (1.0 - 1e-12))));
    if (set_up_needed_) set_up();
    command(commands::timestep(duration / steps));
    context_.time = time_;
    motion_->begin(rocks_, force);
    command(commands::run(steps, false));
    time_ += duration;

    const std::vector<int> before = rocks_.id;
    gather();
    require_all_rocks(before);

    coupling::DemStep done;
    done.substeps = steps;
    done.gravity = settings_.gravity;
    done.cutter_torque = sum(motion_->angular_impulse()) / duration;
    const std::vector<Vec3> wall_impulse = sum(motion_->wall_impulse());
    const std::vector<std::string> bodies = body_names();
    for (std::size_t body = 0; body < bodies.size(); ++body)
        done.wall_force.push_back({bodies[body], wall_impulse[body] / duration, pressed(body)});
    done.contacts = static_cast<int>(std::lround(sum(context_.tally.contacts)));
    done.max_overlap_ratio = motion_->largest_overlap_ratio();
    MPI_Allreduce(MPI_IN_PLACE, &done.max_overlap_ratio, 1, MPI_DOUBLE, MPI_MAX, communicator_);
    for (std::size_t k = 0; k < rocks_.size(); ++k) {
        if (contains(settings_.domain, rocks_.position[k])) {
            done.impulse.push_back(impulse_[k]);
            done.contact_impulse.push_back(contact_impulse_[k]);
        } else {
            done.left.append(rocks_, k);
            done.left_impulse.push_back(impulse_[k]);
            done.left_contact_impulse.push_back(contact_impulse_[k]);
        }
    }
    delete_rocks(done.left.id);
    return done;
}

std::vector<coupling::WallWork> LiggghtsEngine::Implementation::wall_work() const {
    std::vector<coupling::WallWork> works;
    for (std::size_t body = 0; body < walls_.size(); ++body) {
        if (walls_[body].is_soil()) continue;
        coupling::WallWork work{settings_.walls[body].name, work_since_[body], {}, {}, {}};
        for (const Triangle& triangle : walls_[body].surface().triangles())
            work.triangles.push_back({triangle[0], triangle[1], triangle[2]});
        for (const TriangleWork& of_triangle : context_.work[body]) {
            work.impact.push_back(of_triangle.impact);
            work.sliding.push_back(of_triangle.sliding);
        }
        for (std::vector<double>* values : {&work.impact, &work.sliding})
            MPI_Allreduce(MPI_IN_PLACE, values->data(), static_cast<int>(values->size()), MPI_DOUBLE, MPI_SUM, communicator_);
        works.push_back(std::move(work));
    }
    return works;
}

/// LIGGGHTS drops a rock outside its box, or at no position, without a word.
void LiggghtsEngine::Implementation::require_all_rocks(const std::vector<int>& before) const {
    if (rocks_.id != before) {
        double fastest = 0.0;
        for (const Vec3& velocity : rocks_.velocity) fastest = std::max(fastest, velocity.norm());
        throw vanished(
            fmt::format("{} of {} rocks vanished from the DEM near {:.6g} s; the fastest of the others moves at {:.3g} m/s, "
                        "and rock overlaps by up to {:.2g} of its radius",
                        before.size() - rocks_.size(), before.size(), time_, fastest, motion_->largest_overlap_ratio()));
    }
    for (std::size_t k = 0; k < rocks_.size(); ++k)
        if (!rocks_.position[k].allFinite())
            throw std::logic_error(fmt::format("the position of rock {} is not a number; so was a force on it", rocks_.id[k]));
}

void LiggghtsEngine::Implementation::write_checkpoint(const std::filesystem::path& folder) {
    store_contact_forces();
    command(commands::write_restart(folder / k_restart_file));
    set_up_needed_ = true;  // rocks have changed ranks
    const double torque = sum(contact_torque_);
    const std::vector<Vec3> forces = sum(forces_on_bodies_);
    const std::vector<coupling::WallWork> works = wall_work();
    nlohmann::json bodies = nlohmann::json::array();
    const std::vector<std::string> names = body_names();
    for (std::size_t body = 0; body < names.size(); ++body)
        bodies.push_back({{"name", names[body]}, {"force_n", as_list(forces[body])}, {k_pressed, as_list(pressed(body))}});
    if (is_first_rank()) {
        const bool rolling = context_.rock_rock.resists_rolling();
        nlohmann::json state{{"time_s", time_},
                             {"torque_n_m", torque},
                             {k_rolling_history, rolling},
                             {k_contact_memory, k_this_contact_memory},
                             {k_restart_hash, sha256_of_file(folder / k_restart_file)},
                             {k_walls, bodies}};
        if (context_.has_clumps) state[k_clumps] = clump_state(settings_.shapes, bodies_);
        write_file(folder / names::dem_state, state.dump(2) + "\n");
        write_wall_work(folder, works);
    }
    MPI_Barrier(communicator_);
}

/// Of a body in the order of body_names(); sides stay where they are.
Vec3 LiggghtsEngine::Implementation::pressed(std::size_t body) const {
    return body < walls_.size() ? walls_[body].pressed() : Vec3(Vec3::Zero());
}

/// Walls in the order of the settings, then the sides that are walls.
std::vector<std::string> LiggghtsEngine::Implementation::body_names() const {
    std::vector<std::string> names;
    for (const coupling::WallSettings& wall : settings_.walls) names.push_back(wall.name);
    for (std::size_t side = 0; side < coupling::k_domain_sides.size(); ++side)
        if (settings_.domain.side_is_wall[side]) names.emplace_back(coupling::k_domain_sides[side]);
    return names;
}

nlohmann::json LiggghtsEngine::Implementation::read_state_file(const std::filesystem::path& folder) const {
    const nlohmann::json state = read_json_document(folder / names::dem_state,
                                                    {{"time_s", JsonKind::number, true},
                                                     {"torque_n_m", JsonKind::number, true},
                                                     {k_rolling_history, JsonKind::truth, false},
                                                     {k_contact_memory, JsonKind::whole, false},
                                                     {k_restart_hash, JsonKind::text, false},
                                                     {"walls/*/name", JsonKind::text, false},
                                                     {"walls/*/force_n/*", JsonKind::number, false},
                                                     {"walls/*/pressed_m/*", JsonKind::number, false},
                                                     {k_clumps, JsonKind::object, false},
                                                     {"clumps/shapes/*/name", JsonKind::text, false}},
                                                    k_remedy);
    const bool written_with = state.value(k_rolling_history, false), rolling = context_.rock_rock.resists_rolling();
    if (written_with != rolling)
        throw UserError({{(folder / names::dem_state).string(),
                          fmt::format("the checkpoint was written {} rolling friction of rock on rock", written_with ? "with" : "without"),
                          fmt::format("This run has it {}; what contacts remember differs", rolling ? "above 0" : "0"),
                          "Resume with the settings of the checkpoint, or start anew"}});
    const int memory = state.value(k_contact_memory, 1);
    if (memory != k_this_contact_memory)
        throw UserError({{(folder / names::dem_state).string(), fmt::format("{} is {}", k_contact_memory, memory),
                          fmt::format("Contacts of this version remember other values, which is {}", k_this_contact_memory),
                          "Resume with the version that wrote the checkpoint, or start anew"}});
    for (const nlohmann::json& body : state.value(k_walls, nlohmann::json::array()))
        if (!body.contains("name") || !body.contains("force_n"))
            throw UserError({{(folder / names::dem_state).string(), fmt::format("a wall is {}", body.dump()), "It has a name and a force_n",
                              k_remedy}});
    require_whole_restart_file(folder / k_restart_file, state);
    require_same_clumps(settings_.shapes, state.value(k_clumps, nlohmann::json::object()), (folder / names::dem_state).string());
    return state;
}

/// Contacts with walls of the checkpoint belong to this run's walls of the same names; those with walls that this run has not, end.
void LiggghtsEngine::Implementation::adopt_wall_contacts(const std::vector<std::string>& names_before) {
    const std::vector<std::string> names = body_names();
    if (names == names_before) return;
    std::vector<int> body_now;
    for (const std::string& name : names_before) {
        const auto found = std::find(names.begin(), names.end(), name);
        body_now.push_back(found == names.end() ? -1 : static_cast<int>(found - names.begin()));
    }
    for (int i = 0; i < lammps_->atom->nlocal; ++i) {
        auto* records = reinterpret_cast<WallContactRecord*>(records_->array_atom[i]);
        for (int k = 0; k < WallContacts::max_contacts; ++k) {
            if (records[k].impact_radius == 0.0) continue;  // never used
            const auto before = static_cast<std::size_t>(records[k].body);
            const int now = before < body_now.size() ? body_now[before] : -1;
            if (now < 0) records[k] = WallContactRecord{};
            records[k].body = std::max(now, 0);
        }
    }
}

void LiggghtsEngine::Implementation::read_rocks(const std::filesystem::path& folder, const nlohmann::json& state) {
    const nlohmann::json bodies = state.value(k_walls, nlohmann::json::array());
    const std::vector<std::string> names = body_names();
    contact_torque_ = is_first_rank() ? state.at("torque_n_m").get<double>() : 0.0;
    forces_on_bodies_.assign(names.size(), Vec3::Zero());
    std::vector<std::string> names_before;
    for (const nlohmann::json& body : bodies) {
        names_before.push_back(body.at("name"));
        const auto found = std::find(names.begin(), names.end(), names_before.back());
        if (found == names.end()) continue;
        const auto now = static_cast<std::size_t>(found - names.begin());
        const std::vector<double> force = body.at("force_n"), way = body.value(k_pressed, std::vector<double>{});
        if (force.size() == 3 && is_first_rank()) forces_on_bodies_[now] = Vec3(force.data());
        if (way.size() == 3 && now < walls_.size()) walls_[now].set_pressed(Vec3(way.data()));
    }
    set_up_needed_ = true;
    command("clear");
    bodies_.clear();
    declare(folder / k_restart_file, names_before);
    if (context_.has_clumps) restore_bodies(state.at(k_clumps), settings_.shapes.size(), bodies_);
    gather();
    for (std::size_t k = 0; k < rocks_.size(); ++k)
        for (const geometry::Ball& ball : bodies_.balls_of(rocks_.at(k)))
            largest_radius_ = std::max(largest_radius_, ball.radius + context_.half_gap);
    set_neighbours();
    set_up_needed_ = true;
}

void LiggghtsEngine::Implementation::read_checkpoint(const std::filesystem::path& folder) {
    const nlohmann::json state = read_state_file(folder);
    time_ = state.at("time_s");
    read_rocks(folder, state);
    adopt_work(folder);
}

/// The first rank has all that was done so far.
void LiggghtsEngine::Implementation::adopt_work(const std::filesystem::path& folder) {
    std::vector<coupling::WallWork> works = wall_work();
    read_wall_work(folder, time_, works);
    auto work = works.begin();
    for (std::size_t body = 0; body < walls_.size(); ++body) {
        if (walls_[body].is_soil()) continue;
        work_since_[body] = work->since;
        for (std::size_t t = 0; t < work->triangles.size(); ++t)
            context_.work[body][t] = is_first_rank() ? TriangleWork{work->impact[t], work->sliding[t]} : TriangleWork{};
        ++work;
    }
}

void LiggghtsEngine::Implementation::start_from(const std::filesystem::path& folder) {
    read_rocks(folder, read_state_file(folder));
    const commands::SimulationBox needed = box();
    const LAMMPS_NS::Domain& domain = *lammps_->domain;
    const Vec3 low(domain.boxlo), high(domain.boxhi);
    const double rounding = 1e-9 * (needed.high - needed.low).norm();
    if ((low - needed.low).cwiseAbs().maxCoeff() > rounding || (high - needed.high).cwiseAbs().maxCoeff() > rounding)
        throw UserError(
            {{folder.string(),
              fmt::format("its domain, with a margin, reaches from ({:.6g} {:.6g} {:.6g}) to ({:.6g} {:.6g} {:.6g}) m", low[0], low[1],
                          low[2], high[0], high[1], high[2]),
              fmt::format("This run's reaches from ({:.6g} {:.6g} {:.6g}) to ({:.6g} {:.6g} {:.6g}) m; rock is taken over in the "
                          "same domain",
                          needed.low[0], needed.low[1], needed.low[2], needed.high[0], needed.high[1], needed.high[2]),
              "Give both runs the same rock.domain"}});
}

LiggghtsEngine::LiggghtsEngine(const coupling::DemSettings& settings, std::vector<coupling::ZoneMotion> moving, MPI_Comm communicator)
    : implementation_(std::make_unique<Implementation>(settings, std::move(moving), communicator)) {}
LiggghtsEngine::~LiggghtsEngine() = default;
const Rocks& LiggghtsEngine::rocks() const {
    return implementation_->rocks();
}
double LiggghtsEngine::largest_time_step() const {
    return implementation_->largest_time_step();
}
std::vector<bool> LiggghtsEngine::room_for(const Rocks& rocks) const {
    return implementation_->room_for(rocks);
}
std::vector<int> LiggghtsEngine::insert(const Rocks& rocks) {
    return implementation_->insert(rocks);
}
void LiggghtsEngine::remove(gsl::span<const int> ids) {
    implementation_->remove(ids);
}
std::vector<int> LiggghtsEngine::frozen() const {
    return implementation_->frozen();
}
void LiggghtsEngine::freeze(gsl::span<const int> ids) {
    implementation_->set_frozen(ids, true);
}
void LiggghtsEngine::thaw(gsl::span<const int> ids) {
    implementation_->set_frozen(ids, false);
}
double LiggghtsEngine::walls_change_until() const {
    return implementation_->walls_change_until();
}
coupling::DemStep LiggghtsEngine::advance(double duration, const coupling::HydrodynamicForce& force) {
    return implementation_->advance(duration, force);
}
std::vector<coupling::WallWork> LiggghtsEngine::wall_work() const {
    return implementation_->wall_work();
}
std::vector<double> LiggghtsEngine::zone_angles() const {
    return implementation_->zone_angles();
}
void LiggghtsEngine::write_checkpoint(const std::filesystem::path& folder) {
    implementation_->write_checkpoint(folder);
}
void LiggghtsEngine::read_checkpoint(const std::filesystem::path& folder) {
    implementation_->read_checkpoint(folder);
}
void LiggghtsEngine::start_from(const std::filesystem::path& folder) {
    implementation_->start_from(folder);
}

}  // namespace cutterflow::liggghts
