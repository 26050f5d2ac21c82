#pragma once
/// \file The frozen-rotor start: a steady flow past the rotor at rest in its turning frame, from which the transient run begins.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/scenes/cutter/case_inputs.hpp"

namespace cutterflow::cases {

/// A quantity watched over the iterations of the start.
struct Monitor {
    double last = 0.0;
    double drift = 0.0;  ///< largest less smallest value over the last k_convergence_window iterations
};

inline constexpr int k_convergence_window = 50;

/// Value and drift of a history (one value per iteration, oldest first, not empty).
Monitor monitor_of(const std::vector<double>& history);

/// Result of the start. It need not be fully converged: the transient run continues from it.
struct StartFlowReport {
    int iterations = 0;
    Monitor outlet_pressure;      ///< area mean of p* at the outlet [m2/s2]
    Monitor torque;               ///< of the flow on the cutter about the axis [N m]
    double flow_imbalance = 0.0;  ///< |inflow - outflow| over the discharge at the last iteration
    double wall_s = 0.0;          ///< all programs of the stage
    double core_s = 0.0;

    /// "250 iterations; over the last 50 the outlet pressure moved by 0.4 % ..."
    std::string text() const;
};

inline constexpr int k_start_iterations = 250;

/// Called while simpleFoam runs.
using StartProgress = std::function<void(int iteration, int iterations)>;

/// Runs stock simpleFoam with the rotor frozen (MRF) in the sub-case `start/` (its mesh is a link to constant/polyMesh) from the fields of
/// 0/, on inputs.ranks ranks, and puts the resulting U, p, k, epsilon and nut into 0/. The flux is left to the run: the frozen one is
/// relative to the turning frame and does not hold on a moving mesh. An older start/ is replaced.
/// \pre write_case was called and the mesh exists
/// \throws ToolError     a program failed (with its log)
/// \throws CheckFailure  the flow diverged
StartFlowReport run_start_flow(const std::filesystem::path& run_directory, const CaseInputs& inputs, int iterations = k_start_iterations,
                               const StartProgress& progress = {});

/// Takes the flow that `donor`, another run directory whose start is done, computed from the same mesh, fields, properties and settings:
/// files that are the same byte by byte, so that running them again would give the same flow. As run_start_flow, an older start/ is
/// replaced. \return none when something differs; the start has to be run then
std::optional<StartFlowReport> take_start_flow(const std::filesystem::path& run_directory, const std::filesystem::path& donor,
                                               const CaseInputs& inputs, int iterations = k_start_iterations);

}  // namespace cutterflow::cases
