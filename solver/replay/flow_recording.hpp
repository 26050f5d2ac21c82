#pragma once
/// \file The flow of a turning rotor, recorded by rotor phase: what a replay needs instead of a fluid solver.
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "solver/ports/fluid_engine.hpp"

namespace cutterflow::coupling {

/// Cells as FluidEngine::cells() hands them out, owned.
struct RecordedCells {
    std::vector<std::int64_t> ids;
    std::vector<Vec3> centres;
    std::vector<double> volumes, sizes;
    std::vector<std::uint8_t> zone;
    std::size_t size() const { return ids.size(); }
    Cells view() const { return {centres, volumes, sizes, zone, ids}; }
};

/// Mean velocity and Du/Dt of every cell at equally spaced phases, linear between them.
///
/// With B equal blades the flow in the absolute frame repeats after 2 pi / B: cells that stand still have their phases over one passing of
/// a blade. A turning cell meets the same surroundings again after a whole turn, so its phases are over one turn. Vectors of a turning cell
/// have components in its zone's frame, in which they change least.
struct FlowRecording {
    static constexpr std::size_t k_periods = 2;  ///< that of still cells and that of turning ones

    int phases = 0;                                 ///< of either period
    int blades = 1;                                 ///< B
    double start = 0.0, end = 0.0;                  ///< of the recorded interval [s]
    std::optional<double> change{};                 ///< of the flow over one revolution, see PhaseRecorder
    std::vector<ZoneMotion> moving;                 ///< one
    std::vector<std::vector<SteelTriangle>> steel;  ///< by zone
    std::vector<SteelTriangle> soil;                ///< as of Steel
    RecordedCells cells;
    std::array<std::vector<double>, k_periods> weight;  ///< time that each phase stands for [s]
    std::vector<float> velocity, acceleration;          ///< [m/s], [m/s2]; component + 3 (cell + cells phase)
};

/// Place between two phases.
struct PhasePlace {
    std::size_t before = 0, after = 0;
    double share = 0.0;  ///< of `after`
};

/// \param period  0 for still cells, 1 for turning ones \param angle  of the rotor [rad]
PhasePlace phase_place(const FlowRecording& recording, std::size_t period, double angle);

/// Period of a zone's cells.
inline std::size_t period_of(Zone zone) {
    return zone == k_still_zone ? 0 : 1;
}

/// Writes recording.json and steel (rank 0) and cells.<rank> into `folder`, which exists.
void write_recording(const std::filesystem::path& folder, const FlowRecording& recording, int rank, int ranks);

/// The cells of all ranks. \throws UserError  when a file is missing, truncated or does not fit the others
FlowRecording read_recording(const std::filesystem::path& folder);

}  // namespace cutterflow::coupling
