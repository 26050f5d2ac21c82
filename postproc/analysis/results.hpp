#pragma once
/// \file The numbers of a report and their JSON form, the contract `cutterflow.results/1`.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "geometry/base/statistics/production.hpp"
#include "postproc/analysis/exits/last_exits.hpp"
#include "postproc/analysis/scale/scale_numbers.hpp"
#include "postproc/analysis/spillage.hpp"
#include "postproc/analysis/steel/steel_work.hpp"
#include "postproc/analysis/time_average.hpp"
#include "postproc/run/run_reader.hpp"

namespace cutterflow::postproc {

inline constexpr const char* k_results_schema = "cutterflow.results/1";

/// Radial velocity just outside the head, averaged over azimuth and over the averaging window; positive outwards [m/s].
struct BinOutflow {
    geometry::AxialBin bin;
    std::optional<TimeAverage> radial_velocity;
    std::optional<TimeAverage> flux;  ///< outwards through the head's boundary [m3/s]; none in runs of earlier programs
};

/// Means over whole revolutions after the start of the window; before there is one, over whole passings of a blade, with which all
/// that the flow does to the rotor repeats. The torques are those that flow and rock put on the cutter, about the
/// axis from hub to ring; power is what the drive must give.
struct RotorLoads {
    double revolutions = 0.0;                ///< of the whole run
    double averaged_revolutions = 0.0;       ///< 0: no blade has passed since the start, no means
    std::optional<TimeAverage> torque_flow;  ///< [N m], pressure and viscous
    std::optional<TimeAverage> torque_rock;  ///< [N m]
    std::optional<TimeAverage> power;        ///< [W]
};

/// What flows out of the head through its contour, from the run's own mean fluxes, and the spillage of rock that would follow the flow:
/// neutral rock that is mixed well into the head leaves in proportion to the flows, S_mix = q / (1 + q). Runs of earlier programs have mean
/// radial velocities alone.
struct Mixing {
    double outflow_over_discharge = 0.0;  ///< q = Q_out / Q, Q_out the sum over the bins of what flows outwards
    double well_mixed_spillage = 0.0;     ///< S_mix
    std::optional<double> balance_error;  ///< |sum of all fluxes + Q| / Q: what goes in through the boundary has to leave by the mouth
};

/// A larger balance error leaves the outflow in doubt.
inline constexpr double k_most_boundary_error = 0.1;

/// What was lost in the window of a production, over what was fed in it, by mass: gains of the ledger's columns. Mixing and cutting are
/// within reach of the head, and may come back.
struct Losses {
    double mixing = 0.0;                          ///< had been in the head's flow
    double cutting = 0.0;                         ///< never taken in
    double left_behind = 0.0;                     ///< outside and far off, taken out of the run
    std::optional<double> left_behind_cutting{};  ///< of that, never taken in; none in runs of earlier programs
};

/// A head that is fed from a cut face.
struct FedHead {
    Production production;
    Losses losses;
    bool is_full = false;     ///< for a revolution more was owed than 5 % of what a blade passing cuts
    double owed_share = 0.0;  ///< owed, mean of the window, over what a revolution cuts
};

/// Ways out of a head that is fed from a cut face, as shares of what left it outside the mouth in the window of its production, by mass.
struct WaysOut {
    double with_outflow = 0.0;         ///< last exit through a bin where the mean flow goes outwards
    double against_inflow = 0.0;       ///< through one where it goes inwards: rock falls or is thrown out
    std::optional<double> by_cutting;  ///< never taken in: lost where it was cut, over what was spilled in the window from a known cause
    double cause_known = 1.0;          ///< of what was spilled in the window, the share with a known cause
};

/// What a head that is fed from a cut face does in the window of its production (dredging.hpp).
struct Dredging {
    std::optional<double> cut_in_situ;        ///< soil that the swing cuts [m3/s]
    std::optional<double> fed_in_situ;        ///< the same and what the swing before left [m3/s]
    std::optional<double> delivered_in_situ;  ///< fines as neutral rock: (delivered + (1 - S_mix) fines) / (rho_grain (1 - n)) [m3/s]
    double layer_share = 0.0;                 ///< of what was fed: loose rock that the swing before left
    double fines = 0.0;                       ///< cut in the window [kg]; they are not followed
    std::optional<double> delivered_fines;    ///< of them, as neutral rock [kg]: (1 - S_mix) fines; 0 without fines
    std::optional<double> concentration;      ///< volume of delivered rock and fines over the mixture's
    std::optional<double> mixture_density;    ///< [kg/m3]
    std::optional<double> spill_layer;  ///< (1 - P) M_fed / (rho_grain (1 - n)) B / (v_h s): what the swings leave in the end, at most [m]
    std::optional<double> next_layer;   ///< of it on all that the head passed, for the next swing to meet [m]
    std::optional<double> cutting_power;        ///< specific energy given by the user, times cut_in_situ [W]
    std::optional<double> energy;               ///< of the drive for flow and rock, per delivered volume of soil [J/m3]
    std::optional<double> cutting_energy;       ///< of cutting, per delivered volume of soil [J/m3]
    std::optional<double> spillage_with_fines;  ///< fines spilled as neutral rock: ((1 - P) fed + S_mix fines) / (fed + fines)
    /// Mean time that rock waits from its cut until it finds a place [s], by Little's law: mean mass owed over the rate at which it is fed,
    /// both in the window. Of a queue that grows it is less than what the last of its rock waits.
    double waiting_time = 0.0;
    std::optional<double> residence_time;     ///< from cut to mouth: waiting_time, and mean of delivered rock [s]
    std::optional<double> largest_delivered;  ///< diameter [m]
    std::optional<WaysOut> ways_out;          ///< none while nothing was spilled or the outflow is unknown
};

/// What the suction pipe carries.
struct Delivery {
    double pipe_velocity = 0.0;             ///< Q / (pi r_mouth^2) [m/s]
    std::optional<double> concentration;    ///< volume of sucked up rock / (Q * time since the first rock)
    std::optional<double> mixture_density;  ///< rho_f (1 - c) + rho_rock c [kg/m3]
};

/// Largest magnitude over all steps, relative. Absent where a run without rock has none.
struct Conservation {
    std::optional<double> solid_volume, momentum, momentum_interface, flow_balance, interface_imbalance, interface_mismatch, domain_surplus;
    std::optional<double> momentum_carried;               ///< what the water has yet to receive, over what rock exchanged in the step
    std::optional<double> momentum_carried_median;        ///< of the steps with rock: below 1 where the water takes what it is given
    std::optional<double> overfull_cells, clipped_cells;  ///< largest number in a step
    std::optional<double> swept_limited_cells, wake_limited_rocks, hidden_rocks,
        cramped_rocks;  ///< likewise; none in runs of earlier programs
};

/// What was predicted before the run, for the time that it ran.
struct PredictedCost {
    double cells = 0.0, steps = 0.0, core_s = 0.0;
};

struct Cost {
    double wall_s = 0.0;           ///< sum over the steps
    std::optional<double> core_s;  ///< as RunData::core_s
    std::size_t steps = 0;
    std::optional<int> cells, ranks;
    std::optional<double> core_s_per_revolution;
    std::map<std::string, double> share;  ///< of wall_s: fluid, mesh_motion, mapping, dem, output
    std::optional<PredictedCost> predicted;
};

struct Results {
    bool finished = false;
    double end_time = 0.0;             ///< of the last step [s]
    std::optional<Spillage> spillage;  ///< none: no rock
    std::int64_t rock_requested = 0, rock_rejected = 0;
    std::vector<BinOutflow> outflow;                  ///< empty when the run did not sample it
    std::optional<Mixing> mixing;                     ///< of the outflow
    std::optional<FedHead> fed;                       ///< of a head that is fed all the time, once it has run long enough
    std::optional<Dredging> dredging;                 ///< of the same
    std::optional<LastExits> exits;                   ///< in the window of the production, else since the first rock; none without rock
    std::optional<SteelWork> steel;                   ///< what rock does to the steel; none when the run did not count it
    std::vector<std::string> outside_usual_practice;  ///< of a head at work, in the prototype
    RotorLoads rotor;
    Delivery delivery;
    ScaleNumbers scale;
    Conservation conservation;
    Cost cost;
};

/// What the ledger of a head that is fed all the time says. \param revolution  [s] \param blade_period  from blade to blade [s]
/// \return nothing while it has not run long enough, see production_of
std::optional<FedHead> fed_head_of(const Table& ledger, double revolution, double blade_period);

/// \throws CheckFailure  when the fates of the rock do not add up
Results compute_results(const RunData& run);

/// Name and limits of an axial bin; `z_min_m` is null where it has none.
nlohmann::json axial_bin_json(const geometry::AxialBin& bin);

/// The contract's document. Undefined numbers are null; `*_reason` gives the reason.
nlohmann::json results_json(const Results& results, const RunData& run);

}  // namespace cutterflow::postproc
