#include "solver/coupling/coupled_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <fmt/format.h>
#include <gsl/assert>

#include "geometry/base/mistakes.hpp"
#include "geometry/base/process/processor_time.hpp"
#include "geometry/base/run_files.hpp"
#include "geometry/base/sphere.hpp"
#include "solver/coupling/coupling_methods.hpp"
#include "solver/observe/gate_crossings.hpp"
#include "solver/ports/recording_summary.hpp"

namespace cutterflow::coupling {
namespace {

namespace fs = std::filesystem;

/// Angles [rad] of mesh and walls may differ by rounding only.
constexpr double k_angle_tolerance = 1e-9;

/// Angle [rad, or of the whole angle] that a resumed rotor may be off: its time is the name of a folder.
constexpr double k_resumed_angle_tolerance = 1e-6;

/// Deviation [m, or of a unit vector] of a rotor's axis from the z axis that is rounding.
constexpr double k_axis_tolerance = 1e-9;

/// Volume that a step may have too much in a closed domain, over its volume: rounding of sums over many cells.
constexpr double k_largest_surplus = 1e-10;

/// Share of the fed mass that may be missing in the ledger: rounding.
constexpr double k_largest_ledger_error = 1e-9;

/// Tolerance on release times, as a fraction of the step (simulated time accumulates rounding).
constexpr double k_due_tolerance = 1e-3;

/// Adds the wall time of its life to a sum [s].
class Timer {
public:
    explicit Timer(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
    ~Timer() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    double& seconds_;
    Clock::time_point start_;
};

/// Whether an event that acts once has nothing to act on. Extractions tell how they stand.
/// \param ids  of the rock in its region \param frozen  ids, sorted
bool finds_nothing(OperationKind kind, const std::vector<int>& ids, const std::vector<int>& frozen) {
    const auto can_act = [&](int id) { return kind != OperationKind::thaw || std::binary_search(frozen.begin(), frozen.end(), id); };
    return kind != OperationKind::extract && std::none_of(ids.begin(), ids.end(), can_act);
}

/// The head's contour, bins and azimuths are about the z axis.
std::vector<Mistake> check_axis(const ZoneMotion& zone) {
    const RotationAxis& axis = zone.axis;
    const bool is_z = axis.direction.head<2>().norm() < k_axis_tolerance && axis.origin.head<2>().norm() < k_axis_tolerance;
    if (is_z) return {};
    const auto text = [](const Vec3& v) { return fmt::format("({:.6g} {:.6g} {:.6g})", v[0], v[1], v[2]); };
    return {{"constant/dynamicMeshDict",
             fmt::format("cell zone {} turns about an axis along {} through {}", zone.name, text(axis.direction), text(axis.origin)),
             "Sections fates and outflow of constant/couplingProperties take the z axis for the head's",
             "Place the head on the z axis, or remove the two sections"}};
}

/// The fluid spreads a closed domain's surplus over all cells, where it would be a source that nobody sees.
void require_closed_volume(const BalanceRow& balance) {
    if (balance.domain_surplus <= k_largest_surplus) return;
    throw CheckFailure(
        {"", fmt::format("at time {:.9g} s the closed domain has {:.3g} of its volume too much", balance.time, balance.domain_surplus),
         fmt::format("Rock and water fill a closed domain to {:g} of its volume per step", k_largest_surplus),
         "Check that velocities on the boundary let nothing in or out; else report this as a defect"});
}

/// Continuity and the flow balance hold in a flow that has blown up as in any other.
void require_calm(const BalanceRow& balance, const std::optional<double>& largest_speed) {
    if (!largest_speed || balance.speed_max <= *largest_speed) return;
    throw CheckFailure(
        {"",
         fmt::format("at time {:.9g} s the fluid in a cell moves at {:.4g} m/s; its flow has blown up", balance.time, balance.speed_max),
         fmt::format("Nothing here drives it to more than largestSpeed = {:.4g} m/s", *largest_speed), "Report this as a defect"});
}

std::vector<std::size_t> all_of(const Rocks& rocks) {
    std::vector<std::size_t> numbers(rocks.size());
    std::iota(numbers.begin(), numbers.end(), std::size_t{0});
    return numbers;
}

}  // namespace

CoupledRun::CoupledRun(const CouplingSettings& settings, const FluidProperties& properties, FluidEngine& fluid, DemEngine* dem,
                       Communicator& communicator, RunRecorder& recorder, const fs::path& case_folder)
    : settings_(settings),
      fluid_(fluid),
      dem_(dem),
      communicator_(communicator),
      recorder_(recorder),
      case_folder_(case_folder),
      last_picture_(fluid.time()) {
    Mistakes mistakes;
    mistakes.add(check_settings(settings, properties, names::coupling_properties));
    if (settings.fates || settings.outflow)
        for (const ZoneMotion& zone : fluid.moving_zones()) mistakes.add(check_axis(zone));
    const auto moving = fluid.moving_zones();
    const ZoneMotion rotor = moving.empty() ? ZoneMotion{} : moving[0];
    if (settings.has_rock && !settings.rock_feed.empty())
        mistakes.gather([&] { feed_ = FeedQueue(read_rock_feed(settings.rock_feed, {}, settings.shapes), settings.queue, rotor); });
    if (settings.fates && mistakes.empty())
        mistakes.gather([&] {
            const geometry::Contour contour = read_contour(*settings.fates);
            const FateTracker tracker(*settings.fates, contour);
            if (settings.outflow) fluid.watch(velocity_and_flux_places(contour, tracker.bins(), settings.outflow->offset));
            if (settings.has_rock) fates_ = tracker;
        });
    if (settings.has_rock && settings.stop && settings.stop->target_half_width > 0.0) {
        if (rotor.speed == 0.0)
            mistakes.add("stop.targetHalfWidth without a turning zone", "Production is told over whole revolutions",
                         "Remove the key, or let a zone turn");
        else
            production_.emplace(2.0 * k_pi / std::abs(rotor.speed), settings.stop->target_half_width);
    }
    const CouplingMethod& method = coupling_method(settings);
    if (settings.has_rock) mistakes.add(method.mesh_mistakes(settings, fluid, communicator));
    if (settings.velocity && mistakes.empty()) mistakes.gather([&] { velocity_.emplace(*settings.velocity, fluid); });
    mistakes.refuse();
    if (settings.has_rock) {
        rock_ = method.make(settings, properties, fluid, *dem, communicator);
        if (fluid.feels_rock()) momentum_ = std::make_unique<MomentumBalance>(properties, fluid, *dem, communicator);
    }
    if (settings.record) phases_ = std::make_unique<PhaseRecorder>(*settings.record, fluid);

    double cells = static_cast<double>(fluid.cells().centres.size());
    communicator.sum(gsl::span<double>(&cells, 1));
    run_cost_.cells = cells;
    run_cost_.ranks = communicator.size();
    processor_start_ = processor_seconds();
    last_checkpoint_ = fluid.time();
    operations_ = BedOperations(settings.operations);
    stops_ = StopRules(settings.at_rest, settings.idle, settings.below, fluid.time());
}

/// The first call of a run counts: at the end of a start that could have been refused, or with the first step.
void CoupledRun::begin_recording() {
    if (!std::exchange(is_recorded_, true)) recorder_.begin();
}

void CoupledRun::step() {
    begin_recording();
    cost_ = CostRow();
    double seconds = 0.0;
    {
        const Timer timer(seconds);
        remove_finished_rock();
        act_on_bed();
        insert_due_rock();
        sample_flow();
        begin_fluid_step();
        move_rock();
        map_rock();
        end_fluid_step();
        book();
        report();
    }
    report_cost(seconds);
}

RunInstant CoupledRun::now() const {
    const auto moving = fluid_.moving_zones();
    return {fluid_.time(), moving.empty() ? 0.0 : moving[0].angle(fluid_.time())};
}

double CoupledRun::release_tolerance() const {
    return k_due_tolerance * fluid_.time_step();
}

/// With packets of rock, so that the DEM sets itself up once for both.
void CoupledRun::remove_finished_rock() {
    if (!has_rock() || !fates_ || !feed_.packet_is_due(fluid_.time(), release_tolerance())) return;
    const Timer timer(cost_.mapping);
    const std::vector<int> leaving = fates_->finished();
    if (leaving.empty()) return;
    for (const RockEvent& event : fates_->take_out(leaving, dem_->rocks(), now())) recorder_.event(event);
    rock_->remove(leaving);
    for (const int id : leaving) account_.take_out(id, Whereabouts::decided);
}

/// Events in the order of the settings; each sees what the ones before it did.
void CoupledRun::act_on_bed() {
    if (!has_rock()) return;
    const Timer timer(cost_.mapping);
    for (const std::size_t number : operations_.due(fluid_.time(), release_tolerance())) {
        const std::vector<int> ids = operations_.take(number, fluid_.time(), release_tolerance(), dem_->rocks(), dem_->frozen(), account_);
        if (finds_nothing(operations_.kind_of(number), ids, dem_->frozen()))
            recorder_.warning(fluid_.time(),
                              fmt::format("events[{}] ({}) finds nothing in its region", number, name_of(operations_.kind_of(number))));
        switch (operations_.kind_of(number)) {
            case OperationKind::remove:
                take_out(ids, EventSurface::remove, Whereabouts::removed);
                break;
            case OperationKind::extract:
                take_out(ids, EventSurface::extract, Whereabouts::extracted);
                break;
            case OperationKind::freeze:
                dem_->freeze(ids);
                break;
            case OperationKind::thaw:
                dem_->thaw(ids);
                break;
        }
    }
    for (const ExtractionRow& row : operations_.take_rows()) {
        recorder_.extraction(row);
        if (!row.starved)
            starved_.erase(row.event);
        else if (starved_.insert(row.event).second)
            recorder_.warning(row.time, fmt::format("events[{}] (extract) is starved: {:.6g} kg are due and {:.6g} kg out, and the region "
                                                    "has no rock that could be taken",
                                                    row.event, row.due, row.extracted));
    }
}

/// \param ids  sorted
void CoupledRun::take_out(const std::vector<int>& ids, EventSurface surface, Whereabouts to) {
    if (ids.empty()) return;
    const Rocks& rocks = dem_->rocks();
    for (const int id : ids) {
        const auto p = static_cast<std::size_t>(std::lower_bound(rocks.id.begin(), rocks.id.end(), id) - rocks.id.begin());
        recorder_.event(rock_event(surface, EventDirection::out, rocks, p, now()));
        account_.take_out(id, to);
    }
    rock_->remove(ids);
}

void CoupledRun::insert_due_rock() {
    if (!has_rock()) return;
    const Timer timer(cost_.mapping);
    feed_.collect_due(fluid_.time(), release_tolerance());
    if (!feed_.packet_is_due(fluid_.time(), release_tolerance())) return;
    const auto room_for = [&](const std::vector<FeedRock>& rocks) { return rock_->room_for(rocks); };
    const std::vector<FeedRock> packet = feed_.next_packet(fluid_.time(), release_tolerance(), room_for);
    for (const FeedRock& rock : feed_.newly_waiting())
        recorder_.rejected({rock.id, fluid_.time(), "overlaps a rock or a wall or lies outside the domain"});
    if (packet.empty()) return;
    Ensures(rock_->insert(packet).empty());
    const Rocks& rocks = dem_->rocks();
    std::vector<std::size_t> placed;
    for (const FeedRock& rock : packet) {
        const auto p = static_cast<std::size_t>(std::lower_bound(rocks.id.begin(), rocks.id.end(), rock.id) - rocks.id.begin());
        placed.push_back(p);
        recorder_.event(fates_ ? fates_->place(rock.id, rock.diameter, rock.density, rocks.position[p], rocks.velocity[p], now())
                               : rock_event(EventSurface::feed, EventDirection::in, rocks, p, now()));
    }
    account_.place(rocks, placed);
}

void CoupledRun::sample_flow() {
    if (!has_rock()) return;
    const Timer timer(cost_.mapping);
    rock_->sample();
    if (momentum_) momentum_->begin(rock_->carry());
}

void CoupledRun::begin_fluid_step() {
    step_start_ = now();
    const Timer timer(cost_.mesh_motion);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    // Rock was placed for the rotor's angle at its time.
    const double next_event = std::min(feed_.next_release(), operations_.next_time(fluid_.time(), release_tolerance()));
    fluid_.begin_step(has_rock() ? rock_->travel_limit() : infinity, next_event);
}

void CoupledRun::move_rock() {
    if (!has_rock()) return;
    const Timer timer(cost_.dem);
    if (!settings_.gates.empty()) before_ = dem_->rocks();
    moved_ = rock_->move();
    require_equal_angles();
}

void CoupledRun::require_equal_angles() const {
    const std::vector<double> walls = dem_->zone_angles();
    const auto moving = fluid_.moving_zones();
    for (std::size_t zone = 0; zone < walls.size(); ++zone) {
        const double mesh = moving[zone].angle(fluid_.time());
        // The walls' angle is measured within one turn.
        if (std::abs(std::remainder(walls[zone] - mesh, 2.0 * k_pi)) <= k_angle_tolerance * std::max(1.0, std::abs(mesh))) continue;
        throw CheckFailure({"",
                            fmt::format("the walls of zone {} are at {:.12g} rad, its mesh at {:.12g} rad, at time {:.9g} s",
                                        moving[zone].name, walls[zone], mesh, fluid_.time()),
                            "The angle of a zone must be equal for fluid and rock", "Report this as a defect"});
    }
}

void CoupledRun::map_rock() {
    if (!has_rock()) return;
    const Timer timer(cost_.mapping);
    rock_->map();
}

void CoupledRun::end_fluid_step() {
    const Timer timer(cost_.fluid);
    if (has_rock())
        fluid_.end_step(rock_->void_fraction_old(), rock_->void_fraction_new(), rock_->exchange());
    else
        fluid_.end_step({}, {}, {});
}

void CoupledRun::book() {
    if (!has_rock()) return;
    const Timer timer(cost_.mapping);
    balance_ = rock_->book();
    for (const std::string& warning : rock_->take_warnings()) recorder_.warning(fluid_.time(), warning);
    for (const RockEvent& event : follow_rock()) recorder_.event(event);
    for (const int id : moved_.left.id) account_.take_out(id, Whereabouts::left_domain);
    count_crossings();
    if (stops_.watches_rest()) stops_.note_rest(fluid_.time(), restlessness(dem_->rocks(), dem_->frozen(), moved_.gravity.norm()));
}

void CoupledRun::count_crossings() {
    if (settings_.gates.empty()) return;
    const auto count = [&](const Rocks& rocks) {
        for (std::size_t p = 0; p < rocks.size(); ++p) {
            const auto q =
                static_cast<std::size_t>(std::lower_bound(before_.id.begin(), before_.id.end(), rocks.id[p]) - before_.id.begin());
            for (const GateCrossing& crossing : crossings(settings_.gates, before_.position[q], rocks.position[p])) {
                const std::string& gate = settings_.gates[crossing.gate].name;
                const double time = step_start_.time + crossing.share * (fluid_.time() - step_start_.time);
                const double mass = sphere_mass(rocks.diameter[p], rocks.density[p]);
                recorder_.gate({time, gate, rocks.id[p], crossing.sense, crossing.place, rocks.velocity[p], rocks.diameter[p], mass});
                stops_.note_crossing(time, gate, crossing.sense * mass);
            }
        }
    };
    count(dem_->rocks());
    count(moved_.left);
}

std::vector<RockEvent> CoupledRun::follow_rock() {
    const Rocks& left = moved_.left;
    std::vector<RockEvent> events;
    if (fates_) events = fates_->move(dem_->rocks(), step_start_, now());
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (fates_) {
            const auto more = fates_->leave(left.id[k], left.position[k], left.velocity[k], step_start_, now());
            events.insert(events.end(), more.begin(), more.end());
        } else {
            events.push_back(rock_event(EventSurface::domain, EventDirection::out, left, k, now()));
        }
    }
    return events;
}

void CoupledRun::report() {
    const Timer timer(cost_.output);
    if (fluid_.feels_rock()) report_loads_and_balance();
    record_flow();
    if (has_rock()) {
        recorder_.account(fluid_.time(), account_.totals());
        recorder_.contacts(fluid_.time(), moved_.contacts, moved_.max_overlap_ratio);
        recorder_.walls(fluid_.time(), moved_.wall_force);
    }
    // The row before the start bounds the first interval that is averaged.
    if (settings_.outflow && fluid_.time() + fluid_.time_step() >= settings_.outflow->start_time) {
        const std::vector<double> means = fluid_.watched_means();
        const gsl::span<const double> all(means);
        recorder_.outflow(fluid_.time(), all.first(means.size() / 2), all.last(means.size() / 2));
    }
    if (velocity_) velocity_->sample_if_due(fluid_);
    if (fates_) {
        recorder_.fates(fluid_.time(), fates_->totals());
        report_ledger();
    }
    if (has_rock()) account_.require(dem_->rocks(), fluid_.time());
    if (fluid_.write_if_due() && has_rock()) record_picture();
    // Half a step of tolerance, so that checkpoints do not lag their interval by one step each time.
    if (settings_.checkpoint && fluid_.time() + 0.5 * fluid_.time_step() >= last_checkpoint_ + settings_.checkpoint->interval)
        write_checkpoint();
}

void CoupledRun::report_loads_and_balance() {
    const FluidLoads loads = fluid_.loads();
    const auto moving = fluid_.moving_zones();
    const double speed = moving.empty() ? 0.0 : moving[0].speed;
    LoadsRow row{fluid_.time(), now().rotor_angle, loads.torque_pressure, loads.torque_viscous, moved_.cutter_torque, 0.0};
    row.power = -(row.torque_pressure + row.torque_viscous + row.torque_rock) * speed;
    row.soil_force = loads.soil_force;
    recorder_.loads(row);

    BalanceRow balance;
    balance.time = fluid_.time();
    balance.solid_volume_error = balance_.solid_volume_error;
    balance.deposit_error = balance_.deposit_error;
    balance.flow_balance_error = loads.through_flow > 0.0 ? (std::abs(loads.boundary_flow) + loads.wall_flow) / loads.through_flow : 0.0;
    balance.interface_imbalance = loads.interface_imbalance;
    balance.interface_mismatch = loads.interface_mismatch;
    balance.continuity_error = loads.continuity_error;
    balance.domain_surplus = loads.domain_surplus;
    balance.clipped_cells = loads.clipped_cells;
    balance.outlet_flow = loads.outlet_flow;
    balance.outlet_pressure = loads.outlet_pressure;
    balance.solid_fraction_max = balance_.solid_fraction_max;
    balance.overfull_cells = balance_.overfull_cells;
    balance.limited = balance_.limited;
    balance.courant_max = loads.courant_max;
    balance.speed_max = loads.speed_max;
    balance.overlap_ratio_max = moved_.max_overlap_ratio;
    balance.dem_substeps = moved_.substeps;
    balance.contacts = moved_.contacts;
    if (has_rock()) {
        balance.momentum = momentum_->end(rock_->carry(), moved_, loads);
        balance.rocks = static_cast<int>(dem_->rocks().size());
        balance.exchanged_volume = rock_->booked().volume;
        balance.exchanged_momentum = rock_->booked().momentum.norm();
    }
    recorder_.balance(balance);
    require_closed_volume(balance);
    require_calm(balance, settings_.largest_speed);
}

void CoupledRun::report_ledger() {
    const RockLedger ledger = ledger_of(fates_->rocks(), dem_->rocks(), feed_.fed_mass(), feed_.owed_mass());
    recorder_.ledger(fluid_.time(), ledger);
    if (production_) production_->add(fluid_.time(), ledger);
    if (ledger.error() <= k_largest_ledger_error) return;
    throw CheckFailure(
        {"",
         fmt::format("at time {:.9g} s {:.3g} of the {:.6g} kg of rock that was fed is not accounted for; rock/ledger.csv has "
                     "its columns",
                     fluid_.time(), ledger.error(), ledger.fed),
         fmt::format("All rock is somewhere, to {:g} of what was fed", k_largest_ledger_error), "Report this as a defect"});
}

void CoupledRun::record_picture() {
    const Rocks& rocks = dem_->rocks();
    std::vector<Fate> fates;
    for (std::size_t p = 0; fates_ && p < rocks.size(); ++p) fates.push_back(fates_->fate_of(rocks.id[p]));
    const double duration = fluid_.time() - step_start_.time;
    std::vector<Vec3> hydrodynamic, contact;
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        hydrodynamic.push_back(moved_.impulse[p] / duration);
        contact.push_back(moved_.contact_impulse[p] / duration);
    }
    const std::vector<int> frozen = dem_->frozen();
    RockPicture picture{fluid_.time(),
                        rocks.id,
                        rocks.position,
                        rocks.velocity,
                        rocks.diameter,
                        rocks.density,
                        hydrodynamic,
                        contact,
                        fates,
                        frozen,
                        {},
                        {}};
    if (!settings_.shapes.empty()) {
        picture.shape = rocks.shape;
        picture.orientation = rocks.orientation;
    }
    recorder_.picture(picture);
    recorder_.wall_work(fluid_.time(), dem_->wall_work());
    last_picture_ = fluid_.time();
}

void CoupledRun::report_cost(double step_seconds) {
    double seconds[] = {step_seconds, cost_.fluid, cost_.mesh_motion, cost_.mapping, cost_.dem, cost_.output};
    communicator_.max(seconds);
    const CostRow row{fluid_.time(), seconds[0], seconds[1], seconds[2], seconds[3], seconds[4], seconds[5]};
    recorder_.cost(row);
    ++run_cost_.steps;
    run_cost_.wall += row.step;
    run_cost_.totals.step += row.step;
    run_cost_.totals.fluid += row.fluid;
    run_cost_.totals.mesh_motion += row.mesh_motion;
    run_cost_.totals.mapping += row.mapping;
    run_cost_.totals.dem += row.dem;
    run_cost_.totals.output += row.output;
}

bool CoupledRun::finished() const {
    const double time = fluid_.time();
    const bool decided = settings_.stop && fates_ && feed_.all_in() && fates_->totals().undecided() <= settings_.stop->undecided;
    const bool settled = stops_.at_rest(time) && feed_.all_in() && operations_.all_done() && time >= dem_->walls_change_until();
    const bool known = production_ && production_->is_known();
    return decided || known || settled || stops_.idle(time) || stops_.below(time);
}

void CoupledRun::keep() {
    if (settings_.checkpoint && fluid_.time() > last_checkpoint_) write_checkpoint();
}

void CoupledRun::finish() {
    begin_recording();  // a run may begin at its end
    if (has_rock() && fluid_.time() > last_picture_) record_picture();
    keep();
    if (fates_) recorder_.outcomes(fates_->outcomes());
    if (phases_)
        recorder_.warning(fluid_.time(), fmt::format("the flow is not recorded: the run ended before record.endTime = {:g} s",
                                                     settings_.record->end_time));
    report_velocity();
    run_cost_.core = processor_seconds() - processor_start_;
    communicator_.sum(gsl::span<double>(&run_cost_.core, 1));
    recorder_.finished(run_cost_);
}

void CoupledRun::report_velocity() {
    if (velocity_) recorder_.velocity(*velocity_, fluid_.time());
}

void CoupledRun::wait_for_all() {
    double nothing = 0.0;
    communicator_.sum(gsl::span<double>(&nothing, 1));
}

void CoupledRun::record_flow() {
    if (!phases_) return;
    phases_->sample(fluid_);
    if (!phases_->is_over(fluid_.time() + release_tolerance())) return;
    if (phases_->is_complete()) {
        if (const auto warning = warning_of_change(phases_->tell_change(communicator_))) recorder_.warning(fluid_.time(), *warning);
        write_whole(case_folder_ / names::recording, [&](const fs::path& folder) { phases_->write(folder, communicator_); });
    } else {
        recorder_.warning(fluid_.time(),
                          "the flow is not recorded: the rotor did not pass all its phases between record.startTime and endTime");
    }
    phases_.reset();
}

/// A folder that is complete or not there, whenever the run is killed. \param write  writes this rank's files into a folder. Collective.
void CoupledRun::write_whole(const fs::path& folder, const std::function<void(const fs::path&)>& write) {
    const bool leads = communicator_.rank() == 0;
    fs::path part = folder;
    part += ".part";
    if (leads) {
        fs::remove_all(part);
        fs::create_directories(part);
    }
    wait_for_all();
    write(part);
    wait_for_all();
    if (!leads) return;
    fs::remove_all(folder);
    fs::rename(part, folder);
}

void CoupledRun::write_checkpoint() {
    fluid_.write_now();
    write_whole(case_folder_ / names::checkpoints / fluid_.time_name(), [&](const fs::path& folder) {
        write_state_files(folder);
        report_velocity();
        recorder_.flush();
    });
    if (communicator_.rank() == 0) prune_checkpoints(case_folder_, settings_.checkpoint ? settings_.checkpoint->keep : 1);
    last_checkpoint_ = fluid_.time();
}

void CoupledRun::write_state_files(const fs::path& folder) {
    RunState state;
    state.time = fluid_.time();
    state.rotor_angle = now().rotor_angle;
    state.ranks = communicator_.size();
    state.feed = feed_.state();
    if (has_rock()) {
        if (fates_) state.rocks = fates_->rocks();
        state.account = account_.entries();
        state.operations = operations_.state();
        state.stops = stops_.state();
        state.booked = rock_->booked();
        dem_->write_checkpoint(folder);
        write_carry(folder, communicator_.rank(), fluid_.cells().ids, rock_->carry());
        if (fates_) recorder_.outcomes(fates_->outcomes());
    }
    if (phases_) write_whole(folder / names::recording, [&](const fs::path& inner) { phases_->write(inner, communicator_); });
    if (communicator_.rank() != 0) return;
    write_state(folder, state);
    if (velocity_) write_velocity(folder, *velocity_);
    if (production_) write_production(folder, *production_);
}

/// A checkpoint without an account is of a run that had neither events nor gates.
void CoupledRun::restore_account(const RunState& state) {
    const Rocks& rocks = dem_->rocks();
    if (!state.account) return account_.place(rocks, all_of(rocks));
    account_.restore(*state.account);
    account_.require(rocks, fluid_.time());
    operations_.restore(state.operations);
    if (state.stops.last_crossing) stops_.restore(state.stops);
}

void CoupledRun::start_from(const fs::path& checkpoint) {
    dem_->start_from(checkpoint);
    const Rocks& rocks = dem_->rocks();
    for (const int id : feed_.ids_to_come())
        if (std::binary_search(rocks.id.begin(), rocks.id.end(), id))
            throw UserError({{settings_.rock_feed.string(), fmt::format("rock {} is in {} too", id, checkpoint.string()),
                              "Ids are unique in a run", "Number the feed's rock from the largest id of the start on"}});
    rock_->adopt_present_rock();
    account_.place(rocks, all_of(rocks));
    begin_recording();
    for (std::size_t p = 0; p < rocks.size(); ++p) {
        if (fates_) fates_->place(rocks.id[p], rocks.diameter[p], rocks.density[p], rocks.position[p], rocks.velocity[p], now());
        feed_.count_as_fed(sphere_mass(rocks.diameter[p], rocks.density[p]));
        recorder_.event(rock_event(EventSurface::start, EventDirection::in, rocks, p, now()));
    }
}

/// Reads what belongs to this rank's cells. Collective. \throws UserError  on all ranks when one refuses
/// \param of_another  what the others tell
void CoupledRun::on_all_ranks(const std::function<void()>& read, const std::string& of_another) {
    std::optional<UserError> refusal;
    try {
        read();
    } catch (const UserError& error) {
        refusal = error;
    }
    double refused = refusal ? 1.0 : 0.0;
    communicator_.max(gsl::span<double>(&refused, 1));
    if (refusal) throw UserError(*refusal);
    if (refused > 0.0)
        throw UserError(of_another, "A run resumes on the mesh that it had",
                        "Put back that mesh, or remove the folder to start from the beginning");
}

/// Goes on with the recording of the flow, or leaves one that is whole as it is. \throws UserError  when its start has passed
void CoupledRun::resume_recording(const fs::path& checkpoint, double time) {
    if (!phases_) return;
    if (fs::exists(checkpoint / names::recording))
        return on_all_ranks([&] { phases_->restore(checkpoint / names::recording); },
                            "the recording of another rank does not fit its cells");
    if (time <= settings_.record->start_time) return;
    if (!fs::exists(case_folder_ / names::recording))
        throw UserError(
            {{names::coupling_properties,
              fmt::format("record.startTime = {:g} s in a run that goes on at {:g} s", settings_.record->start_time, time),
              "A recording begins in the run that it is of", "Begin it later, remove the section, or start from the beginning"}});
    phases_.reset();
}

void CoupledRun::resume(const fs::path& checkpoint) {
    const RunState state = read_state(checkpoint);
    const auto refuse = [&](const std::string& what, const std::string& rule, const std::string& remedy) {
        throw UserError({{checkpoint.string(), what, rule, remedy}});
    };
    if (std::abs(state.time - fluid_.time()) > 1e-9 * std::max(1.0, std::abs(state.time)))
        refuse(fmt::format("the checkpoint is of time {:.9g} s, the run starts at {:.9g} s", state.time, fluid_.time()),
               "A resumed run starts at its checkpoint's time", "Set startTime to it, or remove the folder to start from the beginning");
    if (std::abs(state.rotor_angle - now().rotor_angle) > k_resumed_angle_tolerance * std::max(1.0, std::abs(state.rotor_angle)))
        refuse(fmt::format("the rotor stood at {:.9g} rad, now it would at {:.9g} rad", state.rotor_angle, now().rotor_angle),
               "A resumed run turns as it did", "Put back the rotor's speed, or remove the folder to start from the beginning");
    last_checkpoint_ = fluid_.time();
    last_picture_ = fluid_.time();  // forces of the step before the checkpoint are not kept
    // Every rank holds the same sums and reads the same file.
    if (velocity_) read_velocity(checkpoint, *velocity_);
    if (production_) read_production(checkpoint, *production_);
    resume_recording(checkpoint, state.time);
    if (!has_rock()) return;
    feed_.restore(state.feed);

    std::vector<Vec3> carry;
    on_all_ranks([&] { carry = read_carry(checkpoint, state.ranks, fluid_.cells().ids); },
                 "the carried momentum of another rank does not fit");

    dem_->read_checkpoint(checkpoint);
    require_equal_angles();
    restore_account(state);
    if (fates_) {
        for (const int id : dem_->rocks().id)
            if (state.rocks.count(id) == 0)
                refuse(fmt::format("the checkpoint does not tell what became of rock {}", id), "Fates are followed from the first rock on",
                       "Remove section fates, or the folder to start from the beginning");
        for (const auto& [id, rock] : state.rocks)
            if (rock.last_exit_bin && *rock.last_exit_bin >= fates_->bins().size())
                refuse(fmt::format("rock {} left the head through bin {}", id, *rock.last_exit_bin),
                       fmt::format("The head has {} bins, counted from 0", fates_->bins().size()),
                       "Resume with the bin width that the run began with, or remove the folder to start from the beginning");
        fates_->restore(state.rocks);
    }
    rock_->restore(std::move(carry), state.booked);
}

}  // namespace cutterflow::coupling
