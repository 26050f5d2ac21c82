#pragma once
/// \file The coupled run: one step of fluid and rock, as named stages.
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "solver/coupling/bed_operations.hpp"
#include "solver/coupling/checkpoint.hpp"
#include "solver/coupling/feed/feed_queue.hpp"
#include "solver/coupling/rock_coupling.hpp"
#include "solver/coupling/stop_rules.hpp"
#include "solver/observe/head/fate_tracker.hpp"
#include "solver/observe/head/outflow_places.hpp"
#include "solver/observe/head/production_watch.hpp"
#include "solver/observe/momentum_balance.hpp"
#include "solver/observe/run_recorder.hpp"
#include "solver/observe/velocity/velocity_sets.hpp"
#include "solver/ports/communicator.hpp"
#include "solver/ports/dem_engine.hpp"
#include "solver/ports/fluid_engine.hpp"
#include "solver/ports/settings.hpp"
#include "solver/replay/phase_recorder.hpp"

namespace cutterflow::coupling {

/// Advances fluid and rock together.
///
/// One step from t to t + dt, with x the rocks' positions, w the deposit and psi the sampling weights (sum over cells of weight times
/// volume = 1 for every rock):
///   remove_finished_rock, act_on_bed, insert_due_rock   rock that is sucked up or left behind goes, events act, rock of the feed comes in;
///                     the void fraction is replaced without a source
///   sample_flow       u, alpha, Du/Dt at every rock with psi(x(t)) on the mesh at t
///   begin_fluid_step  the fluid picks dt (rock travels a quarter of its kernel at most) and moves the mesh
///   move_rock         (rho_s + C_AM rho_f) V dv/dt = D(v)(u - v) + (1 + C_AM) rho_f V Du/Dt + weight - buoyancy + contacts, every DEM step
///   map_rock          alpha from w(x(t)) and w(x(t + dt)), both on the mesh at t + dt; momentum exchange with w(x(t + dt))
///   end_fluid_step    momentum, pressure with d(alpha)/dt, turbulence
///   book              impulse of the rocks that the fluid did not receive is carried to the next step; fates, balances
///   report            rows, fields, checkpoint
/// Without rock only the fluid's two stages and their reports remain. A fluid that does not feel rock gets no momentum exchange; without
/// a medium rock is moved and reported alone.
class CoupledRun {
public:
    /// \param dem       null without rock
    /// \param recorder  a SilentRecorder on all ranks but the first
    /// \throws UserError  with every mistake of settings, feed and contour
    CoupledRun(const CouplingSettings& settings, const FluidProperties& properties, FluidEngine& fluid, DemEngine* dem,
               Communicator& communicator, RunRecorder& recorder, const std::filesystem::path& case_folder);

    /// One step, see above. \throws CheckFailure when the engines disagree about the rotor's angle, or rock of a
    /// mapping other than gaussian is outside the fluid's mesh
    void step();

    /// True when a stop rule holds: every feed is in and the undecided share is small enough; production is known well enough; every feed
    /// is in, every event is over, every wall stands for good and rock is at rest; a gate is idle; less than a rate passes it.
    bool finished() const;

    /// Takes the rock of another run's checkpoint into a run that begins. \throws UserError  when the feed brings one of its ids
    void start_from(const std::filesystem::path& checkpoint);

    /// Writes a checkpoint of the present time, when checkpoints are on.
    void keep();

    /// Writes the end of the run: a picture and a checkpoint of the present time (when checkpoints are on), outcomes, cost.
    void finish();

    /// Restores the state of a checkpoint folder (rock, fates, accumulators, carried momentum). The fluid is already at its time.
    /// \throws UserError  when the checkpoint is of another time or mesh, of a run with other settings, or cannot be read
    void resume(const std::filesystem::path& checkpoint);

    /// Writes `checkpoints/<time name>`; collective.
    void write_checkpoint();

private:
    void begin_recording();
    void remove_finished_rock();
    void act_on_bed();
    void insert_due_rock();
    void sample_flow();
    void begin_fluid_step();
    void move_rock();
    void map_rock();
    void end_fluid_step();
    void book();
    void report();

    void take_out(const std::vector<int>& ids, EventSurface surface, Whereabouts to);
    void count_crossings();
    void restore_account(const RunState& state);
    bool has_rock() const { return rock_ != nullptr; }
    RunInstant now() const;
    void require_equal_angles() const;
    std::vector<RockEvent> follow_rock();
    double release_tolerance() const;
    void report_ledger();
    void report_loads_and_balance();
    void report_cost(double step_seconds);
    void record_picture();
    void write_state_files(const std::filesystem::path& folder);
    void report_velocity();
    void wait_for_all();
    void record_flow();
    void resume_recording(const std::filesystem::path& checkpoint, double time);
    void on_all_ranks(const std::function<void()>& read, const std::string& of_another);
    void write_whole(const std::filesystem::path& folder, const std::function<void(const std::filesystem::path&)>& write);

    CouplingSettings settings_;
    FluidEngine& fluid_;
    DemEngine* dem_;
    Communicator& communicator_;
    RunRecorder& recorder_;
    std::filesystem::path case_folder_;

    std::unique_ptr<RockCoupling> rock_;
    std::unique_ptr<MomentumBalance> momentum_;
    std::optional<FateTracker> fates_;
    std::optional<ProductionWatch> production_;
    std::optional<VelocitySets> velocity_;
    std::unique_ptr<PhaseRecorder> phases_;  // while the flow is recorded
    FeedQueue feed_;
    RockAccount account_;
    BedOperations operations_;
    StopRules stops_;
    Rocks before_;           // the step, when there are gates
    std::set<int> starved_;  // extractions whose region is empty

    RunInstant step_start_;
    DemStep moved_;
    ExchangeBalance balance_;
    CostRow cost_;  // of the step under way
    RunCost run_cost_;
    double processor_start_ = 0.0;  ///< processor time of this process when the run began [s]
    double last_checkpoint_ = 0.0;
    double last_picture_;  // of this start [s]
    bool is_recorded_ = false;
};

}  // namespace cutterflow::coupling
